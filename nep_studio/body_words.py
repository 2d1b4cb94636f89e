"""What a robot does with its joints, voice and lights, in words: "opens the left hand"."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from nep_studio.plain_words import Tr, plain

Label = Callable[[str, str], str]
"""The label of an argument: the table of choices, and the argument's name."""


def body_words(action: str, args: Mapping[str, Any], label: Label, tr: Tr = plain) -> str:
    """An action as the predicate of a sentence; "" when it is none of these."""
    match action:
        case "hand":
            hand = label("hands", "side")
            return (
                tr("opens {hand}", hand=hand)
                if args.get("open")
                else tr("closes {hand}", hand=hand)
            )
        case "move_joint":
            joint, deg = args.get("joint"), args.get("degrees")
            if args.get("relative"):
                return tr("moves {joint} by {deg}°", joint=joint, deg=deg)
            return tr("moves {joint} to {deg}°", joint=joint, deg=deg)
        case "stiffness":
            part = label("lock_parts", "part")
            return (
                tr("locks {part}", part=part)
                if args.get("on")
                else tr("releases {part}", part=part)
            )
        case "awareness" if not args.get("on"):
            return tr("no longer looks at people by itself")
        case "breathing" if not args.get("on"):
            return tr("no longer breathes")
        case "look_at" | "point_at":
            return _at_words(action, args, label("frames", "frame"), tr)
        case "look_at_seen":
            return tr("looks at {thing}", thing=label("things", "thing"))
        case "track":
            thing, how = label("things", "thing"), label("tracking", "using")
            return tr("follows {thing} {how}", thing=thing, how=how)
    return _plain_words(action, tr) or _voice_words(action, args, label, tr)


def _at_words(action: str, args: Mapping[str, Any], frame: str, tr: Tr) -> str:
    x, y, z = (args.get(key) for key in ("x_m", "y_m", "z_m"))
    place = tr("{x} m forward, {y} m left, {z} m up from {frame}", x=x, y=y, z=z, frame=frame)
    if action == "look_at":
        return tr("looks at {place}", place=place)
    return tr("points at {place}", place=place)


def _voice_words(action: str, args: Mapping[str, Any], label: Label, tr: Tr) -> str:
    file, percent = args.get("file"), args.get("percent")
    match action:
        case "volume":
            return tr("sets its volume to {percent} %", percent=percent)
        case "language":
            return tr("speaks {language} from now on", language=label("languages", "language"))
        case "listen":
            words = tr(" or ").join(f"“{word}”" for word in args.get("words", ()))
            return tr("listens for {words}", words=words or tr("an answer"))
        case "intensity":
            lights = label("led_groups", "group")
            return tr("makes {lights} {percent} % bright", lights=lights, percent=percent)
        case "reset_leds":
            return tr("lights {lights} as at the start", lights=label("led_groups", "group"))
        case "learn_face":
            return tr("learns the face of {name}", name=args.get("name"))
        case "forget_face":
            return tr("forgets the face of {name}", name=args.get("name"))
        case "take_picture":
            return tr("takes the picture {file}", file=file)
        case "record_video":
            return tr("records the video {file}", file=file)
        case "play_sound":
            return tr("plays the sound {file}", file=file)
    return ""


def _plain_words(action: str, tr: Tr) -> str:
    """Actions without arguments that need telling."""
    match action:
        case "wake_up":
            return tr("wakes up")
        case "rest":
            return tr("rests")
        case "awareness":
            return tr("looks at people by itself")
        case "breathing":
            return tr("breathes")
        case "walk_freely":
            return tr("walks on and on")
        case "random_eyes":
            return tr("lets its eyes change colours by chance")
        case "rotate_eyes":
            return tr("lets colours go round its eyes")
    return ""

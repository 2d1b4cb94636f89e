"""What a robot does with its joints, voice and lights, in words: "opens the left hand"."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

Label = Callable[[str, str], str]
"""The label of an argument: the table of choices, and the argument's name."""


def body_words(action: str, args: Mapping[str, Any], label: Label) -> str:
    """An action as the predicate of a sentence; "" when it is none of these."""
    match action:
        case "hand":
            return f"{'opens' if args.get('open') else 'closes'} {label('hands', 'side')}"
        case "move_joint":
            how = "by" if args.get("relative") else "to"
            return f"moves {args.get('joint')} {how} {args.get('degrees')}°"
        case "stiffness":
            return f"{'locks' if args.get('on') else 'releases'} {label('lock_parts', 'part')}"
        case "awareness" if not args.get("on"):
            return "no longer looks at people by itself"
        case "breathing" if not args.get("on"):
            return "no longer breathes"
        case "look_at" | "point_at":
            verb = "looks" if action == "look_at" else "points"
            x, y, z = (args.get(key) for key in ("x_m", "y_m", "z_m"))
            return f"{verb} at {x} m forward, {y} m left, {z} m up from {label('frames', 'frame')}"
        case "look_at_seen":
            return f"looks at {label('things', 'thing')}"
        case "track":
            return f"follows {label('things', 'thing')} {label('tracking', 'using')}"
    return _PLAIN.get(action, "") or _voice_words(action, args, label)


def _voice_words(action: str, args: Mapping[str, Any], label: Label) -> str:
    match action:
        case "volume":
            return f"sets its volume to {args.get('percent')} %"
        case "language":
            return f"speaks {label('languages', 'language')} from now on"
        case "listen":
            words = " or ".join(f"“{word}”" for word in args.get("words", ()))
            return f"listens for {words or 'an answer'}"
        case "intensity":
            return f"makes {label('led_groups', 'group')} {args.get('percent')} % bright"
        case "reset_leds":
            return f"lights {label('led_groups', 'group')} as at the start"
        case "learn_face" | "forget_face":
            return f"{action.removesuffix('_face')}s the face of {args.get('name')}"
        case "take_picture":
            return f"takes the picture {args.get('file')}"
        case "record_video":
            return f"records the video {args.get('file')}"
        case "play_sound":
            return f"plays the sound {args.get('file')}"
    return ""


_PLAIN = {
    "wake_up": "wakes up",
    "rest": "rests",
    "awareness": "looks at people by itself",
    "breathing": "breathes",
    "walk_freely": "walks on and on",
    "random_eyes": "lets its eyes change colours by chance",
    "rotate_eyes": "lets colours go round its eyes",
}
"""Actions without arguments that need telling."""

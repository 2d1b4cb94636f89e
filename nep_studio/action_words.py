"""What a robot does, in words: "says “Hello” with a greeting", "turns 90 degrees to the left"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nep_core.messages import ActionRequest
from nep_studio.blocks.language import Language
from nep_studio.body_words import Label, body_words
from nep_studio.plain_words import Tr, plain


def action_words(request: ActionRequest, language: Language, tr: Tr = plain) -> str:
    """An action as the predicate of a sentence about the robot; ``tr`` translates."""
    args = request.args

    def label(table: str, key: str) -> str:
        name = str(args.get(key, ""))
        return language.choices.get(table, {}).get(name, name)

    match request.action:
        case "say":
            return _say_words(str(args.get("text", "")), args.get("gesture"), label, tr)
        case "do":
            return tr("takes the posture {posture}", posture=label("postures", "posture"))
        case "imitate":
            return tr("imitates the animal {animal}", animal=label("animals", "animal"))
        case "play":
            return tr("plays the animation {animation}", animation=label("animations", "animation"))
        case "walk":
            return _walk_words(args, tr)
        case "turn":
            return tr("turns {where}", where=_turned(_number(args, "degrees"), tr) or "0°")
        case "look":
            ways = _turned(_number(args, "yaw_deg"), tr), _nodded(_number(args, "pitch_deg"), tr)
            where = _joined(*ways, tr)
            return tr("looks {where}", where=where) if where else tr("looks ahead")
        case "leds":
            lights, colour = label("led_groups", "group"), args.get("colour")
            return tr("lights {lights} in {colour}", lights=lights, colour=colour)
    return body_words(request.action, args, label, tr) or request.action


def _say_words(text: str, gesture: object, label: Label, tr: Tr) -> str:
    if gesture in (None, "no_gesture"):
        return tr("says “{text}”", text=text)
    manner = label("say_gestures", "gesture")
    return tr("says “{text}” with {manner}", text=text, manner=manner)


def _walk_words(args: Mapping[str, Any], tr: Tr) -> str:
    ahead = _ahead(_number(args, "forward_m"), tr)
    steps = _joined(ahead, _sideways(_number(args, "left_m"), tr), tr)
    turn = _turned(_number(args, "turn_deg"), tr)
    walks = tr("walks {where}", where=steps) if steps else ""
    turns = tr("turns {where}", where=turn) if turn else ""
    return _joined(walks, turns, tr) or tr("stays where it is")


def _joined(first: str, second: str, tr: Tr) -> str:
    if first and second:
        return tr("{first} and {second}", first=first, second=second)
    return first or second


def _ahead(amount_m: float, tr: Tr) -> str:
    """How far forward; nothing for nothing, here and below."""
    if amount_m == 0:
        return ""
    m = f"{abs(amount_m):g}"
    return tr("{m} m forward", m=m) if amount_m > 0 else tr("{m} m back", m=m)


def _sideways(amount_m: float, tr: Tr) -> str:
    if amount_m == 0:
        return ""
    m = f"{abs(amount_m):g}"
    return tr("{m} m to the left", m=m) if amount_m > 0 else tr("{m} m to the right", m=m)


def _turned(angle_deg: float, tr: Tr) -> str:
    if angle_deg == 0:
        return ""
    deg = f"{abs(angle_deg):g}"
    is_left = angle_deg > 0
    return tr("{deg}° to the left", deg=deg) if is_left else tr("{deg}° to the right", deg=deg)


def _nodded(angle_deg: float, tr: Tr) -> str:
    if angle_deg == 0:
        return ""
    deg = f"{abs(angle_deg):g}"
    return tr("{deg}° down", deg=deg) if angle_deg > 0 else tr("{deg}° up", deg=deg)


def _number(args: Mapping[str, Any], key: str) -> float:
    value = args.get(key, 0.0)
    return float(value) if isinstance(value, int | float) else 0.0

"""What a robot does, in words: "says “Hello” with a greeting", "turns 90 degrees to the left"."""

from __future__ import annotations

from nep_core.messages import ActionRequest
from nep_studio.blocks.language import Language
from nep_studio.body_words import body_words


def action_words(request: ActionRequest, language: Language) -> str:
    """An action as the predicate of a sentence about the robot."""
    args = request.args

    def label(table: str, key: str) -> str:
        name = str(args.get(key, ""))
        return language.choices.get(table, {}).get(name, name)

    match request.action:
        case "say":
            gesture = args.get("gesture", "no_gesture")
            manner = "" if gesture == "no_gesture" else f" with {label('say_gestures', 'gesture')}"
            return f"says “{args.get('text', '')}”{manner}"
        case "do":
            return f"takes the posture {label('postures', 'posture')}"
        case "imitate":
            return f"imitates the animal {label('animals', 'animal')}"
        case "play":
            return f"plays the animation {label('animations', 'animation')}"
        case "walk":
            steps = _walk_words(_number(args, "forward_m"), _number(args, "left_m"))
            turn = _sided(_number(args, "turn_deg"), "°", "to the left", "to the right")
            ways = [f"walks {steps}" if steps else "", f"turns {turn}" if turn else ""]
            return " and ".join(filter(None, ways)) or "stays where it is"
        case "turn":
            return f"turns {_sided(_number(args, 'degrees'), '°', 'to the left', 'to the right')}"
        case "look":
            yaw = _sided(_number(args, "yaw_deg"), "°", "to the left", "to the right")
            pitch = _sided(_number(args, "pitch_deg"), "°", "down", "up")
            return f"looks {' and '.join(word for word in (yaw, pitch) if word) or 'ahead'}"
        case "leds":
            return f"lights {label('led_groups', 'group')} in {args.get('colour')}"
    return body_words(request.action, args, label) or request.action


def _walk_words(forward_m: float, left_m: float) -> str:
    forward = _sided(forward_m, " m", "forward", "back")
    sideways = _sided(left_m, " m", "to the left", "to the right")
    return " and ".join(word for word in (forward, sideways) if word)


def _sided(amount: float, unit: str, positive: str, negative: str) -> str:
    """An amount with its direction; nothing for nothing."""
    if amount == 0:
        return ""
    return f"{abs(amount):g}{unit} {positive if amount > 0 else negative}"


def _number(args: dict[str, object], key: str) -> float:
    value = args.get(key, 0.0)
    return float(value) if isinstance(value, int | float) else 0.0

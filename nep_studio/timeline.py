"""What happens in a running project, as lines that a person reads."""

from __future__ import annotations

import msgspec

from nep_core import messages as m
from nep_studio.blocks.language import Language


class Timeline:
    """Turns messages into sentences: (who, what)."""

    def __init__(self, language: Language) -> None:
        self._language = language
        self._requests: dict[str, m.ActionRequest] = {}
        self._told: set[tuple[str, str, str]] = set()

    def line(self, message: msgspec.Struct) -> tuple[str, str] | None:
        """Who did what; None for what need not be told."""
        match message:
            case m.NodeState(event="alive" | "starting" | "connected"):
                return None  # "ready" tells the same
            case m.NodeState(type="cognitive", event="stopped"):
                return None  # the program's own state tells how it ended
            case m.NodeState(event="crashed") if not message.description.startswith(message.node):
                return None  # the session tells it too, and whether the node is started again
            case m.NodeState():
                return message.node, _node_words(message)
            case m.HumanBehavior():
                return message.source or "human", self._recognised(message)
            case m.ActionRequest():
                self._requests[message.id] = message
                return None
            case m.ActionResult():
                words = self._result_words(message)
                return (message.robot, words) if words else None
            case m.ProgramState():
                words = _program_words(message)
                return ("program", words) if words else None
        return None

    def _recognised(self, message: m.HumanBehavior) -> str:
        name = message.human_state.removeprefix("gesture_")
        if name == message.human_state:
            return f"sees {name.replace('_', ' ')}"
        label = self._language.choices.get("gestures", {}).get(name, name)
        return f"recognised {label} ({message.certainty:.0%} certain)"

    def _result_words(self, result: m.ActionResult) -> str:
        request = self._requests.get(result.id)
        told = (result.id, result.robot, result.state)
        if request is None or request.action == "stop" or told in self._told:
            return ""  # a result comes again each time it is asked for
        self._told.add(told)
        if result.state == "started":
            return self._action_words(request)
        if result.state in ("failed", "cancelled"):
            reason = f": {result.description}" if result.description else ""
            return f"{result.state} to {request.action}{reason}".replace("cancelled to", "stopped:")
        return ""

    def _action_words(self, request: m.ActionRequest) -> str:
        args = request.args
        match request.action:
            case "say":
                gesture = str(args.get("gesture", "no_gesture"))
                manner = (
                    "" if gesture == "no_gesture" else f", {self._label('say_gestures', gesture)}"
                )
                return f"says “{args.get('text', '')}”{manner}"
            case "do":
                return f"takes the posture {self._label('postures', str(args.get('posture')))}"
            case "imitate":
                return f"imitates a {self._label('animals', str(args.get('animal')))}"
            case "play":
                return f"plays {self._label('animations', str(args.get('animation')))}"
            case "walk":
                forward_m, left_m = _number(args, "forward_m"), _number(args, "left_m")
                sideways = f" and {left_m:g} m to the left" if left_m else ""
                return f"walks {forward_m:g} m{sideways}"
            case "turn":
                return f"turns {_number(args, 'degrees'):g} degrees"
            case "look":
                yaw, pitch = _number(args, "yaw_deg"), _number(args, "pitch_deg")
                return f"looks {yaw:g} degrees left, {pitch:g} down"
            case "leds":
                return f"lights {args.get('group')} in {args.get('colour')}"
        return request.action

    def _label(self, table: str, name: str) -> str:
        return self._language.choices.get(table, {}).get(name, name)


def _number(args: dict[str, object], key: str) -> float:
    value = args.get(key, 0.0)
    return float(value) if isinstance(value, int | float) else 0.0


def _node_words(state: m.NodeState) -> str:
    words = state.event.replace("_", " ")
    if state.event in ("running", "warning", "crashed", "stopped") and state.description:
        return state.description
    return f"{words}: {state.description}" if state.description else words


def _program_words(state: m.ProgramState) -> str:
    match state.event:
        case "rule_started":
            return f"the rule “when {state.rule.replace('_', ' ')}” begins"
        case "failed":
            return f"stopped with an error: {state.description}"
        case "finished":
            return "has ended"
    return ""

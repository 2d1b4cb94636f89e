"""What happens in a running project, as lines that a person reads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import msgspec

from faults import Tr, plain
from nep_core.wire import messages as m
from nep_core.wire.messages import ActionRequest
from nep_studio.blocks.language import Language

# What a robot does with its joints, voice and lights, in words: "opens the left hand".

Label = Callable[[str, str], str]
"""The label of an argument: the table of choices, and the argument's name."""


def body_words(action: str, args: Mapping[str, Any], label: Label, tr: Tr = plain) -> str:
    """An action as the predicate of a sentence; "" when it is none of these."""
    match action:
        case "hand":
            hand = label("hands", "side")
            return tr("opens {hand}" if args.get("open") else "closes {hand}", hand=hand)
        case "move_joint":
            return tr(
                "moves {joint} by {deg}°" if args.get("relative") else "moves {joint} to {deg}°",
                joint=args.get("joint"),
                deg=args.get("degrees"),
            )
        case "stiffness":
            part = label("lock_parts", "part")
            return tr("locks {part}" if args.get("on") else "releases {part}", part=part)
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
    return tr("looks at {place}" if action == "look_at" else "points at {place}", place=place)


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


# What a robot does, in words: "says “Hello” with a greeting", "turns 90 degrees to the left".


def action_words(request: ActionRequest, language: Language, tr: Tr = plain) -> str:
    """An action as the predicate of a sentence about the robot; ``tr`` translates."""
    args = request.args

    def label(table: str, key: str) -> str:
        name = str(args.get(key, ""))
        return language.choices.get(table, {}).get(name, name)

    match request.action:
        case "say":
            text = str(args.get("text", ""))
            if args.get("gesture") in (None, "no_gesture"):
                return tr("says “{text}”", text=text)
            manner = label("say_gestures", "gesture")
            return tr("says “{text}” with {manner}", text=text, manner=manner)
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
            down = _number(args, "pitch_deg")
            nod = tr("{deg}° down" if down > 0 else "{deg}° up", deg=f"{abs(down):g}")
            where = _joined(_turned(_number(args, "yaw_deg"), tr), nod if down else "", tr)
            return tr("looks {where}", where=where) if where else tr("looks ahead")
        case "leds":
            lights, colour = label("led_groups", "group"), args.get("colour")
            return tr("lights {lights} in {colour}", lights=lights, colour=colour)
    return body_words(request.action, args, label, tr) or request.action


def _walk_words(args: Mapping[str, Any], tr: Tr) -> str:
    forward, left = _number(args, "forward_m"), _number(args, "left_m")
    ahead = tr("{m} m forward" if forward > 0 else "{m} m back", m=f"{abs(forward):g}")
    aside = tr("{m} m to the left" if left > 0 else "{m} m to the right", m=f"{abs(left):g}")
    steps = _joined(ahead if forward else "", aside if left else "", tr)
    turn = _turned(_number(args, "turn_deg"), tr)
    walks = tr("walks {where}", where=steps) if steps else ""
    turns = tr("turns {where}", where=turn) if turn else ""
    return _joined(walks, turns, tr) or tr("stays where it is")


def _joined(first: str, second: str, tr: Tr) -> str:
    if first and second:
        return tr("{first} and {second}", first=first, second=second)
    return first or second


def _turned(deg: float, tr: Tr) -> str:
    """How far to a side; nothing for nothing."""
    left = deg > 0
    words = tr("{deg}° to the left" if left else "{deg}° to the right", deg=f"{abs(deg):g}")
    return words if deg else ""


def _number(args: Mapping[str, Any], key: str) -> float:
    value = args.get(key, 0.0)
    return float(value) if isinstance(value, int | float) else 0.0


MOST_ACTIONS = 1000
"""So many are remembered, of which the oldest are forgotten."""

_ENDS = ("", m.PROCESS_ENDED, m.PROCESS_RESTARTS)
"""Codes of crashes that are told: by who started the node, or by one that knows no codes."""

EVENT_WORDS = (
    "ready", "running", "busy", "connecting", "connection failed", "disconnected", "warning",
    "stopped", "crashed",
)  # fmt: skip
"""What is told of a node: its events, in words."""

Line = tuple[str, str]
"""Who, and what."""


@dataclass
class _Action:
    """What is known of a requested action; its results may be quicker than the request."""

    request: m.ActionRequest | None = None
    results: dict[tuple[str, str], m.ActionResult] = field(default_factory=dict)


class Timeline:
    """Turns messages into sentences, which ``tr`` translates; one thread at a time."""

    def __init__(self, language: Language, tr: Tr = plain) -> None:
        self.language = language
        self.tr = tr
        self._actions: dict[str, _Action] = {}
        self._stopped: set[str] = set()

    def lines(self, message: msgspec.Struct) -> list[Line]:
        """Who did what; nothing for what need not be told."""
        match message:
            case m.ActionRequest():
                action = self._action(message.id)
                if action.request is not None:
                    return []  # it asks how the action is doing
                action.request = message
                return self._result_lines(message, list(action.results.values()))
            case m.ActionResult():
                action = self._action(message.id)
                if (message.robot, message.state) in action.results:
                    return []  # a result comes again each time it is asked for
                action.results[message.robot, message.state] = message
                return self._result_lines(action.request, [message])
        line = self._line(message)
        return [line] if line else []

    def _line(self, message: msgspec.Struct) -> Line | None:
        match message:
            case m.NodeState() if self._has_stopped_before(message):
                return None  # the node and the session both tell it
            case m.NodeState(event="alive" | "starting" | "connected"):
                return None  # "ready" tells the same
            case m.NodeState(type="cognitive", event="stopped"):
                return None  # the program's own state tells how it ended
            case m.NodeState(event="crashed") if message.fault.code not in _ENDS:
                return None  # the session tells it too, and whether the node is started again
            case m.NodeState():
                return message.node, _node_words(message, self.tr)
            case m.HumanBehavior():
                return message.source or self.tr("human"), self._recognised(message)
            case m.ProgramState():
                words = _program_words(message, self.tr)
                return (self.tr("program"), words) if words else None
        return None

    def _has_stopped_before(self, state: m.NodeState) -> bool:
        if state.event != "stopped":
            if state.event != "alive":  # its last heartbeat may come late
                self._stopped.discard(state.node)
            return False
        has_stopped = state.node in self._stopped
        self._stopped.add(state.node)
        return has_stopped

    def _result_lines(
        self, request: m.ActionRequest | None, results: list[m.ActionResult]
    ) -> list[Line]:
        if request is None or request.action == "stop":
            return []
        told = [(result.robot, self._result_words(request, result)) for result in results]
        return [(robot, words) for robot, words in told if words]

    def _action(self, action_id: str) -> _Action:
        action = self._actions.setdefault(action_id, _Action())
        if len(self._actions) > MOST_ACTIONS:
            del self._actions[next(iter(self._actions))]
        return action

    def _recognised(self, message: m.HumanBehavior) -> str:
        name = message.human_state.removeprefix("gesture_")
        if name == message.human_state:
            return self.tr("sees {state}", state=name.replace("_", " "))
        label = self.language.choices.get("gestures", {}).get(name, name)
        certainty = f"{message.certainty:.0%}"
        return self.tr(
            "recognised {gesture} ({certainty} certain)", gesture=label, certainty=certainty
        )

    def _result_words(self, request: m.ActionRequest, result: m.ActionResult) -> str:
        tr, reason = self.tr, result.fault.sentence
        match result.state:
            case "started":
                return action_words(request, self.language, tr)
            case "failed" if reason:
                told = tr(reason)
                return tr("failed to {action}: {reason}", action=request.action, reason=told)
            case "failed":
                return tr("failed to {action}", action=request.action)
            case "cancelled" if result.code == m.DISPLACED:
                does = action_words(request, self.language, tr)
                return tr("no longer {does}: it {reason}", does=does, reason=tr(reason))
            case "cancelled":
                return tr("no longer {does}", does=action_words(request, self.language, tr))
        return ""


def _node_words(state: m.NodeState, tr: Tr) -> str:
    told = tr(state.fault.sentence) if state.fault.sentence else ""
    if state.event in ("running", "warning", "crashed", "stopped") and told:
        return told
    words = state.event.replace("_", " ")
    words = tr(words) if words in EVENT_WORDS else words
    return f"{words}: {told}" if told else words


def _program_words(state: m.ProgramState, tr: Tr) -> str:
    match state.event:
        case "rule_started":
            rule = state.rule.replace("_", " ")
            return tr("the rule “when {rule}” begins", rule=rule)
        case "goal_started":
            return tr("pursues the goal “{goal}”", goal=state.rule)
        case "goal_finished":
            return tr("has reached the goal “{goal}”", goal=state.rule)
        case "goal_stopped":
            return tr("gives the goal “{goal}” up", goal=state.rule)
        case "goal_failed":
            return tr("cannot reach the goal “{goal}”", goal=state.rule)
        case "goal_interrupted":
            return tr("interrupts the goal “{goal}”", goal=state.rule)
        case "state_entered":
            return tr("is in the state “{state}”", state=state.rule)
        case "plan_made" | "plan_step" | "plan_step_failed" | "plan_done":
            return _plan_words(state, tr)
        case "rule_failed":
            reason, rule = tr(state.fault.sentence), state.rule.replace("_", " ")
            if not rule:
                return tr("a rule failed in line {line}: {reason}", line=state.line, reason=reason)
            return tr(
                "the rule “when {rule}” failed in line {line}: {reason}",
                rule=rule,
                line=state.line,
                reason=reason,
            )
        case "warning":
            told = tr(state.fault.sentence)
            return tr("{told} (line {line})", told=told, line=state.line) if state.line else told
        case "failed":
            return tr("stopped with an error: {reason}", reason=tr(state.fault.sentence))
        case "finished":
            return tr("has ended")
    return ""


def _plan_words(state: m.ProgramState, tr: Tr) -> str:
    """What is told of a plan: its steps, which runs now, and what came of it."""
    steps = [_step_words(step) for step in state.plan]
    number = min(max(state.step, 1), len(steps))
    match state.event:
        case "plan_made" if steps:
            return tr("plans to reach “{goal}”: {steps}", goal=state.rule, steps=", ".join(steps))
        case "plan_made":
            return tr("need not plan: “{goal}” is true already", goal=state.rule)
        case "plan_step" if steps:
            step, count = steps[number - 1], len(steps)
            return tr("step {number} of {count}: {step}", number=number, count=count, step=step)
        case "plan_step_failed":
            return tr(state.fault.sentence)
        case "plan_done" if steps:
            return tr("has followed its plan to “{goal}”", goal=state.rule)
    return ""


def _step_words(step: m.PlannedStep) -> str:
    return " ".join([step.task.replace("_", " "), *map(str, step.values)])

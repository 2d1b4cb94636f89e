"""What happens in a running project, as lines that a person reads."""

from __future__ import annotations

from dataclasses import dataclass, field

import msgspec

from nep_core import messages as m
from nep_studio.action_words import action_words
from nep_studio.blocks.language import Language
from nep_studio.plain_words import Tr, plain

MOST_ACTIONS = 1000
"""So many are remembered, of which the oldest are forgotten."""

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
        self._language = language
        self.tr = tr
        self._actions: dict[str, _Action] = {}
        self._stopped: set[str] = set()

    def lines(self, message: msgspec.Struct) -> list[Line]:
        """Who did what; nothing for what need not be told."""
        match message:
            case m.ActionRequest():
                return self._requested(message)
            case m.ActionResult():
                return self._answered(message)
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
            case m.NodeState(event="crashed") if not message.description.startswith(message.node):
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

    def _requested(self, request: m.ActionRequest) -> list[Line]:
        action = self._action(request.id)
        if action.request is not None:
            return []  # it asks how the action is doing
        action.request = request
        return self._told(request, list(action.results.values()))

    def _answered(self, result: m.ActionResult) -> list[Line]:
        action = self._action(result.id)
        if (result.robot, result.state) in action.results:
            return []  # a result comes again each time it is asked for
        action.results[result.robot, result.state] = result
        return self._told(action.request, [result])

    def _told(self, request: m.ActionRequest | None, results: list[m.ActionResult]) -> list[Line]:
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
        label = self._language.choices.get("gestures", {}).get(name, name)
        certainty = f"{message.certainty:.0%}"
        return self.tr(
            "recognised {gesture} ({certainty} certain)", gesture=label, certainty=certainty
        )

    def _result_words(self, request: m.ActionRequest, result: m.ActionResult) -> str:
        tr, reason = self.tr, result.description
        match result.state:
            case "started":
                return action_words(request, self._language, tr)
            case "failed" if reason:
                told = tr(reason)
                return tr("failed to {action}: {reason}", action=request.action, reason=told)
            case "failed":
                return tr("failed to {action}", action=request.action)
            case "cancelled":
                return tr("no longer {does}", does=action_words(request, self._language, tr))
        return ""


def _node_words(state: m.NodeState, tr: Tr) -> str:
    told = tr(state.description) if state.description else ""
    if state.event in ("running", "warning", "crashed", "stopped") and told:
        return told
    words = _event_words(state.event, tr)
    return f"{words}: {told}" if told else words


def _event_words(event: m.NodeEvent, tr: Tr) -> str:
    match event:
        case "ready":
            return tr("ready")
        case "running":
            return tr("running")
        case "busy":
            return tr("busy")
        case "connecting":
            return tr("connecting")
        case "connection_failed":
            return tr("connection failed")
        case "disconnected":
            return tr("disconnected")
        case "warning":
            return tr("warning")
        case "stopped":
            return tr("stopped")
        case "crashed":
            return tr("crashed")
    return event.replace("_", " ")


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
        case "goal_interrupted":
            return tr("interrupts the goal “{goal}”", goal=state.rule)
        case "failed":
            return tr("stopped with an error: {reason}", reason=tr(state.description))
        case "finished":
            return tr("has ended")
    return ""

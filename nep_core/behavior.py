"""Behavior: rules that fire on what the person does, and what runs at the start."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from nep_core.default_network import default_network
from nep_core.human import human_listener
from nep_core.messages import (
    PROGRAM_STATE,
    HumanBehavior,
    ProgramEvent,
    ProgramState,
)
from nep_core.network import Network
from nep_core.pubsub import Publisher
from nep_core.tasks import PROGRAM, Part, current_task

Action = Callable[[], object]
Again = Literal["ignore", "restart", "queue"]

MOST_QUEUED = 20


@dataclass
class Rule:
    """When the person does this, do that; ``again``: what if it fires while it runs."""

    state: str
    action: Action
    again: Again = "ignore"
    running: Part | None = None
    queued: int = 0
    lock: threading.Lock = field(default_factory=threading.Lock)


class Behavior:
    """The rules of a program; ``run`` returns when the program ends.

    A behaviour without rules ends when all that was started at the start is done.
    """

    def __init__(self, name: str = "behaviour", *, network: Network | None = None) -> None:
        self.name = name
        self._network = network
        self._rules: list[Rule] = []
        self._starts: list[Action] = []
        self._parts: list[Part] = []
        self._parts_lock = threading.Lock()

    def when(self, state: str, *, again: Again = "ignore") -> Callable[[Action], Action]:
        """Run the decorated function each time the person's state is ``state``.

        When that happens while the function still runs: "ignore" it, "restart" the function, or
        "queue" another run.
        """

        def add(action: Action) -> Action:
            self._rules.append(Rule(state, action, again))
            return action

        return add

    def when_started(self, action: Action) -> Action:
        """Run the decorated function when the program starts."""
        self._starts.append(action)
        return action

    def run(self) -> None:
        """Run until the program is stopped; raises the first error of any of its parts."""
        network = self._network or default_network()
        self._states = Publisher(PROGRAM_STATE, network=network)
        listener = human_listener(network)
        listener.listen(self._on_behavior)
        try:
            for action in self._starts:
                self._start(action, "")
            self._supervise()
        finally:
            listener.unlisten(self._on_behavior)
            self._cancel_all()
            self._states.close()

    def _supervise(self) -> None:
        while self._rules or self._parts:
            if PROGRAM.cancelled.wait(0.02):
                return
            self._raise_errors()

    def _raise_errors(self) -> None:
        with self._parts_lock:
            ended = [part for part in self._parts if not part.is_running]
            self._parts = [part for part in self._parts if part not in ended]
        for part in ended:
            if part.error is not None:
                raise part.error

    def _cancel_all(self) -> None:
        for part in self._parts:
            part.task.cancel()
        for part in self._parts:
            part.join(1.0)

    def _on_behavior(self, behavior: HumanBehavior) -> None:
        for rule in self._rules:
            if rule.state == behavior.human_state:
                self._fire(rule)

    def _fire(self, rule: Rule) -> None:
        with rule.lock:
            if rule.running is None or not rule.running.is_running:
                rule.running = self._start(lambda: self._run_rule(rule), rule.state)
            elif rule.again == "queue":
                rule.queued = min(rule.queued + 1, MOST_QUEUED)
            elif rule.again == "restart":
                old = rule.running
                old.task.cancel()
                rule.running = self._start(lambda: self._restart_rule(rule, old), rule.state)

    def _restart_rule(self, rule: Rule, old: Part) -> None:
        old.join()
        current_task().check()  # a newer one may have taken its place meanwhile
        self._run_rule(rule)

    def _run_rule(self, rule: Rule) -> None:
        again = True
        while again:
            self._tell("rule_started", rule.state)
            rule.action()
            again = self._goes_on(rule)  # before it is told: who hears it may fire the rule
            self._tell("rule_finished", rule.state)

    def _goes_on(self, rule: Rule) -> bool:
        """Whether another run is queued; if not, the rule may fire afresh from now on."""
        with rule.lock:
            if rule.queued > 0:
                rule.queued -= 1
                return True
            if rule.running is not None and rule.running.task is current_task():
                rule.running = None
            return False

    def _start(self, action: Action, state: str) -> Part:
        part = Part(action, f"nep-{state or 'start'}", PROGRAM)
        with self._parts_lock:  # a part that has not started yet must not count as ended
            self._parts.append(part)
            return part.start()

    def _tell(self, event: ProgramEvent, rule: str) -> None:
        name = threading.current_thread().name
        self._states.send(ProgramState(program=self.name, event=event, rule=rule, thread=name))

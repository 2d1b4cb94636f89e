"""A stage for an example: fast robots, and hands that try what its card offers."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import msgspec

from nep_core.wire.messages import ActionRequest, ProgramState
from nep_core.wire.pubsub import Publisher
from nep_studio.blocks.deployment import rules
from nep_studio.blocks.files import load
from nep_studio.blocks.generate.program import generate_program
from nep_studio.project.examples import Example, Try, examples
from nep_studio.run.installation import studio_language
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import Choices, plan
from nep_studio.run.session import Session

WAIT_S = 20.0
FAST = 50.0
EXAMPLES = {example.path.stem: example for example in examples()}


class Stage:
    """Does what a card offers in place of people, and waits for what follows."""

    def __init__(self, example: Example, network: LocalNetwork, *, has_rules: bool) -> None:
        self.example, self.has_rules = example, has_rules
        self._events: list[msgspec.Struct] = []
        self._seen = 0
        self._touching: Try | None = None
        self.may_interrupt = False
        self._has_tried = self._is_answered = False
        self._rules_before = 0
        self._came = threading.Condition()
        assert network.network is not None
        topics = {each.topic for each in example.tries}
        self._publishers = {topic: Publisher(topic, network=network.network) for topic in topics}

    def hear(self, _topic: str, message: msgspec.Struct) -> None:
        with self._came:
            self._events.append(message)
            self._came.notify_all()

    def meet(self) -> None:
        """Wait for those who hear what is tried."""
        for publisher in self._publishers.values():
            assert publisher.wait_for_subscribers(1, WAIT_S)

    def sees(self, action: str, **wanted: object) -> ActionRequest:
        """Wait for a request of this action, behind the one that was waited for before."""

        def is_it(event: msgspec.Struct) -> bool:
            asked = isinstance(event, ActionRequest) and event.action == action
            return asked and {key: event.args.get(key) for key in wanted} == wanted

        def found() -> bool:
            while self._seen < len(self._events):
                self._seen += 1
                if is_it(self._events[self._seen - 1]):
                    return True
            return False

        with self._came:
            assert self._came.wait_for(found, WAIT_S), (action, wanted, self._events)
            request = self._events[self._seen - 1]
        self.let_go()
        assert isinstance(request, ActionRequest)
        self._is_answered = self._has_tried
        return request

    def sees_end(self) -> None:
        """Wait until the program has ended by itself, and well."""

        def ends() -> list[str]:
            told = [event for event in self._events if isinstance(event, ProgramState)]
            return [state.event for state in told if state.event in ("finished", "failed")]

        with self._came:
            assert self._came.wait_for(ends, WAIT_S), self._events
            assert ends() == ["finished"], self._events

    def tries(self, number: int) -> None:
        """Try what the card offers; a touch lasts until the robot does the next thing."""
        what = self.example.tries[number]
        if what.sense == "word":
            self.sees("listen")
        elif self.has_rules and not self.may_interrupt:
            self.rest()
        self._publishers[what.topic].send(what.message())
        self._has_tried = True
        self._touching = what if what.is_touch else None

    def let_go(self) -> None:
        if self._touching is not None:
            self._publishers[self._touching.topic].send(self._touching.release())
            self._touching = None

    def rest(self) -> None:
        """Wait until every rule that has fired is done: one that runs hears nothing new.

        A rule may be told of later than what it asked for, so what was answered has fired one.
        """
        least = self._rules_before + 1 if self._is_answered else 0

        def is_over() -> bool:
            events = [event.event for event in self._events if isinstance(event, ProgramState)]
            self._rules_before = events.count("rule_started")
            return least <= self._rules_before == events.count("rule_finished")

        with self._came:
            assert self._came.wait_for(is_over, WAIT_S), self._events
        self._is_answered = False


@contextmanager
def staged(name: str, folder: Path, network: LocalNetwork, speed: float = FAST) -> Iterator[Stage]:
    """An example with fast robots; what its watch would see is tried by hand."""
    example, language = EXAMPLES[name], studio_language()
    project = load(example.path, language)
    nodes = [
        replace(node, parameters={**node.parameters, "speed": speed})
        for node in plan(project, language, Choices(), folder)
        if node.node == "action/nao"
    ]
    file = folder / "program.py"
    file.write_text(generate_program(project, language).text, encoding="utf-8")
    hats = {project.blocks[chain[0]].type for chain in rules(project, language)}
    # who is in a state hears all the time
    begins = {hat for hat in hats if not hat.startswith("state.")}
    stage = Stage(example, network, has_rules=not begins <= {"event.started"})
    network.listen(stage.hear)
    try:
        with Session(nodes, network, program=file):
            stage.meet()
            yield stage
    finally:
        network.unlisten(stage.hear)

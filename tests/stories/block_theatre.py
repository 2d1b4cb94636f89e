"""Plays programs of blocks: their real Python in a process, fast robots, and people in the test."""

from __future__ import annotations

import contextlib
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import msgspec
import pytest

from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.places import ROBOT_FILES_VARIABLE
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    HUMAN_BEHAVIOR,
    PROGRAM_CONTROL,
    PROGRAM_STATE,
    SENSE_REQUEST,
    ActionRequest,
    ActionResult,
    HumanBehavior,
    ProgramControl,
    ProgramState,
    SenseRequest,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from tests.node_running import NodeRunner
from tests.stories.programs_in_blocks import LANGUAGE

SPEED = 20
"""How many times faster than real time the robots live."""
WAIT_S = 20.0
ROBOTS = ("NAO", "NAO2", "NAO3")


class BlockTheatre(NodeRunner):
    """Three robots on the screen for one program after the other, and all that was told of them."""

    def __init__(self, network: PeerNetwork, folder: Path) -> None:
        super().__init__(network)
        self._folder = folder
        self._played = 0
        self._program = ""
        self._names: set[str] = set()
        """What the program that is played is called: as a node, and by itself."""
        self._events: list[msgspec.Struct] = []
        self._seen = dict.fromkeys(ROBOTS, 0)
        self._entered = 0
        self._came = threading.Condition()
        self._senses = Publisher(SENSE_REQUEST, network=network)
        self._person = Publisher(HUMAN_BEHAVIOR, network=network)
        self._control = Publisher(PROGRAM_CONTROL, network=network)
        self._requests = Publisher(ACTION_REQUEST, network=network)
        for topic, kind in (
            (ACTION_REQUEST, ActionRequest),
            (ACTION_RESULT, ActionResult),
            (PROGRAM_STATE, ProgramState),
        ):
            Subscriber(topic, kind, network=network, callback=self._hear)
        for robot in ROBOTS:
            self.start_node("action/nao", robot, robot=robot, speed=SPEED)
            self.state("ready", node=robot)
        assert self._senses.wait_for_subscribers(len(ROBOTS), WAIT_S)

    @contextmanager
    def plays(self, project: Project, *, prepare: str = "") -> Iterator[None]:
        """Run a project until the test is through; ``prepare`` is Python that is done before."""
        self._played += 1
        self._program = f"program_{self._played}"
        self._names = {self._program, project.name}
        file = self._folder / f"{project.name}.py"  # beside it is what the program keeps
        language = LANGUAGE.of(project)
        file.write_text(generate_program(project, language).text, encoding="utf-8")
        self.prepare = prepare
        process = self.start_node("cognitive/program", self._program, file=str(file), hold=True)
        self.prepare = ""
        self._events, self._seen, self._entered = [], dict.fromkeys(ROBOTS, 0), 0
        try:
            self.state("ready", node=self._program)
            assert self._control.wait_for_subscribers(1, WAIT_S)
            self._order("start")
            self._wait_for(lambda: self._told("started"))
            yield
        finally:
            self._order("stop")
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(5)
            self._calm_down()

    # What a person does.

    def touch(self, part: str) -> None:
        """Touch a part of the robot, and let it go."""
        for value in (1.0, 0.0):
            self._senses.send(SenseRequest(robot="NAO", sense=part, value=value))

    def feel(self, sensor: str, value: float) -> None:
        """Let a sensor of the robot measure this from now on."""
        self._senses.send(SenseRequest(robot="NAO", sense=sensor, value=value))

    def show(self, thing: str) -> None:
        """Let the robot see something, until the end of the program."""
        self._senses.send(SenseRequest(robot="NAO", sense=thing))

    def tell(self, word: str) -> None:
        """Say a word that a rule waits for."""
        self._senses.send(SenseRequest(robot="NAO", sense="word", name=word))

    def answer(self, *words: str) -> None:
        """Answer the next questions, each once the robot listens."""
        for word in words:
            self.does("listen")
            self.tell(word)

    def person_is(self, state: str) -> None:
        """Let a person do something that a recogniser has seen."""
        self._person.send(HumanBehavior(human_state=state))

    # What the program does, each behind what was waited for before.

    def says(self, *sentences: str, robot: str = "NAO") -> None:
        """Wait until the robot begins to say each of these, one after the other."""
        for sentence in sentences:
            self.does("say", robot, text=sentence)

    def hears(self, robot: str = "NAO") -> str:
        """Wait for the next sentence of the robot, whatever it is, and return it."""
        return str(self.does("say", robot).args["text"])

    def does(self, action: str, robot: str = "NAO", **wanted: object) -> ActionRequest:
        """Wait until the robot begins an action with these arguments."""

        def look() -> ActionRequest | None:
            begun = self._begun(robot)
            while self._seen[robot] < len(begun):
                asked = begun[self._seen[robot]]
                self._seen[robot] += 1
                if asked.action == action and wanted.items() <= asked.args.items():
                    return asked
            return None

        found = self._wait_for(look, f"{robot} {action} {wanted}")
        assert isinstance(found, ActionRequest)
        return found

    def rests(self, rules: int) -> None:
        """Wait until so many rules have come to their end since the start."""
        self._wait_for(lambda: len(self._told("rule_finished")) >= rules, f"{rules} rules")

    def ends(self) -> None:
        """Wait until the program has ended by itself, and well."""
        self._wait_for(lambda: self._told("finished", "failed"), "the end")
        assert [event.event for event in self._told("finished", "failed")] == ["finished"]

    def enters(self, state: str) -> None:
        """Wait until the program comes into this state, behind the one that was waited for before.

        The first of all may be missed: a program that has just begun is not heard at once.
        """

        def look() -> bool:
            entered = [event.rule for event in self._told("state_entered")]
            if state not in entered[self._entered :]:
                return False
            self._entered += entered[self._entered :].index(state) + 1
            return True

        self._wait_for(look, f"the state {state}")

    def begun(self, action: str, robot: str = "NAO") -> list[ActionRequest]:
        """All actions of this kind that the robot has begun since the start of the program."""
        return [request for request in self._begun(robot) if request.action == action]

    def said(self, robot: str = "NAO") -> list[str]:
        """All that the robot has begun to say since the start of the program."""
        return [str(request.args["text"]) for request in self.begun("say", robot)]

    def failures(self) -> list[ProgramState]:
        """What has gone wrong in the program since its start."""
        return self._told("rule_failed", "failed", "warning")

    # How it hears and waits.

    def _hear(self, message: msgspec.Struct) -> None:
        with self._came:
            self._events.append(message)
            self._came.notify_all()

    def _wait_for(self, is_so: Callable[[], object], what: str = "") -> object:
        with self._came:
            so = self._came.wait_for(is_so, WAIT_S)
            assert so, (what, *self._events[-12:])
        return so

    def _told(self, *kinds: str) -> list[ProgramState]:
        """What this program has told of these kinds."""
        told = [event for event in self._events if isinstance(event, ProgramState)]
        return [e for e in told if e.event in kinds and e.program in self._names]

    def _begun(self, robot: str) -> list[ActionRequest]:
        """What this robot has begun, as far as it is known: an answer may outrun its question."""
        events = list(self._events)
        asked = {each.id: each for each in events if isinstance(each, ActionRequest)}
        begun: list[ActionRequest] = []
        for event in events:
            if isinstance(event, ActionResult) and (event.robot, event.state) == (robot, "started"):
                if event.id not in asked:
                    break
                begun.append(asked[event.id])
        return begun

    def _order(self, command: str) -> None:
        self._control.send(ProgramControl(command=command, program=self._program))

    def _calm_down(self) -> None:
        """Let the robots be as they were at the start, for the next program."""
        stop = ActionRequest(id=f"calm_{self._played}", robots=list(ROBOTS), action="stop")
        self._requests.send(stop)
        for robot in ROBOTS:
            for sense, value in (("usual", 1.0), ("face", 0.0)):
                self._senses.send(SenseRequest(robot=robot, sense=sense, value=value))


@contextmanager
def block_theatre() -> Iterator[BlockTheatre]:
    """A theatre with a master and a network of its own, which is closed at the end."""
    with ExitStack() as ending:
        folder = ending.enter_context(tempfile.TemporaryDirectory())
        patch = ending.enter_context(pytest.MonkeyPatch.context())
        master = Master("tcp://127.0.0.1:*")
        ending.callback(master.close)
        patch.setenv(ROBOT_FILES_VARIABLE, folder)
        patch.setenv(MASTER_VARIABLE, master.endpoint)  # the nodes find it there
        network = PeerNetwork("outside", master=master.endpoint)
        ending.callback(network.close)
        theatre = BlockTheatre(network, Path(folder))
        ending.callback(theatre.close)
        yield theatre

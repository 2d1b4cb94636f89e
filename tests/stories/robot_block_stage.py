"""Runs one block after the other on a robot, and looks at the robot's own state after each."""

from __future__ import annotations

import contextlib
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from nep_core.errors import NepError
from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.master import Master
from nep_core.networks.transports import set_default_network
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.places import ROBOT_FILES_VARIABLE
from nep_core.program import tasks
from nep_core.program.human import human_listener
from nep_core.wire.messages import (
    HUMAN_BEHAVIOR,
    ROBOT_STATE,
    SENSE_REQUEST,
    SURROUNDINGS,
    HumanBehavior,
    RobotState,
    SenseRequest,
    Surroundings,
    Thing,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.generate.program import generate_program
from nep_studio.run.installation import studio_language
from tests.blocks.block_building import held, share_variables
from tests.node_running import NodeRunner
from tests.stories.robot_block_looks import ANSWERS, LOOKS
from tests.stories.robot_block_pictures import before
from tests.stories.robot_block_seen import LONG, Look, Seen, Sense
from tests.stories.robot_theatre import B, build

DRIVERS = ("virtual", "naoqi")
SPEED = 10
PATIENCE_S = 15.0
STARTED = B("event.started")
CALM = (
    B("robot.stop"),
    B("robot_moves.lock", {"part": "body"}),
    B("robot_moves.track", {"using": "off"}),
    B("robot_moves.awareness", {"on": False}),
    B("robot_moves.breathing", {"on": False}),
    B("robot.do", {"posture": "posture_stand"}),
    B("robot_lights.reset"),
)
"""Brings the robot back to how it was at the start."""
NOTHING: tuple[Sense, ...] = (
    ("face", 0.0, {"name": "Anna"}),
    ("face", 0.0, {}),
    ("mark", 0.0, {"name": "64"}),
    ("head_front", 0.0, {}),
    ("head_middle", 0.0, {}),
    ("sonar_left", 2.5, {}),
)
NUDGE: Sense = ("sonar_right", 2.5, {})
"""Changes nothing, but a robot that feels something tells at once how it is."""
LANGUAGE = studio_language()


def robot_blocks() -> list[Definition]:
    """Every block of the language that is about a robot."""
    return [
        definition
        for definition in LANGUAGE.definitions.values()
        if definition.result != "robot"  # a value, that does nothing by itself
        and "apart" not in definition.flags  # it does what is in it
        and (
            # those that may name one besides do nothing to it by themselves
            ("robot" in definition.slots and not definition.slots["robot"].group)
            or definition.category.id in ("robot_events", "robot_speech")
        )
    ]


class BlockStage(NodeRunner):
    """A robot called NAO: on the screen, or behind NAOqi and driven by our driver."""

    def __init__(
        self, network: PeerNetwork, outside: PeerNetwork, driver: str, naoqi_port: int
    ) -> None:
        super().__init__(network)
        tasks.PROGRAM.cancelled.clear()
        tasks.PROGRAM._children.clear()
        human_listener(network)
        self.body = "NAO" if driver == "virtual" else "Served"
        """Whose state is looked at, and who is told what there is to sense."""
        self.states_of: dict[str, list[RobotState]] = {"NAO": [], "Served": []}
        self._answer = ""
        self._senses = Publisher(SENSE_REQUEST, network=outside)
        self._person = Publisher(HUMAN_BEHAVIOR, network=outside)
        self._around = Publisher(SURROUNDINGS, network=outside)
        Subscriber(ROBOT_STATE, RobotState, network=outside, callback=self._on_state)
        if driver == "virtual":
            self.start_node("action/nao", "NAO", robot="NAO", speed=SPEED)
        else:
            served = {"robot": "Served", "speed": SPEED, "naoqi_port": naoqi_port}
            self.start_node("action/nao", "Served", **served)
            self.state("ready", node="Served")
            address = f"127.0.0.1:{naoqi_port}"
            self.start_node("action/nao", "NAO", robot="NAO", driver="naoqi", address=address)
        self.state("ready", node="NAO")
        assert self._senses.wait_for_subscribers(1 if driver == "virtual" else 2, 10)
        self._wait(lambda: self.states_of["NAO"] and self.states_of[self.body])

    def look(self, block: str) -> Seen:
        """Run a block and return what was seen; its look says whether that is right."""
        look, definition = LOOKS[block], LANGUAGE.definitions[block]
        self._calm_down(look, is_hat=definition.shape == "hat")
        for one in look.senses if definition.shape != "hat" else ():
            self._sense(one)
        self._put(look.things)
        self._settle()
        if definition.shape != "hat":
            self._wait(lambda: look.in_sight <= self._sees())
        seen = Seen(self.states_of[self.body][-1], self.states_of[self.body])
        self._answer = ANSWERS.get(block, "")
        if definition.shape == "hat":
            self._run_rule(B(block, look.fields), look, seen)
        elif definition.is_value:
            self._ask([STARTED, *look.first, self._keeping(block, look)], look, seen)
        else:
            self._run([STARTED, *look.first, B(block, look.fields), *look.then], seen)
        self._answer = ""
        with contextlib.suppress(TimeoutError):  # who looks says that it is not so
            self._wait(lambda: look.holds(seen))
        self._put(())
        return seen

    def _keeping(self, block: str, look: Look) -> B:
        return B("variable.set", {"variable": "v1"}, {"value": B(block, look.fields)})

    def _run(self, stack: list[B], seen: Seen) -> None:
        try:
            seen.value = self._play([stack]).get("x")
        except NepError as problem:
            seen.refused = problem.sentence

    def _ask(self, stack: list[B], look: Look, seen: Seen) -> None:
        """Ask until the answer is right: some things a robot is asked for once a second only."""
        end_s = time.monotonic() + PATIENCE_S
        self._run(stack, seen)
        while not look.holds(seen) and time.monotonic() < end_s:
            self._run(stack, seen)

    def _run_rule(self, hat: B, look: Look, seen: Seen) -> None:
        """Run a rule beside this, let happen what it waits for until it has run."""
        said = B("robot.say", {"text": LONG})
        playing = threading.Thread(target=self._play, args=([[hat, said], [STARTED]],))
        playing.start()
        end_s = time.monotonic() + PATIENCE_S
        while not look.holds(seen) and time.monotonic() < end_s:
            for one in look.senses:
                self._sense((one[0], 2.5 if one[0] == "sonar_left" else 0.0, one[2]))
                time.sleep(0.4)  # so long it does not sense it: two looks of a real robot's driver
                self._sense(one)
            if look.state:
                self._person.send(HumanBehavior(human_state=look.state))
            with contextlib.suppress(TimeoutError):
                self._wait(lambda: look.holds(seen), 2.5)
        tasks.PROGRAM.cancel()
        playing.join(10)
        assert not playing.is_alive()
        tasks.PROGRAM.cancelled.clear()

    def _play(self, stacks: list[list[B]]) -> dict[str, Any]:
        editor = build(LANGUAGE, *stacks, variables=("x",))
        share_variables(editor)
        code = generate_program(editor.project, LANGUAGE).text
        names: dict[str, Any] = {"__name__": "__main__"}
        exec(compile(code, "program.py", "exec"), names)
        return held(names)

    def _calm_down(self, look: Look, *, is_hat: bool) -> None:
        """Take away what was sensed; what a rule waits to see must be out of sight before."""
        for one in NOTHING:
            self._sense(one)
        self._play([[STARTED, *CALM]])
        sees = self._sees
        if look.in_sight:
            self._wait(lambda: not sees() & look.in_sight if is_hat else sees() <= look.in_sight)

    def _settle(self) -> None:
        """Begin with states that were told from now on."""
        body = self.states_of[self.body]
        body[:] = body[-1:]
        self._sense(NUDGE)
        self._wait(lambda: len(body) > 1)
        body[:] = body[-1:]

    def _sees(self) -> frozenset[str]:
        return frozenset(self.states_of["NAO"][-1].sees)

    def _sense(self, one: Sense) -> None:
        what, value, more = one
        self._senses.send(SenseRequest(robot=self.body, sense=what, value=value, **more))

    def _put(self, things: tuple[Thing, ...]) -> None:
        """Let things stand before the robot, instead of those that stood there."""
        robot = self.states_of[self.body][-1]
        self._around.send(Surroundings(things=[before(robot, thing) for thing in things]))

    def _on_state(self, state: RobotState) -> None:
        self.states_of[state.robot].append(state)
        if state.robot == self.body and state.listening and self._answer:
            self._sense(("word", 1.0, {"name": self._answer}))

    def _wait(self, is_so: Callable[[], object], at_most_s: float = PATIENCE_S) -> None:
        end_s = time.monotonic() + at_most_s
        while not is_so():
            if time.monotonic() > end_s:
                raise TimeoutError
            time.sleep(0.01)


@contextlib.contextmanager
def block_stage(driver: str, naoqi_port: int) -> Iterator[BlockStage]:
    """A stage with a master and networks of its own, which is closed at the end."""
    with ExitStack() as ending:
        folder = ending.enter_context(tempfile.TemporaryDirectory())
        patch = ending.enter_context(pytest.MonkeyPatch.context())
        master = Master("tcp://127.0.0.1:*")
        ending.callback(master.close)
        patch.setenv(ROBOT_FILES_VARIABLE, folder)
        patch.setenv(MASTER_VARIABLE, master.endpoint)  # the nodes find it there
        networks = [PeerNetwork(name, master=master.endpoint) for name in ("program", "outside")]
        for network in networks:
            ending.callback(network.close)
        set_default_network(networks[0])
        ending.callback(set_default_network, None)
        stage = BlockStage(*networks, driver, naoqi_port)
        ending.callback(stage.close)
        yield stage

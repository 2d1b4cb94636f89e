"""A program whose parts want the same limbs, with its robot in a process of its own."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.behavior import Behavior
from nep_core.program.human import human_listener
from nep_core.program.robot import Robot
from nep_core.program.tasks import set_priority, wait
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    DISPLACED,
    HUMAN_BEHAVIOR,
    ActionRequest,
    ActionResult,
    HumanBehavior,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import WAIT_S, NodeRunner

pytestmark = pytest.mark.long

AT_ONCE_S = 0.5
"""What is more important acts within this time, however long the robot would dance."""


class LimbTheatre(NodeRunner):
    """A robot, a person, and a behaviour in a thread; ``told`` is what became of each request."""

    def __init__(self, network: PeerNetwork, outside: PeerNetwork) -> None:
        super().__init__(network)
        tasks.PROGRAM.cancelled.clear()
        tasks.PROGRAM._children.clear()
        human_listener(network)
        self.behavior = Behavior("Limbs")
        self.requests: dict[str, ActionRequest] = {}
        self.told: list[tuple[float, ActionResult]] = []
        self._person = Publisher(HUMAN_BEHAVIOR, network=outside)
        Subscriber(ACTION_REQUEST, ActionRequest, network=outside, callback=self._on_request)
        Subscriber(ACTION_RESULT, ActionResult, network=outside, callback=self._on_result)
        self._thread = threading.Thread(target=self.behavior.run)

    def begin(self, driver: str) -> Robot:
        """Start the robot, and let the behaviour begin."""
        if driver == "naoqi":
            with socket.socket() as chosen:
                chosen.bind(("127.0.0.1", 0))
                port = chosen.getsockname()[1]
            self.start_node("action/nao", "served", robot="served", naoqi_port=port)
            self.state("ready", node="served")
            self.start_node(
                "action/nao", "NAO", robot="NAO", driver="naoqi", address=f"127.0.0.1:{port}"
            )
        else:
            self.start_node("action/nao", "NAO", robot="NAO")
        self.state("ready", node="NAO")
        robot = Robot("NAO")
        robot._state()  # it has heard of the robot, and is heard
        return robot

    def play(self) -> None:
        self._thread.start()

    def person_is(self, state: str) -> float:
        """Let the person do something; when that was."""
        self._person.send(HumanBehavior(human_state=state))
        return time.monotonic()

    def when(self, state: str, action: str, number: int = 1, code: str = "") -> float:
        """When a request of an action got into a state for so many times."""
        end_s = time.monotonic() + WAIT_S
        while time.monotonic() < end_s:
            ids: dict[str, float] = {}
            for came_s, result in [*self.told]:
                asked = self.requests.get(result.id)
                fits = asked is not None and asked.action == action and result.state == state
                if fits and code in ("", result.code):
                    ids.setdefault(result.id, came_s)
            if len(ids) >= number:
                return [*ids.values()][number - 1]
            time.sleep(0.01)
        pytest.fail(f"{action} is not {state}")

    def end(self) -> None:
        tasks.PROGRAM.cancel()
        if self._thread.ident:
            self._thread.join(WAIT_S)
            assert not self._thread.is_alive()
        tasks.PROGRAM.cancelled.clear()
        self.close()

    def _on_request(self, request: ActionRequest) -> None:
        self.requests.setdefault(request.id, request)

    def _on_result(self, result: ActionResult) -> None:
        self.told.append((time.monotonic(), result))


@pytest.fixture
def theatre(network: PeerNetwork, join: Callable[[str], PeerNetwork]) -> Iterator[LimbTheatre]:
    theatre = LimbTheatre(network, join("outside"))
    yield theatre
    theatre.end()


@pytest.mark.parametrize("driver", ["virtual", "naoqi"])
def test_a_high_goal_acts_at_once_against_a_dance_which_is_danced_again_afterwards(
    theatre: LimbTheatre, driver: str, record_property: Callable[[str, object], None]
) -> None:
    robot = theatre.begin(driver)

    @theatre.behavior.when("dance")
    def dance() -> None:
        robot.play("dance")

    @theatre.behavior.goal("help", when="help", priority="high")
    def help_somebody() -> None:
        robot.point_at(1.0, 0.5, 0.8)

    theatre.play()
    theatre.person_is("dance")
    theatre.when("started", "play")
    wait(1.0)

    asked_s = theatre.person_is("help")
    late_s = theatre.when("started", "point_at") - asked_s
    pointed_s = theatre.when("done", "point_at")
    again_s = theatre.when("started", "play", number=2)

    record_property("late_s", late_s)
    print(f"{driver}: acts {late_s * 1000:.0f} ms after it was called")
    assert late_s < AT_ONCE_S
    assert theatre.when("cancelled", "play", code=DISPLACED) < pointed_s < again_s


def test_two_steps_of_what_is_more_important_are_not_taken_turns_with(
    theatre: LimbTheatre,
) -> None:
    robot = theatre.begin("virtual")

    @theatre.behavior.when("story")
    def story() -> None:
        set_priority("low")
        robot.say("Once upon a time there was a robot that wanted to learn how to dance")

    @theatre.behavior.when("help")
    def help_somebody() -> None:
        set_priority("high")
        robot.say("One")
        wait(0.1)
        robot.say("Two")

    theatre.play()
    theatre.person_is("story")
    theatre.when("started", "say")
    theatre.person_is("help")
    theatre.when("started", "say", number=4)

    begun = [theatre.requests[result.id] for _, result in theatre.told if result.state == "started"]
    texts = list(dict.fromkeys((one.id, str(one.args["text"])[:4]) for one in begun))
    assert [text for _, text in texts] == ["Once", "One", "Two", "Once"]


def test_a_rule_that_gives_up_is_over_when_it_has_to_make_way(theatre: LimbTheatre) -> None:
    robot = theatre.begin("virtual")
    went_on = threading.Event()

    @theatre.behavior.when("dance")
    def dance() -> None:
        set_priority("low", displaced="give_up")
        robot.play("dance")
        went_on.set()

    @theatre.behavior.when("help")
    def help_somebody() -> None:
        robot.point_at(1.0, 0.5, 0.8)

    theatre.play()
    theatre.person_is("dance")
    theatre.when("started", "play")

    theatre.person_is("help")
    theatre.when("done", "point_at")
    wait(1.0)

    assert not went_on.is_set()
    assert sum(request.action == "play" for request in theatre.requests.values()) == 1


def test_a_walk_goes_the_rest_of_its_way(theatre: LimbTheatre) -> None:
    robot = theatre.begin("virtual")
    arrived = threading.Event()

    @theatre.behavior.when("walk")
    def walk() -> None:
        robot.walk(0.6)
        arrived.set()

    @theatre.behavior.when("look")
    def sit() -> None:
        set_priority("high")
        robot.turn(20)

    theatre.play()
    theatre.person_is("walk")
    theatre.when("started", "walk")
    wait(2.5)
    theatre.person_is("look")

    assert arrived.wait(WAIT_S)
    walks = [one.args["forward_m"] for one in theatre.requests.values() if one.action == "walk"]
    assert len(walks) == 2 and 0.05 < walks[1] < 0.55


def test_a_walk_without_an_end_goes_on_after_it_had_to_make_way(theatre: LimbTheatre) -> None:
    robot = theatre.begin("virtual")

    @theatre.behavior.when("stroll")
    def stroll() -> None:
        robot.start_walking(50)
        wait(60)

    @theatre.behavior.when("turn")
    def turn() -> None:
        set_priority("high")
        robot.turn(20)

    theatre.play()
    theatre.person_is("stroll")
    theatre.when("started", "walk_freely")
    theatre.person_is("turn")

    cut_s = theatre.when("cancelled", "walk_freely", code=DISPLACED)
    turned_s = theatre.when("done", "turn")
    again_s = theatre.when("started", "walk_freely", number=2)

    assert cut_s < turned_s < again_s

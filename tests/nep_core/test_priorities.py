"""How important what a program asks robots is: who says so, and what becomes of who makes way."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import pytest

from nep_core.errors import NepError
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.robot import Robot
from nep_core.program.tasks import set_priority, together, wait_until
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    DISPLACED,
    ActionRequest,
    ActionResult,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.goal_playing import WAIT_S, Join, Scene


class BusyRobot:
    """A robot that lets the first ``times`` requests make way, and does the others at once."""

    def __init__(self, network: PeerNetwork, name: str = "NAO", times: int = 0) -> None:
        self.name, self.times = name, times
        self.asked: list[ActionRequest] = []
        self._results = Publisher(ACTION_RESULT, network=network)
        Subscriber(ACTION_REQUEST, ActionRequest, network=network, callback=self._on_request)

    def _on_request(self, request: ActionRequest) -> None:
        is_known = any(one.id == request.id for one in self.asked)
        if self.name not in request.robots or request.action == "stop" or is_known:
            return
        self.asked.append(request)
        if len(self.asked) <= self.times:
            self._tell(request, "cancelled", code=DISPLACED, text="made way")
        else:
            self._tell(request, "done")

    def _tell(self, request: ActionRequest, state: str, **more: object) -> None:
        self._results.send(ActionResult(id=request.id, robot=self.name, state=state, **more))


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


def who_asked(robot: BusyRobot) -> list[tuple[int, str]]:
    return [(one.priority, one.by) for one in robot.asked]


def test_what_a_rule_asks_is_normal_and_says_who_asks(scene: Scene, join: Join) -> None:
    nao, robot = BusyRobot(join("NAO")), Robot("NAO")
    scene.behavior.when("wave")(lambda: robot.say("Hello"))
    scene.begin()

    scene.does("wave")

    assert wait_until(lambda: nao.asked, WAIT_S)
    assert who_asked(nao) == [(0, "wave")]


@pytest.mark.parametrize(("priority", "number"), [("low", -1), ("high", 1)])
def test_the_priority_of_a_rule_holds_from_where_it_is_set_in_parts_and_own_blocks(
    scene: Scene, join: Join, priority: str, number: int
) -> None:
    nao, robot = BusyRobot(join("NAO")), Robot("NAO")

    def own_block() -> None:
        robot.say("in an own block")

    @scene.behavior.when("wave")
    def wave() -> None:
        robot.say("before")
        together(lambda: set_priority(priority))
        own_block()
        together(lambda: robot.say("in a part"))

    scene.begin()
    scene.does("wave")

    assert wait_until(lambda: len(nao.asked) == 3, WAIT_S)
    assert [one for one, _ in who_asked(nao)] == [0, number, number]


def test_the_next_run_of_a_rule_is_normal_again(scene: Scene, join: Join) -> None:
    nao, robot = BusyRobot(join("NAO")), Robot("NAO")

    @scene.behavior.when("wave", again="queue")
    def wave() -> None:
        robot.say("first")
        set_priority("high")
        robot.say("then")

    scene.begin()
    scene.does("wave", "wave")

    assert wait_until(lambda: len(nao.asked) == 4, WAIT_S)
    assert [one for one, _ in who_asked(nao)] == [0, 1, 0, 1]


def test_a_goal_and_what_follows_it_have_its_priority_and_other_rules_do_not(
    scene: Scene, join: Join
) -> None:
    nao, robot = BusyRobot(join("NAO")), Robot("NAO")
    scene.behavior.goal("help", when="help", priority="high")(lambda: robot.say("I come"))
    scene.behavior.when_goal("help", "finished")(lambda: robot.say("Done"))
    scene.behavior.when("wave")(lambda: robot.say("Hello"))
    scene.begin()

    scene.does("help")
    assert wait_until(lambda: len(nao.asked) == 2, WAIT_S)
    scene.does("wave")

    assert wait_until(lambda: len(nao.asked) == 3, WAIT_S)
    assert who_asked(nao) == [(1, "help"), (1, "help"), (0, "wave")]


def test_there_is_no_other_priority() -> None:
    with pytest.raises(NepError) as refused:
        set_priority("huge")

    assert refused.value.checklist


def test_what_had_to_make_way_is_asked_for_again(scene: Scene, join: Join) -> None:
    nao, robot = BusyRobot(join("NAO"), times=2), Robot("NAO")

    @scene.behavior.when("wave")
    def wave() -> None:
        robot.say("Hello")
        scene.diary.write("said")

    scene.begin()
    scene.does("wave")

    assert scene.diary.next() == "said"
    assert [one.args["text"] for one in nao.asked] == ["Hello"] * 3
    assert len({one.id for one in nao.asked}) == 3


def test_only_the_robot_that_had_to_make_way_does_it_again(scene: Scene, join: Join) -> None:
    nao, max_ = BusyRobot(join("NAO"), times=1), BusyRobot(join("Max"), "Max")
    robots = Robot(["NAO", "Max"])

    @scene.behavior.when("wave")
    def wave() -> None:
        robots.say("Hello")
        scene.diary.write("said")

    scene.begin()
    scene.does("wave")

    assert scene.diary.next() == "said"
    assert (len(nao.asked), len(max_.asked)) == (2, 1)


def test_a_rule_that_gives_up_ends_well_also_out_of_its_parts(scene: Scene, join: Join) -> None:
    nao, robot = BusyRobot(join("NAO"), times=1), Robot("NAO")
    ended = threading.Event()

    @scene.behavior.when("wave")
    def wave() -> None:
        set_priority("low", displaced="give_up")
        try:
            together(lambda: robot.say("Hello"))
            scene.diary.write("said")
        finally:
            ended.set()

    scene.begin()
    scene.does("wave")

    assert ended.wait(WAIT_S)
    assert scene.diary.is_quiet()
    assert len(nao.asked) == 1 and scene.behavior._first_error is None


@pytest.mark.parametrize(("interrupted", "told"), [("drop", "interrupted"), ("again", "finished")])
def test_what_becomes_of_a_goal_that_has_to_make_way_is_what_it_says(
    scene: Scene, join: Join, interrupted: str, told: str
) -> None:
    nao, robot = BusyRobot(join("NAO"), times=1), Robot("NAO")
    scene.behavior.goal("tour", when="tour", interrupted=interrupted)(lambda: robot.say("Come"))
    for event in ("finished", "interrupted"):
        scene.hook("tour", event)
    scene.begin()

    scene.does("tour")

    assert scene.diary.next() == f"tour {told}"
    assert scene.diary.is_quiet()
    assert len(nao.asked) == (1 if interrupted == "drop" else 2)

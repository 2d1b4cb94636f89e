"""Goals that go on where they were: what stands still meanwhile, and what is done again."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.robot import Robot
from nep_core.program.tasks import CLOCK, together, wait, wait_until
from nep_core.wire.messages import ACTION_REQUEST, ACTION_RESULT, ActionRequest, ActionResult
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.goal_playing import WAIT_S, Join, Scene
from tests.nep_core.robot_playing import PlayedRobot


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


class StoppableRobot:
    """A robot whose actions last until they are stopped; then it tells how far a walk came."""

    def __init__(self, network: PeerNetwork) -> None:
        self.asked: list[ActionRequest] = []
        self.lasts = True
        self._results = Publisher(ACTION_RESULT, network=network)
        Subscriber(ACTION_REQUEST, ActionRequest, network=network, callback=self._on_request)

    def args(self, action: str) -> list[dict[str, object]]:
        return [one.args for one in self.asked if one.action == action]

    def _on_request(self, request: ActionRequest) -> None:
        if request.action == "stop":
            stopped = {one.id: one for one in self.asked}.get(request.args["request"])
            if stopped is not None:
                rest = {"rest_forward_m": 0.7} if stopped.action == "walk" else {}
                self._tell(stopped, "cancelled", text="stopped", values=rest)
        elif all(one.id != request.id for one in self.asked):
            self.asked.append(request)
            self._tell(request, "started")
            if not self.lasts:
                self._tell(request, "done")

    def _tell(self, request: ActionRequest, state: str, **more: object) -> None:
        self._results.send(ActionResult(id=request.id, robot="NAO", state=state, **more))


def alarm(scene: Scene, seconds: float = 0.3) -> None:
    scene.goal("alarm", seconds, priority="high")


def test_an_interrupted_goal_goes_on_where_it_was(scene: Scene) -> None:
    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        for step in range(3):
            scene.diary.write(f"step {step}")
            wait(0.3)

    alarm(scene)
    scene.hook("tour", "interrupted")
    scene.hook("tour", "returns")
    scene.hook("tour", "finished")
    scene.begin()
    scene.does("tour")
    first = [scene.diary.next(), scene.diary.next()]

    scene.does("alarm")

    assert first == ["step 0", "step 1"]
    assert [scene.diary.next() for _ in range(6)] == [
        "tour interrupted",
        "alarm begins",
        "alarm done",
        "tour returns",
        "step 2",
        "tour finished",
    ]


def test_time_in_which_it_stands_still_does_not_count(scene: Scene) -> None:
    gone_s = []

    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        scene.diary.write("begins")
        begun_s = CLOCK.now_s()
        together(lambda: wait(0.8), lambda: wait_until(lambda: False, 0.8))
        gone_s.append(CLOCK.now_s() - begun_s)
        scene.diary.write("ends")

    alarm(scene, 1.0)
    scene.begin()
    scene.does("tour")
    scene.diary.next()

    scene.does("alarm")

    assert [scene.diary.next() for _ in range(3)] == ["alarm begins", "alarm done", "ends"]
    assert gone_s[0] >= 1.75


def test_a_step_on_a_robot_is_stopped_and_made_again(scene: Scene, join: Join) -> None:
    nao, robot = StoppableRobot(join("NAO")), Robot("NAO")

    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        robot.say("A long story")
        scene.diary.write("told")

    alarm(scene)
    scene.begin()
    scene.does("tour")
    assert wait_until(lambda: nao.args("say"), WAIT_S)

    scene.does("alarm")
    entries = [scene.diary.next()]
    during = len(nao.args("say"))
    nao.lasts = False
    entries += [scene.diary.next(), scene.diary.next()]

    assert entries == ["alarm begins", "alarm done", "told"]
    assert during == 1
    assert [args["text"] for args in nao.args("say")] == ["A long story"] * 2


def test_a_walk_that_was_stopped_goes_the_rest_of_its_way(scene: Scene, join: Join) -> None:
    nao, robot = StoppableRobot(join("NAO")), Robot("NAO")

    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        robot.walk(2.0)
        scene.diary.write("arrived")

    alarm(scene)
    scene.begin()
    scene.does("tour")
    assert wait_until(lambda: nao.args("walk"), WAIT_S)

    scene.does("alarm")
    scene.diary.next()
    nao.lasts = False

    assert [scene.diary.next(), scene.diary.next()] == ["alarm done", "arrived"]
    assert [args["forward_m"] for args in nao.args("walk")] == [2.0, 0.7]


def test_what_it_had_begun_and_not_waited_for_is_begun_again(scene: Scene, join: Join) -> None:
    nao, robot = StoppableRobot(join("NAO")), Robot("NAO")

    @scene.behavior.goal("stroll", when="stroll", priority="low", interrupted="resume")
    def stroll() -> None:
        robot.start_walking(50)
        wait(60)

    alarm(scene)
    scene.begin()
    scene.does("stroll")
    assert wait_until(lambda: nao.args("walk_freely"), WAIT_S)

    scene.does("alarm")
    scene.diary.next()
    during = len(nao.args("walk_freely"))
    scene.diary.next()

    assert during == 1
    assert wait_until(lambda: len(nao.args("walk_freely")) == 2, WAIT_S)


def test_a_question_is_asked_once_more_and_what_was_said_meanwhile_answers_nothing(
    scene: Scene, join: Join
) -> None:
    nao, robot = StoppableRobot(join("NAO")), Robot("NAO")
    nao.lasts = False

    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        scene.diary.write(robot.ask("Shall we go on?", ["yes", "no"], 30))

    alarm(scene, 0.5)
    scene.begin()
    scene.does("tour")
    assert wait_until(lambda: nao.args("listen"), WAIT_S)

    scene.does("alarm")
    entries = [scene.diary.next()]
    scene.does("heard_yes")
    entries.append(scene.diary.next())
    assert wait_until(lambda: len(nao.args("say")) == 2, WAIT_S)
    quiet = scene.diary.is_quiet()
    scene.does("heard_no")

    assert entries == ["alarm begins", "alarm done"] and quiet
    assert scene.diary.next() == "no"
    assert [args["text"] for args in nao.args("say")] == ["Shall we go on?"] * 2


def test_one_that_stands_still_can_be_given_up(scene: Scene) -> None:
    ended = []

    @scene.behavior.goal("tour", when="tour", stop="bye", priority="low", interrupted="resume")
    def tour() -> None:
        scene.diary.write("begins")
        try:
            wait(60)
        finally:
            ended.append(time.monotonic())

    alarm(scene, 0.5)
    scene.hook("tour", "stopped")
    scene.begin()
    scene.does("tour")
    scene.diary.next()
    scene.does("alarm")
    scene.diary.next()

    scene.does("bye")

    assert [scene.diary.next(), scene.diary.next()] == ["alarm done", "tour stopped"]
    assert wait_until(lambda: ended, WAIT_S)
    assert wait_until(lambda: not scene.behavior.pursues("tour"), WAIT_S)


def test_a_goal_can_be_interrupted_again_and_again(scene: Scene) -> None:
    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        scene.diary.write("begins")
        wait(2)  # longer than the messages need on a busy computer
        scene.diary.write("ends")

    alarm(scene, 0.1)
    scene.begin()
    scene.does("tour")
    scene.diary.next()

    for _ in range(3):
        scene.does("alarm")
        assert [scene.diary.next(), scene.diary.next()] == ["alarm begins", "alarm done"]
        # What it writes last is not its end, and while it is pursued it does not begin again
        assert wait_until(lambda: not scene.behavior.pursues("alarm"), WAIT_S)

    assert scene.diary.next() == "ends"
    assert scene.diary.is_quiet()


def test_a_program_ends_while_a_goal_stands_still(scene: Scene, join: Join) -> None:
    PlayedRobot(join("NAO"), end=None)
    robot = Robot("NAO")

    @scene.behavior.goal("tour", when="tour", priority="low", interrupted="resume")
    def tour() -> None:
        scene.diary.write("begins")
        robot.say("A long story")

    scene.goal("alarm", priority="high")
    scene.begin()
    scene.does("tour")
    scene.diary.next()
    scene.does("alarm")
    assert scene.diary.next() == "alarm begins"

    scene.end()  # it waits for all threads of the program

"""Robot calls: what is asked, how it ends, who does not answer."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from nep_core.errors import ActionFailed, RobotError, RobotNotAnswering
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import actions
from nep_core.program.robot import Robot
from nep_core.program.tasks import Cancelled, Part, Task
from nep_core.program.values import speak
from tests.nep_core.robot_playing import PlayedRobot

Join = Callable[[str], PeerNetwork]


@pytest.fixture
def nao(join: Join, network: PeerNetwork) -> Iterator[PlayedRobot]:
    yield PlayedRobot(join("NAO"))


def test_every_call_asks_for_its_action(nao: PlayedRobot) -> None:
    robot = Robot("NAO")

    robot.say(3, gesture="explain")
    robot.do("posture_sit")
    robot.imitate("cat")
    robot.play("wave", mirror=True)
    robot.walk(0.5)
    robot.turn(90)
    robot.look(10, 5)
    robot.leds("FaceLeds", "#ff0000")

    assert nao.asked == [
        ("say", {"text": "3", "gesture": "explain", "language": ""}),
        ("do", {"posture": "posture_sit"}),
        ("imitate", {"animal": "cat"}),
        ("play", {"animation": "wave", "mirror": True, "reverse": False, "stretch": 1.0}),
        ("walk", {"forward_m": 0.5, "left_m": 0.0}),
        ("turn", {"degrees": 90}),
        ("look", {"yaw_deg": 10, "pitch_deg": 5}),
        ("leds", {"group": "FaceLeds", "colour": "#ff0000"}),
    ]


def test_a_program_in_german_speaks_german_until_it_sets_another_language(
    nao: PlayedRobot,
) -> None:
    robot = Robot("NAO")
    speak("de")
    try:
        robot.say("Hallo")
        robot.say("Bonjour", language="fr")
        robot.set_language("it")
        robot.say("Ciao")
    finally:
        speak("en")

    said = [args for action, args in nao.asked if action == "say"]
    assert [args.get("usual_language") for args in said] == ["de", None, None]


def test_a_call_to_two_robots_waits_for_both(nao: PlayedRobot, join: Join) -> None:
    second = PlayedRobot(join("NAO2"), "NAO2", end=None)
    calling = threading.Thread(target=Robot(["NAO", "NAO2"]).say, args=("Hello",))
    calling.start()
    assert second.arrived.acquire(timeout=5)
    assert calling.is_alive()

    second.end = "done"  # the next time it is asked how it is going
    calling.join(5)

    assert not calling.is_alive()
    assert nao.words() == second.words() == ["Hello"]


def test_a_lost_request_is_asked_again_and_not_played_twice(
    nao: PlayedRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(actions, "ASK_AGAIN_S", 0.1)
    nao.end = None
    calling = threading.Thread(target=Robot("NAO").say, args=("Hello",))
    calling.start()
    for _ in range(3):
        assert nao.arrived.acquire(timeout=5)

    nao.end = "done"
    calling.join(5)

    assert nao.words() == ["Hello"]
    assert max(nao.times_asked.values()) >= 3


def test_a_robot_that_fails_says_why(nao: PlayedRobot) -> None:
    nao.end = "failed"

    with pytest.raises(ActionFailed, match="NAO could not do that: its arm is stuck"):
        Robot("NAO").say("Hello")


def test_a_robot_that_does_not_answer_is_told_with_a_checklist(
    nao: PlayedRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(actions, "SILENCE_S", 0.3)

    with pytest.raises(RobotNotAnswering, match="NAO2 does not answer") as raised:
        Robot(["NAO", "NAO2"]).say("Hello")

    assert any("Robots page" in step for step in map(str, raised.value.checklist))


def test_a_cancelled_part_stops_its_action(nao: PlayedRobot) -> None:
    nao.end = None
    part = Part(lambda: Robot("NAO").say("A long story"), "story", Task()).start()
    assert nao.arrived.acquire(timeout=5)

    part.task.cancel()
    part.join(5)

    assert not part.is_running
    assert part.error is None
    assert nao.arrived.acquire(timeout=5)
    assert nao.asked[-1][0] == "stop"


def test_a_cancelled_part_asks_for_nothing_more(nao: PlayedRobot) -> None:
    task = Task()
    task.cancel()
    raised: list[BaseException] = []

    def speak() -> None:
        try:
            Robot("NAO").say("Hello")
        except Cancelled as error:
            raised.append(error)

    Part(speak, "late", task).start().join(5)

    assert len(raised) == 1
    assert nao.words() == []


@pytest.mark.parametrize("names", ["", [], ["NAO", ""], [5]])
def test_a_robot_needs_a_name(names: object) -> None:
    with pytest.raises(RobotError, match="needs a name"):
        Robot(names)  # type: ignore[arg-type]

"""Robots that answer what makes no sense, and one that is gone while something waits its turn."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from driver_held_nao import SERVICES, HeldNao
from driver_stage import ANIMATIONS, BODY, DriverStage

from robots.body.pose import VirtualRobot
from robots.naoqi.driver import watching
from robots.naoqi.driver.calls import Calls
from robots.naoqi.driver.real import RealRobot
from robots.naoqi.server.server import Server
from robots.naoqi.wire.promise import Pending, Promise
from robots.naoqi.wire.service import method

pytestmark = pytest.mark.long

NAN = float("nan")
LEG_S = 0.6
ASKED: dict[str, dict[str, Any]] = {
    "look": {"yaw_deg": 20},
    "move_joint": {"joint": "HeadYaw", "degrees": 5, "relative": True},
    "walk": {"forward_m": 0.1},
    "look_at": {"x_m": 1, "y_m": 0, "z_m": 1},
    "play": {"animation": "yes"},
}


class OddNao(HeldNao):
    """Answers as it should until it has an ``odd`` answer for everything."""

    odd: tuple[Any, ...] = ()

    def says(self, usual: Any) -> Any:
        return self.odd[0] if self.odd else usual

    @method("getAngles::m(mb)")
    def angles(self, names: Any, sensors: bool) -> Any:
        return self.says([0.0] * len(names))

    @method("getRobotPosition::m(b)")
    def place(self, sensors: bool) -> Any:
        return self.says([0.0, 0.0, 0.0])

    @method("getListData::m(m)")
    def values(self, keys: list[str]) -> Any:
        return self.says([None for _ in keys])


class SilentNao(HeldNao):
    """Speaks without an end."""

    @method("say::v(s)")
    def say(self, text: str) -> Any:
        return Promise().future


class StridingNao(HeldNao):
    """Walks, a leg in LEG_S; the next one takes its place, and whoever asked before is answered."""

    posture = "Stand"

    def __init__(self) -> None:
        super().__init__()
        self.asked_s: list[float] = []
        self._walking: list[Promise] = []

    @method("getPosture::s()")
    def where(self) -> str:
        return "Stand"

    @method("moveTo::b(fff)")
    def move_to(self, x: float, y: float, theta: float) -> Any:
        before, self._walking = self._walking, [Promise()]
        self.asked_s.append(time.monotonic())
        for one in before:
            one.set(True)
        threading.Timer(LEG_S, self._walking[0].set, (True,)).start()
        return self._walking[0].future


class NowhereNao(StridingNao):
    """Will always be at the same place."""

    @method("getNextRobotPosition::[f]()")
    def next_place(self) -> list[float]:
        return [0.0, 0.0, 0.0]


class VagueNao(StridingNao):
    """Says something else than where it will be."""

    @method("getNextRobotPosition::m()")
    def next_place(self) -> Any:
        return "over there"


class SlidingNao(StridingNao):
    """Will be somewhere else whenever it is asked."""

    @method("getNextRobotPosition::[f]()")
    def next_place(self) -> list[float]:
        return [time.monotonic() % 1000.0, 0.0, 0.0]


@pytest.fixture
def stage_of() -> Iterator[Any]:
    ends = []

    def make(nao: HeldNao) -> tuple[DriverStage, Server]:
        server = Server({name: nao for name in SERVICES}, port=0)
        stage = DriverStage(f"127.0.0.1:{server.start()}")
        ends.extend([stage.close, server.stop])
        stage.until(lambda: stage.driver.state() is not None)
        return stage, server

    yield make
    for end in ends:
        end()


@pytest.mark.parametrize("odd", [None, [], [NAN] * 3, "text", [[[]]], {}, [1e300] * 40])
def test_an_answer_that_makes_no_sense_fails_the_action_and_not_the_robot(
    stage_of, odd: object
) -> None:
    nao = OddNao()
    stage, _ = stage_of(nao)
    nao.odd = (odd,)

    ended = [stage.do(action, **args).state for action, args in ASKED.items()]

    known = stage.driver.state()
    assert set(ended) <= {"failed", "done"}
    assert ended.count("failed") >= 2
    assert known is not None
    assert np.isfinite([*known.joints.values(), *known.base, *(known.torso or ())]).all()


def test_what_waits_for_its_turn_fails_too_when_the_robot_is_gone(stage_of) -> None:
    stage, server = stage_of(SilentNao())
    for id in ("first", "second", "third"):
        stage.ask(id, "say", text="Hello")

    server.stop()
    ends = [stage.end_of(id) for id in ("first", "second", "third")]

    assert [end.state for end in ends] == ["failed"] * 3
    assert {end.description for end in ends} == {str(stage.driver.connection.fault)}
    assert not stage.actor.schedule.running


@pytest.mark.parametrize("kind", [StridingNao, NowhereNao, VagueNao, SlidingNao])
def test_a_robot_that_does_not_tell_of_its_steps_walks_on_without_standing(
    stage_of, kind: type[StridingNao]
) -> None:
    nao = kind()
    stage, _ = stage_of(nao)

    stage.ask("walk", "walk_freely", forward=1.0)
    stage.until(lambda: len(nao.asked_s) > 4)
    stage.ask("stop", "stop")
    stage.until(lambda: "stopMove" in nao.stopped)  # which takes its way to the robot

    pauses_s = np.diff(nao.asked_s)
    assert min(pauses_s[1:]) > 0.15 and np.median(pauses_s[1:]) < LEG_S
    assert "walk cancelled" in stage.told


class Mute:
    """A service that takes every question, and answers none."""

    methods = ("getListData",)

    def begin(self, _method: str, *_args: Any) -> Pending:
        return Pending()


class Clock:
    now_s = 0.0

    def monotonic(self) -> float:
        return self.now_s


def test_who_stood_still_itself_does_not_call_the_robot_frozen(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock = Clock()
    monkeypatch.setattr(watching, "time", clock)
    known = VirtualRobot("NAO", BODY, ANIMATIONS, "StandInit")
    calls = Calls("NAO", {"ALMemory": Mute()}, BODY.names)  # type: ignore[dict-item]
    watch = watching.Watching(RealRobot(known, calls))
    watch.step(is_moving=False)

    clock.now_s += 30.0
    watch.step(is_moving=False)
    after_standing_still = watch.is_frozen
    while clock.now_s < 30.0 + watching.FROZEN_S + 0.1:
        clock.now_s += 0.01
        watch.step(is_moving=False)

    assert not after_standing_still
    assert watch.is_frozen

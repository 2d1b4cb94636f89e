"""Robots that answer what makes no sense, and one that is gone while something waits its turn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from driver_held_nao import SERVICES, HeldNao
from driver_stage import DriverStage

from robots.naoqi.server.server import Server
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.service import method

NAN = float("nan")
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

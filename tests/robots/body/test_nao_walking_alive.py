"""A walk stops by itself when nobody asks for it any more, goes elsewhere, or does not begin."""

from __future__ import annotations

import numpy as np
import pytest
from nao_stage import BODY, TICK_S, Stage

from robots.body.actor import Actor
from robots.body.driver import ActionRequest

pytestmark = pytest.mark.long


def test_a_driven_walk_goes_on_while_it_is_asked_for_and_stops_soon_after() -> None:
    stage = Stage()
    stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)
    for _ in range(6):
        stage.pass_time(0.4)
        stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)
        assert "w cancelled" not in stage.told

    stage.pass_time(1.0)

    assert stage.told.count("w accepted") == 1
    assert "w cancelled" in stage.told


def test_a_walk_without_patience_goes_on_alone() -> None:
    stage = Stage()
    stage.ask("w", "walk_freely", forward=0.5)

    stage.pass_time(5.0)

    assert "w cancelled" not in stage.told


def test_a_driven_walk_that_another_one_follows_is_forgotten() -> None:
    stage = Stage()
    stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)
    stage.pass_time(0.2)
    stage.ask("v", "walk_freely", turn=0.5, unless_asked_s=0.5)
    stage.pass_time(0.4)

    again = ActionRequest(id="w", robots=["NAO"], action="walk_freely", args={"forward": 0.5})
    assert [result.state for result in stage.actor.request(again)] == ["done"]


def test_a_walk_from_before_the_robot_was_started_anew_is_not_begun_again() -> None:
    stage = Stage()

    stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5, was_known=True)
    stage.pass_time(0.4)

    assert stage.told == ["w cancelled"]


def test_a_driven_walk_has_its_patience_in_the_time_of_those_who_ask() -> None:
    stage = Stage()
    stage.actor = Actor("NAO", stage.driver, pace=10.0)
    stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)

    stage.pass_time(4.0)
    assert "w cancelled" not in stage.told
    stage.pass_time(2.0)

    assert "w cancelled" in stage.told


@pytest.mark.parametrize(
    "way", [(0.04, 0.0, 0.0), (0.04, 0.0, 0.1), (-0.04, 0.0, 0.0), (0, 0, 0.2)]
)
def test_a_walk_goes_over_to_another_goal_in_its_steps(way: tuple[float, float, float]) -> None:
    stage = Stage()
    stage.ask("w", "walk", forward_m=0.3)
    while stage.robot.base[0] < 0.1:
        stage.pass_time(TICK_S)
    begun = len(stage.angles)

    for _ in range(20):  # in all parts of a step
        stage.pass_time(0.33)
        assert stage.robot.going is not None and stage.robot.going.replace(np.array(way))
    stood = stage.finish()

    speeds = np.abs(np.diff(stage.angles[begun:], axis=0)) / TICK_S / BODY.max_speed
    feet = stage.robot.stance.feet_base()
    assert stage.told[-1] == "w done" and not stage.robot.fallen
    assert speeds.max() <= 1.0
    assert 0.8 < stood < 2.0  # the rest of a step, the one granted, and the one that ends it
    assert np.hypot(*(feet - stage.robot.base)[:2]) < 0.005


def test_a_walk_tells_where_the_step_under_way_ends_also_after_it_went_elsewhere() -> None:
    stage, told = Stage("StandInit"), []
    stage.ask("w", "walk", forward_m=0.08)
    while stage.driver.is_busy or not told:
        stage.pass_time(TICK_S)
        if stage.robot.going is not None:
            told.append((*stage.robot.going.next_base.tolist(), stage.robot.base[0]))
        if len(told) == 70:  # in its first step
            assert stage.robot.going.replace(np.array([0.0, 0.03, 0.0]))

    ends = list(dict.fromkeys((round(x, 6), round(y, 6)) for x, y, _, _ in told))
    assert ends == [(0.0, 0.0), (0.04, 0.0), (0.04, 0.03)]
    assert all(x > now - 1e-9 for x, _, _, now in told)


@pytest.mark.parametrize(
    ("felt", "value", "code"),
    [
        ("temperature_RKneePitch", 92.0, "too_hot_to_walk"),
        ("battery", 0.05, "battery_too_low_to_walk"),
    ],
)
def test_a_hot_motor_or_an_empty_battery_stops_new_walks(
    felt: str, value: float, code: str
) -> None:
    stage = Stage()
    stage.robot.felt[felt] = value
    walks = {"walk": {"forward_m": 0.1}, "turn": {"degrees": 20.0}, "walk_freely": {"forward": 0.5}}
    for action, args in walks.items():
        stage.ask(action, action, **args)

    stage.finish()
    refused = [one.fault for one in stage.results if one.state == "failed"]

    assert [fault.code for fault in refused] == [code] * 3
    assert refused[0].checklist and not stage.robot.base.any()
    stage.robot.felt.clear()
    stage.ask("again", "walk", forward_m=0.1)
    stage.finish()
    assert "again done" in stage.told


def test_legs_that_it_stands_on_are_released_only_after_it_sat_down() -> None:
    stage = Stage()
    stage.ask("standing", "stiffness", part="legs", on=False)
    stage.ask("sit", "do", posture="posture_sit")
    stage.finish()
    stage.ask("sitting", "stiffness", part="legs", on=False)
    stage.finish()

    [refused] = [one for one in stage.results if one.state == "failed"]
    assert (refused.id, refused.fault.code) == ("standing", "stands") and refused.fault.checklist
    assert "sitting done" in stage.told

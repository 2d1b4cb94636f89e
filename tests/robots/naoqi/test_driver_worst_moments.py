"""A robot is stopped, left, taken over and refuses at the worst moments: nothing throws it over."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest
from driver_stage import DriverStage
from scripted_nao import LEGS, ScriptedNao

from robots.naoqi.discovery import FOLDER_VARIABLE
from robots.naoqi.driver import lease

pytestmark = pytest.mark.long

Stages = Callable[..., DriverStage]


@pytest.fixture(autouse=True)
def no_saved_login(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture(autouse=True)
def quick_leases(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, seconds in {"SETTLING_S": 0.08, "BEAT_S": 0.1, "TAKING_S": 0.3}.items():
        monkeypatch.setattr(lease, name, seconds)


@pytest.fixture
def nao() -> Iterator[ScriptedNao]:
    made = ScriptedNao()
    yield made
    made.close()


@pytest.fixture
def stages(nao: ScriptedNao) -> Iterator[Stages]:
    with ExitStack() as stack:

        def make(**how: bool) -> DriverStage:
            stage = DriverStage(nao.address, **how)
            stack.callback(lambda: (nao.holds.clear(), stage.close()))
            return stage

        yield make


@pytest.fixture
def stage(stages: Stages) -> DriverStage:
    made = stages()
    made.until(lambda: made.driver.state() is not None)
    return made


def test_a_walk_that_has_not_begun_yet_is_not_killed_but_stopped_again(
    stage: DriverStage, nao: ScriptedNao
) -> None:
    nao.holds = {"moveTo"}
    stage.ask("walk", "walk", forward_m=0.4)
    stage.ask("wave", "look", yaw_deg=20)
    stage.until(lambda: nao.times("moveTo"))

    stage.ask("stop", "stop")  # which the robot does before it has taken its first step
    stage.until(lambda: nao.times("moveIsActive") > 2)
    nao.is_walking = True
    stage.until(lambda: nao.times("stopMove") > 1)
    killed_early = nao.times("kill")
    nao.is_walking = False
    nao.let_go("moveTo")
    stage.until(lambda: not stage.driver.moving)

    assert killed_early == 0
    assert nao.times("kill") == 1


def test_an_arm_that_is_stopped_kills_no_walk_that_is_just_beginning(
    stage: DriverStage, nao: ScriptedNao
) -> None:
    nao.holds = {"moveTo", "go"}
    nao.tasks = [["Walk", 1, "x", 0, ["LShoulderPitch", *LEGS]], ["Arm", 2, "x", 0, ["HeadYaw"]]]
    stage.ask("walk", "walk", forward_m=0.4)
    stage.ask("look", "look", yaw_deg=20)
    stage.until(lambda: nao.times("moveTo") and nao.times("go"))

    stage.ask("stop", "stop", request="look")
    stage.until(lambda: nao.times("killTask", 2))

    assert not nao.times("kill") and not nao.times("killTask", 1)


def test_a_stop_while_it_is_asked_for_its_own_life_lets_that_end_before_the_next_move(
    stage: DriverStage, nao: ScriptedNao
) -> None:
    nao.life, nao.holds = "solitary", {"getState"}
    before = nao.times("getState")
    stage.ask("look", "look", yaw_deg=20)
    stage.until(lambda: nao.times("getState") > before)

    stage.ask("stop", "stop")
    nao.let_go("getState")
    stage.do("look", yaw_deg=10)

    assert nao.life == "disabled"
    assert nao.asked.index(("setState", "disabled")) < nao.asked.index(
        ("go", "HeadYaw", "HeadPitch")
    )


def test_nothing_moves_and_nothing_is_killed_while_its_own_life_ends(
    stage: DriverStage, nao: ScriptedNao
) -> None:
    nao.life, nao.awake, nao.holds = "solitary", False, {"wakeUp", "go"}
    stage.ask("arm", "move_joint", joint="LShoulderPitch", degrees=30)
    stage.ask("head", "look", yaw_deg=20)
    stage.until(lambda: nao.times("wakeUp"))
    moved_early = nao.times("go")

    stage.ask("stop", "stop")
    asked = len(nao.asked)
    stage.until(lambda: len(nao.asked) > asked + 10)
    killed_early = nao.times("kill")
    nao.let_go("wakeUp")
    stage.until(lambda: not stage.driver.moving)

    assert (moved_early, killed_early) == (0, 0)


def test_a_stop_reaches_what_it_follows_also_on_a_slow_line(
    stage: DriverStage, nao: ScriptedNao, monkeypatch: pytest.MonkeyPatch
) -> None:
    nao.holds = {"read"}
    asked = nao.times("read")
    stage.until(lambda: nao.times("read") > asked)
    monkeypatch.setattr(lease, "SURE_S", 0.0)  # it is not sure just now whose the robot is

    stage.ask("stop", "stop")
    stage.until(lambda: nao.times("stopTracker"))

    assert nao.times("stopMove")


def test_a_motor_that_gets_hot_on_the_way_ends_the_walk_and_rest_is_offered(
    stage: DriverStage, nao: ScriptedNao
) -> None:
    nao.holds = {"moveTo"}
    stage.ask("walk", "walk", forward_m=3.0)
    stage.until(lambda: nao.times("moveTo"))

    nao.celsius = 86.0
    stage.until(lambda: stage.event == "warning")
    nao.let_go("moveTo")
    end = stage.end_of("walk")

    assert end.fault.code == "too_hot_to_walk"
    assert nao.times("moveTo") == 1


def test_a_free_walk_ends_when_a_motor_gets_hot(stage: DriverStage, nao: ScriptedNao) -> None:
    nao.holds = {"moveTo"}
    stage.ask("walk", "walk_freely", forward=1.0)
    stage.until(lambda: nao.times("moveTo"))

    nao.celsius = 86.0
    end = stage.end_of("walk")

    assert end.fault.code == "too_hot_to_walk"
    stage.until(lambda: nao.times("stopMove"))


def test_a_robot_in_whose_memory_nothing_can_be_written_is_driven_all_the_same(
    stages: Stages, nao: ScriptedNao
) -> None:
    nao.refuses = {("write",)}
    stage = stages()

    stage.until(lambda: stage.driver.state() is not None, at_most_s=5.0)

    assert stage.do("look", yaw_deg=0).state == "done"


@pytest.mark.parametrize("life", ["solitary", "interactive", "safeguard", "disabled"])
def test_its_own_life_is_as_it_was_found_or_solitary_where_that_is_refused(
    stages: Stages, nao: ScriptedNao, life: str
) -> None:
    nao.life = life
    stage = stages()
    stage.until(lambda: stage.driver.state() is not None)
    stage.do("look", yaw_deg=0)
    meanwhile = nao.life
    if life == "safeguard":
        nao.refuses = {("setState", "safeguard")}

    stage.driver.disconnect()

    assert meanwhile == "disabled"
    assert nao.life == {"safeguard": "solitary"}.get(life, life)


def leaving(stage: DriverStage) -> threading.Thread:
    thread = threading.Thread(target=stage.driver.disconnect)
    thread.start()
    return thread


def test_who_leaves_keeps_the_robot_until_it_rests(
    stages: Stages, nao: ScriptedNao, monkeypatch: pytest.MonkeyPatch
) -> None:
    nao.awake = False
    first = stages()
    first.until(lambda: first.driver.state() is not None)
    first.do("wake_up")
    monkeypatch.setattr(lease, "DEAD_S", 0.9)
    second = stages()
    second.until(lambda: (first.step(), second.driver.connection.fault.code == "driven")[1])

    nao.holds = {"rest"}
    left = leaving(first)
    begun = nao.times("write", lease.DRIVER_KEY)
    second.until(lambda: nao.times("write", lease.DRIVER_KEY) > begun + 3)
    second_had_it = second.event == "connected"
    nao.let_go("rest")
    left.join()

    assert not second_had_it
    second.until(lambda: second.event == "connected")


def test_who_has_lost_the_robot_unseen_leaves_it_alone(stages: Stages, nao: ScriptedNao) -> None:
    nao.awake = False
    first = stages()
    first.until(lambda: first.driver.state() is not None)
    first.do("wake_up")
    nao.data[lease.DRIVER_KEY] = other = '{"id": "another", "name": "Anna", "host": "theirs"}'

    first.driver.disconnect()

    assert not nao.times("rest")
    assert nao.data[lease.DRIVER_KEY] == other


def test_of_two_who_take_a_robot_over_at_once_one_has_it(stages: Stages, nao: ScriptedNao) -> None:
    nao.data[lease.DRIVER_KEY] = '{"id": "another", "name": "Anna", "host": "theirs"}'
    both = [stages(takes_over=True), stages(takes_over=True)]

    def have() -> list[DriverStage]:
        for one in both:
            one.step()
        return [one for one in both if one.event == "connected"]

    both[0].until(have, at_most_s=5.0)
    told = [one.driver.connection.fault.code for one in both if one not in have()]
    both[0].until(lambda: told or have(), at_most_s=5.0)

    assert len(have()) == 1


def test_a_robot_is_taken_over_also_when_its_owner_beats_once_more(
    stages: Stages, nao: ScriptedNao
) -> None:
    nao.data[lease.DRIVER_KEY] = owner = '{"id": "another", "name": "Anna", "host": "theirs"}'
    stage = stages(takes_over=True)
    stage.until(lambda: nao.times("write", lease.DRIVER_KEY))

    nao.data[lease.DRIVER_KEY] = owner  # which it had read before that was written

    stage.until(lambda: stage.event == "connected", at_most_s=10.0)


def test_who_is_taken_over_ends_nothing_of_the_next_one(stages: Stages, nao: ScriptedNao) -> None:
    nao.holds = {"moveTo", "go"}
    first = stages()
    first.until(lambda: first.driver.state() is not None)
    first.ask("walk", "walk", forward_m=0.4)
    first.ask("look", "look", yaw_deg=20)
    first.until(lambda: nao.times("moveTo") and nao.times("go"))
    nao.is_walking = True

    second = stages(takes_over=True)
    second.until(lambda: (first.step(), second.event == "connected")[1])
    nao.is_walking = False
    nao.asked.clear()
    second.ask("walk", "walk", forward_m=0.4)
    second.until(lambda: (first.step(), nao.times("moveTo"))[1])
    second.until(lambda: (first.step(), nao.times("read", lease.DRIVER_KEY) > 4)[1])

    assert not nao.times("stopMove") and not nao.times("kill")


@pytest.mark.parametrize("odd", [float("inf"), float("nan")])
def test_a_mark_with_a_number_that_is_none_ends_no_driver(stage: DriverStage, odd: float) -> None:
    heard = stage.driver._heard
    heard.put(("LandmarkDetected", [0, [[[0, 0.1, 0.1, 0.1], [odd]]], [0.0] * 6]))

    stage.until(heard.empty)
    stage.step()

    assert stage.driver.state() is not None

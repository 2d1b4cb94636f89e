"""No fault throws a real robot over: what the driver sends is read along, in order and time."""

from __future__ import annotations

import math
import os
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from driver_stage import DriverStage
from recording_nao import RecordingNao

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher
from nep_core.program.robot import Robot
from nep_core.program.tasks import current_task
from nep_core.wire.messages import ACTION_REQUEST, NODE_STATE, ActionRequest, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from robots.naoqi.discovery import FOLDER_VARIABLE
from tests.node_running import NodeRunner, until

pytestmark = pytest.mark.long

KILLS = ("ALMotion.killAll", "ALMotion.killTasksUsingResources", "ALMotion.killTask")
AT_ONCE = (
    "ALTextToSpeech.stopAll",
    "ALTracker.stopTracker",
    "ALMotion.stopMove",
    "ALRobotPosture.stopMove",
)
"""What ends speech and following, and what lets the robot stand."""
STANDS_S = 4.0
"""It takes less than a second (benchmarks/walk_ends.py); the rest is for a slow computer."""
FEW_STEPS_M = 0.105
"""So far it goes in that second at most: the rest of a step, one more, and half of the last."""


@pytest.fixture(autouse=True)
def no_saved_login(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))


@pytest.fixture
def nao() -> Iterator[RecordingNao]:
    """One that walks and rises so fast that a test can still be in time to stop it."""
    made = RecordingNao(speed=3.0)
    yield made
    made.close()


@pytest.fixture
def steady_nao() -> Iterator[RecordingNao]:
    """One whose steps take as long as those of a real one."""
    made = RecordingNao()
    yield made
    made.close()


@pytest.fixture
def quick_nao() -> Iterator[RecordingNao]:
    made = RecordingNao(speed=10.0)
    yield made
    made.close()


@pytest.fixture
def stages() -> Iterator[Callable[..., DriverStage]]:
    with ExitStack() as stack:

        def make(nao: RecordingNao, **how: bool) -> DriverStage:
            stage = DriverStage(nao.address, **how)
            stack.callback(stage.close)
            return stage

        yield make


def walking(nao: RecordingNao, stage: DriverStage, action: str, **args: float) -> None:
    stage.ask("walk", action, **args)
    stage.until(lambda: nao.served.state().base[0] > 0.02)


def test_a_stop_in_a_walk_kills_nothing_before_the_robot_stands(nao, stages) -> None:
    stage = stages(nao)
    stage.meet()
    walking(nao, stage, "walk", forward_m=2.0)
    stage.ask("wave", "move_joint", joint="LShoulderPitch", degrees=-60, speed=0.05)
    stage.until(lambda: nao.named("ALMotion.angleInterpolationWithSpeed"))

    stage.ask("stop", "stop")
    told = stage.told[-1]
    stage.until(lambda: not stage.driver.moving)

    stop = nao.named("ALMotion.stopMove")[0]
    kill = next(call for call in nao.named(*KILLS) if call.at_s > stop.at_s)
    asked = [call for call in nao.named("ALMotion.moveIsActive") if call.at_s > stop.at_s]
    standing = next(call for call in asked if call.answer is False)
    assert told == "stop done"
    assert standing.answered_s <= kill.at_s
    assert not nao.named("ALMotion.killAll")
    between = [c for c in nao.calls if stop.at_s < c.at_s < kill.at_s and not c.is_query]
    assert {call.name for call in between} <= {*AT_ONCE, "ALMemory.insertData"}
    assert not nao.served.state().fallen


def test_a_gesture_that_is_stopped_lets_the_walk_go_on(nao, stages) -> None:
    stage = stages(nao)
    stage.meet()
    walking(nao, stage, "walk", forward_m=0.25)
    stage.ask("wave", "move_joint", joint="LShoulderPitch", degrees=-60, speed=0.05)
    stage.until(lambda: nao.named("ALMotion.angleInterpolationWithSpeed"))

    stage.ask("stop", "stop", request="wave")

    assert stage.end_of("walk").state == "done"
    assert not nao.named("ALMotion.stopMove", "ALMotion.killTasksUsingResources")


def test_a_free_walk_goes_on_in_its_steps_and_ends_by_itself_when_the_link_freezes(
    steady_nao, stages
) -> None:
    nao, stage = steady_nao, stages(steady_nao)
    stage.meet()
    walking(nao, stage, "walk_freely", forward=1.0)
    begun_m, begun_s = nao.served.state().base[0], time.monotonic()
    stage.until(lambda: nao.served.state().base[0] > begun_m + 0.2)
    needed_s = time.monotonic() - begun_s

    nao.freezes_after = "ALMotion.moveTo"  # no moment is worse: all of a leg is still to be gone
    stage.until(lambda: nao.is_frozen)
    here = nao.served.state().base
    place = stands_after(nao)
    stage.until(lambda: "walk failed" in stage.told)

    assert needed_s < 0.2 / 0.04 * 1.74  # five legs with a stand after each
    assert place[0] - here[0] < FEW_STEPS_M
    into_s = min(into_steps_s(nao), default=0.0)
    assert into_s > 0.14  # 0.2 where the line is held up for nothing
    assert not nao.named("ALMotion.moveToward", "ALMotion.move")
    assert nao.served.state().base == place and not nao.served.state().fallen
    nao.is_frozen = False


def into_steps_s(nao: RecordingNao) -> list[float]:
    """How long after the beginning of a step, as the robot told of it, each next one was asked."""
    into, place, step_s = [], None, 0.0
    for call in list(nao.calls):
        if call.name == "ALMotion.getNextRobotPosition" and call.answer is not None:
            if place is not None and call.answer != pytest.approx(place, abs=1e-5):
                step_s = call.at_s
            place = call.answer
        if call.name == "ALMotion.moveTo" and step_s:
            into.append(call.at_s - step_s)
    return into


def stands_after(nao: RecordingNao) -> tuple[float, float, float]:
    """Wait until the robot stands; where it does."""
    gone_s = time.monotonic()
    while nao.walks:
        assert time.monotonic() - gone_s < STANDS_S
        time.sleep(0.02)
    return nao.served.state().base


def test_a_long_way_is_walked_in_legs_and_ends_where_it_should(quick_nao, stages) -> None:
    stage = stages(quick_nao)
    stage.meet()

    end = stage.do("walk", forward_m=1.2, left_m=0.3, turn_deg=60)

    legs = [call.values for call in quick_nao.named("ALMotion.moveTo")]
    assert end.state == "done" and len(legs) == 3
    assert all(math.hypot(x, y) <= 0.5 for x, y, _ in legs)
    assert quick_nao.served.state().base == pytest.approx((1.2, 0.3, math.radians(60)), abs=0.02)


def test_a_hot_motor_and_a_low_battery_stop_new_walks(quick_nao, stages) -> None:
    stage = stages(quick_nao)
    stage.meet()
    quick_nao.heat("RKneePitch", 92.0)
    stage.until(lambda: stage.event == "warning")
    hot = [stage.do("walk", forward_m=0.2), stage.do("walk_freely", forward=0.5)]
    quick_nao.heat("RKneePitch", 40.0)
    quick_nao.served.sense("battery", 0.08)
    stage.until(lambda: stage.driver.connection.fault.code == "low_battery")
    empty = stage.do("turn", degrees=20)

    assert [end.fault.code for end in hot] == ["too_hot_to_walk"] * 2
    assert hot[0].fault.values["joint"] == "RKneePitch"
    assert hot[0].fault.values["celsius"] == "92"
    assert empty.fault.code == "battery_too_low_to_walk" and empty.fault.checklist
    assert not quick_nao.named("ALMotion.moveTo", "ALMotion.moveToward")


def test_legs_that_it_stands_on_are_not_released(quick_nao, stages) -> None:
    stage = stages(quick_nao)
    stage.meet()

    refused = [stage.do("stiffness", part=part, on=False) for part in ("legs", "body", "left_leg")]
    refused.append(stage.do("set_stiffness", joints={"LKneePitch": 0.0}))
    arm = stage.do("stiffness", part="left_arm", on=False)

    assert [one.fault.code for one in refused] == ["stands"] * 4
    assert arm.state == "done" and all(one.fault.checklist for one in refused[:3])


@pytest.mark.parametrize("action", ["rest", "wake_up"])
def test_what_stands_up_or_goes_down_is_finished_when_it_is_stopped(
    nao, stages, action: str
) -> None:
    stage = stages(nao)
    stage.meet()
    if action == "wake_up":
        stage.do("rest")
    since_s = time.monotonic()
    method = {"rest": "ALMotion.rest", "wake_up": "ALMotion.wakeUp"}[action]
    stage.ask("1", action)
    stage.until(lambda: any(call.at_s > since_s for call in nao.named(method)))

    stage.ask("stop", "stop")
    stage.until(lambda: not stage.driver.moving)

    assert "1 cancelled" in stage.told
    assert nao.ask("ALMotion", "robotIsWakeUp") is (action == "wake_up")
    assert not set(nao.orders(since_s)) & {*KILLS, "ALMotion.stopMove"}


def test_a_robot_is_left_as_it_was_found(quick_nao, stages) -> None:
    quick_nao.ask("ALAutonomousLife", "setState", "solitary")
    quick_nao.ask("ALMotion", "rest")
    stage = stages(quick_nao)
    stage.until(lambda: stage.driver.state() is not None)
    stage.do("wake_up")
    meanwhile = quick_nao.ask("ALAutonomousLife", "getState")

    stage.driver.disconnect()

    assert meanwhile == "disabled"
    assert quick_nao.ask("ALMotion", "robotIsWakeUp") is False
    assert quick_nao.ask("ALAutonomousLife", "getState") == "solitary"


def test_motors_that_are_left_on_are_said(quick_nao, stages) -> None:
    stage = stages(quick_nao)
    stage.meet()

    stage.driver.disconnect()

    assert stage.driver.connection.fault.code == "left_on"


def test_a_second_driver_is_told_who_drives_and_waits_for_its_turn(quick_nao, stages) -> None:
    first, second = stages(quick_nao), stages(quick_nao)
    first.meet()

    second.until(lambda: (first.step(), second.event == "connection_failed")[1])
    fault = second.driver.connection.fault
    second.ask("walk", "walk", forward_m=0.3)
    second.ask("stop", "stop")

    assert fault.code == "driven" and fault.checklist and " on " in str(fault)
    assert "walk failed" in second.told
    assert not quick_nao.named("ALMotion.stopMove", "ALMotion.moveTo")
    first.driver.disconnect()
    second.meet()


def test_a_robot_is_taken_over_only_by_asking_and_the_first_is_told(nao, stages) -> None:
    first = stages(nao)
    first.meet()
    walking(nao, first, "walk", forward_m=2.0)

    second = stages(nao, takes_over=True)
    second.until(lambda: (first.step(), second.event == "connected")[1])
    first.until(lambda: (second.step(), first.driver.connection.fault.code == "taken_over")[1])

    assert "walk failed" in first.told
    assert not nao.named("ALMotion.killAll")
    second.until(lambda: not second.driver.moving)
    assert not nao.walks and not nao.served.state().fallen
    first.ask("again", "walk", forward_m=1.0)
    assert "again failed" in first.told


def test_the_lease_of_a_dead_owner_ends_by_itself_and_what_was_found_is_known(
    quick_nao, stages
) -> None:
    quick_nao.ask("ALAutonomousLife", "setState", "solitary")
    first = stages(quick_nao)
    first.meet()
    first.do("walk", forward_m=0.1)  # which switches its own life off

    second = stages(quick_nao)  # and the first beats no more
    passed_s = second.until(lambda: second.event == "connected")
    second.driver.disconnect()

    assert 2.0 < passed_s < 10.0
    assert quick_nao.ask("ALAutonomousLife", "getState") == "solitary"


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="there are no such signals here")
@pytest.mark.parametrize("name", ["SIGKILL", "SIGSTOP"])
def test_a_robot_stands_soon_after_its_node_is_killed_or_stands_still(
    steady_nao: RecordingNao, network: PeerNetwork, name: str
) -> None:
    nao = steady_nao
    runner = NodeRunner(network)
    requests = Publisher(ACTION_REQUEST, network=network)
    node = runner.start_node("action/nao", "nao", driver="naoqi", address=nao.address)
    try:
        runner.state("connected")
        assert requests.wait_for_subscribers(1, 10)
        speeds = {"forward": 1.0}
        requests.send(ActionRequest(id="1", robots=["NAO"], action="walk_freely", args=speeds))
        until_s = time.monotonic() + 20.0
        while nao.served.state().base[0] < 0.02:
            assert time.monotonic() < until_s
            time.sleep(0.05)

        os.kill(node.pid, getattr(signal, name))
        here = nao.served.state().base
        place = stands_after(nao)
    finally:
        os.kill(node.pid, signal.SIGKILL)
        runner.close()

    assert nao.served.state().base == place
    assert place[0] - here[0] < FEW_STEPS_M


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="there are no such signals here")
def test_a_robot_whose_node_crashed_in_a_free_walk_stands_and_works_again(
    nao: RecordingNao, network: PeerNetwork, tmp_path: Path
) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=network)
    robot = Robot("NAO")
    with Launcher(logs=tmp_path, master=network.master) as launcher:
        launcher.hear(network)
        node = launcher.launch("action/nao", "nao", {"driver": "naoqi", "address": nao.address})
        until(states, lambda told: told.event == "connected")
        robot.start_walking(100)  # which is asked for again as long as somebody answers
        until_s = time.monotonic() + 20.0
        while nao.served.state().base[0] < 0.1:
            assert time.monotonic() < until_s
            time.sleep(0.05)

        os.kill(node.pid, signal.SIGKILL)
        place = stands_after(nao)
        until(states, lambda told: told.event == "connected")
        time.sleep(1.0)

        assert nao.served.state().base == place
        robot.walk(0.1)
        assert nao.served.state().base[0] == pytest.approx(place[0] + 0.1, abs=0.03)
        current_task().end_undone()

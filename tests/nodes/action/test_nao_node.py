"""The action node in a process of its own, asked over the network by a program."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from nep_core.errors import ActionFailed
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.manifest import read_manifest
from nep_core.program.robot import Robot
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    ROBOT_STATE,
    ActionRequest,
    ActionResult,
    RobotState,
)
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import NODES, NodeRunner, until

pytestmark = pytest.mark.long

MANIFEST = NODES / "action" / "nao.toml"


class Theatre(NodeRunner):
    """Starts action nodes, asks them, and hears what they say."""

    def __init__(self, network: PeerNetwork) -> None:
        super().__init__(network)
        self.results = Subscriber(ACTION_RESULT, ActionResult, network=network)
        self.robot_states = Subscriber(ROBOT_STATE, RobotState, network=network)
        self.requests = Publisher(ACTION_REQUEST, network=network)

    def start(self, **parameters: object) -> subprocess.Popen[str]:
        return self.start_node("action/nao", f"nao_{len(self.nodes)}", **parameters)

    def ready(self, **parameters: object) -> subprocess.Popen[str]:
        node = self.start(**parameters)
        self.state("ready")
        assert self.requests.wait_for_subscribers(len(self.nodes), 10)
        return node

    def ask(self, id: str, action: str, *robots: str, **args: Any) -> None:
        self.requests.send(ActionRequest(id=id, robots=list(robots), action=action, args=args))

    def results_until(self, id: str, state: str) -> list[str]:
        heard = until(self.results, lambda result: (result.id, result.state) == (id, state))
        return [f"{result.robot} {result.id} {result.state}" for result in heard]


@pytest.fixture
def theatre(network: PeerNetwork) -> Iterator[Theatre]:
    theatre = Theatre(network)
    yield theatre
    theatre.close()


def test_its_manifest_is_right() -> None:
    parameters = read_manifest(MANIFEST).read_parameters({})

    assert parameters == {
        "robot": "NAO",
        "driver": "virtual",
        "address": "",
        "speed": 1.0,
        "animations": "",
        "naoqi_port": 0,
        "model": "nao",
        "take_over": False,
    }


def test_it_plays_the_animations_of_a_folder_too(theatre: Theatre, tmp_path: Path) -> None:
    hop = 'title = "Hop"\ndescription = ""\nkind = "animation"\n'
    keys = "[joints.HeadPitch]\ntimes = [0.5]\nkeys = [0.3]\n"
    (tmp_path / "hop.toml").write_text(hop + keys)
    theatre.ready(speed=20, animations=str(tmp_path))

    theatre.ask("r1", "play", "NAO", animation="hop")

    assert theatre.results_until("r1", "done")[0] == "NAO r1 accepted"


def test_a_program_makes_it_speak_walk_and_imitate(theatre: Theatre) -> None:
    theatre.ready(speed=20)
    robot = Robot("NAO")

    robot.say("Hello", gesture="greet")
    robot.do("posture_stand")
    robot.imitate("cat")
    robot.walk(0.2)

    last = until(theatre.robot_states, lambda state: state.base[0] == pytest.approx(0.2))[-1]
    assert last.robot == "NAO" and len(last.joints) == 26 and last.posture == "StandInit"


SLOW_PLANNING = """
import time
from pathlib import Path
from robots.body import gait
plan = gait.plan_walk
def plan_slowly(*arguments, **more):
    while not Path({finished!r}).exists():
        time.sleep(0.01)
    return plan(*arguments, **more)
gait.plan_walk = plan_slowly
"""


def test_a_robot_says_how_its_walk_goes_while_it_is_planned(
    theatre: Theatre, tmp_path: Path
) -> None:
    finished = tmp_path / "finished"
    theatre.prepare = SLOW_PLANNING.format(finished=str(finished))
    theatre.ready(speed=50)
    theatre.ask("as_walks_begin", "do", "NAO", posture="posture_stand_init")
    theatre.results_until("as_walks_begin", "done")
    theatre.ask("far", "walk", "NAO", forward_m=5.0)
    theatre.results_until("far", "started")

    for _ in range(3):
        theatre.ask("far", "walk", "NAO", forward_m=5.0)
        assert theatre.results_until("far", "started")

    finished.touch()
    assert theatre.results_until("far", "done")


def test_a_walk_while_sitting_fails_with_what_to_do(theatre: Theatre) -> None:
    theatre.ready(speed=50)
    robot = Robot("NAO")
    robot.do("posture_sit")

    with pytest.raises(ActionFailed, match="NAO sits: it must stand before it can walk"):
        robot.walk(0.3)


def test_two_robots_act_at_once_and_each_hears_its_own_name(theatre: Theatre) -> None:
    theatre.ready(robot="NAO", speed=20)
    theatre.ready(robot="NAO2", speed=20)

    theatre.ask("one", "say", "NAO2", text="I")
    theatre.ask("both", "say", "NAO", "NAO2", text="We")
    heard = until(theatre.results, both_done())

    done = [(result.robot, result.id) for result in heard if result.state == "done"]
    assert sorted(done) == [("NAO", "both"), ("NAO2", "both"), ("NAO2", "one")]


def both_done() -> Callable[[ActionResult], bool]:
    done = set()

    def wanted(result: ActionResult) -> bool:
        if result.id == "both" and result.state == "done":
            done.add(result.robot)
        return len(done) == 2

    return wanted


def test_the_same_request_sent_again_is_not_played_again(theatre: Theatre) -> None:
    theatre.ready(speed=50)

    theatre.ask("1", "turn", "NAO", degrees=90)
    theatre.results_until("1", "done")
    theatre.ask("1", "turn", "NAO", degrees=90)
    again = theatre.results_until("1", "done")
    theatre.ask("2", "look", "NAO", yaw_deg=10)
    theatre.results_until("2", "done")

    assert again == ["NAO 1 done"]
    state = until(
        theatre.robot_states, lambda s: s.joints["HeadYaw"] == pytest.approx(0.1745, abs=1e-3)
    )
    assert state[-1].base[2] == pytest.approx(1.5708, abs=1e-3)


def test_stop_is_heard_at_once_in_the_middle_of_a_long_walk(theatre: Theatre) -> None:
    theatre.ready()
    theatre.ask("walk", "walk", "NAO", forward_m=5)
    theatre.results_until("walk", "started")

    asked_s = time.monotonic()
    theatre.ask("stop", "stop", "NAO")
    told = theatre.results_until("stop", "done")

    assert told == ["NAO walk cancelled", "NAO stop done"]
    assert time.monotonic() - asked_s < 2.0


def test_its_state_comes_30_times_a_second_while_it_moves(theatre: Theatre) -> None:
    theatre.ready()
    theatre.ask("1", "say", "NAO", text="a" * 28)
    theatre.results_until("1", "started")

    states = until(theatre.robot_states, lambda state: state.saying != "")
    states = until(theatre.robot_states, lambda state: state.saying == "")

    assert 25 <= len(states) <= 64  # about 60 on a quiet computer


def test_it_ends_cleanly_and_cancels_what_it_was_doing(theatre: Theatre) -> None:
    node = theatre.ready()
    theatre.ask("1", "walk", "NAO", forward_m=5)
    theatre.results_until("1", "started")

    node.send_signal(signal.SIGTERM)

    assert theatre.results_until("1", "cancelled")
    assert node.wait(20) == 0


def test_a_real_robot_that_does_not_answer_is_told_and_requests_fail_with_the_same_sentence(
    theatre: Theatre, free_port: int
) -> None:
    theatre.start(driver="naoqi", address=f"127.0.0.1:{free_port}")

    failed = theatre.state("connection_failed")

    assert failed.description.startswith("NAO does not answer")
    assert "Is NAO switched on?" in str(failed.fault.checklist[0])
    with pytest.raises(ActionFailed, match=f"NAO does not answer.*127.0.0.1:{free_port}"):
        Robot("NAO").say("Hello")


def test_a_program_that_is_no_robot_is_told_apart_from_one(theatre: Theatre) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        theatre.start(driver="naoqi", address=f"127.0.0.1:{server.getsockname()[1]}")

        failed = theatre.state("connection_failed")

    assert failed.description.startswith("NAO does not answer")


def test_a_robot_behind_naoqi_does_what_programs_ask(theatre: Theatre, free_port: int) -> None:
    theatre.ready(robot="Served", speed=20, naoqi_port=free_port)
    theatre.ready(robot="NAO", driver="naoqi", address=f"127.0.0.1:{free_port}")
    robot = Robot("NAO")

    robot.say("Hello", gesture="greet")
    robot.walk(0.2)
    robot.do("posture_sit")

    def sits(state: RobotState) -> bool:
        return state.robot == "Served" and state.posture == "Sit"

    last = until(theatre.robot_states, sits)[-1]
    assert last.base[0] == pytest.approx(0.2, abs=0.02)
    assert robot.posture() == "Sit"


WALKS_ON = """
from nep_core import Robot, wait
Robot("NAO").start_walking(100)
wait(600)
"""
STANDS_S = 6.0
"""A second without being asked and the end of a step; the rest is for a slow computer."""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there are no such signals here")
@pytest.mark.parametrize("driver", ["virtual", "naoqi"])
def test_a_robot_stands_soon_after_its_program_alone_is_killed(
    theatre: Theatre, tmp_path: Path, free_port: int, driver: str
) -> None:
    walking = "NAO"
    if driver == "naoqi":
        walking = "Served"
        theatre.ready(robot=walking, naoqi_port=free_port)
    theatre.ready(robot="NAO", driver=driver, address=f"127.0.0.1:{free_port}")
    file = tmp_path / "walks_on.py"
    file.write_text(WALKS_ON)
    program = theatre.start_node("cognitive/program", "walks_on", file=str(file))
    until(theatre.robot_states, lambda one: one.robot == walking and one.base[0] > 0.3)

    os.kill(program.pid, signal.SIGKILL)
    killed_s = time.monotonic()
    until(theatre.robot_states, lambda one: one.robot == walking and not one.moving)

    assert time.monotonic() - killed_s < STANDS_S
    Robot("NAO").walk(0.1)  # the next program has a robot that works


def test_a_wrong_address_ends_the_node_with_a_sentence(theatre: Theatre) -> None:
    node = theatre.start(driver="naoqi", address="http://nao")

    _, words = node.communicate(timeout=30)

    assert node.returncode == 1
    assert words.startswith('"http://nao" is not the address of a robot.')
    assert "Traceback" not in words


def test_missing_resources_end_the_node_with_a_sentence(
    theatre: Theatre, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("NEP_RESOURCES", os.fspath(tmp_path / "nowhere"))

    _, words = theatre.start().communicate(timeout=30)

    assert "resources folder" in words and "Traceback" not in words

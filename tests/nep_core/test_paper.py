"""The listings of the paper run exactly as printed, against real processes."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import HUMAN_BEHAVIOR, NODE_STATE, HumanBehavior, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.master_process import until
from tests.nep_core.robot_playing import PlayedRobot

pytestmark = pytest.mark.long

Join = Callable[[str], PeerNetwork]

IMPORT = "from nep_core.paper import *\n"
PUBLISHER, SUBSCRIBER, LAUNCHER, ROBOT, BEHAVIOR, RULE = range(6)


@pytest.fixture
def listings(shared_data: Path) -> list[str]:
    """The paper's listings, in its order."""
    paper = (shared_data.parent / "paper.tex").read_text(encoding="latin-1")
    found = re.findall(
        r"\\begin{lstlisting}\[language=Python\]\n(.*?)\\end{lstlisting}", paper, re.S
    )
    assert len(found) == 6
    return found


@pytest.fixture
def program(master: Master, tmp_path: Path) -> Iterator[Callable[[str], subprocess.Popen[str]]]:
    """Runs a text as a program of its own."""
    started: list[subprocess.Popen[str]] = []

    def run(text: str) -> subprocess.Popen[str]:
        file = tmp_path / f"listing{len(started)}.py"
        file.write_text(IMPORT + text, encoding="utf-8")
        started.append(subprocess.Popen([sys.executable, file], stdout=subprocess.PIPE, text=True))
        return started[-1]

    yield run
    for child in started:
        child.kill()
        child.communicate()


@pytest.mark.real_data
def test_the_subscriber_hears_the_publisher(
    listings: list[str], program: Callable[[str], subprocess.Popen[str]], join: Join
) -> None:
    observer = Publisher("/human_behavior", network=join("observer"))
    hearing = program(listings[SUBSCRIBER] + "\nprint(success, human_state)\n")
    assert observer.wait_for_subscribers(1, 10)

    program(listings[PUBLISHER])

    assert hearing.communicate(timeout=10)[0] == "True happy\n"


@pytest.mark.real_data
def test_the_launcher_starts_a_perceptual_node(
    listings: list[str], program: Callable[[str], subprocess.Popen[str]], join: Join
) -> None:
    states = Subscriber(NODE_STATE, NodeState, network=join("observer"))

    launching = program(listings[LAUNCHER] + "\nprint('launched')\n")

    assert launching.communicate(timeout=30)[0] == "launched\n"
    heard = [state for state in iter(lambda: states.receive(0.5), None) if state]
    assert {state.node for state in heard} == {"gesture_recognition"}
    assert {state.type for state in heard} == {"perceptual"}
    assert [s.event for s in heard if s.event != "alive"] == ["starting", "ready", "stopped"]


@pytest.mark.real_data
def test_the_robot_says_sits_and_imitates(
    listings: list[str], program: Callable[[str], subprocess.Popen[str]], join: Join
) -> None:
    nao = PlayedRobot(join("NAO"))

    assert program(listings[ROBOT]).wait(10) == 0

    assert nao.asked == [
        ("say", {"text": "Hello", "gesture": "no_gesture", "language": ""}),
        ("do", {"posture": "posture_stand"}),
        ("imitate", {"animal": "cat"}),
    ]


@pytest.mark.real_data
def test_the_reactive_behaviour_says_impressive_at_each_karate(
    listings: list[str], program: Callable[[str], subprocess.Popen[str]], join: Join
) -> None:
    nao = PlayedRobot(join("NAO"))
    person = Publisher(HUMAN_BEHAVIOR, network=join("person"))
    program("\n".join([listings[ROBOT], listings[RULE], listings[BEHAVIOR]]))
    assert person.wait_for_subscribers(1, 10)
    assert until(lambda: len(nao.asked) >= 3)

    for state in ("gesture_karate", "gesture_katana", "gesture_karate"):
        person.send(HumanBehavior(human_state=state))
    assert until(lambda: nao.words().count("Impressive!") >= 2)

    assert nao.words() == ["Hello", "Impressive!", "Impressive!"]

"""The nodes in the help page "Write a node" are taken from its text and run."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from nep_core.places import node_folders
from nep_core.processes.launcher import Launcher
from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, NODE_STATE, HumanBehavior, Imu, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from nep_studio.help.texts import page_texts

PAGE = page_texts("en")["write-a-node"]
LONG_S = 15.0


def code(language: str, number: int = 0) -> str:
    """A piece of code of the page."""
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.S)[number]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of nodes with the one of the page, as it tells people to make it."""
    place = tmp_path / "perceptual"
    place.mkdir()
    (place / "shaken.toml").write_text(code("toml"), encoding="utf-8")
    (place / "shaken.py").write_text(code("python"), encoding="utf-8")
    return tmp_path


def batch(start_s: float, force: float) -> Imu:
    times = [start_s + n * 0.02 for n in range(5)]
    return Imu(source="test", rate_hz=50, t=times, acc=[(0.0, 0.0, force)] * 5)


def wait_for(heard: list[HumanBehavior], count: int, publisher: Publisher, force: float) -> None:
    """Send movement until so many states have come."""
    clock_s, until_s = 0.0, time.monotonic() + LONG_S
    while len(heard) < count and time.monotonic() < until_s:
        publisher.send(batch(clock_s, force))
        clock_s += 0.1
        time.sleep(0.02)
    assert len(heard) >= count


def test_the_node_of_the_page_runs_and_tells_when_the_watch_is_shaken(folder, master, network):
    heard: list[HumanBehavior] = []
    with Launcher(folders=(folder, *node_folders()), logs=folder, master=master.endpoint) as nodes:
        states = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network, callback=heard.append)
        publisher = Publisher(IMU, network=network)
        nodes.hear(network)
        nodes.launch("perceptual/shaken", "shaken", {"strength": 20}).wait_ready(LONG_S)
        publisher.send(batch(0.0, 9.8))

        wait_for(heard, 2, publisher, force=40.0)
        states.close()

    assert {state.human_state for state in heard} == {"shaken"}
    assert {state.source for state in heard} == {"shaken"}


def test_the_node_in_another_language_is_heard_by_ours(tmp_path, master, network):
    """Only ZeroMQ and the protocol as the page tells it."""
    script = code("python", 1)
    assert "nep_core" not in script
    path = tmp_path / "bell.py"
    path.write_text(script, encoding="utf-8")
    heard: list[HumanBehavior] = []
    seen: list[NodeState] = []
    states = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network, callback=heard.append)
    nodes = Subscriber(NODE_STATE, NodeState, network=network, callback=seen.append)

    environment = {**os.environ, "NEP_MASTER": master.endpoint}
    child = subprocess.Popen([sys.executable, str(path)], env=environment)
    try:
        until_s = time.monotonic() + LONG_S
        while not (heard and seen) and time.monotonic() < until_s:
            time.sleep(0.02)
    finally:
        child.kill()
        child.wait()
        states.close()
        nodes.close()

    assert heard and heard[0].human_state == "bell_rang"
    assert seen and seen[0].node == "bell"


def test_the_node_of_the_page_is_short():
    assert len(code("python").strip().splitlines()) <= 25

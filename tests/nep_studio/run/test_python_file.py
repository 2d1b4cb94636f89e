"""The saved Python says how to run it, and what it says works in real processes."""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import ACTION_REQUEST, NODE_STATE, ActionRequest, NodeState
from nep_core.wire.pubsub import Subscriber
from nep_studio import paths
from nep_studio.blocks.files import load
from nep_studio.run.installation import studio_language
from nep_studio.run.python_file import python_file, write_kept
from tests.blocks.block_building import B, build
from tests.node_running import until

LANGUAGE = studio_language()


def greeting(words: str = "Hello") -> str:
    editor = build(LANGUAGE, [B("event.started"), B("robot.say", {"text": words})], name="Greeting")
    build(LANGUAGE, [B("robots.robot")], page="robots", editor=editor)
    return python_file(editor.project, LANGUAGE, Path.cwd(), "my greeting.py")


def commands(text: str) -> list[list[str]]:
    """The commands that the comment gives."""
    lines = [line.removeprefix("#   ") for line in text.splitlines() if line.startswith("#   ")]
    return [shlex.split(line) for line in lines]


class Processes:
    def __init__(self) -> None:
        self.all: list[subprocess.Popen[str]] = []

    def start(self, *command: str, folder: Path) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.all.append(process)
        return process


@pytest.fixture
def processes() -> Processes:
    made = Processes()
    yield made
    for process in reversed(made.all):
        for child in psutil.Process(process.pid).children(True) if process.poll() is None else ():
            child.terminate()
        process.terminate()
        process.communicate(timeout=10)


def test_all_that_the_comment_says_runs_the_program(
    processes: Processes, tmp_path: Path, free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    monkeypatch.setenv(MASTER_VARIABLE, endpoint)
    text = greeting()
    (tmp_path / "my greeting.py").write_text(text, encoding="utf-8")
    master, *nodes, program = commands(text)
    tool = [sys.executable, "-m", "nep_studio"]

    processes.start(*tool, *master[1:], folder=tmp_path)
    with PeerNetwork("test", master=endpoint) as network:
        states = Subscriber(NODE_STATE, NodeState, network=network)
        requests = Subscriber(ACTION_REQUEST, ActionRequest, network=network)
        for node in nodes:
            processes.start(*tool, *node[1:], folder=tmp_path)
        until(states, lambda state: state.node == "NAO" and state.event in ("ready", "connected"))
        running = processes.start(*tool, *program[1:], folder=tmp_path)
        said = until(requests, lambda request: request.action == "say")[-1]

        assert said.args["text"] == "Hello"
        assert running.wait(20) == 0


def test_any_python_that_has_nep_core_runs_it(
    master: object, processes: Processes, tmp_path: Path, network: PeerNetwork
) -> None:
    file = tmp_path / "hello.py"
    file.write_text(greeting("Just Python"), encoding="utf-8")
    requests = Subscriber(ACTION_REQUEST, ActionRequest, network=network)
    states = Subscriber(NODE_STATE, NodeState, network=network)
    processes.start(
        *(sys.executable, "-m", "nep_studio", "node", "action/nao", "--name=NAO", "robot=NAO"),
        folder=tmp_path,
    )
    until(states, lambda state: state.node == "NAO" and state.event in ("ready", "connected"))

    running = processes.start(sys.executable, str(file), folder=tmp_path)

    said = until(requests, lambda request: request.action == "say")[-1]
    assert said.args["text"] == "Just Python"
    assert running.wait(20) == 0


@pytest.mark.parametrize("path", sorted(paths.examples().glob("*.nep")), ids=lambda p: p.stem)
def test_the_comment_lists_every_node_of_an_example(path: Path) -> None:
    project = load(path, LANGUAGE)

    text = python_file(project, LANGUAGE, path.parent, "play.py")

    listed = commands(text)
    compile(text, "play.py", "exec")
    assert listed[0] == ["nep-studio", "master"]
    assert ["nep-studio", "exec", "play.py"] in listed
    assert all(words[:2] == ["nep-studio", "node"] for words in listed[1:-1] if "exec" not in words)


def test_a_name_cannot_break_out_of_the_comment() -> None:
    editor = build(LANGUAGE, [B("event.started")])

    text = python_file(editor.project, LANGUAGE, Path.cwd(), "a\nimport os #.py")

    code = "\n".join(line for line in text.split("\n") if not line.startswith("#"))
    assert "import os" not in code


def test_gestures_of_the_project_lie_beside_its_python(tmp_path: Path) -> None:
    project = load(paths.examples() / "own_gestures.nep", LANGUAGE)

    write_kept(project, LANGUAGE, tmp_path / "mine.py")

    text = python_file(project, LANGUAGE, tmp_path, "mine.py")
    settings = dict(word.split("=", 1) for line in commands(text) for word in line if "=" in word)
    assert (tmp_path / settings["model"]).is_file()
    assert sorted(path.stem for path in (tmp_path / settings["takes"]).glob("*.csv")) == [
        "big_wave",
        "circle",
        "knock",
    ]

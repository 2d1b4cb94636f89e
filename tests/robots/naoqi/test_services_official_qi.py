"""Programs made with the official qi package, as they are, drive the robot on the screen."""

from __future__ import annotations

import contextlib
import importlib.util
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from naoqi_theatre import NaoqiTheatre

pytestmark = pytest.mark.long

HERE = Path(__file__).parent
needs_qi = pytest.mark.skipif(
    importlib.util.find_spec("qi") is None, reason="the official qi package is not there"
)


@pytest.fixture
def theatre() -> Iterator[NaoqiTheatre]:
    theatre = NaoqiTheatre(speed=4)
    yield theatre
    theatre.close()


Start = Callable[[str], subprocess.Popen[str]]


@pytest.fixture
def start(theatre: NaoqiTheatre) -> Iterator[Start]:
    """Start a program of this folder, which does not outlive its test."""
    with contextlib.ExitStack() as stack:

        def start_one(program: str) -> subprocess.Popen[str]:
            url = f"--qi-url=tcp://127.0.0.1:{theatre.offered.port}"
            process = subprocess.Popen(
                [sys.executable, str(HERE / program), url],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            stack.enter_context(process)
            stack.callback(process.kill)
            return process

        yield start_one


def until_it_waits(process: subprocess.Popen[str]) -> None:
    assert process.stdout is not None
    said = []
    for line in process.stdout:
        said.append(line)
        if "waiting" in line:
            return
    pytest.fail("".join([*said, process.communicate()[1]]))


@needs_qi
def test_a_program_of_someone_else_greets_moves_and_reacts(
    theatre: NaoqiTheatre, start: Start
) -> None:
    said, lights = set(), set()
    program = start("greeter.py")

    def watch() -> bool:
        state = theatre.state()
        said.add(state.saying)
        lights.add(state.leds["LeftFaceLeds"])
        return {"Hello", "I am", "a robot"} <= said and 0xFF00FF in lights

    theatre.until(watch)
    until_it_waits(program)
    theatre.feel("head_middle")
    output, errors = program.communicate(timeout=30)

    assert program.returncode == 0, errors
    told = json.loads(output)
    assert (told["went"], told["moved"], told["name"]) == (True, True, "Anna")
    assert told["head"] == pytest.approx([0.3, 0.1], abs=1e-3)
    assert told["place"] == pytest.approx([0.06, 0.0, 0.0], abs=0.01)
    assert told["touches"] == [1.0]
    assert told["state"] == "FutureState.Canceled"
    assert told["cancel_s"] < 1.0
    assert "no joint, chain or group “Nose”" in told["joint"]
    assert "no posture “Headstand”" in told["posture"]
    assert "no data “NoSuchKey”" in told["key"]
    assert "Arguments types did not match" in told["arguments"]
    assert "Cannot find service" in told["service"]
    assert told["hand"] == pytest.approx([1.0], abs=0.1)


@needs_qi
def test_the_memory_calls_a_module_of_a_program_back(theatre: NaoqiTheatre, start: Start) -> None:
    program = start("reacting_module.py")
    until_it_waits(program)

    theatre.feel("head_front", 1.0)
    output, errors = program.communicate(timeout=30)

    assert program.returncode == 0, errors
    assert output.strip() == "('FrontTactilTouched', 1.0)"

"""The process that trains: it is asked by lines of JSON, and tells how it goes."""

import contextlib
import json
import os
import subprocess
import sys

import psutil
import pytest

from faults import heard_fault
from nodes.perceptual.recognition import worker
from nodes.perceptual.recognition.model import read_model
from nodes.recordings import write_recording
from nodes.sensory.arm.people import simulate_everyday, simulate_session
from tests.node_running import WAIT_S

pytestmark = pytest.mark.long


class Worker:
    """The process as the studio has it."""

    def __init__(self):
        self.process = subprocess.Popen(
            worker.command_line(), stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def order(self, **order):
        self.process.stdin.write(json.dumps(order).encode() + b"\n")
        self.process.stdin.flush()

    def told(self):
        return json.loads(self.process.stdout.readline())

    def answers(self):
        """All that it tells of an order, to the last."""
        answers = [self.told()]
        while not {"done", "fault"} & set(answers[-1]):
            answers.append(self.told())
        return answers


@pytest.fixture(scope="module")
def process():
    one = Worker()
    assert one.told() == {"ready": True}
    yield one
    one.process.stdin.close()
    assert one.process.wait(WAIT_S) == 0
    one.process.stdout.close()


@pytest.fixture
def folder(tmp_path):
    """Recordings of one gesture, and one of everyday movement."""
    for name in ("takes", "takes/everyday"):
        (tmp_path / name).mkdir()
    write_recording(tmp_path / "takes" / "ann.csv", simulate_session(5, ("karate",), 3))
    write_recording(tmp_path / "takes" / "everyday" / "ann.csv", simulate_everyday(5, 20.0))
    return tmp_path / "takes"


def test_it_tells_how_the_training_goes_and_where_the_model_is(process, folder, tmp_path):
    output = tmp_path / "mine.gestures"

    process.order(train=str(folder), output=str(output), methods=["gmr"], everyday=False)
    *progress, done = process.answers()

    parts = [one["progress"] for one in progress]
    assert parts == sorted(parts)
    assert parts[0] == 0
    assert {one["step"] for one in progress} <= set(worker.STEPS)
    assert done["done"] == str(output)
    assert done["seconds"] > 0
    assert done["report"]["gmr"]["takes"] == {"karate": 3}
    assert done["report"]["gmr"]["everyday_s"] == pytest.approx(20, abs=0.5)
    assert done["remarks"] == []
    assert read_model(output).names == ("karate",)


@pytest.mark.parametrize(
    ("order", "sentence"),
    [
        ({"train": "nowhere"}, "nowhere is not a folder of recordings."),
        ({"output": "/nowhere/x.gestures"}, "cannot be written"),
        ({"methods": ["magic"]}, "The order to train cannot be read"),
        ({"surprise": 1}, "The order to train cannot be read"),
    ],
)
def test_what_cannot_be_trained_is_told_with_what_to_do(process, folder, tmp_path, order, sentence):
    usual = {"train": str(folder), "output": str(tmp_path / "mine.gestures"), "everyday": False}

    process.order(**usual | order)
    told = process.answers()[-1]

    fault = heard_fault(told["fault"])
    assert sentence in str(fault)
    assert fault.checklist
    assert not (tmp_path / "mine.gestures").exists()


def test_it_goes_on_after_a_line_that_is_no_order(process):
    process.process.stdin.write(b"\xff{\n\nnull\n")
    process.process.stdin.flush()

    assert "fault" in process.told()
    assert "fault" in process.told()


@pytest.mark.skipif(sys.platform == "win32", reason="there, the pipe closes with the parent")
def test_it_ends_when_its_parent_dies_though_somebody_holds_its_input_open():
    parent = (
        "import subprocess, sys\nfrom nodes.perceptual.recognition.worker import command_line\n"
        "print(subprocess.Popen(command_line(), stdout=subprocess.DEVNULL).pid)"
    )
    with subprocess.Popen(
        [sys.executable, "-c", parent], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as started:
        orphan = int(started.stdout.readline())
        with contextlib.suppress(psutil.NoSuchProcess):
            _, alive = psutil.wait_procs([psutil.Process(orphan)], WAIT_S)
            assert not alive


def test_a_frozen_program_starts_it_by_its_own_name(monkeypatch):
    monkeypatch.setattr(sys, "frozen", True, raising=False)

    assert worker.command_line() == [sys.executable, "train-worker", str(os.getpid())]

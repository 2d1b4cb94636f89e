"""A process that learns gestures: it keeps warm, is asked by lines of JSON, and tells how it goes.

It reads ``{"train": folder, "output": path, "methods": ["trees", "gmr"], "everyday": true}`` from
its standard input and writes to its standard output

    {"ready": true}
    {"progress": 0.4, "step": "Learning the gestures…"}
    {"done": path, "seconds": 1.9, "report": {...}, "remarks": [...]}
    {"fault": {"code": "...", "sentence": {"text": "What happened."}, "checklist": [...]}}

Training ends early when the process is killed. It ends when its standard input closes, or its
parent is gone, whatever it does then.
"""

from __future__ import annotations

import importlib
import os
import queue
import sys
import threading
import time
import traceback
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO, Literal

import msgspec
import psutil

from faults import Fault, fault_of
from nep_core.errors import NepError
from nep_core.processes.process import program_command
from nep_core.wire.frames import CANNOT_DECODE

from .dataset import everybodys_movement, learn, read_material
from .model import check_writable, write_model

READING = "Reading the recordings…"
LEARNING = "Learning the gestures…"
CHECKING = "Checking what it learned…"
WRITING = "Keeping what it learned…"
STEPS = (READING, LEARNING, CHECKING, WRITING)

_LONGEST_LINE = 1_000_000
_PARENT_S = 1.0
_READ, _CHECKED, _LEARNED = 0.1, 0.65, 0.95  # of the progress


class _Order(msgspec.Struct, forbid_unknown_fields=True):
    train: str
    output: str
    methods: tuple[Literal["trees", "gmr"], ...] = ("trees", "gmr")
    everyday: bool = True


def command_line() -> list[str]:
    """The command by which this program starts such a process, from source or frozen."""
    parent = str(os.getpid())
    if getattr(sys, "frozen", False):
        return program_command("train-worker", parent)
    # -P: as in program_command
    return [sys.executable, "-P", "-m", "nodes.perceptual.recognition.worker", parent]


def main(arguments: list[str]) -> int:
    """Train what is ordered, one after the other, until nobody is there to order more.

    The argument is the id of the process that orders it.
    """
    told = _JsonLines(sys.stdout.buffer)
    sys.stdout = sys.stderr  # what libraries print is no answer
    orders: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(sys.stdin.buffer, orders), daemon=True).start()
    for parent in arguments[:1]:
        threading.Thread(target=_watch_parent, args=(int(parent),), daemon=True).start()
    try:
        _train_without_delay()
    except ImportError as error:
        told.fault(
            fault_of(
                "A part that learning needs is not installed.",
                code="not_installed",
                checklist=(
                    "Install NEP Studio again.",
                    "From source: install the requirements again.",
                ),
            )
        )
        print(error, file=sys.stderr)
        return 1
    told.tell({"ready": True})
    everybodys_movement()
    while True:
        _do(orders.get(), told)


def _train_without_delay() -> None:
    """Import the library of learning now: that takes as long as a training."""
    importlib.import_module("sklearn.ensemble")


def _do(line: bytes, told: _JsonLines) -> None:
    """Do one order, and tell how it ended."""
    try:
        order = msgspec.json.decode(line, type=_Order)
        _train(order, told)
    except NepError as error:
        told.fault(error.fault)
    except CANNOT_DECODE as error:
        told.fault(
            fault_of(
                "The order to train cannot be read: {error}.",
                checklist=("Train again.",),
                error=error,
            )
        )
    except MemoryError:
        told.fault(
            fault_of(
                "The computer has too little memory free to learn from these recordings.",
                code="memory",
                checklist=("Close other programs.", "Learn from fewer or shorter recordings."),
            )
        )
    except Exception as error:  # a fault of ours must not end the process without a word
        traceback.print_exc()
        told.fault(
            fault_of(
                "The training failed: {error}.",
                code=f"python:{type(error).__name__}",
                checklist=("Train again.", "Leave out the recordings that you made last."),
                error=str(error) or type(error).__name__,
            )
        )


def _train(order: _Order, told: _JsonLines) -> None:
    started_s = time.monotonic()
    output = Path(order.output)
    told.progress(0.0, READING)
    check_writable(output)
    material = read_material(Path(order.train))
    if order.everyday:
        material = material.with_everyday(everybodys_movement())
    learning = _Learning(told, 1 + material.has_rotation)
    model = learn(material, order.methods, tell=learning.go_on)
    told.progress(_LEARNED, WRITING)
    write_model(output, model)
    told.tell(
        {
            "done": str(output),
            "seconds": round(time.monotonic() - started_s, 2),
            "report": model.report,
            "remarks": material.remarks,
        }
    )


class _Learning:
    """The progress of a training, which tells when it begins to check, and to learn for good."""

    def __init__(self, told: _JsonLines, count: int) -> None:
        self._told = told
        self._steps = iter(
            [(_READ, CHECKING)]
            + [(_CHECKED + (_LEARNED - _CHECKED) * n / count, LEARNING) for n in range(count)]
        )

    def go_on(self, _what: str) -> None:
        """The next part of the training begins."""
        for part, step in self._steps:
            self._told.progress(part, step)
            return


class _JsonLines:
    """What is told, a line of JSON each."""

    def __init__(self, out: BinaryIO) -> None:
        self._out = out

    def tell(self, message: dict[str, Any]) -> None:
        """Tell it now; nobody to hear it ends the process."""
        try:
            self._out.write(msgspec.json.encode(message) + b"\n")
            self._out.flush()
        except OSError:
            os._exit(0)

    def progress(self, part: float, step: str) -> None:
        """Tell how far the training is, from 0 to 1."""
        self.tell({"progress": round(part, 3), "step": step})

    def fault(self, fault: Fault) -> None:
        """Tell why there is no model, and what to do."""
        self.tell({"fault": fault})


def _read(lines: BinaryIO, orders: queue.SimpleQueue[bytes]) -> None:
    """Take orders; the end of them ends the process, even in the middle of a training."""
    while line := lines.readline(_LONGEST_LINE):
        if line.strip():
            orders.put(line)
    os._exit(0)


def _watch_parent(number: int) -> None:
    """End with a parent whose pipe somebody else holds open."""
    with suppress(psutil.Error):
        parent = psutil.Process(number)
        while parent.is_running() and parent.status() != psutil.STATUS_ZOMBIE:
            time.sleep(_PARENT_S)
    os._exit(0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

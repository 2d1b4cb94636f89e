"""How many functions and files of ours four things enter that happen in a real window.

They are the flows that must stay easy to follow: from Run to the block that glows, a block that is
dropped, a key in a field, and from a node's crash to the sentence about it. Python's profiler
counts in every thread of the window's process, in a process of its own without a screen. What
goes on beside a flow is counted too (a heartbeat, a robot's painting): a person who looks for what
happens meets it as well. The references are those of the house before it was rebuilt.
"""

from __future__ import annotations

import inspect
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from PySide6 import QtCore

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("faults", "nep_core", "nep_studio", "nodes", "robots")
EXAMPLE = "karate_greeting"
CRASHING = "watch"
"""The node of the example that is killed."""

LETTER = "#"
SETTLE_S = 1.0
"""So long what an edit asks for later has time: checks, the code, the journal."""
CHILD_S = 300

NO_FUNCTIONS = ("<module>", "<listcomp>", "<setcomp>", "<dictcomp>", "<genexpr>")
"""What runs as a function of its own in Python, and is none for a reader."""

BEFORE = {
    "Run to glow": (882, 190),
    "a node's crash to its sentence": (316, 120),
    "a dropped block": (470, 130),
    "a key in a field": (444, 128),
}
"""Functions and files before the house was rebuilt, measured so on a quiet machine.

On a busy one the card that says "It runs" may come before the glow: about 18 more, then as now.
"""

Row = dict[str, Any]


@dataclass
class Entered:
    """The functions of ours that were entered while it was counting."""

    codes: set[CodeType] = field(default_factory=set)
    is_counting: bool = False

    def see(self, frame: FrameType, event: str, _argument: object) -> None:
        """Take one event of Python's profiler."""
        if event == "call" and self.is_counting:
            self.codes.add(frame.f_code)

    @property
    def functions(self) -> set[tuple[str, str, int]]:
        """Each with its file, its name and its first line."""
        return {
            (place, code.co_qualname, code.co_firstlineno)
            for code in self.codes
            if code.co_flags
            & inspect.CO_NEWLOCALS  # else the body of a class, once, as it is loaded
            and code.co_name not in NO_FUNCTIONS
            and (place := _place(code.co_filename))
        }

    @property
    def files(self) -> set[str]:
        """The files that they are in."""
        return {place for place, _, _ in self.functions}

    @contextmanager
    def counting(self) -> Iterator[None]:
        """Count from nothing to the end of the block."""
        self.codes.clear()
        self.is_counting = True
        yield
        self.is_counting = False


def _place(file: str) -> str:
    """Where a file lies in the project; empty when it is of none of our packages."""
    path = Path(file)
    if not path.is_relative_to(ROOT):
        return ""
    place = path.relative_to(ROOT).as_posix()
    return place if place.startswith(tuple(f"{name}/" for name in PACKAGES)) else ""


def watch_threads(entered: Entered) -> None:
    """Let it see every thread, Qt's too; before anything of the program is imported."""
    sys.setprofile(entered.see)
    threading.setprofile(entered.see)

    class WatchedThread(QtCore.QThread):
        """A thread of Qt whose ``run`` tells Python's profiler of itself."""

        def __init_subclass__(cls, **more: Any) -> None:
            super().__init_subclass__(**more)
            run = cls.__dict__.get("run")
            if run is not None:
                cls.run = _watched(run, entered)  # type: ignore[method-assign]

    QtCore.QThread = WatchedThread  # type: ignore[misc]


def _watched(run: Callable[..., None], entered: Entered) -> Callable[..., None]:
    def watched(thread: QtCore.QThread) -> None:
        sys.setprofile(entered.see)
        run(thread)

    return watched


def run() -> list[Row]:
    """The functions and the files of each flow."""
    command = [sys.executable, "-m", "benchmarks.flows"]
    environment = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    child = subprocess.run(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, check=True, timeout=CHILD_S
    )
    found: dict[str, tuple[list[Any], list[str]]] = json.loads(child.stdout)
    return [row for name, told in found.items() for row in _rows(name, *map(len, told))]


def _rows(name: str, functions: int, files: int) -> Iterator[Row]:
    for unit, value, before in zip(
        ("functions", "files"), (functions, files), BEFORE[name], strict=True
    ):
        yield {
            "name": f"{name}: {unit} entered",
            "value": value,
            "unit": unit,
            "reference": before,
            "ratio": round(value / before, 3),
        }


class Flows:
    """A window with the example, in which the four things happen."""

    def __init__(self, folder: Path, entered: Entered) -> None:
        # Only now: Qt's threads are watched from here on.
        from benchmarks._heartbeat_child import wait
        from nep_studio import paths
        from nep_studio.settings import Settings
        from nep_studio.ui.services import Studio
        from nep_studio.ui.shell.app import make_application
        from nep_studio.ui.shell.main_window import MainWindow

        self._entered, self._wait = entered, wait
        settings = Settings(folder)
        settings.tour_done = True
        self._window = MainWindow(Studio(make_application(), settings))
        self._window.resize(1280, 800)
        self._window.show()
        self._window.start(None)
        self._window.files.open_example(paths.examples() / f"{EXAMPLE}.nep")
        self._wait(self._canvas.isVisible)
        self._rest()

    @property
    def _canvas(self) -> Any:
        return self._window.workbench.canvas

    def _block(self, kind: str) -> str:
        blocks = self._canvas.editor.project.blocks.values()
        found: str = next(block.id for block in blocks if block.type == kind)
        return found

    def _stacks(self) -> int:
        return len(self._canvas.editor.project.pages["behaviour"])

    def _rest(self) -> None:
        """Let what waits for a pause have it."""
        loop = QtCore.QEventLoop()
        QtCore.QTimer.singleShot(round(SETTLE_S * 1000), loop.quit)
        loop.exec()

    def run_to_glow(self) -> None:
        """Press Run, and see a block glow."""
        with self._entered.counting():
            self._window.actions_by_name["run"].trigger()
            self._wait(lambda: bool(self._window.running.stage.marks.glowing))

    def crash(self) -> None:
        """Kill a node, and be told."""
        told: list[object] = []
        board = self._window.running.runner.board.nodes
        self._wait(lambda: CRASHING in board and board[CRASHING].health in ("ready", "busy"))
        self._window.messages.told.connect(told.append)
        with self._entered.counting():
            os.kill(board[CRASHING].pid, signal.SIGKILL)
            self._wait(lambda: any(one.message.kind in ("warning", "error") for one in told))  # type: ignore[attr-defined]

    def end(self) -> None:
        """Stop what runs."""
        runner = self._window.running.runner
        runner.stop()
        self._wait(lambda: runner.state == "idle")
        self._rest()

    def drop(self) -> None:
        """Carry a block away from its stack, and let it go."""
        from benchmarks.canvas_driving import Driver

        driver, canvas = Driver(self._canvas), self._canvas
        grip = canvas.sight.view_rect_of(self._block("robot.say")).topLeft() + QtCore.QPointF(5, 14)
        driver.press(grip)
        for part in range(1, 6):
            driver.move(grip + QtCore.QPointF(60 * part, 12 * part))
            driver.settle()
        stacks = self._stacks()
        with self._entered.counting():
            driver.release(grip + QtCore.QPointF(300, 60))
            self._rest()
        assert self._stacks() == stacks + 1, "no block was dropped"

    def key(self) -> None:
        """Type a letter into a text of a block."""
        from PySide6.QtTest import QTest

        fields = self._canvas.fields
        fields.open(self._block("robot.say"), "text")
        self._rest()
        with self._entered.counting():
            QTest.keyClicks(fields.widget, LETTER)
            self._rest()
        assert LETTER in fields.widget.text(), "no key came to the field"
        fields.close()

    def close(self) -> None:
        """End all that was started for the window."""
        self._window.running.close()


def measure(folder: Path) -> dict[str, tuple[list[tuple[str, str, int]], list[str]]]:
    """The functions and the files that each flow enters."""
    entered = Entered()
    watch_threads(entered)
    flows = Flows(folder, entered)
    found = {}

    def flow(name: str, work: Callable[[], None]) -> None:
        work()
        found[name] = (sorted(entered.functions), sorted(entered.files))

    flow("Run to glow", flows.run_to_glow)
    flow("a node's crash to its sentence", flows.crash)
    flows.end()
    flow("a dropped block", flows.drop)
    flow("a key in a field", flows.key)
    flows.close()
    return found


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="nep-flows-", ignore_cleanup_errors=True) as home:
        os.environ["NEP_STUDIO_FOLDER"] = home
        print(json.dumps(measure(Path(home))), flush=True)
        sys.setprofile(None)
    os._exit(0)  # nothing of Qt is taken down piece by piece

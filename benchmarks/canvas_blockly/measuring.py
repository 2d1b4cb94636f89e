"""What Blockly needs for loading, dragging and undoing the reference program."""

from __future__ import annotations

import json
import shutil
import statistics
import subprocess
import tarfile
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import dev_system

from ..canvas_workload import STACK_BLOCKS, blockly, drag_path
from .chromium import Chromium, ChromiumFailed, executable

BLOCKLY = "blockly@13.3.0"
PAGE = Path(__file__).with_name("page.html")
SETTLE_PX = 8
UNDO_ROUNDS = 5
DOWNLOAD_S = 180
LONGEST_S = 420
"""No pass is begun after so long."""


class PeerMissing(Exception):
    """Blockly cannot be measured on this machine; the text says what is missing."""


@dataclass(frozen=True)
class BlocklyFigures:
    """Main-thread CPU in ms, medians, and the memory of the process that draws."""

    load_ms: float
    drag_ms: float
    drag_p95_ms: float
    undo_ms: float
    rss_mb: float


def measure(sizes: tuple[int, ...], passes: int) -> dict[int, BlocklyFigures]:
    """Measure programs of so many blocks, each pass in a browser of its own.

    Raises PeerMissing when npm, Chromium or the network is not there.
    """
    chromium = _provide_chromium()
    end_s = time.monotonic() + LONGEST_S
    with _page() as page:
        found = {}
        for blocks in sizes:
            runs = [_pass(chromium, page, blocks)]
            while len(runs) < passes and time.monotonic() < end_s:
                runs.append(_pass(chromium, page, blocks))
            found[blocks] = _median(runs)
        return found


def _provide_chromium() -> str:
    """The Chromium of this machine, installed when that is allowed without asking."""
    found = executable()
    if found is None and shutil.which("apt-get"):
        machine = dev_system.this_machine()
        if machine.may_install:
            dev_system.install_packages(["chromium"], machine)
            found = executable()
        if found is None:
            raise PeerMissing(dev_system.advice(["chromium"], machine))
    if found is None:
        raise PeerMissing("Chromium is missing. Install it, then measure again.")
    return found


@contextmanager
def _page() -> Iterator[Path]:
    """The page with Blockly beside it, in a folder that is removed afterwards."""
    npm = shutil.which("npm")
    if npm is None:
        raise PeerMissing("npm is missing: it fetches Blockly. Install Node.js, then try again.")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        pack = [npm, "pack", BLOCKLY, "--pack-destination", name]
        try:
            fetched = subprocess.run(pack, cwd=name, capture_output=True, timeout=DOWNLOAD_S)
        except subprocess.TimeoutExpired as error:
            raise PeerMissing(f"{BLOCKLY} could not be fetched in {DOWNLOAD_S} s.") from error
        archive = next(folder.glob("*.tgz"), None)
        if fetched.returncode != 0 or archive is None:
            last = fetched.stderr.decode(errors="replace").strip()[-400:]
            raise PeerMissing(f"{BLOCKLY} could not be fetched with npm: {last}")
        with tarfile.open(archive) as packed:
            packed.extractall(folder, filter="data")
        yield Path(shutil.copy(PAGE, folder))


def _pass(chromium: str, page: Path, blocks: int) -> BlocklyFigures:
    """Load, drag and undo once in a new browser."""
    with Chromium(chromium) as browser:
        browser.open(page)
        main_thread = _MainThread(browser)
        browser.evaluate(f"window.program = {json.dumps(json.dumps(blockly(blocks // 100)))}; 0")
        load_ms = main_thread.ms(lambda: _expect(browser, "load(window.program)", blocks))
        rss_mb = main_thread.process.memory_info().rss / 1e6
        steps_ms = _drag(browser, main_thread)
        undo_ms = [_undo(browser, main_thread, blocks) for _ in range(UNDO_ROUNDS)]
    return BlocklyFigures(
        load_ms,
        statistics.median(steps_ms),
        statistics.quantiles(steps_ms, n=20)[-1],
        statistics.median(undo_ms),
        rss_mb,
    )


def _drag(browser: Chromium, main_thread: _MainThread) -> list[float]:
    """Drag the first stack over its neighbours with the mouse; the CPU of each step."""
    x, y = browser.evaluate("grip()")
    before = browser.evaluate("place()")
    browser.mouse("mousePressed", x, y)
    browser.mouse("mouseMoved", x + SETTLE_PX, y)
    browser.evaluate("drawn()")

    def step(dx: float, dy: float) -> None:
        browser.mouse("mouseMoved", x + dx, y + dy)
        browser.evaluate("drawn()")

    path = drag_path()
    steps_ms = []
    for dx, dy in path:
        steps_ms.append(main_thread.ms(lambda dx=dx, dy=dy: step(dx, dy)))  # type: ignore[misc]
    moved = browser.evaluate("place()")
    if abs(moved[0] - before[0] - path[-1][0]) > SETTLE_PX:
        raise ChromiumFailed(f"The stack was not dragged: it went from {before} to {moved}.")
    step(0, 0)
    browser.mouse("mouseReleased", x, y)
    browser.evaluate("drawn()")
    return steps_ms


def _undo(browser: Chromium, main_thread: _MainThread, blocks: int) -> float:
    """Delete the first stack; the CPU of taking that back."""
    _expect(browser, "deleteFirstStack()", blocks - STACK_BLOCKS)
    return main_thread.ms(lambda: _expect(browser, "undo()", blocks))


def _expect(browser: Chromium, script: str, blocks: int) -> None:
    found = browser.evaluate(script)
    if found != blocks:
        raise ChromiumFailed(f"After {script} there are {found} blocks, not {blocks}.")


class _MainThread:
    """The thread of the renderer that does layout, script and painting."""

    def __init__(self, browser: Chromium) -> None:
        self.process = browser.renderer()
        pid = self.process.pid
        self._times = Path(f"/proc/{pid}/task/{pid}/schedstat")
        if not self._times.exists():
            raise PeerMissing("This system does not tell the CPU time of a thread (schedstat).")

    def ms(self, work: Callable[[], object]) -> float:
        """The CPU time that the thread spends until ``work`` is done."""
        start = self._ns()
        work()
        return (self._ns() - start) / 1e6

    def _ns(self) -> int:
        return int(self._times.read_text(encoding="ascii").split()[0])


def _median(runs: list[BlocklyFigures]) -> BlocklyFigures:
    names = BlocklyFigures.__dataclass_fields__
    return BlocklyFigures(
        *(statistics.median(getattr(run, name) for run in runs) for name in names)
    )

"""What the help costs, in CPU time: a page shown, the book made, a search, a step of reading.

Nothing of this may keep the window busy; the reference is a frame at 60 a second.
"""

from __future__ import annotations

import os
import statistics
import time
from collections.abc import Callable
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtWidgets import QApplication

from benchmarks.canvas_workload import language, made
from nep_studio.blocks.editor import Editor
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.plugins.help.panel import HelpPages
from nep_studio.ui.plugins.help.repository import Book
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import use_language

_FRAME_MS = 1000 / 60
_LONG_PAGES = ("howto/problems", "howto/words", "blocks/robot_moves", "blocks/list", "home")
_SHORT_PAGE = "block/control.wait"
_TYPED = ("s", "sa", "say", "gestrue", "how do I connect a phone to the robot", "a" * 60)
_ROUNDS = 5

Row = dict[str, Any]


def run() -> list[Row]:
    """The slowest of each kind, each the median of some rounds."""
    app = QApplication.instance()
    if not isinstance(app, QApplication):
        app = QApplication([])
    use_language("en")
    words = studio_language()
    canvas = Canvas(Editor(made(100, language()), language()), load_theme("light"))
    panel = HelpPages(canvas, Look(app, "light"), lambda: words)
    panel.resize(420, 700)
    panel.show()
    app.processEvents()
    rows = [
        _row("a page of the help shown", _slowest_page(panel), most_ms=50),
        _row("the book of the help made", _slowest([lambda: Book(words).contents()]), most_ms=50),
        _row("a search in the help", _slowest_search(panel), most_ms=10),
        _row("a step of reading the pages", _slowest_step(panel), most_ms=50),
    ]
    panel.close()
    panel.deleteLater()
    return rows


def _row(name: str, taken_ms: float, *, most_ms: float) -> Row:
    return {
        "name": name,
        "value": round(taken_ms, 2),
        "unit": "ms CPU",
        "reference": round(_FRAME_MS, 1),
        "ratio": round(taken_ms / _FRAME_MS, 3),
        "goal": f"at most {most_ms:g} ms",
        "ok": taken_ms <= most_ms,
    }


def _slowest(actions: list[Callable[[], object]], before: Callable[[], object] = int) -> float:
    """The median CPU time, in ms, of the slowest action; ``before`` is done first each time."""
    medians = []
    for act in actions:
        taken_s = []
        for _ in range(_ROUNDS):
            before()
            start_s = time.process_time()
            act()
            taken_s.append(time.process_time() - start_s)
        medians.append(statistics.median(taken_s))
    return 1000 * max(medians)


def _slowest_page(panel: HelpPages) -> float:
    def shown(name: str) -> Callable[[], None]:
        def show() -> None:
            panel.open(name)
            QApplication.processEvents()

        return show

    panel.open("block/robot.say")  # reads the files
    return _slowest([shown(name) for name in _LONG_PAGES], lambda: panel.open(_SHORT_PAGE))


def _slowest_search(panel: HelpPages) -> float:
    index = panel.book.new_index()
    for findable in panel.book.findables():
        index.add(findable)
    return _slowest([lambda typed=typed: index.search(typed) for typed in _TYPED])  # type: ignore[misc]


def _slowest_step(panel: HelpPages) -> float:
    searching = panel.searching
    searching._index = None
    searching.begin()
    slowest_s = 0.0
    while not searching.is_whole:
        start_s = time.process_time()
        searching._go_on()
        slowest_s = max(slowest_s, time.process_time() - start_s)
    return 1000 * slowest_s

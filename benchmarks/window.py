"""What the parts beside the canvas cost, in CPU time; the reference is a frame at 60 a second.

On the reference program of 5,000 blocks, offscreen: the palette made and painted, the minimap
painted, a suggestion for what is typed, a search, a message looked up in another language.
"""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtWidgets import QApplication

from benchmarks.canvas_workload import language, made
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.operations.finding import find
from nep_studio.blocks.typing_in.suggesting import suggestions
from nep_studio.settings import Settings
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.words import tr, use_language
from nep_studio.ui.workbench.minimap import Minimap
from nep_studio.ui.workbench.palette.palette import Palette

_BLOCKS = 5000
_FRAME_MS = 1000 / 60
_QUERIES = ("say hello", "r", "set score to 5", "x + 1", "w", "if score > 3", "say hi twice")

Row = dict[str, Any]


def run() -> list[Row]:
    """The medians of some rounds of each."""
    app = QApplication.instance() or QApplication([])
    words = language()
    project = made(_BLOCKS, words)
    canvas = Canvas(Editor(project, words), load_theme("light"))
    palette, minimap = Palette(canvas, _settings()), Minimap(canvas)
    for widget in (canvas, palette):
        widget.resize(400, 700)
        widget.show()
    app.processEvents()
    rows = [
        _row("palette made and painted", lambda: _fill(palette), most_ms=100),
        _row("minimap painted", minimap.draw_now, most_ms=10),
        _row("a suggestion for what is typed", _suggest(canvas), most_ms=5, each=len(_QUERIES)),
        _row("a search in the program", lambda: find(project, words, "step 1"), most_ms=100),
        _row("a message told in German, new each time", _tell(), most_ms=1, each=100),
    ]
    for widget in (palette, canvas):
        widget.close()
        widget.deleteLater()
    use_language("en")
    app.processEvents()
    return rows


def _settings() -> Settings:
    settings = Settings(Path(tempfile.mkdtemp(prefix="nep-bench-")))
    settings.palette_level = "all"
    return settings


def _fill(palette: Palette) -> None:
    palette.fill()
    palette.shelf.viewport().repaint()


def _suggest(canvas: Canvas) -> Callable[[], None]:
    def ask() -> None:
        for query in _QUERIES:
            suggestions(query, canvas.editor.language, canvas.editor.project)

    return ask


def _tell() -> Callable[[], None]:
    use_language("de")
    told = iter(range(10**6))

    def tell() -> None:
        for _ in range(100):
            tr(f"“block {next(told)}” is under no “when” block and will not run.")

    return tell


def _row(name: str, work: Callable[[], object], *, most_ms: float, each: int = 1) -> Row:
    """The median of five rounds, after one that fills the caches."""
    work()
    spent = []
    for _ in range(5):
        start = time.thread_time()
        work()
        spent.append(1000 * (time.thread_time() - start) / each)
    value = statistics.median(spent)
    return {
        "name": f"window: {name}",
        "value": round(value, 3),
        "unit": "ms CPU",
        "reference": round(_FRAME_MS, 1),
        "ratio": round(value / _FRAME_MS, 4),
        "goal": f"under {most_ms:g} ms",
        "ok": value < most_ms,
    }

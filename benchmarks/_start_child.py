"""Starts a program that has a window, and tells when that is painted and nothing is left to do.

Needs nothing but Qt, for the program may live in an environment of its own:
``python _start_child.py PySide6 nep_studio``. One line of JSON comes out when the window can be
used, and one when nothing is left to be made behind it: ours makes its workbench after its first
page. Then the program ends. Qt is left to the program to import: how it does that is part of what
it costs. The program ``empty`` is a main window with nothing in it.
"""

from __future__ import annotations

import builtins
import json
import os
import runpy
import sys
import time
from importlib import import_module
from typing import Any

TURNS = 3
"""So many turns of the event loop, one after the other, with nothing else to do."""
EMPTY = "empty"
SIZE = (1280, 800)


def watch(qt: str) -> None:
    """Let the program tell, as soon as its event loop runs, when its main window is there."""
    core: Any = import_module(f"{qt}.QtCore")
    widgets: Any = import_module(f"{qt}.QtWidgets")
    run_loop = widgets.QApplication.exec

    class Watcher(core.QObject):  # type: ignore[misc, unused-ignore]
        """Sees the main window being painted."""

        def __init__(self) -> None:
            super().__init__()
            shown = [w for w in widgets.QApplication.topLevelWidgets() if w.isVisible()]
            self.window = next(w for w in shown if isinstance(w, widgets.QMainWindow))
            self.window.installEventFilter(self)
            self.window.update()
            self.turns_left = TURNS

        def eventFilter(self, watched: Any, event: Any) -> bool:  # noqa: N802 - Qt's name
            if event.type() == core.QEvent.Type.Paint:
                self.window.removeEventFilter(self)
                core.QTimer.singleShot(0, self.turn)
            return False

        def turn(self) -> None:
            """Wait for some turns more; then tell."""
            self.turns_left -= 1
            if not self.turns_left:
                tell()
            elif self.turns_left < 0 and is_complete(self.window):
                tell()
                os._exit(0)
            core.QTimer.singleShot(0, self.turn)

    def run_watched(*_app: Any) -> int:
        watcher = Watcher()
        code: int = run_loop()
        del watcher
        return code

    widgets.QApplication.exec = run_watched


def watch_when_imported(qt: str) -> None:
    """Watch as soon as the program has imported the widgets of Qt, and not before."""
    name, plain_import = f"{qt}.QtWidgets", builtins.__import__

    def watching(*words: Any, **more: Any) -> Any:
        module = plain_import(*words, **more)
        if name in sys.modules and hasattr(sys.modules[name], "QApplication"):
            builtins.__import__ = plain_import
            watch(qt)
        return module

    builtins.__import__ = watching


def is_complete(window: Any) -> bool:
    """Whether a window has made all that it makes later, if it makes anything later."""
    lazy = getattr(window, "lazy", None)
    return lazy is None or bool(lazy.is_done)


def tell() -> None:
    """Print the CPU time since the process began, and the memory that it holds now."""
    told = {"cpu_s": time.process_time()} | memory()
    print(json.dumps(told), file=sys.__stdout__, flush=True)


def memory() -> dict[str, float]:
    """What the process holds in MB, as Linux counts it; empty elsewhere.

    ``rss`` counts all of its pages, those of libraries that others use too; ``uss`` only those
    that would be free without it.
    """
    try:
        with open("/proc/self/smaps_rollup", encoding="ascii") as file:
            kb = {line.split()[0]: int(line.split()[1]) for line in file if line.endswith("kB\n")}
    except OSError:
        return {}
    own = kb["Private_Clean:"] + kb["Private_Dirty:"]
    return {"rss_mb": kb["Rss:"] / 1024, "uss_mb": own / 1024}


def show_empty(qt: str) -> None:
    """A main window of the usual size with nothing in it."""
    widgets: Any = import_module(f"{qt}.QtWidgets")
    watch(qt)
    app, window = widgets.QApplication([]), widgets.QMainWindow()
    window.resize(*SIZE)
    window.show()
    app.exec()


if __name__ == "__main__":
    toolkit, program, *words = sys.argv[1:]
    sys.argv = [program, *words]
    sys.path[0] = os.getcwd()
    if program == EMPTY:
        show_empty(toolkit)
    else:
        watch_when_imported(toolkit)
        runpy.run_module(program, run_name="__main__", alter_sys=True)

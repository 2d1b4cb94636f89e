"""Starts a program that has a window, and tells when that is painted and nothing is left to do.

Needs nothing but Qt, for the program may live in an environment of its own:
``python _start_child.py PySide6 nep_studio``. One line of JSON comes out when the window can be
used, and one when nothing is left to be made behind it: ours makes its workbench after its first
page. Then the program ends.
"""

from __future__ import annotations

import json
import os
import runpy
import sys
import time
from importlib import import_module
from typing import Any

TURNS = 3
"""So many turns of the event loop, one after the other, with nothing else to do."""


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


def is_complete(window: Any) -> bool:
    """Whether a window has made all that it makes later, if it makes anything later."""
    later = getattr(window, "later", None)
    return later is None or bool(later.is_done)


def tell() -> None:
    """Print the CPU time since the process began."""
    print(json.dumps({"cpu_s": time.process_time()}), file=sys.__stdout__, flush=True)


if __name__ == "__main__":
    toolkit, module, *words = sys.argv[1:]
    watch(toolkit)
    sys.argv = [module, *words]
    sys.path[0] = os.getcwd()
    runpy.run_module(module, run_name="__main__", alter_sys=True)

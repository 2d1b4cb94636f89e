"""Opens an example, runs it, and opens every panel, page and dialog; tells the memory on the way.

``python -m benchmarks._panels_child 50`` opens and closes each of them 50 times more, and tells
by how much that made the process grow. One line of JSON a figure, in MB.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import nep_studio.ui  # noqa: F401  first: how Qt is imported is part of what a window costs

# isort: split

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QDialog, QWidget

from benchmarks._start_child import memory
from nep_studio import paths
from nep_studio.settings import Settings
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.app import make_application
from nep_studio.ui.shell.main_window import MainWindow

DIALOGS = (
    *("settings", "shortcuts", "about", "connect_robot", "connect_watch", "picture", "print"),
    *("open_network", "needs"),
)
"""The actions that open one."""
LOOK_S, RUN_S, LONGEST_S = 0.06, 6.0, 30.0
WARM_ROUNDS = 3
"""After so many rounds all that is made once has been made."""


def main(rounds: int) -> None:
    """Use all of the window."""
    app = make_application()
    home = Path(tempfile.mkdtemp(prefix="nep-bench-"))
    window = MainWindow(Studio(app, Settings(home)), is_gradual=True)
    window.show()
    window.start(None)
    _wait(lambda: window.lazy.is_done and window.start_page.gallery.is_complete)
    _pass(LOOK_S)
    _tell("start")
    project = home / "mine.nep"
    project.write_bytes((paths.examples() / "karate_greeting.nep").read_bytes())
    window.files.open(project)
    _wait(lambda: window.files.document is not None)
    _tell("project")
    window.actions_by_name["run"].trigger()
    _pass(RUN_S)
    for panel in window.workbench.panels.all:
        _open_panel(window, panel.widget)
    window.actions_by_name["stop"].trigger()
    for name in DIALOGS:
        _open_dialog(window, name)
    _pass(LOOK_S)
    _tell("used")
    for name, use in _uses(window).items() if rounds else ():
        for _ in range(WARM_ROUNDS):
            use()
        before = memory().get("rss_mb", 0.0)
        for _ in range(rounds):
            use()
        grown = memory().get("rss_mb", 0.0) - before
        print(json.dumps({"name": name, "grown_mb": round(grown, 2)}), flush=True)
    window.running.close()
    sys.stdout.flush()
    os._exit(0)


def _uses(window: MainWindow) -> dict[str, Callable[[], None]]:
    panels = window.workbench.panels.all
    uses: dict[str, Callable[[], None]] = {
        panel.name: partial(_open_panel, window, panel.widget) for panel in panels
    }
    return uses | {name: partial(_open_dialog, window, name) for name in DIALOGS}


def _open_panel(window: MainWindow, widget: QWidget) -> None:
    window.workbench.panels.show(widget)
    _pass(LOOK_S)
    [panel] = [one for one in window.workbench.panels.all if one.widget is widget]
    if panel.action.isChecked() and not panel.is_usual:
        panel.action.trigger()
    window.workbench.rooms.show_canvas()
    _pass(LOOK_S / 3)


def _open_dialog(window: MainWindow, name: str) -> None:
    """Open one, look at it, close it; one that waits for its answer is closed by a timer."""

    def close() -> None:
        for widget in QApplication.topLevelWidgets():
            if isinstance(widget, QDialog) and widget.isVisible():
                widget.reject()

    closing = QTimer(interval=round(LOOK_S * 1000))
    closing.timeout.connect(close)
    closing.start()
    window.actions_by_name[name].trigger()
    _pass(LOOK_S * 2)
    closing.stop()


def _pass(seconds: float) -> None:
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        QApplication.processEvents()
        time.sleep(0.005)


def _wait(holds: Callable[[], bool]) -> None:
    end_s = time.monotonic() + LONGEST_S
    while not holds() and time.monotonic() < end_s:
        QApplication.processEvents()


def _tell(name: str) -> None:
    print(json.dumps({"name": name} | memory()), flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 0)

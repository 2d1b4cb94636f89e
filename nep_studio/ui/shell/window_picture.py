"""``nep-studio picture FILE.png [FILE.nep]``: draws the window into a file, to see that it can."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QTimer, Signal
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QWidget

if TYPE_CHECKING:
    from .main_window import MainWindow

FAILED = 1
MOST_S = 60.0
LOOK_MS = 100
SAME_LOOKS = 5
"""So often in a row the window must look the same: then it has drawn all that it will."""
SIZE = (1280, 800)


class _FirstPaint(QObject):
    """Notes when a window is painted for the first time."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self.at_s = self.cpu_s = 0.0
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Note the time, and how much work it was."""
        if event.type() == QEvent.Type.Paint and not self.at_s:
            self.at_s = round(time.time(), 3)
            self.cpu_s = round(time.process_time(), 3)
        return super().eventFilter(watched, event)


class _Onlooker(QTimer):
    """Looks at a window again and again; ``finished`` comes when it does not change any more."""

    finished = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window, interval=LOOK_MS)
        self._window, self._same = window, 0
        self.picture = QImage()
        self.timeout.connect(self._look)
        self.start()

    def _look(self) -> None:
        if not self._window.lazy.is_done:
            return
        seen = self._window.grab().toImage()
        self._same = self._same + 1 if seen == self.picture else 0
        self.picture = seen
        if self._same == SAME_LOOKS:
            self.finished.emit()


def main(arguments: list[str]) -> int:
    """Draw it, and print in JSON when it was first painted; 1 when it cannot be drawn."""
    from nep_studio.ui.services import Studio

    from .app import make_application
    from .main_window import MainWindow

    parser = argparse.ArgumentParser(prog="nep-studio picture", description="Draw the window.")
    parser.add_argument("picture", type=Path, metavar="FILE.png")
    parser.add_argument("project", type=Path, nargs="?", metavar="FILE.nep")
    asked = parser.parse_args(arguments)
    app = make_application()
    window = MainWindow(Studio(app), is_gradual=True)
    painted = _FirstPaint(window)
    window.resize(*SIZE)
    window.show()
    window.start(asked.project)
    onlooker = _Onlooker(window)
    onlooker.finished.connect(app.quit)
    QTimer.singleShot(int(MOST_S * 1000), app, app.quit)
    app.exec()
    is_drawn = onlooker.picture.save(str(asked.picture))
    report = {"platform": app.platformName(), "drawn": is_drawn}
    print(json.dumps({**report, "painted_at": painted.at_s, "cpu_s": painted.cpu_s}))
    return 0 if is_drawn else FAILED

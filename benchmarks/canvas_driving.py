"""Real mouse and wheel events for a canvas, and what the CPU spends until it is painted."""

from __future__ import annotations

import functools
import statistics
import time
from collections.abc import Callable

from PySide6.QtCore import QEvent, QEventLoop, QObject, QPoint, QPointF, Qt, QTimer
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractScrollArea, QApplication, QLineEdit

LONGEST_WAIT_MS = 500
REST_MS = 15
"""A view that has not painted for so long has nothing to paint."""

SETTLE_PX = 12.0
NOTCH = 120
LEFT, NONE = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton


class NotPainted(Exception):
    """What should be seen in the view was not."""


class Driver(QObject):
    """Moves a mouse over a view and waits for its painting."""

    def __init__(self, view: QAbstractScrollArea) -> None:
        super().__init__()
        self._viewport = view.viewport()
        self._is_painted = False
        self._patience = QTimer(self, singleShot=True)
        self._viewport.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Notice that the view is painted."""
        self._is_painted |= event.type() == QEvent.Type.Paint
        return False

    def cpu_ms(self, work: Callable[[], object]) -> float:
        """The CPU time of some work with the painting that it asks for."""
        self._is_painted = False
        start = time.process_time()
        work()
        self.wait_for_paint()
        return (time.process_time() - start) * 1000

    @staticmethod
    def ms(work: Callable[[], object]) -> float:
        """The CPU time of some work that paints nothing."""
        start = time.process_time()
        work()
        return (time.process_time() - start) * 1000

    def settle(self) -> None:
        """Let everything happen that is waiting to happen."""
        self._is_painted = False
        while self._paints_within(REST_MS):
            self._is_painted = False

    def wait_for_paint(self) -> None:
        """Wait until the view is painted; raises NotPainted when it is not."""
        if not self._paints_within(LONGEST_WAIT_MS):
            raise NotPainted("The canvas did not paint: what was measured did not happen.")

    def press(self, at: QPointF) -> None:
        """Press the left button."""
        self._mouse(QEvent.Type.MouseButtonPress, at, LEFT, LEFT)

    def move(self, at: QPointF) -> None:
        """Move with the left button held down."""
        self._mouse(QEvent.Type.MouseMove, at, NONE, LEFT)

    def release(self, at: QPointF) -> None:
        """Release the left button."""
        self._mouse(QEvent.Type.MouseButtonRelease, at, LEFT, NONE)

    def wheel(self, notches: int, *, is_zooming: bool = False) -> None:
        """Turn the wheel in the middle of the view, with Ctrl to zoom."""
        at = QPointF(self._viewport.rect().center())
        held = Qt.KeyboardModifier.ControlModifier if is_zooming else Qt.KeyboardModifier.NoModifier
        turned = QPoint(0, notches * NOTCH)
        glob = QPointF(self._viewport.mapToGlobal(at.toPoint()))
        phase = Qt.ScrollPhase.NoScrollPhase
        event = QWheelEvent(at, glob, QPoint(), turned, NONE, held, phase, False)
        QApplication.sendEvent(self._viewport, event)

    def click(self, at: QPointF) -> None:
        """Press and release the left button."""
        self.press(at)
        self.release(at)
        self.settle()

    def keys_ms(self, line: QLineEdit, text: str) -> float:
        """Type into a line; the median CPU of a key until the line is painted."""
        times_ms = []
        for letter in text:
            start = time.process_time()
            QTest.keyClicks(line, letter)
            line.repaint()
            QApplication.processEvents()
            times_ms.append((time.process_time() - start) * 1000)
        return statistics.median(times_ms)

    def drag(
        self,
        grip: QPointF,
        path: list[tuple[float, float]],
        after_step: Callable[[], object] = lambda: None,
    ) -> list[float]:
        """Drag what is at ``grip`` along a path and back; the CPU of each step of the path."""
        self.press(grip)
        for part in (0.5, 1.0):
            self.move(grip + QPointF(SETTLE_PX * part, 0))
            self.settle()
        times_ms = []
        for step in path:
            to = grip + QPointF(*step)
            times_ms.append(self.cpu_ms(functools.partial(self.move, to)))
            after_step()
        self.move(grip)
        self.settle()
        self.release(grip)
        self.settle()
        return times_ms

    def _paints_within(self, patience_ms: int) -> bool:
        """Handle events until the view is painted; False when it was not, for so long."""
        QApplication.processEvents()
        if self._is_painted:
            return True
        self._patience.start(patience_ms)
        while not self._is_painted and self._patience.isActive():
            QApplication.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
        return self._is_painted

    def _mouse(
        self, kind: QEvent.Type, at: QPointF, button: Qt.MouseButton, held: Qt.MouseButton
    ) -> None:
        glob = QPointF(self._viewport.mapToGlobal(at.toPoint()))
        none = Qt.KeyboardModifier.NoModifier
        QApplication.sendEvent(self._viewport, QMouseEvent(kind, at, glob, button, held, none))

"""What results and try-out share: the recogniser that is looked at, and the recognition points."""

from __future__ import annotations

from msgspec.structs import replace
from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.own_gestures import TRIGGER, keep_gesture
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.words import tr

from .findings import Findings, findings_of

METHODS = ("trees", "gmr")
LOWEST, HIGHEST = 0.05, 0.95
"""Between these the certainty of a recognition point is."""


def method_words(method: str) -> str:
    """What a recogniser is called, for people."""
    words = {
        "trees": tr("Trees, the usual recogniser"),
        "gmr": tr("Expected curves, as in the paper"),
    }
    return words.get(method, method)


class Tuning(QObject):
    """``point_changed`` gives the gesture whose recognition point is another, also while it is
    dragged; ``method_changed`` tells that another recogniser is looked at.
    """

    point_changed = Signal(str)
    method_changed = Signal()

    def __init__(self, controller: GestureController, parent: QObject) -> None:
        super().__init__(parent)
        self.controller = controller
        self.method = METHODS[0]
        self._dragged: dict[str, float] = {}
        self._read_from: object = None
        self._findings: dict[str, Findings] = {}

    @property
    def findings(self) -> Findings | None:
        """What the last training found out about the recogniser that is looked at."""
        recogniser = self.controller.recogniser
        if recogniser != self._read_from:
            self._read_from = recogniser
            self._findings = findings_of(recogniser.report) if recogniser is not None else {}
        return self._findings.get(self.method)

    @property
    def points(self) -> dict[str, float]:
        """The recognition point of each gesture, as it is now."""
        return {name: self.point(name) for name in self.controller.gestures}

    def point(self, name: str) -> float:
        """The certainty at which a gesture counts as made."""
        gesture = self.controller.gestures.get(name)
        return self._dragged.get(name, gesture.certainty if gesture is not None else TRIGGER)

    @property
    def moved(self) -> frozenset[str]:
        """The gestures whose recognition point is shown elsewhere than the project has it."""
        return frozenset(self._dragged)

    def preview(self, name: str, certainty: float) -> None:
        """Show what another recognition point would do; the project stays as it is."""
        certainty = min(max(round(certainty, 2), LOWEST), HIGHEST)
        if name in self.controller.gestures and certainty != self.point(name):
            self._dragged[name] = certainty
            self.point_changed.emit(name)

    def keep(self, name: str) -> None:
        """Let the project have the recognition point that is shown, as one step."""
        certainty, gesture = self.point(name), self.controller.gestures.get(name)
        self._dragged.pop(name, None)
        if gesture is not None and certainty != gesture.certainty:
            edit = keep_gesture(name, replace(gesture, certainty=certainty))
            self.controller.change("set a recognition point", [edit])
        self.point_changed.emit(name)

    def reset(self, name: str) -> None:
        """Take the usual recognition point."""
        self.preview(name, TRIGGER)
        self.keep(name)

    def use_method(self, method: str) -> None:
        """Look at the other recogniser."""
        if method in METHODS and method != self.method:
            self.method = method
            self.method_changed.emit()

"""Sets how certain the recogniser must be of one gesture, and shows both sides of it at once."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, QSize, Qt, QTimer
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.own_gestures import TRIGGER
from nep_studio.ui.theme import Look
from nep_studio.ui.trainer.results.point_curve import PointCurve
from nep_studio.ui.trainer.results.point_words import both_sides
from nep_studio.ui.trainer.results.tuning import HIGHEST, LOWEST, Tuning
from nep_studio.ui.words import tr

KEEP_MS = 700
"""Steps of keys that follow each other within this time are one step of undo."""


class PointPanel(QWidget):
    """A gesture is chosen, its curves are shown, a slider below them sets its point."""

    def __init__(self, tuning: Tuning, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.tuning = tuning
        self.gesture = QComboBox()
        self.gesture.setAccessibleName(tr("Gesture"))
        self.gesture.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.curve = PointCurve(look)
        self.slider = PointSlider(tuning)
        self.sentence = QLabel()
        self.sentence.setWordWrap(True)
        self.reset = QPushButton(tr("Usual"))
        self.reset.setToolTip(tr("Set the recognition point to {percent} %", percent=75))
        self.reset.setProperty("kind", "quiet")
        self._lay_out()
        self.gesture.currentIndexChanged.connect(self.refresh)
        self.curve.dragged.connect(lambda certainty: tuning.preview(self.name, certainty))
        self.curve.let_go.connect(lambda: tuning.keep(self.name))
        self.reset.clicked.connect(lambda: tuning.reset(self.name))
        tuning.point_changed.connect(self._on_point_changed)
        tuning.method_changed.connect(self.refresh)
        self.fill()

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.addWidget(self.gesture, 1)
        row.addWidget(self.reset)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addLayout(row)
        box.addWidget(self.curve)
        box.addWidget(self.slider)
        box.addWidget(self.sentence)

    @property
    def name(self) -> str:
        """The gesture that is chosen."""
        return str(self.gesture.currentData() or "")

    def fill(self) -> None:
        """Offer the gestures that were learned."""
        findings, gestures = self.tuning.findings, self.tuning.desk.gestures
        known = [name for name in gestures if findings is not None and name in findings.takes]
        chosen = self.name
        with QSignalBlocker(self.gesture):
            self.gesture.clear()
            for name in known:
                self.gesture.addItem(gestures[name].title, name)
            self.gesture.setCurrentIndex(max(0, self.gesture.findData(chosen)))
        self.refresh()

    def choose(self, name: str) -> None:
        """Show a gesture."""
        if (at := self.gesture.findData(name)) >= 0:
            self.gesture.setCurrentIndex(at)

    def refresh(self) -> None:
        """Show the recognition point as it is now."""
        findings, certainty = self.tuning.findings, self.tuning.point(self.name)
        points = findings.curves.get(self.name, ()) if findings is not None else ()
        self.curve.show_points(points, certainty)
        self.slider.show_gesture(self.name)
        words = both_sides(findings, self.name, certainty) if findings is not None else ""
        missing = tr("Record each gesture at least twice: then it is known what a point means.")
        self.sentence.setText(words or missing)
        self.slider.setAccessibleDescription(words)
        self.reset.setEnabled(bool(self.name) and round(certainty - TRIGGER, 3) != 0)

    def _on_point_changed(self, name: str) -> None:
        if name == self.name:
            self.refresh()


class PointSlider(QSlider):
    """The recognition point of a gesture in hundredths; a drag is one step of undo."""

    def __init__(self, tuning: Tuning, parent: QWidget | None = None) -> None:
        super().__init__(Qt.Orientation.Horizontal, parent)
        self.tuning, self.name = tuning, ""
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.setRange(round(LOWEST * 100), round(HIGHEST * 100))
        self.setPageStep(5)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._keep_soon = QTimer(self, singleShot=True, interval=KEEP_MS)
        self._keep_soon.timeout.connect(self.keep)
        self.valueChanged.connect(self._on_value_changed)
        self.sliderReleased.connect(self.keep)

    def show_gesture(self, name: str) -> None:
        """Be the slider of this gesture."""
        if name != self.name:
            self.keep()
            self.name = name
            gesture = self.tuning.desk.gestures.get(name)
            title = gesture.title if gesture is not None else ""
            self.setAccessibleName(tr("Recognition point of “{gesture}”", gesture=title))
        with QSignalBlocker(self):
            self.setValue(round(self.tuning.point(name) * 100))
        self.setEnabled(bool(name))
        self.update()

    def keep(self) -> None:
        """Let the project have what is shown, if it was moved."""
        self._keep_soon.stop()
        if self.name in self.tuning.moved:
            self.tuning.keep(self.name)

    def _on_value_changed(self, value: int) -> None:
        self.tuning.preview(self.name, value / 100)
        if not self.isSliderDown():
            self._keep_soon.start()

    def minimumSizeHint(self) -> QSize:
        """As narrow as the curves above may be."""
        return QSize(self.fontMetrics().height() * 6, super().minimumSizeHint().height())

"""What the sensors of a robot measure, and what happens to its body."""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import (
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.language import Language
from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .buttons import WordsButton
from .hands import Hands

SLIDERS = {"sonar_left": (5, 255, 255), "sonar_right": (5, 255, 255), "battery": (1, 100, 100)}
"""Sensors with a slider: the least and the most that they measure, and what they do usually."""


class SensorBox(QWidget):
    """Sliders for the sensors that matter most, and a line for the others."""

    def __init__(self, hands: Hands, language: Language, look: Look) -> None:
        super().__init__()
        self._hands = hands
        names = language.choices.get("sensors", {})
        self.sliders: dict[str, QSlider] = {}
        self._values: dict[str, QLabel] = {}
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 1)
        for row, sensor in enumerate(SLIDERS):
            self._add_slider(2 * row, sensor, names.get(sensor, sensor))
        self.other = QComboBox()
        for sensor, name in names.items():
            if sensor not in SLIDERS:
                self.other.addItem(name, sensor)
        self.other.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self.other.setMinimumContentsLength(8)
        self.other.setAccessibleName(tr("Another sensor"))
        self.value = QDoubleSpinBox()
        self.value.setRange(-1000.0, 1000.0)
        self.value.setAccessibleName(tr("What it measures"))
        self.measure = WordsButton(tr("Measure this"), look, "gauge")
        self.measure.clicked.connect(self._on_measured)
        others = QWidget()
        flow = FlowLayout(others, self.fontMetrics().height() // 3)
        for widget in (self.other, self.value, self.measure):
            flow.addWidget(widget)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addLayout(self._grid)
        box.addWidget(others)

    def rest(self) -> None:
        """Let all measure by themselves again."""
        for sensor, slider in self.sliders.items():
            with QSignalBlocker(slider):
                slider.setValue(SLIDERS[sensor][2])
            self._values[sensor].setText(str(SLIDERS[sensor][2]))
        self._hands.let_measure()

    def _add_slider(self, row: int, sensor: str, name: str) -> None:
        low, high, usual = SLIDERS[sensor]
        slider = self.sliders[sensor] = QSlider(Qt.Orientation.Horizontal)
        slider.setRange(low, high)
        slider.setValue(usual)
        slider.setPageStep(25)
        slider.setAccessibleName(name)
        title, value = QLabel(name[:1].upper() + name[1:]), QLabel(str(usual))
        title.setWordWrap(True)
        value.setMinimumWidth(self.fontMetrics().horizontalAdvance("000"))
        self._values[sensor] = value
        self._grid.addWidget(title, row, 0, 1, 2)
        self._grid.addWidget(slider, row + 1, 0)
        self._grid.addWidget(value, row + 1, 1)
        slider.valueChanged.connect(partial(self._on_slid, sensor))

    def _on_slid(self, sensor: str, value: int) -> None:
        self._values[sensor].setText(str(value))
        self._hands.measure(sensor, float(value))

    def _on_measured(self) -> None:
        self._hands.measure(str(self.other.currentData()), self.value.value())


class BodyBox(QWidget):
    """What a hand does to the body of a robot: push it, help it up, move it."""

    def __init__(self, hands: Hands, language: Language, look: Look) -> None:
        super().__init__()
        self._hands = hands
        ways = {0: tr("forward"), 180: tr("back"), 90: tr("to the left"), -90: tr("to the right")}
        self.pushes = {
            degrees: WordsButton(tr("Push it {way}", way=way), look, "move")
            for degrees, way in ways.items()
        }
        self.posture = _choice(language.choices.get("postures", {}), tr("Posture"))
        self.take = WordsButton(tr("Let it take this posture"), look, "person-standing")
        self.joint = QComboBox()
        for part, label in language.choices.get("body_parts", {}).items():
            for joint, name in language.choices.get(f"joints.{part}", {}).items():
                words = tr("{part}: {joint}", part=label, joint=name)
                self.joint.addItem(words[:1].upper() + words[1:], joint)
        _fit(self.joint)
        self.joint.setAccessibleName(tr("Joint"))
        self.angle = QDoubleSpinBox()
        self.angle.setRange(-180.0, 180.0)
        self.angle.setDecimals(0)
        self.angle.setSuffix("°")
        self.angle.setAccessibleName(tr("Angle"))
        self.turn = WordsButton(tr("Turn it"), look, "rotate-ccw")
        self._lay_out()
        for degrees, button in self.pushes.items():
            button.clicked.connect(partial(self._on_pushed, degrees))
        self.take.clicked.connect(lambda: hands.take_posture(str(self.posture.currentData())))
        self.turn.clicked.connect(self._on_turned)

    def _lay_out(self) -> None:
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        rows: tuple[tuple[QWidget, ...], ...] = (
            tuple(self.pushes.values()),
            (self.posture, self.take),
            (self.joint, self.angle, self.turn),
        )
        for widgets in rows:
            row = QWidget()
            flow = FlowLayout(row, self.fontMetrics().height() // 3)
            for widget in widgets:
                flow.addWidget(widget)
            box.addWidget(row)

    def _on_pushed(self, degrees: int) -> None:
        self._hands.push(float(degrees))

    def _on_turned(self) -> None:
        self._hands.turn_joint(str(self.joint.currentData()), self.angle.value())


def _choice(entries: dict[str, str] | object, name: str) -> QComboBox:
    box = QComboBox()
    if isinstance(entries, dict):
        for key, label in entries.items():
            box.addItem(label[:1].upper() + label[1:], key)
    _fit(box)
    box.setAccessibleName(name)
    return box


def _fit(box: QComboBox) -> None:
    """Let a list of long words be as narrow as there is room."""
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(10)

"""What the sensors of a robot measure, and what happens to its body."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QSlider,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.language import Language
from nep_studio.project.surroundings import FIRST_MARK
from nep_studio.project.triggers import Occurrence
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import FlowLayout, in_column, in_row
from nep_studio.ui.words import tr
from robots.body.limbs import TOUCH_SENSORS

from .person_box import OccurrenceButton, WordsButton
from .stimuli import Stimuli

SLIDERS = {"sonar_left": (5, 255, 255), "sonar_right": (5, 255, 255), "battery": (1, 100, 100)}
"""Sensors with a slider: the least and the most that they measure, and what they do usually."""


class SensorBox(QWidget):
    """Sliders for the sensors that matter most, and a line for the others."""

    def __init__(self, stimuli: Stimuli, language: Language, look: Look) -> None:
        super().__init__()
        self._stimuli = stimuli
        names = language.choices.get("sensors", {})
        self.sliders: dict[str, QSlider] = {}
        self._values: dict[str, QLabel] = {}
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 1)
        for row, sensor in enumerate(SLIDERS):
            self._add_slider(2 * row, sensor, names.get(sensor, sensor))
        self.other = QComboBox(
            sizeAdjustPolicy=QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        for sensor, name in names.items():
            if sensor not in SLIDERS:
                self.other.addItem(name, sensor)
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
        in_column(self._grid, others, of=self, margins=0)

    def rest(self) -> None:
        """Let all measure by themselves again."""
        for sensor, slider in self.sliders.items():
            with QSignalBlocker(slider):
                slider.setValue(SLIDERS[sensor][2])
            self._values[sensor].setText(str(SLIDERS[sensor][2]))
        self._stimuli.let_measure()

    def _add_slider(self, row: int, sensor: str, name: str) -> None:
        low, high, usual = SLIDERS[sensor]
        slider = self.sliders[sensor] = QSlider(Qt.Orientation.Horizontal)
        slider.setRange(low, high)
        slider.setValue(usual)
        slider.setPageStep(25)
        slider.setAccessibleName(name)
        title, value = QLabel(name[:1].upper() + name[1:], wordWrap=True), QLabel(str(usual))
        value.setMinimumWidth(self.fontMetrics().horizontalAdvance("000"))
        self._values[sensor] = value
        self._grid.addWidget(title, row, 0, 1, 2)
        self._grid.addWidget(slider, row + 1, 0)
        self._grid.addWidget(value, row + 1, 1)
        slider.valueChanged.connect(partial(self._on_slid, sensor))

    def _on_slid(self, sensor: str, value: int) -> None:
        self._values[sensor].setText(str(value))
        self._stimuli.measure(sensor, float(value))

    def _on_measured(self) -> None:
        self._stimuli.measure(str(self.other.currentData()), self.value.value())


class BodyBox(QWidget):
    """What a hand does to the body of a robot: push it, help it up, move it."""

    def __init__(self, stimuli: Stimuli, language: Language, look: Look) -> None:
        super().__init__()
        self._stimuli = stimuli
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
        self.angle = QDoubleSpinBox(decimals=0)
        self.angle.setRange(-180.0, 180.0)
        self.angle.setSuffix("°")
        self.angle.setAccessibleName(tr("Angle"))
        self.turn = WordsButton(tr("Turn it"), look, "rotate-ccw")
        self._lay_out()
        for degrees, button in self.pushes.items():
            button.clicked.connect(partial(self._on_pushed, degrees))
        self.take.clicked.connect(lambda: stimuli.take_posture(str(self.posture.currentData())))
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
        self._stimuli.push(float(degrees))

    def _on_turned(self) -> None:
        self._stimuli.turn_joint(str(self.joint.currentData()), self.angle.value())


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


# A ball, a mark and sounds, which a robot notices.


class ThingsBox(QWidget):
    """What is shown to a robot stands in the scene of the robots too."""

    def __init__(self, stimuli: Stimuli, look: Look) -> None:
        super().__init__()
        self._stimuli = stimuli
        self.ball = QCheckBox(tr("The red ball"))
        self.mark = QCheckBox(tr("The mark"))
        self.number = QSpinBox()
        self.number.setRange(0, 999)
        self.number.setValue(FIRST_MARK)
        self.number.setAccessibleName(tr("The number of the mark"))
        sides = {0: tr("ahead"), 90: tr("the left"), -90: tr("the right"), 180: tr("behind")}
        self.sounds = {
            degrees: WordsButton(tr("Sound from {side}", side=side), look, "volume-2")
            for degrees, side in sides.items()
        }
        self._lay_out()
        self.ball.toggled.connect(partial(self._on_toggled, "ball"))
        self.mark.toggled.connect(partial(self._on_toggled, "mark"))
        self.number.valueChanged.connect(self._on_number_changed)
        for degrees, button in self.sounds.items():
            button.clicked.connect(partial(self._on_sound, degrees))
        stimuli.visitors.changed.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        sounds = QWidget()
        flow = FlowLayout(sounds, self.fontMetrics().height() // 3)
        for button in self.sounds.values():
            flow.addWidget(button)
        hint = QLabel(tr("Other things are placed in the scene of the robots."), wordWrap=True)
        hint.setProperty("role", "hint")
        in_column(self.ball, in_row(self.mark, self.number, 1), sounds, hint, of=self, margins=0)

    def refresh(self) -> None:
        """Show what is there."""
        for what, check in (("ball", self.ball), ("mark", self.mark)):
            with QSignalBlocker(check):
                check.setChecked(self._stimuli.visitors.find(what) is not None)
        mark = self._stimuli.visitors.find("mark")
        if mark is not None and mark.name.isdecimal():
            with QSignalBlocker(self.number):
                self.number.setValue(int(mark.name))

    def _on_toggled(self, what: str, is_there: bool) -> None:
        name = str(self.number.value()) if what == "mark" else ""
        if is_there:
            self._stimuli.visitors.come(what, self._stimuli.robot, name)
        else:
            self._stimuli.visitors.go(what)

    def _on_number_changed(self, number: int) -> None:
        self._stimuli.visitors.rename("mark", str(number))

    def _on_sound(self, degrees: int) -> None:
        self._stimuli.make_sound(float(degrees))


# Touching a robot, and making gestures before it.


class TouchBox(QWidget):
    """A button for each place that feels; it is touched as long as the button is held."""

    def __init__(self, stimuli: Stimuli, language: Language, look: Look) -> None:
        super().__init__()
        names = language.choices.get("touch_parts", {})
        self.buttons = [
            OccurrenceButton(
                Occurrence("touch", part, names.get(part, part)),
                look,
                stimuli.begin,
                stimuli.end,
                _capital(names.get(part, part)),
            )
            for part in TOUCH_SENSORS
        ]
        flow = FlowLayout(self, self.fontMetrics().height() // 3)
        for button in self.buttons:
            flow.addWidget(button)


class GestureBox(QWidget):
    """A button for each gesture, and how it comes about."""

    def __init__(self, stimuli: Stimuli, language: Language, look: Look) -> None:
        super().__init__()
        self._stimuli, self._look = stimuli, look
        self.buttons: list[OccurrenceButton] = []
        self._shown: dict[str, str] | None = None
        self._rows = QWidget()
        self._flow = FlowLayout(self._rows, self.fontMetrics().height() // 3)
        self.how = QLabel(wordWrap=True)
        self.how.setProperty("role", "hint")
        self.certainty = QSpinBox()
        self.certainty.setRange(1, 100)
        self.certainty.setValue(100)
        self.certainty.setSuffix(tr(" %"))
        self.certainty.setAccessibleName(tr("How certain the gesture is"))
        self.certainty.valueChanged.connect(self._on_certainty_changed)
        self._certain = QWidget()
        in_row(QLabel(tr("Certainty")), self.certainty, 1, of=self._certain, margins=0)
        in_column(self._rows, self.how, self._certain, of=self, margins=0)
        self.show_gestures([], language.choices.get("gestures", {}))

    def show_gestures(self, of_program: Iterable[Occurrence], known: Mapping[str, str]) -> None:
        """Offer the gestures of the program, and all that the watch on the screen knows."""
        wanted = {one.value: one.words for one in of_program if one.kind == "gesture"}
        offered = {**wanted, **known}
        if offered != self._shown:
            self._shown = offered
            for button in self.buttons:
                self._flow.removeWidget(button)
                button.hide()
                button.deleteLater()
            self.buttons = [
                OccurrenceButton(
                    Occurrence("gesture", name, label),
                    self._look,
                    self._stimuli.begin,
                    self._stimuli.end,
                    _capital(label),
                )
                for name, label in offered.items()
            ]
            for button in self.buttons:
                self._flow.addWidget(button)
                button.show()
        self.refresh()

    def refresh(self) -> None:
        """Say how a gesture comes about now."""
        is_moved = self._stimuli.has_watch
        by_watch = tr("The watch on the screen makes the movement, which has to be recognised.")
        by_hand = tr("No watch runs: the program is told by hand that the gesture was made.")
        self.how.setText(by_watch if is_moved else by_hand)
        self._certain.setVisible(not is_moved)

    def _on_certainty_changed(self, percent: int) -> None:
        self._stimuli.certainty = percent / 100.0


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]

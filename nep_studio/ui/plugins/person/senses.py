"""What the sensors of a robot measure, and what happens to its body."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
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
    QWidget,
)

from faults import Text, text_of
from nep_studio.blocks.language import Language
from nep_studio.project.surroundings import FIRST_MARK
from nep_studio.project.triggers import Occurrence
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import hint, plain_label
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr
from robots.body.limbs import TOUCH_SENSORS

from .person_box import Buttons, OccurrenceButton, WordsButton, call
from .stimuli import Stimuli

SLIDERS = {"sonar_left": (5, 255, 255), "sonar_right": (5, 255, 255), "battery": (1, 100, 100)}
"""Sensors with a slider: the least and the most that they measure, and what they do usually."""


class SensorBox(QWidget):
    """Sliders for the sensors that matter most, and a line for the others."""

    def __init__(self, stimuli: Stimuli, language: Callable[[], Language], look: Look) -> None:
        super().__init__()
        self._stimuli, self._language = stimuli, language
        self.sliders: dict[str, QSlider] = {}
        self._titles: dict[str, QLabel] = {}
        self._values: dict[str, QLabel] = {}
        self._grid = QGridLayout()
        self._grid.setColumnStretch(0, 1)
        for row, sensor in enumerate(SLIDERS):
            self._add_slider(2 * row, sensor)
        self.other = Choices(
            lambda: {key: name for key, name in self._names().items() if key not in SLIDERS}
        )
        _may_be_narrow(labelled(self.other, name="Another sensor"), 8)
        self.value = labelled(QDoubleSpinBox(), name="What it measures")
        self.value.setRange(-1000.0, 1000.0)
        self.measure = WordsButton("Measure this", look, "gauge")
        self.measure.clicked.connect(self._on_measured)
        others = Buttons((self.other, self.value, self.measure))
        in_column(self._grid, others, of=self, margins=0)
        follow_words(self, self._say)

    def _names(self) -> Mapping[str, str]:
        return self._language().choices.get("sensors", {})

    def _say(self) -> None:
        for sensor, slider in self.sliders.items():
            name = self._names().get(sensor, sensor)
            slider.setAccessibleName(name)
            self._titles[sensor].setText(_capital(name))

    def rest(self) -> None:
        """Let all measure by themselves again."""
        for sensor, slider in self.sliders.items():
            with QSignalBlocker(slider):
                slider.setValue(SLIDERS[sensor][2])
            self._values[sensor].setText(str(SLIDERS[sensor][2]))
        self._stimuli.let_measure()

    def _add_slider(self, row: int, sensor: str) -> None:
        low, high, usual = SLIDERS[sensor]
        slider = self.sliders[sensor] = QSlider(Qt.Orientation.Horizontal)
        slider.setRange(low, high)
        slider.setValue(usual)
        slider.setPageStep(25)
        title = self._titles[sensor] = plain_label()
        value = self._values[sensor] = QLabel(str(usual))
        value.setMinimumWidth(self.fontMetrics().horizontalAdvance("000"))
        self._grid.addWidget(title, row, 0, 1, 2)
        self._grid.addWidget(slider, row + 1, 0)
        self._grid.addWidget(value, row + 1, 1)
        slider.valueChanged.connect(partial(self._on_slid, sensor))

    def _on_slid(self, sensor: str, value: int) -> None:
        self._values[sensor].setText(str(value))
        self._stimuli.measure(sensor, float(value))

    def _on_measured(self) -> None:
        self._stimuli.measure(str(self.other.currentData()), self.value.value())


PUSHES = {0: "forward", 180: "back", 90: "to the left", -90: "to the right"}
"""Where a robot can be pushed, in degrees."""
SOUNDS = {0: "ahead", 90: "the left", -90: "the right", 180: "behind"}
"""From where a sound can come, in degrees."""


class BodyBox(QWidget):
    """What a hand does to the body of a robot: push it, help it up, move it."""

    def __init__(self, stimuli: Stimuli, language: Callable[[], Language], look: Look) -> None:
        super().__init__()
        self._stimuli = stimuli
        self.pushes = {
            degrees: WordsButton(text_of("Push it {way}", way=Text(way)), look, "move")
            for degrees, way in PUSHES.items()
        }
        self.posture = Choices(lambda: _postures(language()))
        self.take = WordsButton("Let it take this posture", look, "person-standing")
        self.joint = Choices(lambda: _joints(language()))
        _may_be_narrow(labelled(self.posture, name="Posture"), 10)
        _may_be_narrow(labelled(self.joint, name="Joint"), 10)
        self.angle = labelled(QDoubleSpinBox(decimals=0, suffix="°"), name="Angle")
        self.angle.setRange(-180.0, 180.0)
        self.turn = WordsButton("Turn it", look, "rotate-ccw")
        pushes, posture = Buttons(self.pushes.values()), Buttons((self.posture, self.take))
        joint = Buttons((self.joint, self.angle, self.turn))
        in_column(pushes, posture, joint, of=self, margins=0)
        for degrees, button in self.pushes.items():
            button.clicked.connect(partial(self._on_pushed, degrees))
        self.take.clicked.connect(lambda: stimuli.take_posture(str(self.posture.currentData())))
        self.turn.clicked.connect(self._on_turned)

    def _on_pushed(self, degrees: int) -> None:
        self._stimuli.push(float(degrees))

    def _on_turned(self) -> None:
        self._stimuli.turn_joint(str(self.joint.currentData()), self.angle.value())


def _may_be_narrow(box: QComboBox, letters: int) -> None:
    """Let a list of long words be as narrow as there is room."""
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(letters)


def _postures(language: Language) -> dict[object, str]:
    return {key: _capital(name) for key, name in language.choices.get("postures", {}).items()}


def _joints(language: Language) -> dict[object, str]:
    """All joints, each with the part of the body that it moves."""
    return {
        joint: _capital(tr("{part}: {joint}", part=label, joint=name))
        for part, label in language.choices.get("body_parts", {}).items()
        for joint, name in language.choices.get(f"joints.{part}", {}).items()
    }


# A ball, a mark and sounds, which a robot notices.


class ThingsBox(QWidget):
    """What is shown to a robot stands in the scene of the robots too."""

    def __init__(self, stimuli: Stimuli, look: Look) -> None:
        super().__init__()
        self._stimuli = stimuli
        self.ball = labelled(QCheckBox(), text="The red ball")
        self.mark = labelled(QCheckBox(), text="The mark")
        self.number = QSpinBox(minimum=0, maximum=999, value=FIRST_MARK)
        labelled(self.number, name="The number of the mark")
        self.sounds = {
            degrees: WordsButton(text_of("Sound from {side}", side=Text(side)), look, "volume-2")
            for degrees, side in SOUNDS.items()
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
        marked, sounds = in_row(self.mark, self.number, 1), Buttons(self.sounds.values())
        more = hint("Other things are placed on the stage.")
        in_column(self.ball, marked, sounds, more, of=self, margins=0)

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


class TouchBox(Buttons):
    """A button for each place that feels; it is touched as long as the button is held."""

    def __init__(self, stimuli: Stimuli, language: Callable[[], Language], look: Look) -> None:
        buttons = [
            OccurrenceButton(Occurrence("touch", part), look, stimuli.begin, stimuli.end)
            for part in TOUCH_SENSORS
        ]
        super().__init__(buttons)
        self.buttons, self._language = buttons, language
        follow_words(self, self._say)

    def _say(self) -> None:
        call(self.buttons, self._language().choices.get("touch_parts", {}))


ARMS = {"raised": "Raise the arm", "level": "Hold the arm level", "lowered": "Let the arm hang"}
"""How the arm that wears the watch is held, and what does so; stimuli.py says them, too."""


class GestureBox(QWidget):
    """A button for each gesture and for how the arm is held, and how it comes about."""

    def __init__(self, stimuli: Stimuli, language: Callable[[], Language], look: Look) -> None:
        super().__init__()
        self._stimuli, self._look = stimuli, look
        self.buttons: list[OccurrenceButton] = []
        self._shown: dict[str, str] | None = None
        self._rows = Buttons()
        self.arms = {
            one: WordsButton(words, look, "person-standing") for one, words in ARMS.items()
        }
        for posture, button in self.arms.items():
            button.clicked.connect(partial(self._on_arm, posture))
        self.how = plain_label()
        self.how.setProperty("role", "hint")
        self.certainty = QSpinBox(minimum=1, maximum=100, value=100)
        labelled(self.certainty, name="How certain the gesture is")
        self.certainty.valueChanged.connect(self._on_certainty_changed)
        self._certain = QWidget()
        in_row(labelled(QLabel(), text="Certainty"), self.certainty, 1, of=self._certain, margins=0)
        arms = Buttons(self.arms.values())
        in_column(self._rows, arms, self.how, self._certain, of=self, margins=0)
        self.show_gestures([], language().choices.get("gestures", {}))
        follow_words(self, self._say)

    def _say(self) -> None:
        self.certainty.setSuffix(tr(" %"))

    def show_gestures(self, of_program: Iterable[Occurrence], known: Mapping[str, str]) -> None:
        """Offer the gestures of the program, and all that the watch on the screen knows."""
        wanted = {one.value: one.words for one in of_program if one.kind == "gesture"}
        offered = {**wanted, **known}
        if offered != self._shown:
            self._shown = offered
            old, do = self.buttons, (self._look, self._stimuli.begin, self._stimuli.end)
            self.buttons = [OccurrenceButton(Occurrence("gesture", one), *do) for one in offered]
            call(self.buttons, offered)
            self._rows.replace(old, self.buttons)
        self.refresh()

    def refresh(self) -> None:
        """Say how a gesture comes about now."""
        is_moved = self._stimuli.has_watch
        labelled(
            self.how,
            text="The watch on the screen makes the movement, which has to be recognised."
            if is_moved
            else "No watch runs: the program is told by hand that the gesture was made.",
        )
        self._certain.setVisible(not is_moved)

    def _on_arm(self, posture: str) -> None:
        self._stimuli.begin(Occurrence("arm", posture))

    def _on_certainty_changed(self, percent: int) -> None:
        self._stimuli.certainty = percent / 100.0


def _capital(words: str) -> str:
    return words[:1].upper() + words[1:]

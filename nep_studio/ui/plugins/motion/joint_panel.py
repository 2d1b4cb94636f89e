"""A slider for each joint: the angles of the pose that is shown, and how far each can go."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QFrame,
    QGridLayout,
    QLabel,
    QScrollArea,
    QSlider,
    QWidget,
)

from nep_studio.blocks.language import Language
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr
from robots.body.body import Joint

from .editing import pose_at
from .motion_controller import MotionController, joint_words
from .timeline_painter import limb_words

STEPS = 10
"""A slider has so many places for each degree, or each hundredth of a hand."""


class JointRow(QWidget):
    """One joint: ``turned`` gives its angle (rad, hands 0 to 1), ``released`` ends the turning."""

    turned = Signal(str, float)
    released = Signal()

    def __init__(self, joint: Joint, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.joint, self.words = joint, ""
        self.is_hand = joint.name.endswith("Hand")
        self.label = QLabel(self)
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.box = QDoubleSpinBox(self, decimals=1)
        self._is_showing = False
        low, high = self._shown(self.joint.min_rad), self._shown(self.joint.max_rad)
        self.slider.setRange(math.ceil(low * STEPS), math.floor(high * STEPS))
        self.box.setRange(math.ceil(low * STEPS) / STEPS, math.floor(high * STEPS) / STEPS)
        self.box.setSuffix(" %" if self.is_hand else "°")
        self.box.setKeyboardTracking(False)
        self.slider.valueChanged.connect(lambda value: self._on_changed(value / STEPS))
        self.slider.sliderReleased.connect(self.released)
        self.box.valueChanged.connect(self._on_changed)
        self.box.editingFinished.connect(self.released)

    def say(self, words: str) -> None:
        """Call the joint so."""
        self.words = words
        self.label.setText(words)
        for field in (self.slider, self.box):
            field.setAccessibleName(words)
        low, high = self._shown(self.joint.min_rad), self._shown(self.joint.max_rad)
        unit = "%" if self.is_hand else "°"
        limits = tr("from {low} to {high}", low=f"{low:.0f}{unit}", high=f"{high:.0f}{unit}")
        for widget in (self.label, self.slider, self.box):
            widget.setToolTip(f"{self.joint.name}: {limits}")

    def show_angle(self, angle: float, *, is_key: bool) -> None:
        """Show an angle; a joint with a key at this moment stands out."""
        value = self._shown(angle)
        self._is_showing = True
        self.slider.setValue(round(value * STEPS))
        if not self.box.hasFocus() or abs(self.box.value() - value) > 0.06:
            self.box.setValue(value)
        self._is_showing = False
        font = self.label.font()
        if font.bold() != is_key:
            font.setBold(is_key)
            self.label.setFont(font)

    def _shown(self, angle: float) -> float:
        return angle * 100.0 if self.is_hand else math.degrees(angle)

    def _on_changed(self, value: float) -> None:
        if not self._is_showing:
            angle = value / 100.0 if self.is_hand else math.radians(value)
            self.turned.emit(self.joint.name, angle)


class JointPanel(QScrollArea):
    """The joints by limb."""

    def __init__(
        self,
        controller: MotionController,
        language: Callable[[], Language],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.controller, self._language = controller, language
        self.both = labelled(
            QCheckBox(),
            text="Both sides alike",
            tip="What one arm or leg does, the other does too, as in a mirror",
        )
        self.both.toggled.connect(self._on_both_toggled)
        self.rows = {
            joint.name: JointRow(joint)
            for joint in controller.body.joints
            if joint.name not in controller.body.same_motor
        }
        self._lay_out()
        for row in self.rows.values():
            row.turned.connect(self._on_turned)
            row.released.connect(controller.seal)
        controller.changed.connect(self.refresh)
        controller.moved.connect(self.refresh)
        follow_words(self, self._say)
        self.refresh()

    def refresh(self) -> None:
        """Show the pose of the moment."""
        pose, keys = self.controller.rehearsal.pose(self.controller.cursor_s), self._keys()
        for name, row in self.rows.items():
            row.show_angle(float(pose[self.controller.body.index[name]]), is_key=name in keys)

    def _say(self) -> None:
        language, body = self._language(), self.controller.body
        for name, row in self.rows.items():
            row.say(joint_words(language, body, name))
        for limb, heading in self._headings.items():
            heading.setText(limb_words()[limb])

    def _keys(self) -> frozenset[str]:
        return frozenset(pose_at(self.controller.motion, self.controller.cursor_s))

    def _lay_out(self) -> None:
        inner = QWidget()
        grid = QGridLayout()
        grid.setColumnStretch(1, 1)
        body = self.controller.body
        self._headings = {limb: self._heading() for limb in limb_words()}
        for limb, heading in self._headings.items():
            names = [n for n in self.rows if body.joints[body.index[n]].limb is limb]
            if names:
                grid.addWidget(heading, grid.rowCount(), 0, 1, 3)
                self._add_rows(grid, names)
        in_column(self.both, grid, 1, of=inner)
        self.setWidget(inner)
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)

    def minimumSizeHint(self) -> QSize:
        """As wide as its rows: they are not scrolled sideways."""
        line, inner = self.fontMetrics().height(), self.widget()
        width = inner.minimumSizeHint().width() if inner is not None else 0
        return QSize(width + line * 2, line * 8)

    def _heading(self) -> QLabel:
        heading = QLabel(self)
        font = heading.font()
        font.setBold(True)
        heading.setFont(font)
        return heading

    def _add_rows(self, grid: QGridLayout, names: list[str]) -> None:
        for name in names:
            row, number = self.rows[name], grid.rowCount()
            row.slider.setMinimumWidth(self.fontMetrics().height() * 5)
            for column, widget in enumerate((row.label, row.slider, row.box)):
                grid.addWidget(widget, number, column)
            row.setParent(self)
            row.hide()

    def _on_turned(self, name: str, angle: float) -> None:
        self.controller.set_joints({name: angle}, tr("turn a joint"), merge=f"joint {name}")

    def _on_both_toggled(self, is_on: bool) -> None:
        self.controller.is_mirrored = is_on

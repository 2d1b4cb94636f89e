"""The page on which a motion is made: the robot, its joints, and the timeline."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QAction, QHideEvent, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QCheckBox,
    QDoubleSpinBox,
    QFrame,
    QGridLayout,
    QLabel,
    QScrollArea,
    QSlider,
    QSplitter,
    QStackedWidget,
    QToolBar,
    QToolButton,
    QWidget,
)

from nep_studio.blocks.language import Language
from nep_studio.blocks.own_animations import OwnAnimation
from nep_studio.ui.actions import Actions
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.theme.icons import fit_icons, icon_room
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr
from nodes.resources import NAO, model_folder
from robots.body.body import Joint, load_body
from robots.body.limbs import Limb

from .bars import Header, NotesBar, Transport
from .commands import Commands, ProjectCommands
from .curve import CurvePanel
from .editing import pose_at
from .motion_controller import Faults, KeptMotions, MotionController, Player, joint_words
from .rehearsal import LIMBS, limb_words
from .stage import PosingStage, RobotPoses
from .timeline import Timeline

if TYPE_CHECKING:
    from nep_studio.ui.host import Host

# A slider for each joint: the angles of the pose that is shown, and how far each can go.

STEPS = 10
"""A slider has so many places for each degree, or each hundredth of a hand."""


class JointRow(QObject):
    """One joint: ``turned`` gives its angle (rad, hands 0 to 1), ``released`` ends the turning."""

    turned = Signal(str, float)
    released = Signal()

    def __init__(self, joint: Joint, parent: QWidget) -> None:
        super().__init__(parent)
        self.joint, self.words = joint, ""
        self.is_hand = joint.name.endswith("Hand")
        self.label = QLabel()
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.box = QDoubleSpinBox(decimals=1)
        self._is_showing = False
        low, high = self._shown(self.joint.min_rad), self._shown(self.joint.max_rad)
        self.slider.setMinimumWidth(parent.fontMetrics().height() * 5)
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
            widget.setToolTip(plain_tip(f"{self.joint.name}: {limits}"))

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

    def __init__(self, controller: MotionController, language: Callable[[], Language]) -> None:
        super().__init__()
        self.controller, self._language = controller, language
        self.both = labelled(
            QCheckBox(),
            text="Both sides alike",
            tip="What one arm or leg does, the other does too, as in a mirror",
        )
        self.both.toggled.connect(self._on_both_toggled)
        self.rows = {
            joint.name: JointRow(joint, self)
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
        controller, now_s = self.controller, self.controller.cursor_s
        pose, keys = controller.rehearsal.pose(now_s), pose_at(controller.motion, now_s)
        for name, row in self.rows.items():
            row.show_angle(float(pose[controller.body.index[name]]), is_key=name in keys)

    def _say(self) -> None:
        language, body = self._language(), self.controller.body
        for name, row in self.rows.items():
            row.say(joint_words(language, body, name))
        for limb, heading in self._headings.items():
            heading.setText(limb_words()[limb])

    def _lay_out(self) -> None:
        inner = QWidget()
        grid = QGridLayout()
        grid.setColumnStretch(1, 1)
        font = self.font()
        font.setBold(True)
        self._headings: dict[Limb, QLabel] = {}
        for limb in LIMBS:
            rows = [row for row in self.rows.values() if row.joint.limb is limb]
            if rows:
                heading = self._headings[limb] = QLabel()
                heading.setFont(font)
                grid.addWidget(heading, grid.rowCount(), 0, 1, 3)
            for row in rows:
                number = grid.rowCount()
                for column, widget in enumerate((row.label, row.slider, row.box)):
                    grid.addWidget(widget, number, column)
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

    def _on_turned(self, name: str, angle: float) -> None:
        self.controller.set_joints({name: angle}, tr("turn a joint"), merge=f"joint {name}")

    def _on_both_toggled(self, is_on: bool) -> None:
        self.controller.is_mirrored = is_on


class MotionPage(QWidget):
    """Makes one motion at a time, for a robot of a ``model``: "" is a NAO."""

    def __init__(self, host: Host, model: str = "") -> None:
        super().__init__()
        self.host, self.look, self.model = host, host.services.look, model

        def language() -> Language:
            return host.services.language

        folder = model_folder(model or NAO)
        body = load_body(folder)
        self.controller = MotionController(body, self)
        self.player = Player(self.controller, self)
        self.kept = KeptMotions(host.services.files, folder, body)
        self.actions_by_name = Actions(self, self.look, Qt.ShortcutContext.WidgetShortcut)
        self.commands = Commands(self)
        self.project = ProjectCommands(self)
        self.view = RobotView(self.look)
        self.stage = PosingStage(self.view, self.controller, model)
        self.joints = JointPanel(self.controller, language)
        self.header = Header(self.controller, language)
        self.timeline = Timeline(self.controller, self.look)
        self.curve = CurvePanel(self.controller, self.timeline, language, self.look)
        self.transport = Transport(
            self.controller, self.player, self.timeline, self.actions_by_name
        )
        self.notes = NotesBar(self.controller, self.look)
        self.faults = Faults(self.controller, self.stage.skeleton, language)
        self.robots = RobotPoses(host.services.runner, self.controller, self)
        self._lay_out()
        self._connect()
        self.controller.open(new_motion())
        self._untitled = self.controller.motion.title
        follow_words(self, self._say)

    def _connect(self) -> None:
        self.faults.found.connect(self.timeline.show_faults)
        self.faults.found.connect(self.notes.show_faults)
        self.notes.time_asked.connect(self.commands.give_time)
        self.notes.open_asked.connect(self.project.show_open_menu)
        self.timeline.key_asked.connect(self.commands.add_pose)
        self.timeline.menu_asked.connect(self.commands.show_menu)
        self.host.services.files.document_changed.connect(self._on_document_changed)
        self.view.limb_pressed.connect(lambda *_: self.player.pause())
        for signal in (self.controller.changed, self.controller.chosen_changed):
            signal.connect(self._on_changed)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        body = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False)
        body.addWidget(self.view)
        body.addWidget(self.joints)
        body.setStretchFactor(0, 1)
        self.view.setMinimumSize(line * 12, line * 8)
        self.time_pages = QStackedWidget()
        holder = QScrollArea(widgetResizable=True)
        holder.setWidget(self.timeline)
        holder.setFrameShape(QFrame.Shape.StyledPanel)
        holder.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.time_pages.addWidget(holder)
        self.time_pages.addWidget(self.curve)
        self.time_pages.setFixedHeight(self.timeline.sizeHint().height() + 2 * holder.frameWidth())
        self.toolbar = self._toolbar()
        below = self.notes, self.transport, self.time_pages
        in_column(self.toolbar, self.header, (body, 1), *below, of=self, spacing=line // 2)
        fit_icons(self)

    def show_curve(self, is_shown: bool) -> None:
        """Show the curve of one joint in place of the timeline."""
        moving = [name for name in self.controller.motion.joints if name in self.joints.rows]
        if is_shown and self.curve.curve.joint not in moving and moving:
            self.curve.show_joint(moving[0])
        self.time_pages.setCurrentIndex(int(is_shown))
        height = self.timeline.sizeHint().height() + 2
        self.time_pages.setFixedHeight(height + self.timeline.line * 5 if is_shown else height)

    def _toolbar(self) -> QToolBar:
        bar = QToolBar(toolButtonStyle=Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        bar.setIconSize(icon_room(self.fontMetrics().height()))
        actions = self.actions_by_name
        for name in ("new_motion", "open_motion", "save_motion"):
            bar.addAction(actions[name])
        bar.addSeparator()
        for name in ("change_motion", "robot_pose", "look_from", "more_motion"):
            bar.addAction(actions[name])
            mode = QToolButton.ToolButtonPopupMode.InstantPopup
            _button_of(bar, actions[name]).setPopupMode(mode)
        return bar

    def _say(self) -> None:
        """Call a motion that nobody has begun yet by the name that it has in this language."""
        motion, new = self.controller.motion, new_motion()
        if not motion.joints and not self.controller.is_modified and motion.title == self._untitled:
            self.controller.open(new)
        self._untitled = new.title
        self._on_changed()

    def _on_changed(self) -> None:
        self.commands.update()
        self.project.update()

    def _on_document_changed(self) -> None:
        """Another project keeps no motion of the last one: what is here is new to it."""
        self.controller.name = ""
        self._on_changed()

    def event(self, event: QEvent) -> bool:
        """Keys that mean something here do not reach the window, where they mean another thing."""
        is_key = event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent)
        if is_key and self._meant(cast("QKeyEvent", event)) is not None:
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Keys that no field wanted for itself."""
        action = self._meant(event)
        if action is None:
            event.ignore()
        else:
            action.trigger()

    def _meant(self, event: QKeyEvent) -> QAction | None:
        """What a key does here; None where it is the window's."""
        modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        if not modifiers:
            return self.commands.plain(event.key())
        pressed = QKeySequence(event.keyCombination())
        named = self.actions_by_name.by_name.values()
        own = (one for one in named if one.isEnabled() and pressed in one.shortcuts())
        return next(own, None)

    def hideEvent(self, event: QHideEvent) -> None:
        """What nobody sees does not play on."""
        super().hideEvent(event)
        self.player.pause()

    @property
    def has_changes(self) -> bool:
        """Whether something would be lost."""
        return self.controller.is_modified and bool(self.controller.motion.joints)


def new_motion() -> OwnAnimation:
    """A motion in which nothing moves yet."""
    return OwnAnimation(tr("My motion"), {})


def _button_of(bar: QToolBar, action: QAction) -> QToolButton:
    button = bar.widgetForAction(action)
    assert isinstance(button, QToolButton)
    return button

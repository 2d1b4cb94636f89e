"""The window from which a robot is driven by hand, and the keys that drive it."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QFocusEvent, QHideEvent, QKeyEvent, QKeySequence
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QFrame,
    QGridLayout,
    QLabel,
    QPushButton,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from faults import text_of
from nep_core.wire import messages as m
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.theme.icons import fit_icons, icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import label_of, plain_label, room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .drive import KEYS, SILENT_S, STILL, Drive, Gamepad, Pilot, Tilt, sum_of
from .stage import ACTION

if TYPE_CHECKING:
    from nep_studio.run.plan import PlannedNode
    from nep_studio.ui.host import Host
    from nep_studio.ui.running.runner import Heard

# The keys that drive a robot: held on the keyboard, or on the screen with the mouse.

ARROWS = {
    Qt.Key.Key_Up: "arrow-up",
    Qt.Key.Key_Down: "arrow-down",
    Qt.Key.Key_Left: "arrow-left",
    Qt.Key.Key_Right: "arrow-right",
}
Place = tuple[int, int]


class DrivePad(QFrame):
    """``changed`` gives the Drive of all that is held; ``stop_asked`` that everything is to stop.

    Whoever looks elsewhere lets go: without the focus nothing is held.
    """

    changed = Signal(object)
    stop_asked = Signal()

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._held: dict[int, None] = {}
        self.buttons: dict[int, QPushButton] = {}
        self.hint = QLabel(wordWrap=True)
        self.stop_button = QPushButton(autoDefault=False)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        labelled(self, name="Drive with the keys")
        self._lay_out()
        self._say_how()
        follow_words(self, self._say_keys)
        look.theme_changed.connect(self._dress)
        self._dress()

    def let_go(self) -> None:
        """Nothing is held any more."""
        if self._held:
            self._held.clear()
            self._tell()

    def hold(self, key: int) -> None:
        """Begin to hold a key."""
        if key not in self._held:
            self._held[key] = None
            self._tell()

    def release(self, key: int) -> None:
        """Let go of a key."""
        if key in self._held:
            del self._held[key]
            self._tell()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Hold a key; the space bar stops everything."""
        if event.key() == Qt.Key.Key_Space:
            if not event.isAutoRepeat():
                self._stop()
        elif event.key() not in KEYS or event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            super().keyPressEvent(event)
        elif not event.isAutoRepeat():
            self.hold(event.key())

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Let go of a key."""
        if event.key() in KEYS and not event.isAutoRepeat():
            self.release(event.key())
        else:
            super().keyReleaseEvent(event)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """The keys are heard from now on."""
        super().focusInEvent(event)
        self._say_how()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Without the focus it is not heard when a key is let go."""
        super().focusOutEvent(event)
        self.let_go()
        self._say_how()

    def hideEvent(self, event: QHideEvent) -> None:
        """What is not seen is not held."""
        super().hideEvent(event)
        self.let_go()

    def changeEvent(self, event: QEvent) -> None:
        """A pad that is switched off holds nothing."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.EnabledChange and not self.isEnabled():
            self.let_go()

    def _tell(self) -> None:
        for key, button in self.buttons.items():
            button.setDown(key in self._held)
        self.changed.emit(sum_of(KEYS[key] for key in self._held))

    def _lay_out(self) -> None:
        walk: dict[int, Place] = {
            int(Qt.Key.Key_Q): (0, 0),
            int(Qt.Key.Key_Up): (0, 1),
            int(Qt.Key.Key_E): (0, 2),
            int(Qt.Key.Key_Left): (1, 0),
            int(Qt.Key.Key_Down): (1, 1),
            int(Qt.Key.Key_Right): (1, 2),
        }
        head: dict[int, Place] = {
            int(Qt.Key.Key_W): (0, 1),
            int(Qt.Key.Key_A): (1, 0),
            int(Qt.Key.Key_S): (1, 1),
            int(Qt.Key.Key_D): (1, 2),
        }
        labelled(self.stop_button, text="Stop", tip="Stop everything the robot does (Space)")
        self.stop_button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.stop_button.setProperty("kind", "stop")
        self.stop_button.clicked.connect(self._stop)
        walking = self._group(labelled(QLabel(), text="Walk"), walk)
        looking = self._group(labelled(QLabel(), text="Head"), head)
        in_column(in_row(walking, 1, looking, 1, self.stop_button), self.hint, of=self)

    def _group(self, heading: QLabel, keys: dict[int, Place]) -> QVBoxLayout:
        group = QWidget()
        group.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # as on every keyboard
        grid = QGridLayout(group)
        grid.setContentsMargins(0, 0, 0, 0)
        for key, (row, column) in keys.items():
            grid.addWidget(self._button(key), row, column)
        heading.setAlignment(Qt.AlignmentFlag.AlignCenter)
        return in_column(heading, group)

    def _button(self, key: int) -> QPushButton:
        button = self.buttons[key] = QPushButton(autoDefault=False)
        line = self.fontMetrics().height()
        button.setFixedSize(round(line * 2.4), round(line * 2.1))
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        if Qt.Key(key) not in ARROWS:
            button.setText(_named(key))
        button.pressed.connect(lambda: self.hold(key))
        button.released.connect(lambda: self.release(key))
        return button

    def _dress(self) -> None:
        for key, name in ARROWS.items():
            self.buttons[int(key)].setIcon(icon(name, self._look.theme))
        self.stop_button.setIcon(icon("square", self._look.theme, "stop_text"))

    def _say_keys(self) -> None:
        for key, words in key_words().items():
            self.buttons[key].setAccessibleName(words)
            self.buttons[key].setToolTip(f"{words} ({_named(key)})")

    def _say_how(self) -> None:
        labelled(
            self.hint,
            text="Hold a key to move the robot. Let go, and it stops."
            if self.hasFocus()
            else "Click here to drive with the keys.",
        )

    def _stop(self) -> None:
        self.let_go()
        self.stop_asked.emit()


def _named(key: int) -> str:
    return QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText)


def key_words() -> dict[int, str]:
    """What the keys do, in words."""
    key = Qt.Key
    return {
        int(key.Key_Up): tr("forward"),
        int(key.Key_Down): tr("back"),
        int(key.Key_Left): tr("turn left"),
        int(key.Key_Right): tr("turn right"),
        int(key.Key_Q): tr("sideways to the left"),
        int(key.Key_E): tr("sideways to the right"),
        int(key.Key_W): tr("look up"),
        int(key.Key_S): tr("look down"),
        int(key.Key_A): tr("look to the left"),
        int(key.Key_D): tr("look to the right"),
    }


# The window from which a robot is driven by hand.

LOOK_MS = 100
WALK, ARM = "walk", "arm"


def _uses() -> dict[str, str]:
    """What the movements of a watch can be used for."""
    return {WALK: tr("walks with its tilt"), ARM: tr("moves the right arm")}


class TeleoperationWindow(QDialog):
    """Drives one running robot with keys, a gamepad or a watch."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        labelled(self, window_title="Drive a robot")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._runner = host.services.runner
        self.states: dict[str, m.RobotState] = {}
        self.pilot = Pilot(self._runner, self)
        self.gamepad = Gamepad(self)
        self.tilt = Tilt()
        self._tilt_heard_s = 0.0
        self._drives: dict[str, Drive] = {}
        self.view = RobotView(host.services.look)
        self.robot = QComboBox()
        labelled(self.robot, name="Robot")
        self.start_button = QPushButton(autoDefault=False)
        self.pad = DrivePad(host.services.look)
        self.speed = QSlider(Qt.Orientation.Horizontal)
        self.with_gamepad = labelled(QCheckBox(), text="Gamepad")
        self.with_watch = labelled(QCheckBox(), text="Watch")
        self.watch_use = Choices(_uses)
        self.missing, self.told = plain_label(), plain_label()
        self._lay_out()
        self._connect()
        follow_words(self, self.refresh)
        (self.pad if self.states else self.start_button).setFocus()

    def refresh(self) -> None:
        """Show which robots there are."""
        names = sorted(self.states)
        shown = [self.robot.itemText(place) for place in range(self.robot.count())]
        if names != shown:
            now = self.robot.currentText()
            self.robot.clear()
            self.robot.addItems(names)
            self.robot.setCurrentIndex(max(0, self.robot.findText(now)))
        self.robot.setEnabled(bool(names))
        self.pilot.choose(self.robot.currentText())
        was_off = not self.pad.isEnabled()
        self.pad.setEnabled(bool(names))
        if names and was_off:
            self.pad.setFocus()
        waiting = self._waiting()
        self.start_button.setVisible(bool(waiting))
        if waiting:
            labelled(self.start_button, text=text_of("Start {robot}", robot=waiting[0].name))
        for name in set(self.view.room.robots) - {self.pilot.robot}:
            self.view.remove_robot(name)
        if self.pilot.robot:
            state = self.states.get(self.pilot.robot)
            self.view.show_robot(self.pilot.robot, state, can_touch=False)
        how = tr("Start it here.") if waiting else tr("Add a robot on the Robots page.")
        self.missing.setText(tr("No robot runs yet. {how}", how=how))
        self.missing.setVisible(not names)

    def _waiting(self) -> list[PlannedNode]:
        """The robots of the project that do not run."""
        robots = [one for one in self._runner.planned() if one.node.startswith(ACTION)]
        return [one for one in robots if one.name not in self.states]

    def _on_finished(self) -> None:
        """The window goes, and the robot stops."""
        self.pad.let_go()
        self.gamepad.close()
        self._drives.clear()
        self.pilot.let_go()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        top = in_row((self.robot, 1), self.start_button)
        self.speed.setRange(20, 100)
        self.speed.setValue(60)
        labelled(self.watch_use, name="What the watch does")
        self.watch_use.setEnabled(False)
        speed = in_row(label_of("How fast it walks", self.speed), (self.speed, 1))
        others = in_row(self.with_gamepad, 1, self.with_watch, self.watch_use)
        self.view.setMinimumSize(line * 14, line * 10)
        in_column(top, self.missing, (self.view, 1), self.told, self.pad, speed, others, of=self)
        fit_icons(self)
        room = room_around(self).size()
        self.resize(min(line * 30, room.width()), min(line * 40, room.height()))

    def _connect(self) -> None:
        runner = self._runner
        runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self).arrived.connect(self._on_states)
        runner.nodes_changed.connect(self._on_nodes_changed)
        runner.disconnected.connect(self._on_disconnected)
        self.finished.connect(self._on_finished)
        self.robot.activated.connect(self._on_robot_chosen)
        self.start_button.clicked.connect(self._on_start_clicked)
        self.pad.changed.connect(partial(self._on_drive, "keys"))
        self.pad.stop_asked.connect(self._on_stop)
        self.gamepad.changed.connect(partial(self._on_drive, "gamepad"))
        self.gamepad.stopped.connect(self._on_stop)
        self.gamepad.lost.connect(self._on_gamepad_lost)
        self.with_gamepad.toggled.connect(self._on_gamepad_toggled)
        self.with_watch.toggled.connect(self._on_watch_toggled)
        self.speed.valueChanged.connect(self._steer)
        runner.tap(m.IMU, kind=m.Imu, parent=self).arrived.connect(self._on_imu)
        looking = QTimer(self, interval=LOOK_MS)
        looking.timeout.connect(self._on_look)
        looking.start()

    # What is wanted

    def changeEvent(self, event: QEvent) -> None:
        """Who turns to another window lets go, of a gamepad and a watch too."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.ActivationChange and not self.isActiveWindow():
            self._drives.clear()
            self._steer()

    def _on_drive(self, source: str, drive: Drive) -> None:
        self._drives[source] = drive if self.isActiveWindow() else STILL
        self._steer()

    def _steer(self) -> None:
        self.pilot.steer(sum_of(self._drives.values()).slowed(self.speed.value() / 100.0))

    def _on_stop(self) -> None:
        self._drives.clear()
        self.pilot.stop()
        labelled(self.told, text="Everything stops.")

    def _on_gamepad_toggled(self, is_on: bool) -> None:
        self._drives.pop("gamepad", None)
        if not is_on:
            self.gamepad.close()
        elif not self.gamepad.open():
            self.with_gamepad.setChecked(False)
            labelled(self.told, text="No gamepad is found. Plug one in, then try again.")
        self._steer()

    def _on_gamepad_lost(self) -> None:
        self.with_gamepad.setChecked(False)
        labelled(self.told, text="The gamepad is gone. The robot stops.")

    def _on_watch_toggled(self, is_on: bool) -> None:
        self.watch_use.setEnabled(is_on)
        self._drives.pop("watch", None)
        self.tilt = Tilt()
        self._tilt_heard_s = time.monotonic()
        if is_on:
            labelled(self.told, text="Hold the watch still for a moment: that is its middle.")
        self._steer()

    def _on_imu(self, batch: list[Heard]) -> None:
        if not self.with_watch.isChecked():
            return
        for heard in batch:
            self.tilt.hear(heard.message)
        self._tilt_heard_s = time.monotonic()
        if not self.tilt.is_settled:
            return
        if self.watch_use.currentData() == ARM:
            self._on_drive("watch", STILL)
            self.pilot.set_angles(self.tilt.arm())
        else:
            self._on_drive("watch", self.tilt.drive())

    def _on_look(self) -> None:
        is_silent = time.monotonic() - self._tilt_heard_s > SILENT_S
        if self._drives.get("watch", STILL) != STILL and is_silent:
            self._on_drive("watch", STILL)
            labelled(self.told, text="The watch is not heard any more. The robot stops.")

    # What is heard

    def _on_states(self, batch: list[Heard]) -> None:
        self.states |= {heard.message.robot: heard.message for heard in batch}
        if self.robot.count() != len(self.states):
            self.refresh()
        state = self.states.get(self.pilot.robot)
        if state is not None:
            self.pilot.see(state)
            self.view.show_robot(state.robot, state, can_touch=False)

    def _on_nodes_changed(self, names: list[str]) -> None:
        nodes = self._runner.board.nodes
        for name in names:
            if name in nodes and not nodes[name].is_there:
                self.states.pop(name, None)
        self.refresh()

    def _on_disconnected(self) -> None:
        self.states.clear()
        self.refresh()

    def _on_robot_chosen(self) -> None:
        self.refresh()
        self.pad.setFocus()

    def _on_start_clicked(self) -> None:
        for planned in self._waiting()[:1]:
            self._runner.start_node(planned)
        self.pad.setFocus()

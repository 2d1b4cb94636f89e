"""The window from which a robot is driven by hand."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, QTimer
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QLabel,
    QPushButton,
    QSlider,
)

from faults import text_of
from nep_core.wire import messages as m
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.theme.icons import fit_icons
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .drive import SILENT_S, STILL, Drive, Pilot, Tilt, sum_of
from .gamepad import Gamepad
from .pad import DrivePad
from .stage import ACTION

if TYPE_CHECKING:
    from nep_studio.ui.host import Host
    from nep_studio.ui.running.runner import Heard

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
        self.missing, self.told = QLabel(), QLabel()
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
        self.pilot.choose(self.robot.currentText())
        was_off = not self.pad.isEnabled()
        self.pad.setEnabled(bool(names))
        if names and was_off:
            self.pad.setFocus()
        waiting = [one for one in self._runner.planned() if one.node.startswith(ACTION)]
        waiting = [one for one in waiting if one.name not in self.states]
        self.start_button.setVisible(bool(waiting))
        if waiting:
            labelled(self.start_button, text=text_of("Start {robot}", robot=waiting[0].name))
        for name in set(self.view.room.names) - {self.pilot.robot}:
            self.view.remove_robot(name)
        if self.pilot.robot:
            state = self.states.get(self.pilot.robot)
            self.view.show_robot(self.pilot.robot, state, can_touch=False)
        if names:
            self.missing.hide()
        else:
            add, start = tr("Add a robot on the Robots page."), tr("Start it here.")
            words = tr("No robot runs yet. {how}", how=start if waiting else add)
            self.missing.setText(words)
            self.missing.show()

    def closeEvent(self, event: QCloseEvent) -> None:
        """The robot stops."""
        self._leave()
        super().closeEvent(event)

    def reject(self) -> None:
        """Esc: the robot stops, and the window goes."""
        self._leave()
        super().reject()

    def _leave(self) -> None:
        self.pad.let_go()
        self.gamepad.close()
        self._drives.clear()
        self.pilot.let_go()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        top = in_row((self.robot, 1), self.start_button)
        self.speed.setRange(20, 100)
        self.speed.setValue(60)
        labelled(self.speed, name="How fast it walks")
        labelled(self.watch_use, name="What the watch does")
        self.watch_use.setEnabled(False)
        speed = in_row(labelled(QLabel(), text="How fast it walks"), (self.speed, 1))
        others = in_row(self.with_gamepad, 1, self.with_watch, self.watch_use)
        self.missing.setWordWrap(True)
        self.told.setWordWrap(True)
        self.view.setMinimumSize(line * 14, line * 10)
        in_column(top, self.missing, (self.view, 1), self.told, self.pad, speed, others, of=self)
        fit_icons(self)
        room = room_around(self).size()
        self.resize(min(line * 30, room.width()), min(line * 40, room.height()))

    def _connect(self) -> None:
        runner = self._runner
        states = runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self)
        states.arrived.connect(self._on_states)
        runner.nodes_changed.connect(self._on_nodes_changed)
        runner.disconnected.connect(self._on_disconnected)
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
        imu = runner.tap(m.IMU, kind=m.Imu, parent=self)
        imu.arrived.connect(self._on_imu)
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._on_look)
        self._looking.start()

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
        for planned in self._runner.planned():
            if planned.node.startswith(ACTION) and planned.name not in self.states:
                self._runner.start_node(planned)
                break
        self.pad.setFocus()

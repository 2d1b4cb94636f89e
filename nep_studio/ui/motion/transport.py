"""Plays and pauses a motion, and says how fast and how often; a row of buttons."""

from __future__ import annotations

from PySide6.QtCore import QLocale, Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QToolButton, QWidget

from nep_studio.ui.actions import Actions
from nep_studio.ui.motion.desk import MotionDesk
from nep_studio.ui.motion.player import Player
from nep_studio.ui.motion.timeline import Timeline
from nep_studio.ui.words import tr

SPEEDS = (0.25, 0.5, 1.0, 2.0)
SNAPS_S = (0.0, 0.01, 0.05, 0.1, 0.25)
VIEW_BUTTONS = ("show_curve",)
BUTTONS = ("first_pose", "play_motion", "loop_motion")
KEY_BUTTONS = ("add_pose", "copy_pose", "delete_pose")


class Transport(QWidget):
    """The row between the robot and the timeline."""

    def __init__(
        self,
        desk: MotionDesk,
        player: Player,
        timeline: Timeline,
        actions: Actions,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.desk, self.player, self.timeline = desk, player, timeline
        self.time = QLabel()
        self.speed = QComboBox()
        self.speed.setAccessibleName(tr("Speed"))
        self.speed.setToolTip(tr("How fast it is shown here; the motion stays as it is"))
        for speed in SPEEDS:
            self.speed.addItem(
                f"\N{MULTIPLICATION SIGN} {QLocale().toString(speed, 'g', 3)}", speed
            )
        self.speed.setCurrentIndex(SPEEDS.index(1.0))
        self.snap = QComboBox()
        self.snap.setAccessibleName(tr("Grid"))
        self.snap.setToolTip(tr("To which times key poses go when they are moved"))
        for snap in SNAPS_S:
            words = tr("no grid") if not snap else tr("grid {time} s", time=f"{snap:g}")
            self.snap.addItem(words, snap)
        self.snap.setCurrentIndex(SNAPS_S.index(timeline.snap_s))
        self._lay_out(actions)
        self.speed.currentIndexChanged.connect(self._on_speed_changed)
        self.snap.currentIndexChanged.connect(self._on_snap_changed)
        for signal in (desk.changed, desk.moved):
            signal.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the moment."""
        place, whole = self.desk.cursor_s, self.desk.motion.duration_s
        local = QLocale()
        words = (local.toString(place, "f", 2), local.toString(whole, "f", 2))
        self.time.setText(tr("{now} of {all} s", now=words[0], all=words[1]))

    def _lay_out(self, actions: Actions) -> None:
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        for name in BUTTONS:
            row.addWidget(_button(actions, name))
        row.addWidget(self.speed)
        row.addWidget(self.time)
        row.addStretch(1)
        for name in KEY_BUTTONS:
            row.addWidget(_button(actions, name, has_words=name == "add_pose"))
        row.addWidget(self.snap)
        for name in VIEW_BUTTONS:
            row.addWidget(_button(actions, name))

    def _on_speed_changed(self) -> None:
        self.player.speed = float(self.speed.currentData())

    def _on_snap_changed(self) -> None:
        self.timeline.snap_s = float(self.snap.currentData())


def _button(actions: Actions, name: str, *, has_words: bool = False) -> QToolButton:
    button = QToolButton()
    button.setDefaultAction(actions[name])
    style = Qt.ToolButtonStyle
    button.setToolButtonStyle(
        style.ToolButtonTextBesideIcon if has_words else style.ToolButtonIconOnly
    )
    return button

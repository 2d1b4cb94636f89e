"""What can be done with a motion, as actions of its window: each has words, an icon, keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QInputDialog, QMenu

from nep_studio.blocks.own_animations import OwnAnimation
from nep_studio.ui.motion import editing
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.motion.window import MotionWindow

PLAIN_KEYS = {
    Qt.Key.Key_Space: "play_motion",
    Qt.Key.Key_K: "add_pose",
    Qt.Key.Key_D: "copy_pose",
    Qt.Key.Key_L: "loop_motion",
    Qt.Key.Key_Home: "first_pose",
    Qt.Key.Key_Delete: "delete_pose",
    Qt.Key.Key_Backspace: "delete_pose",
}
COPY_GAP_S = 0.5
"""So much later than the last pose copies come, where the moment shown says nothing else."""
LEAST_STRETCH, MOST_STRETCH = 10, 1000


class Commands:
    """Adds the actions of a window, and does what they ask for."""

    def __init__(self, window: MotionWindow) -> None:
        self.window, self.desk, self.player = window, window.desk, window.player
        self._add_edit()
        self._add_play()
        self._add_changes()

    def update(self) -> None:
        """Let those actions be used that have something to do."""
        actions, desk = self.window.actions_by_name, self.desk
        is_there = bool(desk.motion.joints)
        actions.enable(bool(desk.undo_label), "undo_motion")
        actions.enable(bool(desk.redo_label), "redo_motion")
        actions.enable(bool(desk.chosen), "copy_pose", "delete_pose")
        names = ("first_pose", "play_motion", "mirror", "backwards", "stretch", "all_poses")
        actions.enable(is_there, *names)
        for name, label, words in (
            ("undo_motion", desk.undo_label, tr("Undo")),
            ("redo_motion", desk.redo_label, tr("Redo")),
        ):
            actions[name].setText(f"{words}: {label}" if label else words)

    def press(self, key: int) -> bool:
        """Do what a key without Ctrl means; False when it means nothing here.

        They are no shortcuts: a button that has the focus is pressed with the space bar.
        """
        name = PLAIN_KEYS.get(Qt.Key(key))
        if name is None:
            return False
        self.window.actions_by_name[name].trigger()
        return True

    def _add_edit(self) -> None:
        add, keys = self.window.actions_by_name.add, QKeySequence.StandardKey
        desk = self.desk
        add("undo_motion", tr("Undo"), desk.undo, icon_name="undo-2", keys=keys.Undo)
        add("redo_motion", tr("Redo"), desk.redo, icon_name="redo-2", keys=(keys.Redo, "Ctrl+Y"))
        self._add_plain("add_pose", tr("Add a pose"), self.add_pose, "plus")
        self._add_plain("copy_pose", tr("Copy the poses to here"), self.copy, "copy-plus")
        self._add_plain("delete_pose", tr("Delete the poses"), self.delete, "trash-2")
        add("all_poses", tr("Choose all poses"), self.choose_all, keys=keys.SelectAll)

    def _add_play(self) -> None:
        begin = tr("To the beginning")
        self._add_plain("first_pose", begin, lambda: self.desk.show(0.0), "rotate-ccw")
        self._add_plain("play_motion", tr("Play"), self.player.toggle, "play")
        self._add_plain("loop_motion", tr("Again and again"), lambda: None, "repeat")
        loop = self.window.actions_by_name["loop_motion"]
        loop.setCheckable(True)
        loop.toggled.connect(self._on_loop_toggled)
        self.player.changed.connect(self._on_playing_changed)
        add = self.window.actions_by_name.add
        words = tr("The curve of one joint")
        curve = add("show_curve", words, lambda: None, icon_name="chart-line")
        curve.setCheckable(True)
        curve.toggled.connect(self.window.show_curve)

    def _add_plain(self, name: str, words: str, do: Callable[[], object], icon_name: str) -> None:
        """Add an action whose key is pressed without Ctrl."""
        key = next(key for key, one in PLAIN_KEYS.items() if one == name)
        keys = QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText)
        tip = f"{words} ({keys})"
        self.window.actions_by_name.add(name, words, do, icon_name=icon_name, tip=tip)

    def _add_changes(self) -> None:
        add = self.window.actions_by_name.add
        mirror, backwards = tr("Mirror: left is right"), tr("Backwards")
        add("mirror", mirror, lambda: self._do(mirror, editing.mirrored))
        add("backwards", backwards, lambda: self._do(backwards, editing.backwards))
        add("stretch", tr("Slower or faster…"), self.ask_stretch, icon_name="gauge")
        look = add("look_from", tr("Look from"), lambda: None, icon_name="eye")
        menu = QMenu(self.window)
        for preset, words in (
            ("front", tr("the front")),
            ("side", tr("the side")),
            ("back", tr("behind")),
            ("top", tr("above")),
        ):
            menu.addAction(words, partial(self._look_from, preset))
        look.setMenu(menu)
        words = tr("Give it the time it needs")
        add("give_time", words, self.give_time, icon_name="hourglass")

    # What they do

    def add_pose(self) -> None:
        """Keep the pose that is shown."""
        self.player.pause()
        self.desk.add_key(tr("add a key pose"))

    def copy(self) -> None:
        """Copy the chosen poses to the moment that is shown, or behind the last one."""
        desk = self.desk
        if not desk.chosen:
            return
        first = desk.chosen[0]
        is_away = all(abs(desk.cursor_s - time) > editing.SAME_S for time in desk.chosen)
        end_s = desk.motion.duration_s + COPY_GAP_S
        target = desk.cursor_s if is_away and desk.cursor_s > 0 else end_s
        desk.copy_chosen(target - first, tr("copy key poses"))
        desk.show(desk.chosen[0])

    def delete(self) -> None:
        """Take the chosen poses away."""
        self.desk.delete_chosen(tr("delete key poses"))

    def choose_all(self) -> None:
        """Choose every pose."""
        self.desk.choose(editing.key_times(self.desk.motion))

    def give_time(self) -> None:
        """Make it as slow as the robot needs, where it is too fast."""
        self.player.pause()
        self.desk.give_time(tr("give it the time it needs"))

    def ask_stretch(self) -> None:
        """Ask how many percent of its time the motion is to take."""
        dialog = QInputDialog(self.window)
        dialog.setWindowTitle(tr("Slower or faster"))
        dialog.setLabelText(tr("How long it takes, in percent of now:"))
        dialog.setInputMode(QInputDialog.InputMode.IntInput)
        dialog.setIntRange(LEAST_STRETCH, MOST_STRETCH)
        dialog.setIntValue(100)
        dialog.intValueSelected.connect(self.stretch)
        dialog.open()

    def stretch(self, percent: int) -> None:
        """Let it take so many percent of its time."""
        motion = editing.stretched(self.desk.motion, percent / 100.0)
        self.desk.choose(())
        self.desk.do(tr("change how long it takes"), motion)

    def show_menu(self, place: object) -> None:
        """The menu of the timeline."""
        assert isinstance(place, QPoint)
        menu = QMenu(self.window)
        actions = self.window.actions_by_name
        menu.addActions([actions[name] for name in ("add_pose", "copy_pose", "delete_pose")])
        menu.addSeparator()
        menu.addActions([actions[name] for name in ("all_poses", "mirror", "backwards", "stretch")])
        menu.aboutToHide.connect(menu.deleteLater)
        menu.popup(place)

    def _do(self, label: str, change: Callable[[OwnAnimation], OwnAnimation]) -> None:
        self.player.pause()
        self.desk.choose(())
        self.desk.do(label, change(self.desk.motion))

    def _look_from(self, preset: str) -> None:
        self.window.view.look_from(preset)

    def _on_loop_toggled(self, is_on: bool) -> None:
        self.player.is_looping = is_on

    def _on_playing_changed(self, is_playing: bool) -> None:
        action = self.window.actions_by_name["play_motion"]
        action.setText(tr("Pause") if is_playing else tr("Play"))
        theme = self.window.look.theme
        action.setIcon(icon("pause" if is_playing else "play", theme))

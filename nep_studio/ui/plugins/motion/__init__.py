"""Making a motion: poses on a timeline, which a robot then plays; and driving a robot by hand."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QDialog

from nep_studio.blocks.operations.animations import Use, use_of
from nep_studio.blocks.own_animations import own_animations
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost
    from nep_studio.ui.shell.main_window import MainWindow

    from .teleoperation import TeleoperationWindow
    from .window import MotionWindow


# Puts making motions and driving robots by hand into the window.

MOTION_WINDOW = "motion_window"


def add_motion(window: MainWindow) -> MotionKit:
    """Add the actions "make_motion" and "teleoperate" to the Robots menu."""
    return MotionKit(window)


class MotionKit(QObject):
    """What the actions do; the windows are loaded when they are opened."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window.actions_by_name)
        self._window = window
        add = window.actions_by_name.add
        tip = tr("Pose the robot, put the poses on a timeline, and let blocks play the motion")
        words = tr("Make a motion…")
        make = add("make_motion", words, self.make, icon_name="person-standing", tip=tip)
        menu = window.menus["robots"]
        menu.addAction(make)
        words = tr("Drive a robot…")
        tip = tr("Let a robot walk and look around with keys, a gamepad or a watch")
        menu.addAction(add("teleoperate", words, self.drive, icon_name="crosshair", tip=tip))
        window.workbench.canvas.menu_sections.append(self._section)
        window.files.document_changed.connect(self._update)
        window.installEventFilter(self)
        self._update()

    def make(self) -> MotionWindow:
        """Show the window in which motions are made; there is one."""
        from .window import MotionWindow

        made = self._open_motion() or MotionWindow(self._window, self._model())
        made.show()
        made.raise_()
        made.activateWindow()
        return made

    def drive(self) -> TeleoperationWindow:
        """Show the window from which a robot is driven; there is one."""
        from .teleoperation import TeleoperationWindow

        shown = [w for w in self._window.findChildren(TeleoperationWindow) if w.isVisible()]
        made = shown[0] if shown else TeleoperationWindow(self._window)
        made.show()
        made.raise_()
        made.activateWindow()
        return made

    def _model(self) -> str:
        """The model of the project's robots; a NAO's where they are different ones."""
        planned = self._window.running.runner.planned()
        models = {str(node.parameters.get("model", "")) for node in planned if is_robot(node)}
        return models.pop() if len(models) == 1 else ""

    def make_for(self, use: Use) -> None:
        """Make a new motion, which a block plays once it is kept."""
        motion = self.make()
        motion.project.new(use)

    def change(self, name: str) -> None:
        """Show a motion of the project, or one that comes with the robot as a start."""
        motion = self.make()
        motion.project.guard(lambda: motion.project.open(name))

    def _section(self, canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of a block that plays a motion offers."""
        if place.hit is None:
            return []
        block = canvas.editor.project.blocks.get(place.hit.block)
        use = use_of(canvas.editor, block.id) if block is not None else None
        if block is None or use is None:
            return []
        name = str(canvas.editor.language.definitions[block.type].value(block, use.slot))
        entries = [
            MenuEntry("new_motion", tr("Make a motion for it…"), lambda: self.make_for(use), "plus")
        ]
        if name in own_animations(canvas.editor.project):
            words, run = tr("Change this motion…"), partial(self.change, name)
            entries.append(MenuEntry("change_motion", words, run, "person-standing"))
        return entries

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """A motion that is not kept is asked about before its program is gone."""
        motion = self._open_motion() if event.type() == QEvent.Type.Close else None
        if motion is None or not motion.has_changes:
            return super().eventFilter(watched, event)
        event.ignore()
        motion.raise_()
        motion.project.guard(partial(self._close_all, motion))
        return True

    def _open_motion(self) -> MotionWindow | None:
        """The window that is open; by its name, for its room is loaded late."""
        dialogs = self._window.findChildren(QDialog, MOTION_WINDOW)
        found = next((dialog for dialog in dialogs if dialog.isVisible()), None)
        return cast("MotionWindow | None", found)

    def _close_all(self, motion: MotionWindow) -> None:
        motion.close_now()
        self._window.close()

    def _update(self, _document: object = None) -> None:
        is_open = self._window.files.document is not None
        self._window.actions_by_name.enable(is_open, "make_motion", "teleoperate")


def is_robot(node: PlannedNode) -> bool:
    """Whether a node plays a robot."""
    return node.node.startswith("action/")

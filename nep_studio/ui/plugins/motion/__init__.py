"""Making a motion: poses on a timeline, which a robot then plays; and driving a robot by hand."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QDialog

from nep_studio.blocks.operations.animations import Use, use_of
from nep_studio.blocks.own_animations import own_animations
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

    from .teleoperation import TeleoperationWindow
    from .window import MotionWindow

MOTION_WINDOW = "motion_window"


def make(host: Host) -> Parts:
    """The actions of the Robots menu, and what the menu of a block that plays a motion offers."""
    kit = MotionKit(host)
    actions = [
        NewAction(
            "make_motion",
            "Make a motion…",
            kit.make,
            "person-standing",
            tip="Pose the robot, put the poses on a timeline, and let blocks play the motion",
            menu="robots",
        ),
        NewAction(
            "teleoperate",
            "Drive a robot…",
            kit.drive,
            "crosshair",
            tip="Let a robot walk and look around with keys, a gamepad or a watch",
            menu="robots",
        ),
    ]
    return Parts(actions=actions, menu_sections=[kit.section])


class MotionKit(QObject):
    """What the actions do; the windows are loaded when they are opened."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.actions)
        self._host = host

    def make(self) -> MotionWindow:
        """Show the window in which motions are made; there is one."""
        from .window import MotionWindow

        made = self._open_motion() or MotionWindow(self._host, self._model())
        self._host.widget.installEventFilter(self)  # from now on there is something to ask about
        made.show()
        made.raise_()
        made.activateWindow()
        return made

    def drive(self) -> TeleoperationWindow:
        """Show the window from which a robot is driven; there is one."""
        from .teleoperation import TeleoperationWindow

        shown = [w for w in self._host.widget.findChildren(TeleoperationWindow) if w.isVisible()]
        made = shown[0] if shown else TeleoperationWindow(self._host)
        made.show()
        made.raise_()
        made.activateWindow()
        return made

    def _model(self) -> str:
        """The model of the project's robots; a NAO's where they are different ones."""
        planned = self._host.services.runner.planned()
        robots = [node for node in planned if node.node.startswith("action/")]
        models = {str(node.parameters.get("model", "")) for node in robots}
        return models.pop() if len(models) == 1 else ""

    def make_for(self, use: Use) -> None:
        """Make a new motion, which a block plays once it is kept."""
        motion = self.make()
        motion.project.new(use)

    def change(self, name: str) -> None:
        """Show a motion of the project, or one that comes with the robot as a start."""
        motion = self.make()
        motion.project.guard(lambda: motion.project.open(name))

    def section(self, canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of a block that plays a motion offers."""
        block = canvas.editor.project.blocks.get(place.hit.block) if place.hit else None
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
        dialogs = self._host.widget.findChildren(QDialog, MOTION_WINDOW)
        found = next((dialog for dialog in dialogs if dialog.isVisible()), None)
        return cast("MotionWindow | None", found)

    def _close_all(self, motion: MotionWindow) -> None:
        motion.close_now()
        self._host.widget.close()


plugin = Plugin("motion", make, order=170, needs_project=True)

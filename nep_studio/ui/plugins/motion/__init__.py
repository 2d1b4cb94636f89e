"""Making a motion: poses on a timeline, which a robot then plays; and driving a robot by hand."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Signal

from nep_studio.blocks.operations.animations import Use, use_of
from nep_studio.blocks.own_animations import own_animations
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.host import Host, NewAction, NewPanel, Parts, Plugin
from nep_studio.ui.widgets.layouts import LatePanel
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

    from .page import MotionPage
    from .teleoperation import TeleoperationWindow


class MotionRoom(LatePanel["MotionPage"]):
    """The page on which motions are made, filled when it is opened; it has steps of its own."""

    usual_lines, least_lines = (45, 30), (30, 24)
    history_changed = Signal()

    @property
    def undo_label(self) -> str:
        """What undo would take back."""
        return self.page.controller.undo_label if self.page is not None else ""

    @property
    def redo_label(self) -> str:
        """What redo would do again."""
        return self.page.controller.redo_label if self.page is not None else ""

    def undo(self) -> None:
        """Take the last step back."""
        self.opened().controller.undo()

    def redo(self) -> None:
        """Do again what was taken back."""
        self.opened().controller.redo()


def make(host: Host) -> Parts:
    """The page, the actions of the Robots menu, and what the menu of a block offers."""
    room = MotionRoom(lambda: kit.page())
    kit = MotionKit(host, room)
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
    panel = NewPanel(room, "Motion", "person-standing", "page", history=room, has_own_robot=True)
    return Parts(panel, actions=actions, menu_sections=[kit.section])


class MotionKit(QObject):
    """What the actions do; the windows are loaded when they are opened."""

    def __init__(self, host: Host, room: MotionRoom) -> None:
        super().__init__(host.actions)
        self._host, self.room = host, room

    def page(self) -> MotionPage:
        """The page for the project's robots."""
        from .page import MotionPage

        made = MotionPage(self._host, self._model())
        made.controller.changed.connect(self.room.history_changed)
        self._host.widget.installEventFilter(self)  # from now on there is something to ask about
        return made

    def make(self) -> MotionPage:
        """Show the page on which motions are made."""
        page = self.room.page
        if page is not None and page.model != self._model() and not page.has_changes:
            self.room.forget()  # it is for robots that the project does not have any more
        self._host.show_panel(self.room)
        made = self.room.opened()
        made.timeline.setFocus()
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
        motion = self.room.page if event.type() == QEvent.Type.Close else None
        if motion is None or not motion.has_changes:
            return super().eventFilter(watched, event)
        event.ignore()
        self._host.show_panel(self.room)
        motion.project.guard(self._close_all)
        return True

    def _close_all(self) -> None:
        self._host.workbench.rooms.show_canvas()
        self.room.forget()  # it may take another question before the window is closed
        self._host.widget.close()


plugin = Plugin("motion", make, order=170, needs_project=True)

"""What the pictures of the guide show: a first rule, and show mode."""

from __future__ import annotations

from image_scenes import scene
from image_scenes_rooms import SCENES
from image_window import SIZE, Stage, block_of, part_of, picture, quiet
from PySide6.QtCore import QRect, QSize
from PySide6.QtGui import QImage

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.places import InStack
from nep_studio.ui.plugins.show import ShowMode
from nep_studio.ui.shell.main_window import MainWindow

__all__ = ["SCENES"]

RULE, SAYS = "robot_events.touched", "robot.say"


def _make_rule(window: MainWindow) -> None:
    """Let the page hold nothing but a rule of two blocks."""
    editor = window.workbench.canvas.editor
    project = editor.project
    for stack in list(project.pages["behaviour"]):
        editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    project.notes.clear()
    place = editor.new_stack("behaviour", 60, 60)
    with editor.transaction("a rule"):
        editor.create(RULE, place)
        says = editor.create(SAYS, InStack(place.stack, 1))
        editor.apply(SetField(says, "text", "That tickles."))


@scene("first-rule")
def first_rule(stage: Stage) -> QImage:
    """A rule: when the head is touched, the robot says something."""
    with stage.window() as window:
        canvas = window.workbench.canvas
        _make_rule(window)
        canvas.show_block(block_of(canvas, SAYS))
        quiet()
        whole = part_of(window, canvas.viewport())
        return picture(window, whole.intersected(QRect(whole.topLeft(), QSize(460, 200))))


@scene("show-mode")
def show_mode(stage: Stage) -> QImage:
    """What the public sees."""
    with stage.window(example="museum_coach") as window:
        mode = window.findChild(ShowMode)
        assert mode is not None
        show = mode.begin()
        show.showNormal()
        show.resize(*SIZE)
        quiet(1500)
        shown = show.grab().toImage()
        show.left.emit()
        return shown

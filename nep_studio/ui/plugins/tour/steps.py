"""The steps of the tour as data: what is said, what is shown, and what a person does there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QRect
from PySide6.QtWidgets import QToolBar, QWidget

from nep_studio import paths
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Block, Stack
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

FIRST_STEPS = paths.resources() / "tour" / "first_steps.nep"
"""The project of the tour: a “when” block that waits for others, and a robot on the screen."""

PROJECT = "First steps"
"""What that project is called."""

START, SAY = "event.started", "robot.say"


def _nothing(_window: MainWindow) -> None:
    """Nothing has to be prepared, or done."""


@dataclass(frozen=True)
class Step:
    """One step. ``target`` is the place in the window that is shown, empty where there is none.

    ``prepare`` lets it be seen. A step with ``is_done`` goes on by itself when that becomes true;
    ``do`` does it in place of a person who goes on without.
    """

    title: str
    text: str
    target: Callable[[MainWindow], QRect]
    prepare: Callable[[MainWindow], object] = _nothing
    is_done: Callable[[MainWindow], bool] | None = None
    do: Callable[[MainWindow], object] = _nothing


def steps() -> list[Step]:
    """The five steps in the language in use."""
    return [
        Step(
            tr("Here are the blocks"),
            tr("Each block is a sentence: something a robot does, or when it does it."),
            lambda window: place_of(window, window.workbench.helpers.palette),
            show_blocks,
        ),
        Step(
            tr("Drag a block"),
            tr("Drag “NAO says” to the page, and let it go under “when the program starts”."),
            _palette_and_page,
            _show_say,
            lambda window: say_block(window) is not None,
            add_say,
        ),
        Step(
            tr("Say it in your words"),
            tr("Click the white field of the new block, type a sentence, and press Enter."),
            _say_place,
            show_blocks,
            _has_own_words,
        ),
        Step(
            tr("Press Run"),
            tr("The program checks your blocks, starts the robot on the screen, and begins."),
            _run_button,
            is_done=_is_running,
        ),
        Step(
            tr("See it happen"),
            tr(
                "The block that runs glows, and NAO says your sentence. To know more of a block,"
                " click it and press F1."
            ),
            _say_place,
        ),
    ]


def place_of(window: MainWindow, widget: QWidget | None) -> QRect:
    """Where a widget is in the window; empty when it is not to be seen."""
    if widget is None or not widget.isVisible():
        return QRect()
    return QRect(widget.mapTo(window, QPoint(0, 0)), widget.size())


def started_stack(window: MainWindow) -> Stack | None:
    """The stack that runs when the program starts."""
    project = window.workbench.canvas.editor.project
    stacks = project.stacks.values()
    return next((s for s in stacks if project.blocks[s.body[0]].type == START), None)


def say_block(window: MainWindow) -> Block | None:
    """The first block in that stack by which a robot says something."""
    stack = started_stack(window)
    project = window.workbench.canvas.editor.project
    found = (project.blocks[block] for block in (stack.body if stack else ()))
    return next((block for block in found if block.type == SAY), None)


def show_blocks(window: MainWindow) -> None:
    """Show the page and the palette, whatever was hidden."""
    workbench = window.workbench
    palette = workbench.helpers.palette
    workbench.panels.show(palette)
    palette.set_narrow(False)
    workbench.canvas.show_page("behaviour")


def add_say(window: MainWindow) -> None:
    """Put the block there for a person who goes on without."""
    stack, canvas = started_stack(window), window.workbench.canvas
    if stack is not None and say_block(window) is None:
        canvas.attempt(lambda: canvas.editor.create(SAY, InStack(stack.id, 1)))


def _show_say(window: MainWindow) -> None:
    show_blocks(window)
    window.workbench.canvas.sight.show_beginning()
    window.workbench.helpers.palette.open_drawer("robot")


def _palette_and_page(window: MainWindow) -> QRect:
    workbench = window.workbench
    page = place_of(window, workbench.canvas)
    return place_of(window, workbench.helpers.palette).united(page)


def _say_place(window: MainWindow) -> QRect:
    """Where the block is on the page; the page where it is out of sight."""
    canvas, block = window.workbench.canvas, say_block(window)
    page = place_of(window, canvas.viewport())
    rect = canvas.sight.view_rect_of(block.id) if block is not None else None
    if rect is None:
        return page
    seen = rect.toAlignedRect().translated(page.topLeft()).intersected(page)
    return seen if seen.height() >= rect.height() / 2 else page


def _has_own_words(window: MainWindow) -> bool:
    canvas, block = window.workbench.canvas, say_block(window)
    if block is None or canvas.fields.widget is not None:
        return False
    usual = canvas.editor.language.definitions[SAY].defaults["text"]
    return "text" in block.inputs or block.fields.get("text", usual) != usual


def _run_button(window: MainWindow) -> QRect:
    bar: QToolBar = window.toolbar
    return place_of(window, bar.widgetForAction(window.actions_by_name["run"]))


def _is_running(window: MainWindow) -> bool:
    return window.running.runner.state != "idle"

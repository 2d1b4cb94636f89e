"""The steps of the tour as data: what is said, what is shown, and what a person does there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QRect
from PySide6.QtWidgets import QToolButton, QWidget

from nep_studio import paths
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Block, Stack
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.host import Host

FIRST_STEPS = paths.resources() / "tour" / "first_steps.nep"
"""The project of the tour: a “when” block that waits for others, and a robot on the screen."""

PROJECT = "First steps"
"""What that project is called."""

START, SAY = "event.started", "robot.say"


def _nothing(_host: Host) -> None:
    """Nothing has to be prepared, or done."""


@dataclass(frozen=True)
class Step:
    """One step. ``target`` is the place in the window that is shown, empty where there is none.

    ``prepare`` lets it be seen. A step with ``is_done`` goes on by itself when that becomes true;
    ``do`` does it in place of a person who goes on without.
    """

    title: str
    text: str
    target: Callable[[Host], QRect]
    prepare: Callable[[Host], object] = _nothing
    is_done: Callable[[Host], bool] | None = None
    do: Callable[[Host], object] = _nothing


def steps() -> list[Step]:
    """The five steps in the language in use."""
    return [
        Step(
            tr("Here are the blocks"),
            tr("Each block is a sentence: something a robot does, or when it does it."),
            lambda host: place_of(host, host.workbench.helpers.palette),
            show_blocks,
        ),
        Step(
            tr("Drag a block"),
            tr("Drag “NAO says” to the page, and let it go under “when the program starts”."),
            _palette_and_page,
            _show_say,
            lambda host: say_block(host) is not None,
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


def place_of(host: Host, widget: QWidget | None) -> QRect:
    """Where a widget is in the window; empty when it is not to be seen."""
    if widget is None or not widget.isVisible():
        return QRect()
    return QRect(widget.mapTo(host.widget, QPoint(0, 0)), widget.size())


def started_stack(host: Host) -> Stack | None:
    """The stack that runs when the program starts."""
    project = host.workbench.canvas.editor.project
    stacks = project.stacks.values()
    return next((s for s in stacks if project.blocks[s.body[0]].type == START), None)


def say_block(host: Host) -> Block | None:
    """The first block in that stack by which a robot says something."""
    stack = started_stack(host)
    project = host.workbench.canvas.editor.project
    found = (project.blocks[block] for block in (stack.body if stack else ()))
    return next((block for block in found if block.type == SAY), None)


def show_blocks(host: Host) -> None:
    """Show the page and the palette, whatever was hidden."""
    workbench = host.workbench
    palette = workbench.helpers.palette
    workbench.panels.show(palette)
    palette.set_narrow(False)
    workbench.canvas.show_page("behaviour")


def add_say(host: Host) -> None:
    """Put the block there for a person who goes on without."""
    stack, canvas = started_stack(host), host.workbench.canvas
    if stack is not None and say_block(host) is None:
        canvas.attempt(lambda: canvas.editor.create(SAY, InStack(stack.id, 1)))


def _show_say(host: Host) -> None:
    show_blocks(host)
    host.workbench.canvas.sight.show_beginning()
    host.workbench.helpers.palette.open_drawer("robot")


def _palette_and_page(host: Host) -> QRect:
    workbench = host.workbench
    page = place_of(host, workbench.canvas)
    return place_of(host, workbench.helpers.palette).united(page)


def _say_place(host: Host) -> QRect:
    """Where the block is on the page; the page where it is out of sight."""
    canvas, block = host.workbench.canvas, say_block(host)
    page = place_of(host, canvas.viewport())
    rect = canvas.sight.view_rect_of(block.id) if block is not None else None
    if rect is None:
        return page
    seen = rect.toAlignedRect().translated(page.topLeft()).intersected(page)
    return seen if seen.height() >= rect.height() / 2 else page


def _has_own_words(host: Host) -> bool:
    canvas, block = host.workbench.canvas, say_block(host)
    if block is None or canvas.fields.widget is not None:
        return False
    usual = canvas.editor.language.definitions[SAY].defaults["text"]
    return "text" in block.inputs or block.fields.get("text", usual) != usual


def _run_button(host: Host) -> QRect:
    run = host.actions["run"]
    buttons = host.widget.findChildren(QToolButton)
    return place_of(host, next((one for one in buttons if one.defaultAction() is run), None))


def _is_running(host: Host) -> bool:
    return host.services.runner.state != "idle"

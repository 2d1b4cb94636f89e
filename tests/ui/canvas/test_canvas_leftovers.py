"""What is on the screen after each step is what a canvas shows that is painted whole."""

from __future__ import annotations

import random

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QImage, QMouseEvent
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.edits.content import SetField, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.errors import EditRefused
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.running.stage import RunOverlay
from nep_studio.ui.theme.colours import load_theme
from tests.ui.canvas.test_canvas_layers import many_stacks

FEW = 80
"""So many pixels differ where a letter is smoothed otherwise at the edge of a part."""

LEFT, NONE = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton

KINDS = ("text", "flag", "fold", "delete", "stack", "pan", "undo", *["drag"] * 4)


@pytest.fixture
def view(qtbot) -> Canvas:
    view = Canvas(many_stacks(), load_theme("light"))
    qtbot.addWidget(view)
    view.resize(700, 600)
    with qtbot.waitExposed(view):
        view.show()
    view.setFocus()
    return view


def on_screen(view: Canvas) -> QImage:
    """What the screen shows now, part by part as it was painted."""
    QApplication.sendPostedEvents()
    QApplication.processEvents()
    return (
        view.screen().grabWindow(view.winId()).toImage().convertToFormat(QImage.Format.Format_RGB32)
    )


def painted_whole(view: Canvas) -> QImage:
    view.repaint_all()
    return on_screen(view)


def differing(one: QImage, other: QImage) -> int:
    """How many pixels differ by more than smooth edges do."""
    assert one.size() == other.size()
    first, second = (
        np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
        for image in (one, other)
    )
    apart = np.abs(first.astype(np.int16) - second.astype(np.int16))
    return int(np.count_nonzero(apart > 64))


def mouse(view: Canvas, kind: QEvent.Type, at: QPointF, button, held) -> None:
    place = QPointF(view.viewport().mapToGlobal(at.toPoint()))
    event = QMouseEvent(kind, at, place, button, held, Qt.KeyboardModifier.NoModifier)
    QApplication.sendEvent(view.viewport(), event)


def drag(view: Canvas, chance: random.Random) -> None:
    """Take a block along, let it be drawn on its way, and drop it or not."""
    block = chance.choice(list(view.editor.project.blocks))
    rect = view.sight.view_rect_of(block)
    if rect is None or not rect.intersects(view.viewport().rect()):
        return
    at = rect.topLeft() + QPointF(5, 12)
    mouse(view, QEvent.Type.MouseButtonPress, at, LEFT, LEFT)
    for _ in range(5):
        at += QPointF(chance.randrange(-60, 90), chance.randrange(-60, 90))
        mouse(view, QEvent.Type.MouseMove, at, NONE, LEFT)
        on_screen(view)
    if chance.random() < 0.5:
        view.pointing.cancel()
    mouse(view, QEvent.Type.MouseButtonRelease, at, LEFT, NONE)


def step(view: Canvas, chance: random.Random) -> str:
    editor, project = view.editor, view.editor.project
    block = chance.choice(list(project.blocks.values()))
    stack = chance.choice(list(project.stacks.values()))
    kind = chance.choice(KINDS)
    try:
        if kind == "text":
            says = [one for one in project.blocks.values() if one.type == "robot.say"]
            if says:
                editor.apply(SetField(chance.choice(says).id, "text", "x" * chance.randrange(60)))
        elif kind == "flag":
            editor.apply(SetFlag(block.id, "disabled", not block.disabled))
        elif kind == "fold":
            editor.apply(SetFlag(block.id, "collapsed", not block.collapsed))
        elif kind == "delete" and len(project.stacks) > 3:
            editor.apply(DeleteBlocks(block.id, 1))
        elif kind == "stack":
            editor.apply(MoveStack(stack.id, chance.randrange(500), chance.randrange(500)))
        elif kind == "pan":
            view.sight.pan(chance.randrange(-80, 80), chance.randrange(-80, 80))
        elif kind == "drag":
            drag(view, chance)
        else:
            editor.history.undo()
    except EditRefused:
        pass
    return kind


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("scale", [1.0, 0.6])
def test_nothing_is_left_over_on_the_screen_after_edits_and_drags(view, seed, scale) -> None:
    chance = random.Random(seed)
    overlay = RunOverlay()
    view.layers.show_overlay(overlay)
    view.sight.zoom(scale, QPointF(0, 0))
    view.layers.sharpen.stop()
    on_screen(view)
    for number in range(12):
        blocks = list(view.editor.project.blocks)
        problems = chance.sample(blocks, min(3, len(blocks)))
        view.problems.show(
            [Diagnostic("error", "x", "behaviour", block, "wrong") for block in problems]
        )
        overlay.marks.glowing = frozenset(chance.sample(blocks, 1))
        overlay.marks.counts.update(chance.sample(blocks, 1))
        view.selection.set(chance.sample(blocks, min(2, len(blocks))))
        view.viewport().update()
        on_screen(view)

        kind = step(view, chance)
        shown = on_screen(view)

        wrong = differing(shown, painted_whole(view))
        assert wrong <= FEW, (kind, number)

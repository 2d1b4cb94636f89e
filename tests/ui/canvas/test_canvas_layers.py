"""The picture of what rests: repaired where it changed, it is the same as one painted anew."""

from __future__ import annotations

import random

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtGui import QImage

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.errors import EditRefused
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.painting.layers import make_sprite
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build


def many_stacks() -> Editor:
    stacks = []
    for number in range(6):
        inner = [B("robot.say", {"text": f"number {number}"}), B("control.wait")]
        stacks.append([B("event.started"), B("control.repeat", bodies={"do": inner})])
    return build(studio_language(), *stacks)


@pytest.fixture
def view(qtbot) -> Canvas:
    view = Canvas(many_stacks(), load_theme("light"))
    qtbot.addWidget(view)
    view.resize(700, 600)
    view.show()
    qtbot.waitExposed(view)
    return view


def picture(view: Canvas) -> QImage:
    return view.viewport().grab().toImage()


def painted_anew(view: Canvas) -> QImage:
    view.repaint_all()
    return picture(view)


def is_same(one: QImage, other: QImage) -> bool:
    """Whether they differ by no more than how smooth edges are rounded in parts of a picture."""
    if one.size() != other.size():
        return False
    first, second = (np.frombuffer(image.constBits(), np.uint8) for image in (one, other))
    apart = np.maximum(first, second) - np.minimum(first, second)
    return int(np.count_nonzero(apart > 64)) < 30


def random_step(view: Canvas, chance: random.Random) -> None:
    editor, project = view.editor, view.editor.project
    block = chance.choice(list(project.blocks.values()))
    stack = chance.choice(list(project.stacks.values()))
    step = chance.randrange(7)
    try:
        if step == 0 and block.type == "robot.say":
            editor.apply(SetField(block.id, "text", "x" * chance.randrange(60)))
        elif step == 1:
            editor.apply(SetFlag(block.id, "disabled", not block.disabled))
        elif step == 2:
            editor.apply(SetFlag(block.id, "collapsed", not block.collapsed))
        elif step == 3 and len(project.stacks) > 3:
            editor.apply(DeleteBlocks(block.id, 1))
        elif step == 4:
            editor.apply(MoveStack(stack.id, chance.randrange(500), chance.randrange(900)))
        elif step == 5:
            view.sight.pan(chance.randrange(-80, 80), chance.randrange(-80, 80))
        else:
            editor.history.undo()
    except EditRefused:
        pass


@pytest.mark.parametrize("seed", range(8))
def test_a_repaired_picture_is_the_same_as_one_painted_anew(view: Canvas, seed) -> None:
    chance = random.Random(seed)
    picture(view)

    for _ in range(12):
        random_step(view, chance)
        repaired = picture(view)

        assert is_same(repaired, painted_anew(view))


def test_zooming_stretches_the_picture_at_once_and_sharpens_it_when_it_rests(view, qtbot) -> None:
    picture(view)

    view.sight.zoom(1.7, QPointF(100, 100))
    stretched = picture(view)
    qtbot.waitUntil(lambda: not view.layers.sharpen.isActive())
    sharp = picture(view)

    assert not is_same(stretched, sharp)
    assert is_same(sharp, painted_anew(view))


def test_a_page_of_another_name_is_shown_empty(view: Canvas) -> None:
    view.show_page("robots")

    assert view.page_layout.bounds() is None
    assert view.page == "robots"


def test_the_scroll_bars_reach_over_the_whole_page(view: Canvas) -> None:
    bar = view.verticalScrollBar()

    bar.setValue(bar.maximum())

    bounds = view.page_layout.bounds()
    assert view.sight.visible_page_rect().bottom >= bounds.bottom


def test_fitting_shows_every_block(view: Canvas) -> None:
    view.sight.fit()

    bounds, seen = view.page_layout.bounds(), view.sight.visible_page_rect()
    assert seen.holds(bounds.x, bounds.y)
    assert seen.holds(bounds.right, bounds.bottom)


@pytest.mark.parametrize("scale", [0.1, 0.4, 1.0, 4.0])
def test_a_repaired_picture_is_right_at_this_zoom(view: Canvas, scale) -> None:
    chance = random.Random(7)
    view.sight.zoom(scale, QPointF(60, 60))
    view.layers.sharpen.stop()
    picture(view)

    for _ in range(10):
        random_step(view, chance)
        repaired = picture(view)

        assert is_same(repaired, painted_anew(view))


@pytest.mark.parametrize("scale", [0.5, 1.0, 1.3])
def test_a_sprite_is_drawn_exactly_over_the_blocks_that_it_shows(view, scale) -> None:
    view.sight.zoom(scale, QPointF(0, 0))
    view.layers.sharpen.stop()
    stack, chain = next(iter(view.page_layout.chains.items()))
    block = next(b.id for b in view.editor.project.blocks.values() if b.type == "robot.say")
    placed = view.page_layout.placed(block)
    inside = view.sight.camera.view_rect(placed.rect).toAlignedRect().adjusted(3, 3, -3, -3)
    before = view.viewport().grab(inside).toImage()

    view.layers.set_sprite(make_sprite(view, [chain], view.page_layout.index.rects[stack]))

    assert is_same(view.viewport().grab(inside).toImage(), before)


def test_a_new_size_is_never_shown_unpainted_while_zooming(view: Canvas) -> None:
    view.sight.zoom(1.7)

    view.resize(900, 650)

    assert view.layers.sharpen.isActive()
    shown = picture(view)
    view.layers.sharpen.stop()
    assert is_same(shown, painted_anew(view))

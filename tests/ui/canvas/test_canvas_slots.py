"""Slots take what is held over them: wherever over them, the innermost first."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF

from nep_studio.blocks.places import InInput
from nep_studio.ui.canvas.editing.snapping import (
    PREFERENCE_PX,
    RADIUS_PX,
    Ends,
    Ground,
    Target,
    ends_of,
    search,
    slots,
)
from nep_studio.ui.canvas.layout.page import PageLayout
from nep_studio.ui.canvas.painting.painter import choice_tint
from tests.blocks.block_building import B
from tests.ui.canvas.test_canvas_snapping import (
    PAGES,
    PLACES,
    all_slots,
    fits,
    page_of,
    say,
    stack,
    story,
)


@pytest.fixture
def page() -> PageLayout:
    return page_of(story(), [say("loose")])


@given(st.sampled_from(PAGES), PLACES)
def test_the_slot_that_is_found_is_the_nearest_of_all_and_the_innermost(page, point):
    found = search(Ground(page), Ends(output=point), fits).target

    rects = {InInput(block, key): rect for block, key, rect in all_slots(page)}
    nearest = min(rect.distance(*point) for rect in rects.values())
    if found is None:
        assert nearest > RADIUS_PX
    else:
        rect = rects[found.place]
        over = [each for each in rects.values() if each.holds(*point)]
        assert rect.distance(*point) == nearest
        assert not over or rect.width == min(each.width for each in over)


@given(st.sampled_from(PAGES), PLACES)
def test_a_slot_that_is_shown_stays_until_another_is_clearly_nearer(page, point):
    ground, rects = Ground(page), {InInput(b, key): rect for b, key, rect in all_slots(page)}
    shown = search(ground, Ends(output=point), fits).target
    beside = (point[0] + PREFERENCE_PX / 4, point[1] + PREFERENCE_PX / 4)

    found = search(ground, Ends(output=beside), fits, current=shown).target

    if shown is not None:
        assert found is not None
        is_over = rects[found.place].distance(*beside) == 0.0
        assert found == shown or is_over  # another takes over only right under the pointer


@pytest.mark.parametrize("is_mirrored", [False, True])
@pytest.mark.parametrize("share", [0.02, 0.3, 0.6, 0.98])
def test_all_of_a_wide_empty_hole_takes_a_condition(is_mirrored, share):
    page = page_of([B("event.started"), B("control.if")], is_mirrored=is_mirrored)
    block = stack(page).body[1]
    rect = dict(slots(page.placed(block)))["condition"]
    point = (rect.x + rect.width * share, rect.y + rect.height * 0.8)

    found = search(Ground(page), Ends(output=point), fits)

    assert found.target.place == InInput(block, "condition")


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_slot_takes_what_is_held_over_it_with_its_body(is_mirrored):
    page = page_of([B("control.if")], [B("logic.compare")], is_mirrored=is_mirrored)
    block, side = stack(page).body[0], -1 if is_mirrored else 1
    rect = dict(slots(page.placed(block)))["condition"]
    ends = ends_of(page.chains[stack(page, 1).id])
    way = ends.inner[0] - ends.output[0]
    first = rect.right if is_mirrored else rect.x
    output = (first - side * (RADIUS_PX + 2), rect.y + 4)

    assert way * side > RADIUS_PX / 2
    assert search(Ground(page), Ends(output=output), fits).target is None
    found = search(Ground(page), Ends(output=output, inner=(output[0] + way, output[1])), fits)
    assert found.target.place == InInput(block, "condition")


def test_a_slot_inside_the_shown_one_takes_over_where_it_is(page):
    repeat = page.project.blocks[stack(page).body[1]]
    inner = repeat.inputs["times"]
    rect = dict(slots(page.placed(inner)))["b"]
    outer = Target(InInput(repeat.id, "times"), "input", 0.0, 0.0)
    inside = Ends(output=(rect.x + rect.width / 2, rect.y + rect.height / 2))
    ground = Ground(page)

    found = search(ground, inside, fits, current=outer).target
    just_outside = Ends(output=(rect.x - 3, rect.y + rect.height / 2))

    assert found.place == InInput(inner, "b")
    assert search(ground, just_outside, fits, current=found).target.place == found.place
    assert search(ground, just_outside, fits, current=outer).target.place == outer.place


@pytest.mark.parametrize("is_mirrored", [False, True])
@pytest.mark.parametrize("share", [0.1, 0.9])
def test_a_condition_dropped_anywhere_on_a_wide_hole_is_plugged_in(desk, share, is_mirrored):
    desk = desk([B("control.if")], [B("logic.compare")], is_mirrored=is_mirrored)
    [block], [condition] = desk.body(0), desk.body(1)
    placed = desk.canvas.page_layout.placed(block)
    hole = next(piece for piece in placed.box.pieces if piece.key == "condition")
    x, y = placed.x + piece_x(hole, share), placed.y + hole.y + hole.height / 2
    grabbed = desk.canvas.sight.view_rect_of(condition)
    start = (
        grabbed.topRight() + QPointF(-6, 6) if is_mirrored else grabbed.topLeft() + QPointF(6, 6)
    )

    desk.mouse.drop(start, desk.canvas.sight.camera.to_view(x, y))

    assert desk.editor.project.blocks[block].inputs == {"condition": condition}


def piece_x(piece, share: float) -> float:
    """A point along a piece, in its block."""
    return piece.x + piece.width * share


def test_what_is_typed_in_is_painted_white_and_what_is_chosen_in_the_tint_of_its_block(
    desk,
) -> None:
    desk = desk([B("robot.say", {"text": "hello"})])
    [say] = desk.body()
    colours = desk.canvas.look.theme.block("robot")
    picture = desk.canvas.viewport().grab().toImage()

    def fill(key: str) -> str:
        placed = desk.canvas.page_layout.placed(say)
        piece = next(piece for piece in placed.box.pieces if piece.key == key)
        at = desk.canvas.sight.camera.to_view(placed.x + piece.x, placed.y + piece.y)
        return picture.pixelColor((at + QPointF(piece.width / 2, 3)).toPoint()).name()

    assert fill("text") == "#ffffff"
    assert fill("robot") == fill("gesture") == choice_tint(colours).name() != colours.fill.name()

"""The layout: what is where, and that only what changed is made anew."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks, MoveBlocks
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InBody, InStack
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.layout.boxes import Box, Chain, Measures
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Gap
from nep_studio.ui.canvas.layout.page import PageLayout, boxes_of
from tests.blocks.block_building import B, build

LINE = 18.0
EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


def measures(*, is_mirrored: bool = False) -> Measures:
    return Measures(LINE, lambda text: 8.0 * len(text), is_mirrored=is_mirrored)


def story() -> list[B]:
    inner = B("robot.say", {"text": "inside"})
    number = B("math.arithmetic", {"a": 1, "b": 2})
    return [
        B("event.started"),
        B("control.repeat", {}, {"times": number}, {"do": [inner, B("control.wait")]}),
        B("robot.say", {"text": "after"}),
    ]


def shown(layout: PageLayout) -> dict[str, Rect]:
    return {p.box.block: p.rect for p in layout.boxes(EVERYWHERE)}


def insides(chain: Chain) -> Iterator[Box]:
    return (placed.box for placed in boxes_of(chain, EVERYWHERE))


def test_blocks_of_a_chain_are_directly_below_each_other(language: Language) -> None:
    editor = build(language, story())
    layout = PageLayout(editor.project, editor.language, measures())

    chain = next(iter(layout.chains.values()))

    assert chain.ys[0] == 0
    for upper, lower, box in zip(chain.ys, chain.ys[1:], chain.boxes, strict=False):
        assert lower - upper == box.height


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_what_is_inside_a_block_is_inside_its_outline(language: Language, is_mirrored) -> None:
    editor = build(language, story())
    layout = PageLayout(editor.project, editor.language, measures(is_mirrored=is_mirrored))

    for box in insides(next(iter(layout.chains.values()))):
        for piece in box.pieces:
            assert piece.x >= 0 and piece.x + piece.width <= box.width
            assert piece.y >= 0 and piece.y + piece.height <= box.height
        for plug in box.plugs:
            assert plug.x >= 0 and plug.x + plug.box.width <= box.width


def test_a_mirrored_page_has_the_same_blocks_left_and_right_exchanged(language) -> None:
    editor = build(language, story())
    plain = shown(PageLayout(editor.project, editor.language, measures()))

    mirrored = shown(PageLayout(editor.project, editor.language, measures(is_mirrored=True)))

    axis = editor.project.pages["behaviour"][0].x
    for block, rect in plain.items():
        assert mirrored[block].right == pytest.approx(2 * axis - rect.x)
        assert mirrored[block][1:] == pytest.approx(rect[1:])


def test_an_edit_gives_the_layout_that_a_fresh_one_would_give(language: Language) -> None:
    editor = build(language, story(), [B("event.started"), B("control.wait")])
    layout = PageLayout(editor.project, editor.language, measures())
    editor.history.listen(layout.change)
    say = next(b.id for b in editor.project.blocks.values() if b.fields.get("text") == "inside")
    repeat = next(b.id for b in editor.project.blocks.values() if b.type == "control.repeat")
    other = editor.project.pages["behaviour"][1].id

    editor.apply(SetField(say, "text", "a much longer text than before, so that it grows"))
    editor.apply(MoveBlocks(say, 1, InStack(other, 2)))
    editor.apply(DeleteBlocks(repeat, 1))
    editor.history.undo()
    editor.apply(MoveBlocks(say, 1, InBody(repeat, "do", 0)))

    assert shown(layout) == shown(PageLayout(editor.project, editor.language, measures()))


def test_an_edit_leaves_the_boxes_of_other_blocks_as_they_are(language: Language) -> None:
    editor = build(language, story(), story())
    layout = PageLayout(editor.project, editor.language, measures())
    editor.history.listen(layout.change)
    first, second = editor.project.pages["behaviour"]
    other_boxes = layout.chains[second.id].boxes

    editor.apply(SetField(first.body[2], "text", "new"))

    assert layout.chains[second.id].boxes is other_boxes
    assert layout.layout.box(first.body[1]) is layout.chains[first.id].boxes[1]


def test_carried_blocks_leave_no_hole_and_a_gap_is_as_high_as_they_are(language) -> None:
    editor = build(language, story())
    layout = PageLayout(editor.project, editor.language, measures())
    stack = editor.project.pages["behaviour"][0]
    repeat = stack.body[1]
    before = layout.chains[stack.id].height
    carried = layout.layout.box(repeat).height

    layout.update(layout.layout.preview(frozenset({repeat}), None))
    closed = layout.chains[stack.id].height
    layout.update(layout.layout.preview(frozenset({repeat}), Gap(stack.id, "", 2, 100.0, carried)))
    open_again = layout.chains[stack.id].height
    layout.update(layout.layout.preview(frozenset(), None))

    assert closed == before - carried
    assert open_again == before
    assert shown(layout) == shown(PageLayout(editor.project, editor.language, measures()))


def test_a_point_is_on_the_innermost_block(language: Language) -> None:
    editor = build(language, story())
    layout = PageLayout(editor.project, editor.language, measures())

    for block, rect in shown(layout).items():
        hit = layout.hit(rect.x + 1.5, rect.y + rect.height / 2)
        if editor.project.blocks[block].bodies or hit is None:
            continue  # the middle of a C block is its mouth
        inside = {b.id for b in editor.project.within([block])}
        assert hit.block in inside


def test_the_room_beside_the_blocks_in_a_mouth_is_no_block(language: Language) -> None:
    editor = build(language, [B("event.started"), B("control.forever")])
    layout = PageLayout(editor.project, editor.language, measures())
    forever = editor.project.pages["behaviour"][0].body[1]
    placed = layout.placed(forever)

    mouth = placed.box.mouths[0]
    hit = layout.hit(placed.x + mouth.x + 10, placed.y + mouth.y + 10)

    assert hit is None


def test_a_block_of_an_unknown_type_shows_its_type_and_keeps_its_bodies(language) -> None:
    editor = build(language, story())
    repeat = next(b for b in editor.project.blocks.values() if b.type == "control.repeat")
    repeat.type = "pack.unknown"

    layout = PageLayout(editor.project, editor.language, measures())

    box = layout.layout.box(repeat.id)
    assert any("pack.unknown" in piece.text for piece in box.pieces)
    assert len(box.mouths) == 1
    assert len(box.plugs) == 1


def test_a_stack_of_ten_thousand_blocks_is_laid_out_without_recursion(language) -> None:
    deep = B("control.repeat")
    for _ in range(300):
        deep = B("control.repeat", bodies={"do": [deep]})
    editor = build(language, [B("event.started"), deep])

    layout = PageLayout(editor.project, editor.language, measures())

    assert len(shown(layout)) == 302

"""Sentences laid out: nothing overlaps, nothing is outside its block, words stay with fields."""

from __future__ import annotations

from itertools import combinations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddGroup, SetField
from nep_studio.blocks.program import Parameter, Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.layout.boxes import Box, Measures, Piece, TextWidths
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import PageLayout, boxes_of
from nep_studio.ui.canvas.layout.pieces import flow
from nep_studio.ui.theme.look import text_font
from nep_studio.ui.words import PSEUDO, use_language
from tests.blocks.block_building import B, build

LANGUAGE = studio_language()
EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)
LOOKS = {"light": (11.0, False), "mirrored": (11.0, True), "large": (24.0, False)}


def measures(points: float, *, is_mirrored: bool) -> Measures:
    assert QApplication.instance() is not None
    widths = TextWidths(text_font(points))
    return Measures(widths.line, widths.__getitem__, is_mirrored=is_mirrored)


def editor_with(block_type: str) -> tuple[Editor, str]:
    """A block with one part more than it must have of each group."""
    editor = Editor(Project("Test"), LANGUAGE)
    definition = editor.language.definitions[block_type]
    block = editor.create(block_type, editor.new_stack(definition.page, 0, 0))
    for name, group in definition.groups.items():
        count = editor.project.blocks[block].groups[name]
        if count < group.maximum:
            slots = definition.group_slots(name)
            fields = {s: definition.defaults[s] for s in slots if s in definition.defaults}
            editor.apply(AddGroup(block, name, count + 1, slots, fields))
    return editor, block


def assert_tidy(box: Box) -> None:
    """No two parts of a block overlap, and all are inside it."""
    parts = [(p.x, p.y, p.width, p.height) for p in box.pieces]
    parts += [(p.x, p.y, p.box.width, p.box.height) for p in box.plugs]
    for x, y, width, height in parts:
        assert x >= -0.01 and x + width <= box.width + 0.01
        assert y >= -0.01 and y + height <= box.height + 0.01
    for a, b in combinations(parts, 2):
        is_beside = a[0] + a[2] <= b[0] + 0.01 or b[0] + b[2] <= a[0] + 0.01
        is_below = a[1] + a[3] <= b[1] + 0.01 or b[1] + b[3] <= a[1] + 0.01
        assert is_beside or is_below, (box.type, a, b)


@pytest.mark.parametrize("look", LOOKS)
def test_every_block_is_tidy(qapp, look) -> None:
    points, is_mirrored = LOOKS[look]
    measured = measures(points, is_mirrored=is_mirrored)
    for block_type in LANGUAGE.definitions:
        editor, block = editor_with(block_type)

        assert_tidy(PageLayout(editor.project, editor.language, measured).layout.box(block))


def test_every_block_is_tidy_in_longer_words(qapp) -> None:
    use_language(PSEUDO)
    try:
        for block_type in LANGUAGE.definitions:
            editor, block = editor_with(block_type)
            look = measures(11, is_mirrored=True)
            assert_tidy(PageLayout(editor.project, editor.language, look).layout.box(block))
    finally:
        use_language("en")


TEXTS = st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=120)


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(texts=st.lists(TEXTS, min_size=1, max_size=6), look=st.sampled_from(sorted(LOOKS)))
def test_random_programs_are_tidy(qapp, texts, look) -> None:
    points, is_mirrored = LOOKS[look]
    says = [B("robot.say", {"text": text}) for text in texts]
    joined = B("text.join", {"item.1": texts[0]}, {"item.2": B("text.text", {"text": texts[-1]})})
    inner = B("robot.say", {}, {"text": joined})
    editor = build(LANGUAGE, [B("control.repeat", {}, {}, {"do": [*says, inner]}), *says])
    layout = PageLayout(editor.project, editor.language, measures(points, is_mirrored=is_mirrored))

    for chain in layout.chains.values():
        for placed in boxes_of(chain, EVERYWHERE):
            assert_tidy(placed.box)


def words(text: str, width: float) -> Piece:
    return Piece("words", 0, 0, width, 18, text)


def field(width: float) -> Piece:
    return Piece("field", 0, 0, width, 24, "x", "slot", "text", "square")


def plain_measures() -> Measures:
    return Measures(18.0, lambda text: 8.0 * len(text))


def test_a_short_word_wraps_with_the_field_that_it_announces() -> None:
    rows = flow([field(300), words("with", 32), field(200)], plain_measures())

    assert [len(row.items) for row in rows] == [1, 2]


def test_a_comma_stays_with_the_field_before_it() -> None:
    rows = flow([field(455), words(",", 8), words("then", 32)], plain_measures())

    assert [len(row.items) for row in rows] == [2, 1]


def test_an_empty_place_says_what_it_takes(qapp) -> None:
    editor, block = editor_with("control.while")

    box = PageLayout(editor.project, editor.language, measures(11, is_mirrored=False)).layout.box(
        block
    )

    assert [p.hint for p in box.pieces if p.piece == "socket"] == ["yes or no?"]


def test_a_long_text_is_cut(qapp) -> None:
    editor, block = editor_with("robot.say")
    editor.apply(SetField(block, "text", "word " * 200))
    look = measures(11, is_mirrored=False)

    box = PageLayout(editor.project, editor.language, look).layout.box(block)

    shown = next(p for p in box.pieces if p.key == "text")
    assert shown.text.endswith("…")
    assert shown.width <= look.widest_field + 3 * look.field_pad


def test_a_unit_is_not_said_twice(qapp) -> None:
    editor, block = editor_with("robot_moves.move_joint")

    box = PageLayout(editor.project, editor.language, measures(11, is_mirrored=False)).layout.box(
        block
    )

    assert next(p.text for p in box.pieces if p.kind == "angle") == "30"


def test_a_header_shows_its_parameters_in_the_shapes_of_their_blocks(qapp) -> None:
    editor = Editor(Project("Test"), LANGUAGE)
    given = [Parameter("a1", "name", "text"), Parameter("a2", "polite", "boolean")]
    place = editor.new_stack("behaviour", 0, 0)
    editor.add_procedure(["greet", *given], place=place)
    layout = PageLayout(editor.project, editor.language, measures(11, is_mirrored=False))

    box = layout.chains[place.stack].boxes[0]

    pills = [(p.text, p.shape) for p in box.pieces if p.kind == "parameter"]
    assert pills == [("name", "square"), ("polite", "hexagon")]


def said(text: str) -> Piece:
    return words(text, 8.0 * len(text))


def test_a_unit_never_begins_a_row() -> None:
    sizes = Measures(18.0, lambda text: 8.0 * len(text))
    number = Piece("field", 0, 0, sizes.widest - 2, 24.0, "1", "length", "number")

    rows = flow([number, said("m"), said("forward")], sizes)

    assert [[item.text for item in row.items] for row in rows] == [["1", "m"], ["forward"]]


def test_a_unit_stays_with_its_number_when_words_follow_it() -> None:
    editor, block = editor_with("robot_speech.wait_for_word")
    page = PageLayout(editor.project, editor.language, measures(11.0, is_mirrored=False))

    texts = [piece.text for piece in page.placed(block).box.pieces if piece.piece == "words"]

    assert "s" in texts
    assert "for the word" in texts


def test_nothing_is_added_after_wide_punctuation() -> None:
    sizes = Measures(18.0, lambda text: 8.0 * len(text))

    [row] = flow([said("聞いて、"), said("待つ")], sizes)

    assert row.width == sum(item.width for item in row.items)


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_the_first_answer_to_a_question_begins_a_row(is_mirrored) -> None:
    editor, block = editor_with("robot_speech.ask")
    page = PageLayout(editor.project, editor.language, measures(11.0, is_mirrored=is_mirrored))
    box = page.placed(block).box

    asked = next(piece for piece in box.pieces if piece.key == "seconds")
    answer = next(piece for piece in box.pieces if piece.key == "word.1")
    others = [piece for piece in box.pieces if piece.piece == "field" and piece is not answer]

    assert answer.y > asked.y + asked.height
    assert answer.y + answer.height <= box.mouths[0].y
    assert all(piece.y + piece.height <= answer.y for piece in others if piece.y < box.mouths[0].y)

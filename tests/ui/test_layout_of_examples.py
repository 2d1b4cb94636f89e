"""Blocks have room for what they say: the examples and every definition, in all languages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import combinations

import pytest
from PySide6.QtGui import QFont, QFontMetricsF
from PySide6.QtWidgets import QApplication

from nep_studio import paths
from nep_studio.blocks.definitions import Group, Part
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddGroup, SetField
from nep_studio.blocks.files import load
from nep_studio.blocks.language import Language, translated
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.layout.boxes import Box, Measures, Piece, TextWidths
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import PageLayout, Placed
from nep_studio.ui.canvas.layout.pieces import HINT_SIZE
from nep_studio.ui.theme.colours import load_theme, themes
from nep_studio.ui.theme.look import text_font
from nep_studio.ui.words import PSEUDO, use_language
from tests.conftest import a_part_of

BLOCK_FONT_POINTS = 10.5
LARGE = 1.6
EVERYWHERE = Rect(-1e6, -1e6, 2e6, 2e6)
A_HAIR = 0.01
EXAMPLES = sorted(paths.examples().glob("*.nep"))
TABLES = sorted(path.stem for path in (paths.resources() / "translations").glob("*.toml"))
LANGUAGES = ["en", *TABLES, PSEUDO]


@cache
def language_of(code: str) -> Language:
    """A language; the made-up one says everything at greater length."""
    if code != PSEUDO:
        return studio_language(code)
    english = studio_language()
    return translated(english, {"blocks": longer_sentences(english)})


def longer_sentences(language: Language) -> dict[str, str]:
    """The table of a language in which the words of every block are two fifths longer."""
    return {key: sentence_of(each.parts) for key, each in language.definitions.items()}


def sentence_of(parts: Iterable[Part]) -> str:
    said = []
    for part in parts:
        if isinstance(part, Group):
            said.append(f"[{part.name}: {sentence_of(part.parts)}]")
        else:
            said.append(longer(part) if isinstance(part, str) else f"{{{part.name}}}")
    return "".join(said)


def longer(words: str) -> str:
    return re.sub(r"\w+", lambda found: found[0] + "·" * round(0.4 * len(found[0])), words)


@dataclass
class Scene:
    """Blocks that are laid out with a real font."""

    metrics: QFontMetricsF
    hints: QFontMetricsF
    measures: Measures
    layout: PageLayout

    def boxes(self) -> Iterator[Placed]:
        for page in self.layout.project.pages:
            self.layout.show(page)
            yield from self.layout.boxes(EVERYWHERE)

    def words(self, box: Box) -> str:
        return f"{box.type}: {' '.join(piece.text for piece in box.pieces)}"


def scene(project: Project, language: Language, scale: float = 1.0, *, is_mirrored=False) -> Scene:
    font = text_font(BLOCK_FONT_POINTS * scale, QFont.Weight.Medium)
    font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    small = QFont(font)
    small.setPointSizeF(font.pointSizeF() * HINT_SIZE)
    widths = TextWidths(font)
    measures = Measures(widths.line, widths.__getitem__, is_mirrored=is_mirrored)
    layout = PageLayout(project, language, measures)
    return Scene(QFontMetricsF(font), QFontMetricsF(small), measures, layout)


def everything(language: Language) -> Editor:
    """A program with each definition once, with all the parts that a person can add."""
    editor = Editor(Project(), language)
    variable = editor.add_variable("score")
    parameters = [editor.new_parameter("name", "text"), editor.new_parameter("polite", "boolean")]
    editor.add_procedure(["greet", *parameters], place=editor.new_stack("behaviour", 0, 0))
    for definition in list(editor.language.definitions.values()):
        if definition.id.startswith("my.define"):
            continue
        block = editor.create(definition.id, editor.new_stack(definition.page, 0, 0))
        for key, slot in definition.slots.items():
            if slot.kind.name == "variable":
                editor.apply(SetField(block, key, getattr(variable, "id", variable)))
        for name, group in definition.groups.items():
            count = editor.project.blocks[block].groups[name]
            if count < group.maximum:
                slots = definition.group_slots(name)
                given = {s: definition.defaults[s] for s in slots if s in definition.defaults}
                editor.apply(AddGroup(block, name, count + 1, slots, given))
    return editor


@pytest.fixture(autouse=True)
def english_afterwards(qapp: QApplication, fonts) -> Iterator[None]:
    yield
    use_language("en")


@pytest.fixture(params=LANGUAGES)
def language(request: pytest.FixtureRequest) -> Language:
    """Each language in turn; hints and counts are in its words too."""
    use_language(request.param)
    return language_of(request.param)


@pytest.fixture(params=a_part_of(EXAMPLES), ids=lambda path: path.stem)
def example(request: pytest.FixtureRequest, language: Language) -> Project:
    return load(request.param, language)


# What may not happen


def text_too_wide(piece: Piece, scene: Scene) -> bool:
    """Whether the words of a piece need more room than the piece has."""
    measures, lines = scene.measures, piece.text.split("\n")
    width = max(scene.metrics.horizontalAdvance(line) for line in lines)
    if piece.kind in ("colour", "checkbox"):
        return False
    if not piece.text:
        return scene.hints.horizontalAdvance(piece.hint) > piece.width + A_HAIR
    room = piece.width
    if piece.piece == "button":
        room -= piece.height + measures.gap
    elif piece.piece == "field":
        room -= marks_width(piece, measures)
    return width > room + A_HAIR


def marks_width(piece: Piece, measures: Measures) -> float:
    """What the arrow or the drawing in a field takes away from its text."""
    opens = {"choice", "gesture", "robot", "variable", "state", "settings"}
    arrow = 0.75 * (piece.kind in opens)
    lead = 0.95 * (piece.kind == "angle")
    return measures.line * (arrow + lead)


def text_too_high(piece: Piece, scene: Scene) -> bool:
    """Whether letters reach out of the row that the piece is in."""
    ink = scene.metrics.tightBoundingRect(piece.text.split("\n")[0])
    return bool(piece.text) and ink.height() > scene.measures.field_height + A_HAIR


def clipped(scene: Scene) -> list[str]:
    return [
        f"{scene.words(placed.box)} ({piece.text or piece.hint})"
        for placed in scene.boxes()
        for piece in placed.box.pieces
        if text_too_wide(piece, scene) or text_too_high(piece, scene)
    ]


def parts(box: Box) -> list[Rect]:
    """The pieces and the plugged blocks of a box."""
    pieces = [Rect(p.x, p.y, p.width, p.height) for p in box.pieces]
    return pieces + [Rect(p.x, p.y, p.box.width, p.box.height) for p in box.plugs]


def is_over(one: Rect, other: Rect) -> bool:
    """Whether two rectangles share more than an edge."""
    wide = min(one.right, other.right) - max(one.x, other.x)
    high = min(one.bottom, other.bottom) - max(one.y, other.y)
    return wide > A_HAIR and high > A_HAIR


def mouths(box: Box, scene: Scene) -> list[Rect]:
    """The openings of a box, from the arm to its far side, with what is in them."""
    found = []
    for number, mouth in enumerate(box.mouths):
        height = box.segments[2 * number + 1]
        assert mouth.height <= height + A_HAIR
        left = 0.0 if box.is_mirrored else mouth.x
        far = mouth.x if box.is_mirrored else box.width
        found.append(Rect(left, mouth.y, far - left, height))
    return found


def overlaps(scene: Scene) -> list[str]:
    return [
        scene.words(placed.box)
        for placed in scene.boxes()
        for one, other in combinations([*parts(placed.box), *mouths(placed.box, scene)], 2)
        if is_over(one, other)
    ]


def outside(scene: Scene) -> list[str]:
    return [
        scene.words(placed.box)
        for placed in scene.boxes()
        for part in [*parts(placed.box), *mouths(placed.box, scene)]
        if part.x < -A_HAIR
        or part.y < -A_HAIR
        or part.right > placed.box.width + A_HAIR
        or part.bottom > placed.box.height + A_HAIR
    ]


def stacks_over_each_other(scene: Scene) -> list[tuple[str, str]]:
    found = []
    for page in scene.layout.project.pages:
        scene.layout.show(page)
        rects = {stack: scene.layout.index.rects[stack] for stack in scene.layout.chains}
        found += [(a, b) for a, b in combinations(rects, 2) if is_over(rects[a], rects[b])]
    return found


# The examples


@pytest.mark.parametrize("is_mirrored", [False, True], ids=["left", "right"])
def test_examples_are_shown_without_clipped_words_and_overlaps(example, language, is_mirrored):
    shown = scene(example, language, is_mirrored=is_mirrored)

    assert clipped(shown) == []
    assert overlaps(shown) == []
    assert outside(shown) == []
    assert stacks_over_each_other(shown) == []


def test_examples_have_room_for_large_letters(example, language) -> None:
    shown = scene(example, language, LARGE)

    assert clipped(shown) == []
    assert overlaps(shown) == []
    assert outside(shown) == []


def test_no_theme_changes_where_blocks_are(qtbot, example, language) -> None:
    font = text_font(BLOCK_FONT_POINTS, QFont.Weight.Medium)
    places = []

    for name in themes():
        view = Canvas(Editor(example, language), load_theme(name), font=font)
        qtbot.addWidget(view)
        boxes = view.page_layout.boxes(EVERYWHERE)
        places.append([(placed.box.block, placed.rect) for placed in boxes])

    assert all(each == places[0] for each in places)


# Every definition


@pytest.mark.parametrize("scale", [1.0, LARGE])
@pytest.mark.parametrize("is_mirrored", [False, True], ids=["left", "right"])
def test_every_block_has_room_for_its_words(language, scale, is_mirrored) -> None:
    editor = everything(language)

    shown = scene(editor.project, editor.language, scale, is_mirrored=is_mirrored)

    assert clipped(shown) == []
    assert overlaps(shown) == []
    assert outside(shown) == []


def test_a_block_with_too_little_room_is_found(language) -> None:
    """The checks themselves: a piece that is made narrower, moved away, or put over another."""
    editor = everything(language)
    shown = scene(editor.project, editor.language)
    say = next(placed.box for placed in shown.boxes() if placed.box.type == "robot.say")
    say.pieces[0].width -= 20
    say.pieces[1].x = say.pieces[0].x
    say.pieces[2].x = say.width

    assert clipped(shown) and overlaps(shown) and outside(shown)

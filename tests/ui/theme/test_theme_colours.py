"""The tables of colours: whole, readable, and told apart by every eye."""

from __future__ import annotations

import dataclasses
import itertools
import tomllib

import pytest
from colour_seeing import EYES, Matrix, contrast, distance
from PySide6.QtGui import QColor

from nep_studio import paths
from nep_studio.ui.canvas.painting.painter import choice_tint
from nep_studio.ui.theme.colours import (
    DISABLED,
    HIGH_CONTRAST,
    PLACEHOLDER,
    Theme,
    UnknownColour,
    load_theme,
    themes,
    to_colour,
)
from nep_studio.ui.theme.icons import CATEGORY_ICONS

WORDS = [
    (words, ground)
    for grounds, all_words in (
        (("canvas", "panel", "panel_alt", "hover", "menu"), ("text", "muted")),
        (("canvas", "panel", "menu"), ("error", "warning", "info", "success", "link")),
        (("error_panel", "warning_panel", "info_panel", "success_panel"), ("text", "link")),
        (("field",), ("field_text", "muted", "error", "code_keyword", "code_text", "code_name")),
        (("field", "code_line"), ("code_number", "code_comment", "code_keyword", "code_text")),
        (("field",), tuple(f"plot_{number}" for number in range(1, 7))),
        (("selection",), ("selection_text",)),
        (("accent", "accent_hover"), ("accent_text",)),
        (("tooltip",), ("tooltip_text",)),
        (("run",), ("run_text",)),
        (("stop",), ("stop_text",)),
        (("note",), ("note_text",)),
        (("search_hit", "pressed"), ("text",)),
    )
    for ground in grounds
    for words in all_words
]
SIGNS = [
    (sign, ground)
    for grounds, signs in (
        (("canvas",), ("focus", "snap", "placeholder")),
        (("panel", "field"), ("focus", "accent", "scroll")),
        (("field", "panel"), ("field_line",)),
        (("error_panel",), ("error",)),
        (("warning_panel",), ("warning",)),
        (("info_panel",), ("info",)),
        (("success_panel",), ("success",)),
    )
    for ground in grounds
    for sign in signs
]
MAIN = ("events", "control", "robot", "sensing", "logic", "math", "text", "variables", "my_blocks")
LEAST_DISTANCE, LEAST_DISTANCE_OF_MAIN = 0.05, 0.058


def block_colour(theme: Theme, category: str) -> QColor:
    """What tells the blocks of a category: their fill, or their outline on black."""
    block = theme.block(category)
    return block.line if theme.name == HIGH_CONTRAST else block.fill


def test_there_are_a_light_a_dark_and_a_high_contrast_theme() -> None:
    assert [(name, load_theme(name).is_dark) for name in themes()] == [
        ("light", False),
        ("dark", True),
        ("high_contrast", True),
    ]


def test_every_theme_has_the_same_names(theme: Theme) -> None:
    light = load_theme("light")

    assert theme.colours.keys() == light.colours.keys()
    assert theme.blocks.keys() == light.blocks.keys()
    assert theme.blocks.keys() == {*CATEGORY_ICONS, PLACEHOLDER, DISABLED}


def test_every_category_of_the_shipped_blocks_has_colours_and_an_icon(theme: Theme) -> None:
    used = {
        tomllib.loads(path.read_text(encoding="utf-8"))["category"]["colour"]
        for path in (paths.resources() / "blocks").glob("*.toml")
    }

    assert used <= theme.blocks.keys() & CATEGORY_ICONS.keys()


def test_no_two_categories_share_a_colour() -> None:
    used = [
        tomllib.loads(path.read_text(encoding="utf-8"))["category"]["colour"]
        for path in (paths.resources() / "blocks").glob("*.toml")
    ]

    assert len(used) == len(set(used))


def test_words_can_be_read_on_what_they_stand_on(theme: Theme) -> None:
    least = 7.0 if theme.name == HIGH_CONTRAST else 4.5

    poor = [
        (words, ground, round(found, 2))
        for words, ground in WORDS
        if (found := contrast(theme.colour(words), theme.colour(ground)))
        < (4.5 if ground == "search_hit" else least)
    ]

    assert poor == []


def test_signs_stand_out_from_their_ground(theme: Theme) -> None:
    poor = [
        (sign, ground, round(found, 2))
        for sign, ground in SIGNS
        if (found := contrast(theme.colour(sign), theme.colour(ground))) < 3
    ]

    assert poor == []


def test_words_and_fields_of_blocks_can_be_read(theme: Theme) -> None:
    least = 7.0 if theme.name == HIGH_CONTRAST else 4.5

    poor = [
        (name, round(found, 2))
        for name, block in theme.blocks.items()
        if (found := min(contrast(block.text, block.fill), contrast(block.field_text, block.field)))
        < least
    ]

    assert poor == []


def test_choices_are_tinted_and_can_be_read_and_what_is_typed_in_is_white(theme: Theme) -> None:
    least = 7.0 if theme.name == HIGH_CONTRAST else 4.5

    for name, block in theme.blocks.items():
        tint = choice_tint(block)
        assert contrast(block.text, tint) >= (4.5 if name == DISABLED else least), name
        assert tint != block.fill, name
        if name != DISABLED:
            assert block.field.lightnessF() > 0.93, name
            assert contrast(block.field, tint) >= 1.3, name


def test_where_blocks_land_is_no_warm_colour(theme: Theme) -> None:
    hue = theme.colour("snap").hue()

    assert 150 <= hue <= 200


def test_blocks_stand_out_from_the_canvas_and_fields_from_blocks(theme: Theme) -> None:
    canvas = theme.colour("canvas")

    for name, block in theme.blocks.items():
        on_canvas = max(contrast(block.fill, canvas), contrast(block.line, canvas))
        edges = (
            contrast(block.field, block.fill),
            contrast(block.field_line, block.fill),
            contrast(block.field_line, block.field),
        )

        assert on_canvas >= 3, name
        assert max(edges) >= 3, name


@pytest.mark.parametrize("eye", EYES.values(), ids=EYES)
def test_categories_can_be_told_apart(theme: Theme, eye: Matrix) -> None:
    for one, other in itertools.combinations(CATEGORY_ICONS, 2):
        are_main = {one, other} <= set(MAIN)
        apart = distance(block_colour(theme, one), block_colour(theme, other), eye)

        assert apart >= (LEAST_DISTANCE_OF_MAIN if are_main else LEAST_DISTANCE), (one, other)


def test_no_two_categories_share_an_icon() -> None:
    assert len(set(CATEGORY_ICONS.values())) == len(CATEGORY_ICONS)


def test_a_colour_that_is_not_in_the_table_is_an_error_that_names_it(theme: Theme) -> None:
    with pytest.raises(UnknownColour, match="canvass"):
        theme.colour("canvass")


def test_a_category_colour_of_a_foreign_pack_looks_like_unknown_blocks(theme: Theme) -> None:
    assert theme.block("plaid") is theme.block(PLACEHOLDER)


def test_changing_a_colour_that_was_handed_out_does_not_change_the_theme(theme: Theme) -> None:
    before = theme.colour("canvas")

    theme.colour("canvas").setAlpha(1)

    assert theme.colour("canvas") == before


def test_a_theme_cannot_be_changed(theme: Theme) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        theme.name = "other"  # type: ignore[misc]


def test_a_colour_may_be_see_through() -> None:
    assert to_colour("#11223344").getRgb() == (0x11, 0x22, 0x33, 0x44)


@pytest.mark.parametrize("text", ["red", "#12345", "#1234567", "", "#11223344ff"])
def test_a_colour_that_is_not_hexadecimal_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="#rrggbb"):
        to_colour(text)

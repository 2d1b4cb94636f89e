"""How much the palette shows: a new person's first blocks, a lesson's own, more of them, all."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible, QContextMenuEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.program import FIRST_BLOCKS
from nep_studio.paths import examples
from nep_studio.settings import Settings
from nep_studio.ui.theme.colours import load_theme, themes
from nep_studio.ui.workbench.palette.levels import first_types, offer
from tests.blocks.block_building import B, build
from tests.ui.palette.conftest import LANGUAGE
from tests.ui.palette.palette_use import (
    LEFT,
    click,
    drop,
    grip,
    listed,
    number_of,
    press_and_drag,
    type_of,
    types,
)


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(tmp_path)


def choose(palette, level: str) -> None:
    QTest.mouseClick(palette.levels.buttons[level], LEFT)


def headings(palette) -> list[str]:
    return [entry.text for entry in palette.shelf.entries if entry.kind == "heading"]


def open_menu(palette, block_type: str):
    """What the system sends for a click with the right button on a block of the palette."""
    viewport = palette.shelf.viewport()
    place = grip(palette.shelf, number_of(palette, block_type))
    mouse = QContextMenuEvent.Reason.Mouse
    event = QContextMenuEvent(mouse, place, viewport.mapToGlobal(place))
    QApplication.sendEvent(viewport, event)
    return palette.snippet_menu.menu


def choose_in_menu(palette, block_type: str, words: str) -> None:
    menu = open_menu(palette, block_type)
    action = next(action for action in menu.actions() if action.text() == words)
    QTest.mouseClick(menu, LEFT, pos=menu.actionGeometry(action).center())


def test_a_new_person_sees_few_blocks_under_few_headings(palette):
    assert palette.levels.buttons["first"].isChecked()
    assert headings(palette) == ["When", "Robot", "Control", "Sensing"]
    assert 12 <= len(listed(palette)) <= 18
    assert len(listed(palette)) == len(set(listed(palette)))
    assert not palette.categories.isVisible()


def test_the_karate_story_is_made_of_first_blocks(palette):
    story = {
        "event.started", "robot.do", "robot.say", "event.gesture", "control.together",
        "robot.play", "robot.walk", "robot.leds",
    }  # fmt: skip

    assert story <= set(listed(palette))


def test_the_levels_are_chosen_by_mouse_and_there_again_at_the_next_start(
    palette, settings, tmp_path
):
    counts = {}
    for level in ("more", "all", "first", "more"):
        choose(palette, level)
        counts[level] = len(set(listed(palette)))

    assert counts["first"] < 20 < counts["more"] < 100 < counts["all"]
    assert palette.categories.isVisible()
    assert Settings(tmp_path).palette_level == "more"


def test_the_levels_are_chosen_by_keys(palette, qtbot):
    palette.levels.buttons["first"].setFocus()

    qtbot.keyClick(palette.levels.buttons["first"], Qt.Key.Key_Right)
    qtbot.keyClick(palette.levels.buttons["more"], Qt.Key.Key_Space)

    assert palette.level == "more"
    assert "logic.compare" in listed(palette) and "code.lines" not in listed(palette)


def test_all_has_every_block_and_more_leaves_out_rare_ones_only(palette):
    choose(palette, "all")
    every = set(listed(palette))
    choose(palette, "more")
    more = set(listed(palette))

    rare = {one for one in every if offer().is_rare(LANGUAGE.definitions[one])}
    assert more == every - rare
    assert set(offer().usual) <= more


def test_what_the_levels_name_is_there():
    categories = {category.id for category in LANGUAGE.categories}
    named = {one for heading in offer().headings for one in (heading.category, *heading.joins)}

    assert set(offer().usual) | offer().rare_blocks <= LANGUAGE.definitions.keys()
    assert named | offer().rare_categories <= categories


def test_a_strange_level_in_the_settings_is_that_of_a_new_person(settings, canvas):
    from nep_studio.ui.workbench.palette.palette import Palette

    settings.palette_level = "everything"

    assert Palette(canvas, settings).level == "first"


def test_a_search_finds_all_blocks_and_says_where_others_are_from(palette, qtbot):
    qtbot.keyClicks(palette.search, "wait")
    notes = {type_of(palette, n): e.note for n, e in enumerate(palette.shelf.entries)}
    qtbot.keyClicks(palette.search, " for word")
    read = QAccessible.queryAccessibleInterface(palette.shelf)
    spoken = [read.child(n).text(QAccessible.Text.Name) for n in range(read.childCount())]

    assert notes["control.wait"] == ""
    assert notes["control.wait_until"] == "In “More”: Control"
    assert any("In “More”: Speech" in words for words in spoken)


def test_what_a_search_found_outside_the_level_is_dragged_out_like_any_block(palette, qtbot):
    qtbot.keyClicks(palette.search, "python")
    [found] = {"code.lines"} & set(listed(palette))

    press_and_drag(palette, found, QPoint(450, 60))
    drop(palette, QPoint(450, 60))

    assert types(palette)[-1] == "code.lines"


def test_what_was_used_is_not_listed_twice_among_the_first_blocks(palette, qtbot):
    click(palette, "control.wait")
    QTest.mouseMove(palette.canvas.viewport(), QPoint(300, 300))
    qtbot.wait(30)

    assert listed(palette).count("control.wait") == 1
    assert "Recently used" not in headings(palette)


def test_own_blocks_and_snippets_are_among_the_first_when_there_are_some(palette, qtbot):
    canvas = palette.canvas
    canvas.editor.add_procedure(("greet",))
    qtbot.waitUntil(lambda: "greet" in [entry.text for entry in palette.shelf.entries])
    canvas.selection.set([canvas.editor.project.pages["behaviour"][0].body[1]])

    palette.snippet_menu.keep("Stand up")

    assert headings(palette)[-2:] == ["My blocks", "My snippets"]
    assert palette.shelf.entries[-1].text == "Stand up"


def test_other_pages_have_their_blocks_at_every_level(palette):
    palette.canvas.show_page("robots")

    assert listed(palette) == ["robots.robot"]


def test_a_teacher_chooses_the_first_blocks_of_a_project(palette, qtbot, settings):
    editor = palette.canvas.editor
    choose(palette, "more")
    choose_in_menu(palette, "robot.imitate", "Put among the first blocks")
    choose(palette, "first")
    choose_in_menu(palette, "robot.walk", "Take away from the first blocks")
    qtbot.waitUntil(lambda: "robot.walk" not in listed(palette))
    chosen = listed(palette)

    saved = from_bytes(to_bytes(editor.project), "lesson.nep", LANGUAGE)
    editor.history.undo()
    editor.history.undo()

    assert "robot.imitate" in chosen and "robot.leds" in chosen
    assert set(first_types(saved, LANGUAGE)) == set(chosen)
    qtbot.waitUntil(lambda: listed(palette) == list(offer().usual))


def test_there_is_a_way_back_to_the_usual_first_blocks(palette, qtbot):
    choose_in_menu(palette, "robot.walk", "Take away from the first blocks")
    qtbot.waitUntil(lambda: "robot.walk" not in listed(palette))

    choose_in_menu(palette, "robot.say", "The usual first blocks")

    qtbot.waitUntil(lambda: listed(palette) == list(offer().usual))
    assert FIRST_BLOCKS not in palette.canvas.editor.project.extra


def test_the_last_of_the_first_blocks_stays(palette, qtbot):
    palette.canvas.editor.apply(SetExtra(FIRST_BLOCKS, ["robot.say"]))
    qtbot.waitUntil(lambda: listed(palette) == ["robot.say"])

    menu = open_menu(palette, "robot.say")

    words = "Take away from the first blocks"
    assert not next(a for a in menu.actions() if a.text() == words).isEnabled()


@pytest.mark.parametrize(
    ("kept", "shown"),
    [
        (["robot.say", "no.such", "robot.say", 7, None, "robots.robot"], ("robot.say",)),
        (["my.call.x", "nodes.launch"], None),
        ("robot.say", None),
        ({"a": 1}, None),
        ([], None),
        (["x"] * 10_000, None),
    ],
)
def test_what_a_stranger_wrote_of_first_blocks_does_no_harm(palette, qtbot, kept, shown):
    project = build(LANGUAGE, [B("event.started")]).project
    project.extra[FIRST_BLOCKS] = kept
    read = from_bytes(to_bytes(project), "strange.nep", LANGUAGE)

    palette.canvas.editor.apply(SetExtra(FIRST_BLOCKS, read.extra[FIRST_BLOCKS]))

    assert first_types(read, LANGUAGE) == (shown or offer().usual)
    qtbot.waitUntil(lambda: set(listed(palette)) == set(shown or offer().usual))


def test_no_block_of_the_examples_is_of_the_first_when_it_is_not_there():
    for path in sorted(examples().glob("*.nep")):
        project = from_bytes(path.read_bytes(), path.name, LANGUAGE)
        assert set(project.first_blocks) <= LANGUAGE.definitions.keys()


@pytest.mark.parametrize("theme", themes())
@pytest.mark.parametrize("is_mirrored", [False, True])
def test_the_first_blocks_fit_into_a_narrow_palette(palette, qtbot, theme, is_mirrored):
    canvas = palette.canvas
    canvas.set_look(load_theme(theme), canvas.look.block_font, is_mirrored=is_mirrored)
    palette.refresh()
    palette.setFixedWidth(240)
    qtbot.waitUntil(lambda: palette.shelf.viewport().width() < 240)

    width = palette.shelf.viewport().width()
    rects = [palette.shelf.rect_of(n) for n in range(len(palette.shelf.entries))]
    assert all(rect.left() >= 0 and rect.right() <= width for rect in rects)
    for button in palette.levels.buttons.values():
        assert button.width() >= button.fontMetrics().horizontalAdvance(button.text())
        assert palette.levels.rect().contains(button.geometry())

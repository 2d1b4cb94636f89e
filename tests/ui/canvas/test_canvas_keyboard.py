"""The canvas without a mouse: go, select, edit, carry, delete, undo, all by keys."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt

from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.text import sentence
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build

Key, Modifier = Qt.Key, Qt.KeyboardModifier


def new_canvas(qtbot, *, is_mirrored: bool = False) -> Canvas:
    does = [B("robot.say", {"text": "one"}), B("robot.say", {"text": "two"})]
    number = B("math.arithmetic", {"a": 4, "b": 6})
    repeat = B("control.repeat", {}, {"times": number}, {"do": does})
    after = B("robot.say", {"text": "after"})
    editor = build(
        studio_language(),
        [B("event.started"), repeat, after],
        [B("event.started"), B("robot.say", {"text": "other"})],
    )
    canvas = Canvas(editor, load_theme("light"), is_mirrored=is_mirrored)
    qtbot.addWidget(canvas)
    canvas.resize(900, 700)
    canvas.show()
    canvas.setFocus()
    return canvas


@pytest.fixture
def canvas(qtbot) -> Canvas:
    return new_canvas(qtbot)


def at(canvas: Canvas) -> str:
    cursor = canvas.selection.cursor
    return sentence(canvas.editor.project, canvas.editor.language, cursor) if cursor else ""


def press(qtbot, canvas: Canvas, *keys, held=Modifier.NoModifier) -> None:
    for key in keys:
        qtbot.keyClick(canvas, key, held)


def walk(qtbot, canvas: Canvas, key, times: int) -> list[str]:
    seen = []
    for _ in range(times):
        press(qtbot, canvas, key)
        seen.append(at(canvas))
    return seen


def chain(canvas: Canvas, stack: int = 0) -> list[str]:
    project, language = canvas.editor.project, canvas.editor.language
    return [sentence(project, language, i) for i in project.pages["behaviour"][stack].body]


def texts_inside(canvas: Canvas) -> list[object]:
    blocks = canvas.editor.project.blocks
    repeat = next(b for b in blocks.values() if b.type == "control.repeat")
    return [blocks[i].fields.get("text") for i in repeat.bodies.get("do", [])]


def go_to(qtbot, canvas: Canvas, text: str) -> str:
    blocks = canvas.editor.project.blocks.values()
    block = next(b.id for b in blocks if b.fields.get("text") == text)
    canvas.selection.set([block])
    return block


def test_down_goes_through_all_statements_as_they_are_read(canvas, qtbot) -> None:
    assert walk(qtbot, canvas, Key.Key_Down, 8) == [
        "when the program starts",
        "repeat 4 + 6 times",
        "NAO says one with no gesture",
        "NAO says two with no gesture",
        "NAO says after with no gesture",
        "when the program starts",
        "NAO says other with no gesture",
        "NAO says other with no gesture",
    ]


def test_up_goes_the_same_way_back(canvas, qtbot) -> None:
    down = walk(qtbot, canvas, Key.Key_Down, 7)

    up = walk(qtbot, canvas, Key.Key_Up, 6)

    assert up == down[-2::-1]


def test_right_goes_into_a_block_and_left_out_of_it(canvas, qtbot) -> None:
    press(qtbot, canvas, Key.Key_Down, Key.Key_Down, Key.Key_Right)
    inside = at(canvas)
    press(qtbot, canvas, Key.Key_Left)

    assert inside == "4 + 6"
    assert at(canvas) == "repeat 4 + 6 times"


def test_left_goes_into_a_block_when_the_page_is_mirrored(qtbot) -> None:
    canvas = new_canvas(qtbot, is_mirrored=True)

    press(qtbot, canvas, Key.Key_Down, Key.Key_Down, Key.Key_Left)

    assert at(canvas) == "4 + 6"


def test_home_end_and_page_keys_go_to_the_ends_of_stacks(canvas, qtbot) -> None:
    press(qtbot, canvas, Key.Key_Down, Key.Key_End)
    end = at(canvas)
    press(qtbot, canvas, Key.Key_PageDown)
    other = canvas.editor.project.stack_of(canvas.selection.cursor)
    press(qtbot, canvas, Key.Key_Home, held=Modifier.ControlModifier)
    first = canvas.editor.project.stack_of(canvas.selection.cursor)

    assert end == "NAO says after with no gesture"
    assert [first, other] == canvas.editor.project.pages["behaviour"]


def test_shift_and_down_select_what_is_on_the_way(canvas, qtbot) -> None:
    go_to(qtbot, canvas, "one")

    press(qtbot, canvas, Key.Key_Down, Key.Key_Down, held=Modifier.ShiftModifier)

    assert len(canvas.selection.ids) == 3
    press(qtbot, canvas, Key.Key_Up, held=Modifier.ShiftModifier)
    assert len(canvas.selection.ids) == 2


def test_delete_takes_the_block_away_and_control_z_brings_it_back(canvas, qtbot) -> None:
    before = to_bytes(canvas.editor.project)
    go_to(qtbot, canvas, "one")

    press(qtbot, canvas, Key.Key_Delete)
    without = texts_inside(canvas)
    next_one = at(canvas)
    press(qtbot, canvas, Key.Key_Z, held=Modifier.ControlModifier)

    assert without == ["two"]
    assert next_one == "NAO says two with no gesture"
    assert to_bytes(canvas.editor.project) == before


def test_space_picks_up_arrows_choose_a_place_and_enter_puts_down(canvas, qtbot) -> None:
    go_to(qtbot, canvas, "after")

    press(qtbot, canvas, Key.Key_Space, Key.Key_Up, Key.Key_Up, Key.Key_Return)

    assert texts_inside(canvas) == ["one", "after", "two"]
    assert at(canvas) == "NAO says after with no gesture"
    assert canvas.pointing.gesture is None
    assert canvas.layers.sprite is None


def test_what_is_carried_is_shown_as_a_gap_and_told(canvas, qtbot) -> None:
    told: list[str] = []
    canvas.news.announced.connect(told.append)
    go_to(qtbot, canvas, "after")

    press(qtbot, canvas, Key.Key_Space, Key.Key_Up, Key.Key_Up)

    assert canvas.page_layout.layout.gap is not None
    assert told[-1] == "after NAO says one with no gesture"
    press(qtbot, canvas, Key.Key_Escape)
    assert canvas.page_layout.layout.gap is None
    assert told[-1] == "Put back."


def test_escape_puts_carried_blocks_back_without_a_step_of_undo(canvas, qtbot) -> None:
    before, label = to_bytes(canvas.editor.project), canvas.editor.history.undo_label
    go_to(qtbot, canvas, "one")

    press(qtbot, canvas, Key.Key_Space, Key.Key_Down, Key.Key_Escape)

    assert to_bytes(canvas.editor.project) == before
    assert canvas.editor.history.undo_label == label


def test_a_carried_value_goes_from_slot_to_slot_that_takes_it(canvas, qtbot) -> None:
    press(qtbot, canvas, Key.Key_Down, Key.Key_Down, Key.Key_Right, Key.Key_Space)

    press(qtbot, canvas, Key.Key_Down, Key.Key_Return)

    number = canvas.editor.project.blocks[canvas.selection.cursor]
    owner = canvas.editor.project.blocks[canvas.editor.project.parents[number.id].owner]
    assert owner.type == "robot.say"
    assert owner.inputs == {"text": number.id}


def test_blocks_can_be_put_down_by_themselves_on_the_page(canvas, qtbot) -> None:
    go_to(qtbot, canvas, "after")

    press(qtbot, canvas, Key.Key_Space)
    press(qtbot, canvas, Key.Key_Right, Key.Key_Right, held=Modifier.ControlModifier)
    press(qtbot, canvas, Key.Key_Return)

    assert len(canvas.editor.project.pages["behaviour"]) == 3
    assert chain(canvas, 2) == ["NAO says after with no gesture"]


def test_copied_blocks_are_pasted_with_control_c_and_control_v(canvas, qtbot) -> None:
    go_to(qtbot, canvas, "one")

    press(qtbot, canvas, Key.Key_C, Key.Key_V, held=Modifier.ControlModifier)

    assert chain(canvas, 2) == ["NAO says one with no gesture"]
    assert at(canvas) == "NAO says one with no gesture"


def test_the_menu_key_asks_for_the_menu_at_the_block(canvas, qtbot) -> None:
    block = go_to(qtbot, canvas, "one")
    asked: list[QPoint] = []
    canvas.news.menu_requested.disconnect()
    canvas.news.menu_requested.connect(asked.append)

    press(qtbot, canvas, Key.Key_F10, held=Modifier.ShiftModifier)

    hit = canvas.sight.hit(asked[0])
    assert hit is not None
    assert hit.block == block


def test_a_letter_begins_a_new_block_by_its_name(canvas, qtbot) -> None:
    typed: list[str] = []
    canvas.keyboard.type_letter = typed.append

    qtbot.keyClicks(canvas, "s")
    qtbot.keyClicks(canvas, "/")

    assert typed == ["s", ""]


def test_control_e_switches_blocks_off_and_control_m_folds_them(canvas, qtbot) -> None:
    block = canvas.editor.project.blocks[go_to(qtbot, canvas, "one")]

    press(qtbot, canvas, Key.Key_E, Key.Key_M, held=Modifier.ControlModifier)

    assert block.disabled
    assert block.collapsed


def test_keys_on_an_empty_page_do_no_harm(canvas, qtbot) -> None:
    canvas.show_page("robots")

    for key in (Key.Key_Down, Key.Key_Up, Key.Key_Left, Key.Key_Space, Key.Key_Return, Key.Key_End):
        press(qtbot, canvas, key)

    assert canvas.selection.cursor == ""


@pytest.mark.parametrize("key", [Key.Key_X, Key.Key_Delete])
def test_blocks_that_undo_brings_back_are_selected(canvas, qtbot, key) -> None:
    go_to(qtbot, canvas, "one")
    press(qtbot, canvas, Key.Key_Down, held=Modifier.ShiftModifier)
    selected = set(canvas.selection.ids)
    held = Modifier.ControlModifier if key == Key.Key_X else Modifier.NoModifier
    press(qtbot, canvas, key, held=held)
    gone = set(canvas.selection.ids)

    press(qtbot, canvas, Key.Key_Z, held=Modifier.ControlModifier)

    assert len(selected) == 2
    assert not gone & selected
    assert set(canvas.selection.ids) == selected


def test_undo_of_a_change_keeps_the_selection(canvas, qtbot) -> None:
    go_to(qtbot, canvas, "one")
    selected = canvas.selection.ids
    press(qtbot, canvas, Key.Key_E, held=Modifier.ControlModifier)

    press(qtbot, canvas, Key.Key_Z, held=Modifier.ControlModifier)

    assert canvas.selection.ids == selected


def test_only_control_shift_space_picks_a_block_up_alone(canvas, qtbot) -> None:
    go_to(qtbot, canvas, "one")

    press(qtbot, canvas, Key.Key_Space, held=Modifier.ControlModifier)
    by_control = canvas.pointing.gesture
    press(qtbot, canvas, Key.Key_Space, held=Modifier.ControlModifier | Modifier.ShiftModifier)

    assert by_control is None
    assert canvas.pointing.gesture is not None
    press(qtbot, canvas, Key.Key_Escape)

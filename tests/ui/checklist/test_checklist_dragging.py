"""The checklist, dragging: one test for each row of the feature inventory."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint

from nep_studio.ui.canvas.editing.snapping import PREFERENCE_PX, RADIUS_PX
from tests.blocks.block_building import B
from tests.ui.checklist.person import ALT, CTRL, Fingers, Key, Person, is_dragging, say_block, story

FREE = QPoint(520, 560)


def test_drag_a_block_and_everything_below_drop_anywhere(person: Person) -> None:
    """Drag block + everything below; drop anywhere."""
    person.make(story())
    before = person.file

    person.put(person.body()[2], FREE)

    assert person.texts(0) == ["one"]
    assert person.texts(1) == ["two", "three"]
    assert (person.corner(person.body(1)[0]) - FREE).manhattanLength() <= 2
    assert person.undo() == before


@pytest.mark.parametrize("held", [CTRL, ALT])
def test_drag_one_block_out_and_the_stack_heals(person: Person, held) -> None:
    """Drag ONE block out, stack heals (Ctrl/Alt-drag; menu "extract")."""
    person.make(story())
    before = person.file

    person.put(person.body()[2], FREE, held)

    assert person.texts(0) == ["one", "three"]
    assert person.texts(1) == ["two"]
    assert person.undo() == before
    person.choose(person.menu(person.grip(person.body()[2])), "extract")
    assert person.texts(0) == ["one", "three"]
    assert person.undo() == before


def test_snap_preview_opens_a_gap(person: Person) -> None:
    """Snap preview: gap opens / ghost insertion marker."""
    person.make(story(), [B("control.wait")])
    one, two, three = person.body()[1:]
    before = person.corner(three)

    place = person.carry(person.body(1)[0], person.foot(one))

    gap = person.canvas.page_layout.layout.gap
    assert gap is not None and gap.index == 2
    assert person.corner(three).y() > before.y() + 20
    person.release(place)
    assert person.body()[2] == person.block("control.wait").id
    assert person.body()[3] == two
    assert person.canvas.page_layout.layout.gap is None


def test_replace_preview_highlights_the_block_that_will_be_pushed_out(person: Person) -> None:
    """Replace preview (highlight of the block that will be pushed out)."""
    older, newer = (B("variable.get", {"variable": name}) for name in ("v4", "v5"))
    person.make([say_block(older)], [newer], variables=("old", "new"))
    before, speaker = person.file, person.body()[0]
    old, new = person.project.blocks[speaker].inputs["text"], person.body(1)[0]
    rect = person.rect(old).adjusted(-4, -4, 4, 4)
    highlighted = person.seen("snap", rect)

    place = person.carry(new, person.corner(old) + QPoint(3, 9))

    assert highlighted == 0 and person.seen("snap", rect) > 50
    person.release(place)
    assert person.project.blocks[speaker].inputs["text"] == new
    assert person.project.stack_of(old).body == [old]
    assert person.undo() == before


def test_snap_radius_of_28_pixels_and_hysteresis_of_8_pixels(person: Person) -> None:
    """Hysteresis on the current candidate (8 px), snap radius 28 px (Snap 20)."""
    person.make(story(), [B("control.wait")])
    person.canvas.sight.zoom(1.0)
    person.look_at_corner()
    wait, last = person.body(1)[0], person.body()[-1]
    one, two = person.foot(person.body()[1]), person.foot(person.body()[2])
    end, way = person.foot(last), person.grip(wait) - person.corner(wait)
    middle = (two.y() - one.y()) // 2

    def target_at(corner: QPoint) -> int | None:
        person.move(corner + way)
        gap = person.canvas.page_layout.layout.gap
        return gap.index if gap is not None else None

    person.press(person.grip(wait))

    assert target_at(end + QPoint(0, round(RADIUS_PX) + 2)) is None
    assert target_at(end + QPoint(0, round(RADIUS_PX) - 2)) == 4
    assert target_at(one) == 2
    assert target_at(one + QPoint(0, middle + round(PREFERENCE_PX / 2) - 2)) == 2
    assert target_at(one + QPoint(0, middle + round(PREFERENCE_PX / 2) + 2)) == 3
    assert target_at(one + QPoint(0, middle - round(PREFERENCE_PX / 2) + 2)) == 3
    person.key(Key.Key_Escape)


def test_bump_loose_near_miss_blocks_away(person: Person) -> None:
    """Bump loose near-miss blocks away (250 ms delay)."""
    person.make(story(), [B("math.number")])
    before, number = person.file, person.body(1)[0]

    person.put(number, person.foot(person.body()[-1]) + QPoint(3, -6))

    stack, loose = (
        person.canvas.page_layout.index.rects[s.id] for s in person.project.pages["behaviour"]
    )
    assert not stack.touches(loose)
    assert person.undo() == before


def test_wrap_a_selection_with_a_c_block_on_drop(person: Person) -> None:
    """Wrap a selection with a C-block on drop (stack goes into the mouth)."""
    person.make(story(), [B("control.repeat")])
    before, loop = person.file, person.body(1)[0]
    one, two, three = person.body()[1:]
    person.select(one, two)

    person.put(loop, person.corner(one) + QPoint(4, -4))

    assert person.body() == [person.body()[0], loop, three]
    assert person.project.blocks[loop].bodies["do"] == [one, two]
    assert person.undo() == before
    person.canvas.selection.clear()
    person.from_palette("control.repeat", person.corner(two) + QPoint(20, -12))
    wrapped = person.block("control.repeat", 1)
    assert wrapped.bodies.get("do") == [two, three]
    assert person.undo() == before


def test_escape_cancels_a_drag_and_restores(person: Person) -> None:
    """Esc cancels a drag and restores."""
    person.make(story(), [B("control.wait")])
    before, steps = person.file, person.editor.history.steps

    place = person.carry(person.body()[1], person.foot(person.body(1)[0]))
    assert is_dragging(person)
    person.key(Key.Key_Escape)
    person.release(place)

    assert person.file == before and person.editor.history.steps == steps
    assert person.canvas.layers.sprite is None and person.canvas.page_layout.layout.gap is None
    assert not person.canvas.page_layout.layout.hidden


def test_edge_scroll_and_wheel_scroll_while_dragging(person: Person) -> None:
    """Edge auto-scroll while dragging; wheel scroll while dragging."""
    person.make(story())
    camera, block = person.canvas.sight.camera, person.body()[3]
    view = person.canvas.viewport().rect()

    place = person.carry(block, FREE)
    before = camera.y
    person.wheel(-1, at=place)
    assert camera.y > before and is_dragging(person)
    edge = QPoint(view.center().x(), view.bottom() - 2)
    person.move(edge)
    before = camera.y
    person.qtbot.waitUntil(lambda: camera.y > before + 150)
    person.release(edge)

    [dropped] = person.body(1)
    assert person.rect(dropped).intersects(view)
    assert person.project.stack_of(dropped).y > before + 150


def test_duplicate_on_drag_of_parameters_and_variables_from_a_header(person: Person) -> None:
    """Duplicate-on-drag of parameters/variables from a header."""
    person.make([B("event.started"), B("control.count", {"variable": "v4"})], variables=("turn",))
    greeted = person.editor.new_parameter("name", "text")
    place = person.editor.new_stack("behaviour", 40, 300)
    own = person.editor.add_procedure(["greet", greeted], place=place)
    before, loop, header = person.file, person.body()[1], person.body(1)[0]

    start = person.piece(header, greeted.id)
    person.drop(start, start + QPoint(220, 90))
    assert person.project.blocks[person.body(2)[0]].type == f"my.parameter.{own}.{greeted.id}"
    assert person.undo() == before
    start = person.piece(loop, "variable")
    person.drop(start, start + QPoint(100, 180))
    copied = person.project.blocks[person.body(2)[0]]
    assert (copied.type, copied.fields["variable"]) == ("variable.get", "v4")
    assert person.undo() == before


def test_type_check_at_connect_says_why(person: Person) -> None:
    """Type check at connect, with a reason shown on refusal: say why."""
    person.make([B("control.if")], [B("math.number")])
    before, check, number = person.file, person.body()[0], person.body(1)[0]

    place = person.carry(number, person.piece(check, "condition") - QPoint(40, 14))
    told = person.canvas.marks.bubble.text()
    shown = person.canvas.marks.bubble.isVisible()
    person.release(place)

    assert shown and len(told) > 10
    assert person.project.blocks[check].inputs == {}
    assert told in person.told()
    moved = person.project.stack_of(number)
    assert person.undo() == before and moved.body == [number]


def test_touch_taps_drags_pinches_and_opens_menus(person: Person, fingers: Fingers) -> None:
    """Touch: pinch + long press."""
    person.make(story())
    before, last = person.file, person.body()[3]
    start, camera = person.grip(last), person.canvas.sight.camera

    fingers.to(start)
    for step in range(1, 5):
        fingers.to(start + QPoint(70, 80) * step)
    fingers.up(start + QPoint(280, 320))
    assert person.texts(1) == ["three"]
    assert person.undo() == before

    scale, middle = camera.scale, QPoint(140, 500)
    fingers.to(middle - QPoint(50, 0))
    fingers.to(middle - QPoint(50, 0), middle + QPoint(50, 0))
    fingers.to(middle - QPoint(100, 0), middle + QPoint(100, 0))
    fingers.up(middle - QPoint(100, 0), middle + QPoint(100, 0))
    assert camera.scale == pytest.approx(scale * 2, rel=0.1)

    person.canvas.sight.zoom(scale)
    person.look_at_corner()
    place = person.grip(person.body()[1])
    fingers.to(place)
    person.qtbot.waitUntil(
        lambda: person.canvas.menu is not None and person.canvas.menu.isVisible()
    )
    fingers.up(place)
    assert person.file == before
    person.canvas.menu.close()

"""The checklist, finding and moving about: one test for each row of the feature inventory."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible
from PySide6.QtTest import QTest

from nep_studio.ui.canvas.accessibility import interface_of
from tests.blocks.block_building import B
from tests.ui.checklist.person import (
    CTRL,
    LEFT,
    SHIFT,
    Key,
    Person,
    say,
    story,
)


def in_view(person: Person, block: str) -> bool:
    return person.canvas.viewport().rect().intersects(person.rect(block).toRect())


def listed(person: Person) -> list[str]:
    """The types of the blocks in the palette."""
    shelf = person.palette.shelf
    blocks = shelf._stock.project.blocks
    return [blocks[entry.sample].type for entry in shelf.entries if entry.sample]


def test_keyboard_moves_between_blocks_picks_up_places_and_edits(person: Person) -> None:
    """Keyboard: move between blocks, pick up and place by arrows, edit fields."""
    person.make(story())
    hat, one, two, three = person.body()
    before = person.file

    person.key(Key.Key_Home, CTRL)
    person.key(Key.Key_Down)
    assert person.canvas.selection.cursor == one
    person.key(Key.Key_Space)
    person.key(Key.Key_Escape)
    assert person.file == before
    person.key(Key.Key_Space, SHIFT | CTRL)
    person.key(Key.Key_Down)
    person.key(Key.Key_Return)
    assert person.body() == [hat, two, one, three]
    assert person.undo() == before
    person.canvas.selection.set([one])
    person.key(Key.Key_F2)
    person.key(Key.Key_Tab, widget=person.canvas.fields.widget.first())
    line = person.canvas.fields.widget
    line.selectAll()
    person.type("typed", line)
    person.key(Key.Key_Return, widget=line)

    assert person.texts() == ["typed", "two", "three"]
    assert person.canvas.hasFocus()
    assert person.undo() == before


def test_insert_a_block_by_typing_its_name(person: Person) -> None:
    """Insert a block by typing its name."""
    person.make(story())
    before = person.file
    person.select(person.body()[1])
    bar = person.window.workbench.helpers.insert_bar

    person.key(Key.Key_Space, CTRL)
    person.type("say hello twice", bar.line)
    offered = [row.label for row in bar.list.rows]
    person.key(Key.Key_Return, widget=bar.line)

    assert bar.isHidden() and offered
    loop = person.project.blocks[person.body()[2]]
    assert (loop.type, loop.fields["times"]) == ("control.repeat", 2)
    [inside] = loop.bodies["do"]
    assert person.project.blocks[inside].fields["text"] == "hello"
    assert person.undo() == before
    person.type("w")
    person.type("ait 3", bar.line)
    person.key(Key.Key_Escape, widget=bar.line)
    assert person.file == before and person.canvas.hasFocus()


def test_a_screen_reader_hears_the_blocks_and_the_moves(person: Person) -> None:
    """Screen reader: works in Qt."""
    person.make([B("event.started"), B("control.repeat", bodies={"do": [say("a"), say("b")]})])
    loop, heard = person.body()[1], []
    person.canvas.news.announced.connect(heard.append)
    tree = QAccessible.queryAccessibleInterface(person.canvas)
    name = QAccessible.Text.Name

    person.canvas.selection.set([loop])
    person.key(Key.Key_Space)
    person.key(Key.Key_Escape)

    assert tree.role() == QAccessible.Role.Tree
    assert (
        interface_of(person.canvas).focusChild().text(name).startswith("repeat 3 times, contains")
    )
    assert heard[0].startswith("Picked up") and heard[-1] == "Put back."
    outline = person.window.workbench.outline
    person.window.workbench.panels.show(outline)
    row = outline.model().index(0, 0)
    assert "when the program starts" in str(row.data())


def test_zoom_with_wheel_pinch_and_buttons_pan_fit_and_go_to_a_block(person: Person) -> None:
    """Zoom wheel/pinch/buttons, pan, fit, centre on block."""
    place = person.editor.new_stack("behaviour", 3000, 2500)
    far = person.editor.create("event.started", place)
    person.make(story())
    camera, view = person.canvas.sight.camera, person.canvas.viewport()
    at = QPoint(300, 200)
    usual, fixed = camera.scale, person.canvas.sight.to_page(at)

    person.wheel(1, CTRL, at)
    assert camera.scale == pytest.approx(usual * 1.2)
    assert (person.canvas.sight.to_page(at) - fixed).manhattanLength() < 2
    toolbar, actions = person.window.toolbar, person.window.actions_by_name
    QTest.mouseClick(toolbar.widgetForAction(actions["zoom_out"]), LEFT)
    assert camera.scale == pytest.approx(usual)
    person.wheel(-1)
    assert camera.y > -20
    x = camera.x
    QTest.mousePress(view, Qt.MouseButton.MiddleButton, pos=at)
    person.move(at + QPoint(50, 30))
    QTest.mouseRelease(view, Qt.MouseButton.MiddleButton, pos=at + QPoint(50, 30))
    assert camera.x == pytest.approx(x - 50 / usual)
    QTest.mouseClick(toolbar.widgetForAction(actions["zoom_fit"]), LEFT)
    assert all(in_view(person, block) for block in (*person.body(1), far))
    person.key(Key.Key_0, CTRL)
    person.look_at_corner()
    assert not in_view(person, far)
    person.key(Key.Key_End, CTRL)
    assert in_view(person, far)


def test_the_minimap_shows_the_page_and_moves_it(person: Person) -> None:
    """Minimap."""
    place = person.editor.new_stack("behaviour", 2000, 4000)
    far = person.editor.create("event.started", place)
    person.make(story())
    minimap = person.window.workbench.helpers.minimap

    person.window.actions_by_name["minimap"].trigger()
    assert minimap.isVisible()
    minimap.draw_now()
    stack = person.project.stack_of(far)
    spot = minimap._to_map(stack.x + 20, stack.y + 10).toPoint()
    person.click(spot, widget=minimap)

    assert in_view(person, far)
    assert minimap.view_frame().contains(spot)


def test_the_palette_has_categories_in_one_continuous_list(person: Person) -> None:
    """Flyout toolbox, categories, continuous scroll."""
    shelf, buttons = person.palette.shelf, person.palette.categories.buttons
    definitions = person.editor.language.definitions.values()

    person.click(buttons["math"].rect().center(), widget=buttons["math"])
    assert shelf.shown_drawer().id == "math" and buttons["math"].isChecked()
    bar = shelf.verticalScrollBar()
    bar.setValue(bar.value() - 40)

    assert shelf.shown_drawer().id != "math" and not buttons["math"].isChecked()
    wanted = {d.id for d in definitions if d.page == "behaviour"}
    assert wanted - set(listed(person)) == {"variable.get"}  # until there is a variable
    before = person.file
    person.from_palette("event.started", QPoint(200, 200))
    assert person.body() == [person.block("event.started").id]
    assert person.undo() == before


def test_the_palette_is_searched(person: Person) -> None:
    """Toolbox search."""
    before = person.file

    person.type("pause", person.palette.search)
    assert "control.wait" in listed(person)[:3]
    person.key(Key.Key_Return, widget=person.palette.search)
    assert len(person.project.pages["behaviour"]) == 1
    person.key(Key.Key_Escape, widget=person.palette.search)

    assert len(listed(person)) > 140
    assert person.undo() == before


def test_recently_used_blocks_come_first(person: Person) -> None:
    """Recently used / suggested blocks."""
    person.from_palette("control.wait", QPoint(200, 200))
    person.from_palette("robot.say", QPoint(200, 400))
    QTest.mouseMove(person.canvas.viewport(), QPoint(300, 500))

    person.qtbot.waitUntil(lambda: listed(person)[:2] == ["robot.say", "control.wait"])
    assert person.palette.shelf.entries[0].text == "Recently used"
    assert person.window.settings.recent_blocks[:2] == ["robot.say", "control.wait"]


def test_find_in_the_program_with_next_and_previous(person: Person) -> None:
    """Workspace search Ctrl+F with next/previous."""
    inside = B("control.repeat", bodies={"do": [say("hello again")]})
    person.make([B("event.started"), say("Hello"), inside])
    first, loop = person.body()[1:]
    folded = person.block("robot.say", 1).id
    person.select(loop)
    person.key(Key.Key_M, CTRL)
    finder = person.window.workbench.helpers.find_bar

    person.key(Key.Key_F, CTRL)
    person.type("hello", finder.line)
    assert set(finder.hits) == {first, folded}
    assert "2" in finder.count.text()
    for _ in range(2):
        person.key(Key.Key_Return, widget=finder.line)
    seen = {person.canvas.selection.cursor}
    person.key(Key.Key_Return, SHIFT, finder.line)
    seen.add(person.canvas.selection.cursor)
    assert seen == {first, folded}
    assert not person.project.blocks[loop].collapsed
    person.key(Key.Key_Escape, widget=finder.line)
    assert finder.isHidden() and person.canvas.hasFocus()

"""The checklist, editing and undo: one test for each row of the feature inventory."""

from __future__ import annotations

from PySide6.QtCore import QPoint
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest

from nep_studio.ui.canvas.editing.menu import MenuEntry
from tests.blocks.block_building import B
from tests.ui.checklist.person import CTRL, LEFT, SHIFT, Key, Person, say, story

FREE = QPoint(520, 560)


def test_block_and_page_comments_that_can_be_resized(person: Person) -> None:
    """Block and workspace comments, resizable."""
    person.make(story())
    one, before = person.body()[1], person.file

    person.choose(person.menu(person.grip(one)), "comment")
    bubble = person.canvas.fields.comments.bubble
    person.type("say it softly", bubble.text)
    corner, size = bubble.corner.rect().center(), bubble.size()
    person.drop(corner, corner + QPoint(50, 30), widget=bubble.corner)
    grown = bubble.size()
    person.key(Key.Key_Escape, widget=bubble.text)
    block = person.project.blocks[one]
    assert block.comment == "say it softly"
    assert grown.width() > size.width() and block.comment_width > 0
    assert any(p.kind == "comment" for p in person.canvas.page_layout.placed(one).box.pieces)
    person.undo()
    assert person.undo() == before

    person.choose(person.menu(FREE), "add_note")
    person.type("to do", person.canvas.viewport().findChild(type(person.window.focusWidget())))
    person.click(QPoint(30, 700))
    [note] = person.project.notes.values()
    assert note.text == "to do"
    rect = person.canvas.sight.camera.view_rect(person.canvas.notes.rect_of(note))
    person.drop(
        rect.bottomRight().toPoint() - QPoint(4, 4), rect.bottomRight().toPoint() + FREE / 9
    )
    [resized] = person.project.notes.values()
    assert resized.width > note.width and resized.height > note.height


def test_collapse_a_block_and_unfold_it(person: Person) -> None:
    """Collapse a block / fold a section."""
    person.make([B("event.started"), B("control.repeat", bodies={"do": [say("a"), say("b")]})])
    loop, before = person.body()[1], person.file
    high = person.rect(loop).height()

    person.select(loop)
    person.key(Key.Key_M, CTRL)
    pieces = person.canvas.page_layout.placed(loop).box.pieces
    assert person.project.blocks[loop].collapsed
    assert person.rect(loop).height() < high / 2
    assert any("2 blocks" in piece.text for piece in pieces)
    person.click(person.piece(loop, "", kind="expand"))

    assert not person.project.blocks[loop].collapsed
    assert person.rect(loop).height() == high
    person.undo()
    assert person.undo() == before


def test_switch_a_block_off_and_on(person: Person) -> None:
    """Disable (skip) a block."""
    person.make(story())
    two, before = person.body()[2], person.file
    code = person.window.workbench.code.text.toPlainText

    person.choose(person.menu(person.grip(two)), "disable")
    assert person.project.blocks[two].disabled
    assert person.canvas.page_layout.placed(two).box.is_disabled
    person.qtbot.waitUntil(lambda: "three" in code() and '.say("two")' not in code())
    person.key(Key.Key_E, CTRL)

    assert person.file == before
    person.undo()
    assert person.undo() == before


def test_context_menus_of_block_page_and_note_with_own_entries(person: Person) -> None:
    """Context menu on block, workspace, comment; add own entries."""
    person.make(story())
    asked: list[object] = []
    own = MenuEntry("own", "My own entry", lambda: asked.append(1))
    person.canvas.menu_sections.append(lambda canvas, place: [own])
    note = person.canvas.notes.add(300, 100, "note")
    rect = person.canvas.notes.rect_of(person.project.notes[note])
    middle = person.canvas.sight.camera.view_rect(rect).center().toPoint()

    menus = [person.menu(at) for at in (person.grip(person.body()[1]), FREE, middle)]
    block, page, comment = ({a.objectName() for a in menu.actions()} for menu in menus)

    assert {"duplicate", "copy", "cut", "delete", "disable", "collapse", "comment"} <= block
    assert {"undo", "paste", "add_note", "select_all", "tidy", "picture"} <= page
    assert {"edit_note", "delete_note"} <= comment
    assert "own" in block & page & comment
    person.choose(menus[2], "own")
    assert asked == [1]


def test_undo_and_redo_of_everything_one_step_per_action(person: Person) -> None:
    """Undo/redo of everything incl. field edits, grouped."""
    person.make(story(), [B("control.wait")])
    states = [person.file]

    def done() -> None:
        states.append(person.file)
        assert states[-1] != states[-2]

    person.put(person.body(1)[0], person.foot(person.body()[1]))
    done()
    person.click(person.piece(person.body()[1], "text"))
    person.type("good morning", person.canvas.fields.widget)
    person.key(Key.Key_Return, widget=person.canvas.fields.widget)
    done()
    person.select(person.body()[1], person.body()[3])
    person.key(Key.Key_E, CTRL)
    done()
    person.key(Key.Key_D, CTRL)
    done()
    person.key(Key.Key_Delete)
    done()
    person.choose(person.menu(person.grip(person.body()[0])), "delete_below")
    done()

    for state in reversed(states[:-1]):
        assert person.undo() == state
    for state in states[1:]:
        assert person.redo() == state
    action = person.window.actions_by_name["undo"]
    assert action.isEnabled() and "delete" in action.text().lower()


def test_copy_cut_and_paste_also_across_projects_and_as_text(person: Person) -> None:
    """Copy/cut/paste; across projects: text clipboard (JSON + Python)."""
    score = person.editor.add_variable("score")
    person.make([B("event.started"), say("one"), B("variable.set", {"variable": score})])
    before = person.file
    person.select(person.body()[1], person.body()[2])

    person.key(Key.Key_X, CTRL)
    data = QGuiApplication.clipboard().mimeData()
    assert person.body() == [person.body()[0]]
    assert "nao.say" in data.text() or '"robot.say"' in data.text()
    assert person.undo() == before
    person.select(person.body()[1], person.body()[2])
    person.key(Key.Key_C, CTRL)
    person.window.files.document.close()
    person.window.files.document = None
    person.key(Key.Key_N, CTRL, person.window)
    person.key(Key.Key_V, CTRL)

    assert person.texts() == ["one"]
    assert [variable.name for variable in person.project.variables] == ["score"]
    QGuiApplication.clipboard().setText('nao = Robot("NAO")\nnao.say("from Python")\n')
    person.key(Key.Key_V, CTRL)
    assert any(b.fields.get("text") == "from Python" for b in person.project.blocks.values())


def test_several_blocks_are_selected_moved_copied_switched_off_and_deleted(
    person: Person,
) -> None:
    """Multi-select: rubber band, Shift-click, move/copy/delete/disable together."""
    person.make(story(), [say("loose")])
    before, (_hat, one, two, three), loose = person.file, person.body(), person.body(1)[0]

    person.drop(QPoint(700, person.corner(one).y() + 2), person.corner(loose) + QPoint(10, 5))
    assert set(person.canvas.selection.ids) == {one, two, three, loose}
    person.click(person.grip(two), SHIFT)
    assert set(person.canvas.selection.ids) == {one, three, loose}

    person.put(loose, FREE)
    assert person.texts(0) == ["two"]
    assert person.undo() == before
    person.select(one, three)
    person.key(Key.Key_E, CTRL)
    assert [person.project.blocks[b].disabled for b in (one, two, three)] == [True, False, True]
    assert person.undo() == before
    person.key(Key.Key_D, CTRL)
    assert len(person.project.blocks) == 8  # with the robot of the project
    assert person.undo() == before
    person.select(one, three)
    person.key(Key.Key_Delete)
    assert person.texts() == ["two"]
    assert person.undo() == before
    person.key(Key.Key_A, CTRL)
    person.key(Key.Key_Delete)
    assert not person.project.pages["behaviour"]
    assert person.undo() == before


def test_the_trash_keeps_deleted_blocks_and_brings_them_back(person: Person) -> None:
    """Trashcan with recovery of deleted blocks: "deleted blocks" list."""
    person.make(story())
    trash = person.window.workbench.helpers.trash
    middle = trash.mapTo(person.canvas, trash.rect().center())

    grip = person.grip(person.body()[2])
    place = person.canvas.viewport().mapFrom(person.canvas, middle)
    person.drop(grip, place)
    assert person.texts() == ["one"]
    person.undo()
    person.select(person.body()[1])
    person.key(Key.Key_Delete)
    QTest.mouseClick(trash, LEFT)

    titles = [entry.text for entry in trash.panel.shelf.entries]
    assert trash.panel.isVisible() and len(titles) == 2
    person.click(trash.panel.shelf.rect_of(1).center(), widget=trash.panel.shelf.viewport())
    assert len(trash.panel.shelf.entries) == 1
    said = sorted(
        str(b.fields["text"]) for b in person.project.blocks.values() if "text" in b.fields
    )
    assert said.count("two") == 2
    person.key(Key.Key_Escape, widget=trash.panel)
    assert not trash.panel.isVisible()


def test_tidy_up_pushes_stacks_apart_and_keeps_their_order(person: Person) -> None:
    """Tidy up / no overlaps: keep positions, push apart."""
    person.make(story(), story(), story())
    for number, stack in enumerate(person.project.pages["behaviour"]):
        stack.y = 40.0 + 60 * number
    person.canvas.set_editor(person.editor)
    before = person.file
    index = person.canvas.page_layout.index

    person.window.actions_by_name["tidy"].trigger()

    stacks = list(person.project.pages["behaviour"])
    rects = [index.rects[stack.id] for stack in stacks]
    assert not any(a.touches(b) for n, a in enumerate(rects) for b in rects[n + 1 :])
    assert [rect.y for rect in rects] == sorted(rect.y for rect in rects)
    assert rects[0].x == 40 and rects[0].y == 40
    assert person.undo() == before

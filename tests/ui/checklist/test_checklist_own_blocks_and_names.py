"""The checklist, own blocks, names and pages: one test for each row of the inventory."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialogButtonBox, QMenu, QPushButton

from nep_studio.blocks.text import sentence
from tests.blocks.block_building import B
from tests.ui.checklist.person import CTRL, LEFT, PLAIN, Key, Person, say, story


def press_in_palette(person: Person, action: str) -> None:
    """Click a button of the palette."""
    shelf = person.palette.shelf
    number = next(n for n, entry in enumerate(shelf.entries) if entry.action == action)
    shelf._go_to(number)
    person.click(shelf.rect_of(number).center(), widget=shelf.viewport())


def press_words(dialog, words: str) -> None:
    """Click the button with these words."""
    button = next(b for b in dialog.findChildren(QPushButton) if b.text() == words)
    QTest.mouseClick(button, LEFT)


def make_greeting(person: Person) -> str:
    """Make the block "greet (name)" by hand; gives its id."""
    press_in_palette(person, "block")
    dialog = person.palette.making.dialog
    person.type("greet", dialog.rows[0].name)
    press_words(dialog, "Add a value")
    person.type("name", dialog.rows[1].name)
    dialog.rows[1].kind.setCurrentIndex(dialog.rows[1].kind.findData("text"))
    QTest.mouseClick(dialog.gives_value, LEFT, PLAIN, QPoint(8, dialog.gives_value.height() // 2))
    press_words(dialog, "Make")
    [procedure] = person.project.procedures
    return procedure


def test_own_blocks_with_parameters_and_a_value_to_give_back(person: Person) -> None:
    """My blocks / procedures with parameters and return."""
    person.make([B("event.started"), say("x")])
    before = person.file

    own = make_greeting(person)
    made = person.file
    parameter = person.project.procedures[own].parts[1]
    header = next(b.id for b in person.project.blocks.values() if b.type == f"my.define.{own}")
    person.qtbot.waitUntil(lambda: any(e.text == "greet …" for e in person.palette.shelf.entries))
    person.from_palette("my.return", person.foot(header) + QPoint(20, 12))
    give = person.block("my.return").id
    start = person.piece(header, parameter.id)
    slot = person.piece(give, "value")
    person.drop(start, slot + QPoint(4, 0))
    speaker = person.body()[1]
    person.from_palette(f"my.call.{own}", person.piece(speaker, "text") + QPoint(12, 2))

    call = person.block(f"my.call.{own}").id
    assert person.project.procedures[own].gives_value
    assert person.project.stack_of(give).body == [header, give]
    inside = person.project.blocks[give].inputs["value"]
    assert person.project.blocks[inside].type == f"my.parameter.{own}.{parameter.id}"
    assert person.project.blocks[speaker].inputs["text"] == call
    code = person.window.workbench.code.text
    person.qtbot.waitUntil(lambda: "def greet(name):\n    return name" in code.toPlainText())
    for _ in range(3):
        after = person.undo()
    assert after == made
    assert person.undo() == before


def test_edit_a_procedure_signature_all_callers_follow_in_one_undo(person: Person) -> None:
    """Edit a procedure signature, all callers follow, one undo."""
    name = person.editor.new_parameter("name", "text")
    place = person.editor.new_stack("behaviour", 40, 300)
    own = person.editor.add_procedure(["greet", name], place=place)
    call = B(f"my.call.{own}", {name.id: "Ada"})
    person.make([B("event.started"), call, call])
    header = next(b.id for b in person.project.blocks.values() if b.type == f"my.define.{own}")
    before = person.file

    person.click(person.piece(header, name.id))
    line = person.canvas.fields.widget
    line.selectAll()
    person.type("person", line)
    person.key(Key.Key_Return, widget=line)
    assert person.project.procedures[own].parts[1].name == "person"
    assert person.undo() == before

    person.choose(person.menu(person.grip(header)), "change_block")
    dialog = person.palette.making.dialog
    person.key(Key.Key_End, widget=dialog.rows[0].name)
    person.type(" kindly", dialog.rows[0].name)
    press_words(dialog, "Add a value")
    person.type("times", dialog.rows[2].name)
    dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok).click()

    calls = [b.id for b in person.project.blocks.values() if b.type == f"my.call.{own}"]
    said = {sentence(person.project, person.editor.language, call) for call in calls}
    assert len(calls) == 2 and len(said) == 1
    assert said.pop().startswith("greet kindly Ada")
    assert person.undo() == before


def test_rename_a_variable_everywhere_find_its_uses_and_a_warning_before_it_goes(
    person: Person,
) -> None:
    """Rename variable everywhere; find uses; delete warns."""
    person.make(
        [B("event.started"), B("variable.set", {"variable": "v4"})],
        [B("variable.get", {"variable": "v4"})],
        variables=("score",),
    )
    assign, reporter, before = person.body()[1], person.body(1)[0], person.file

    def open_and_choose(words: str):
        person.click(person.piece(assign, "variable"))
        popup = person.canvas.fields.widget
        [row] = popup.list.findItems(words, Qt.MatchFlag.MatchStartsWith)
        place = popup.list.visualItemRect(row).center()
        person.click(place, widget=popup.list.viewport())
        return popup

    popup = open_and_choose("rename")
    popup.question.name.selectAll()
    person.type("points", popup.question.name)
    person.key(Key.Key_Return, widget=popup.question.name)
    for block in (assign, reporter):
        assert "points" in sentence(person.project, person.editor.language, block)
    assert person.undo() == before

    person.choose(person.menu(person.grip(assign)), "uses")
    assert set(person.window.workbench.helpers.find_bar.hits) == {assign, reporter}
    person.key(Key.Key_Escape, widget=person.window.workbench.helpers.find_bar.next)

    popup = open_and_choose("delete")
    assert "2 blocks use the variable “score”" in popup.question.words
    QTest.mouseClick(popup.question.yes, LEFT)
    assert person.project.variables == []
    assert person.undo() == before


def test_jump_to_the_definition_and_show_the_callers(person: Person) -> None:
    """Jump to definition / show callers."""
    place = person.editor.new_stack("behaviour", 40, 3000)
    own = person.editor.add_procedure(["bow deeply"], place=place)
    person.make([B("event.started"), B(f"my.call.{own}")])
    header = next(b.id for b in person.project.blocks.values() if b.type == f"my.define.{own}")
    call = person.block(f"my.call.{own}").id
    view = person.canvas.viewport().rect()

    person.choose(person.menu(person.grip(call)), "definition")
    assert person.canvas.selection.ids == (header,)
    assert person.rect(header).toRect().intersects(view)
    person.choose(person.menu(person.grip(header)), "uses")
    finder = person.window.workbench.helpers.find_bar
    person.key(Key.Key_G, CTRL)

    assert call in finder.hits
    assert person.canvas.selection.ids == (finder.hits[finder.index],)
    assert person.rect(call).toRect().intersects(view)


def test_snippets_are_kept_on_disk_for_all_projects(person: Person) -> None:
    """Backpack / snippets: files on disk."""
    person.make(story())
    one, two = person.body()[1:3]
    person.select(one, two)

    person.choose(person.menu(person.grip(one)), "keep")
    question = person.palette.snippet_menu.asking.question
    person.type("my words", question.name)
    person.key(Key.Key_Return, widget=question.name)
    [kept] = person.palette.snippets.folder.iterdir()
    person.window.files.document.close()
    person.window.files.document = None
    person.key(Key.Key_N, CTRL, person.window)
    shelf = person.palette.shelf
    number = next(n for n, entry in enumerate(shelf.entries) if entry.text == "my words")
    shelf._go_to(number)
    before = person.file
    person.click(shelf.rect_of(number).center(), widget=shelf.viewport())

    assert kept.name == "my-words.nepsnippet"
    assert person.texts() == ["one", "two"]
    assert person.undo() == before


def test_several_pages_of_blocks_in_one_project(person: Person) -> None:
    """Several pages/tabs of blocks in one project."""
    person.make([B("event.started"), say("first page")])
    before, bar = person.file, person.window.workbench.pages_bar
    titles = [bar.tabs.tabText(n) for n in range(bar.tabs.count())]

    QTest.mouseClick(bar.add_button, LEFT)
    more = QApplication.activePopupWidget()
    assert isinstance(more, QMenu)
    QTest.mouseClick(more, LEFT, pos=more.actionGeometry(more.actions()[0]).center())
    added = person.canvas.page
    person.from_palette("event.started", QPoint(200, 200))
    assert person.project.kind_of_page(added) == "behaviour"
    assert len(person.body()) == 1 and person.rect(person.body()[0]).x() > 100
    person.click(bar.tabs.tabRect(0).center(), widget=bar.tabs)
    assert person.canvas.page == "behaviour"
    assert person.texts() == ["first page"]
    code = person.window.workbench.code.text.toPlainText
    person.qtbot.waitUntil(lambda: "first page" in code())

    assert len(titles) == 3 and bar.tabs.count() == 4
    person.undo()
    assert person.undo() == before
    assert bar.tabs.count() == 3

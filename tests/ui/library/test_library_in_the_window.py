"""Own blocks in the window: kept in the library, used from there, shared, taken in, updated."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.operations.packing import packed
from nep_studio.blocks.packs import ENDING, About
from nep_studio.blocks.places import InStack
from nep_studio.blocks.procedures import CALL, DEFINE, header_of, title
from nep_studio.project.library import Library, read_pack, write_pack
from nep_studio.run.gate import concerns_of
from nep_studio.ui.canvas.editing.menu import menu_for
from nep_studio.ui.plugins.library.dialog import ShareDialog
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.workbench.help_card import card_text
from nep_studio.ui.workbench.palette.palette import Palette
from tests.blocks.block_building import B, add, build
from tests.ui.palette.palette_use import drop, press_and_drag
from tests.ui.window.conftest import answer, chooser, home, studio, window

__all__ = ["answer", "chooser", "home", "studio", "window"]


@pytest.fixture
def mine(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window with a project in which “wave (times)” is defined and used."""
    window.files.new()
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    editor = window.files.document.editor
    times = editor.new_parameter("times", "number")
    own = editor.add_procedure(["wave", times])
    header = [B(DEFINE + own), B("robot.say", {"text": "Hi"})]
    build(editor.language, header, [B("event.started"), B(CALL + own)], editor=editor)
    return window


def own_of(window: MainWindow) -> str:
    return next(iter(window.files.document.project.procedures))


def header(window: MainWindow) -> str:
    return header_of(window.files.document.project, own_of(window))


def palette_of(window: MainWindow) -> Palette:
    palette = window.workbench.helpers.palette
    palette.set_level("all")
    return palette


def choose(window: MainWindow, block: str, entry: str) -> None:
    """Choose an entry of the menu of a block."""
    canvas = window.workbench.canvas
    canvas.show_block(block)
    rect = canvas.sight.view_rect_of(block)
    hit = canvas.sight.hit(QPointF(rect.left() + 6, rect.center().y()))
    menu = menu_for(canvas, hit, canvas.sight.to_page(QPoint(0, 0)), canvas.menu_sections)
    next(action for action in menu.actions() if action.objectName() == entry).trigger()
    menu.deleteLater()


def entries(window: MainWindow, block: str) -> list[str]:
    canvas = window.workbench.canvas
    canvas.show_block(block)
    rect = canvas.sight.view_rect_of(block)
    hit = canvas.sight.hit(QPointF(rect.left() + 6, rect.center().y()))
    menu = menu_for(canvas, hit, canvas.sight.to_page(QPoint(0, 0)), canvas.menu_sections)
    names = [action.objectName() for action in menu.actions()]
    menu.deleteLater()
    return names


def told(window: MainWindow) -> list[str]:
    return [card.message.title for card in window.message_area.cards]


def kept(window: MainWindow) -> list[str]:
    """What the palette offers of the library."""
    palette = palette_of(window)
    palette.fill()
    shelf = palette.shelf
    return [entry.text for entry in shelf.entries if shelf.pack_of(entry) is not None]


def begin_another(window: MainWindow) -> None:
    window.files._show(None)
    window.files.new()


def share_dialog(window: MainWindow) -> ShareDialog:
    [dialog] = [one for one in window.findChildren(ShareDialog) if one.isVisible()]
    return dialog


def test_a_block_is_kept_from_the_menu_of_its_header(mine: MainWindow) -> None:
    choose(mine, header(mine), "keep_own_block")

    assert told(mine) == ["“wave” is in your library, as version 1."]
    assert kept(mine) == [], "the project has it"
    origin = mine.files.document.project.procedures[own_of(mine)].origin
    assert (origin.title, origin.version) == ("wave", 1)
    begin_another(mine)
    assert kept(mine) == ["wave 0"]


def test_only_a_header_offers_it(mine: MainWindow) -> None:
    project = mine.files.document.project
    call = next(b.id for b in project.blocks.values() if b.type == CALL + own_of(mine))

    assert "keep_own_block" not in entries(mine, call)


def test_a_block_of_the_library_is_used_by_a_key_in_one_step(mine: MainWindow) -> None:
    choose(mine, header(mine), "keep_own_block")
    begin_another(mine)
    palette, editor = palette_of(mine), mine.files.document.editor
    palette.fill()
    entry = next(one for one in palette.shelf.entries if palette.shelf.pack_of(one))
    before = editor.history.steps

    palette.use(entry)

    assert editor.history.steps == before + 1
    [own] = editor.project.procedures
    assert header_of(editor.project, own)
    assert CALL + own in [block.type for block in editor.project.blocks.values()]
    assert kept(mine) == []
    editor.history.undo()
    assert not editor.project.procedures
    assert kept(mine) == ["wave 0"]


def test_a_block_of_the_library_is_dragged_below_another(mine: MainWindow, qtbot: QtBot) -> None:
    choose(mine, header(mine), "keep_own_block")
    begin_another(mine)
    palette, canvas = palette_of(mine), mine.workbench.canvas
    editor = mine.files.document.editor
    start = add(editor, B("event.started"), editor.new_stack("behaviour", 60, 60))
    palette.fill()
    block_type = next(
        palette.shelf.type_of(e) for e in palette.shelf.entries if palette.shelf.pack_of(e)
    )
    canvas.sight.move_camera(0, 0)
    rect = canvas.sight.view_rect_of(start)

    press_and_drag(palette, block_type, QPoint(int(rect.left()) + 60, int(rect.bottom()) + 20))
    drop(palette, QPoint(int(rect.left()) + 60, int(rect.bottom()) + 20))

    [own] = editor.project.procedures
    chain = editor.project.stack_of(start).body
    assert [editor.project.blocks[one].type for one in chain] == ["event.started", CALL + own]
    assert header_of(editor.project, own)


def test_typed_words_find_a_block_of_the_library(mine: MainWindow) -> None:
    choose(mine, header(mine), "keep_own_block")
    begin_another(mine)
    palette = palette_of(mine)

    palette.search.setText("wave")

    assert [e.text for e in palette.shelf.entries if palette.shelf.pack_of(e)] == ["wave 0"]


def test_a_pack_is_taken_out_of_the_library_by_its_menu(mine: MainWindow, qtbot: QtBot) -> None:
    choose(mine, header(mine), "keep_own_block")
    begin_another(mine)
    palette = palette_of(mine)
    palette.fill()
    entry = next(one for one in palette.shelf.entries if palette.shelf.pack_of(one))
    palette.snippet_menu.open(entry, QPoint(0, 0))
    action = next(a for a in palette.snippet_menu.menu.actions() if "out of my library" in a.text())
    palette.snippet_menu.menu.close()

    action.trigger()
    qtbot.mouseClick(palette.snippet_menu.asking.question.yes, Qt.MouseButton.LeftButton)

    assert kept(mine) == []
    assert list(palette.library.folder.iterdir()) == []


# Share


def test_blocks_are_shared_with_what_is_told_of_them(mine: MainWindow, tmp_path: Path) -> None:
    mine.actions_by_name["share_blocks"].trigger()
    dialog = share_dialog(mine)
    dialog.name.setText("Waving")
    dialog.author.setText("Ada")
    dialog.form.help.setPlainText("Waves as often as you like.")
    dialog.form.lines["de"].setText("winke {times} Mal")

    dialog.share(tmp_path / "waving")

    pack = read_pack(tmp_path / f"waving{ENDING}", mine.studio.language)
    [procedure] = pack.offered
    assert (pack.title, pack.about.version, pack.about.author) == ("Waving", 1, "Ada")
    assert procedure.help == "Waves as often as you like."
    assert procedure.sentences == {"de": "winke {" + procedure.parts[1].id + "} Mal"}
    assert mine.settings.author == "Ada"
    assert told(mine) == [f"“Waving” is shared in the file waving{ENDING}."]
    call = next(b for b in mine.files.document.project.blocks.values() if b.type.startswith(CALL))
    about = card_text(mine.files.document.editor, call.id)
    assert "Waves as often as you like." in about
    assert "“Waving”, version 1" in about
    mine.studio.choose_language("de")
    assert "winke" in card_text(mine.files.document.editor, call.id)
    mine.files.document.editor.history.undo()
    assert mine.files.document.project.procedures[own_of(mine)].origin is None


def test_what_was_shared_before_is_shared_as_the_next_version(
    mine: MainWindow, tmp_path: Path
) -> None:
    for number in (1, 2):
        mine.actions_by_name["share_blocks"].trigger()
        dialog = share_dialog(mine)
        assert f"ersion {number}" in dialog.which.currentText()
        dialog.share(tmp_path / f"{number}{ENDING}")

    first, second = (
        read_pack(tmp_path / f"{number}{ENDING}", mine.studio.language) for number in (1, 2)
    )
    assert first.about.id == second.about.id
    assert first.about.offers == second.about.offers
    assert second.about.version == 2


def test_a_sentence_that_lacks_a_value_is_refused_and_changes_nothing(
    mine: MainWindow, tmp_path: Path
) -> None:
    mine.actions_by_name["share_blocks"].trigger()
    dialog, document = share_dialog(mine), mine.files.document
    before = document.editor.history.position
    dialog.form.lines["fr"].setText("fais signe")

    dialog.share(tmp_path / "x.nepblocks")

    assert "{times}" in dialog.reason.text
    assert document.editor.history.position == before
    assert not (tmp_path / "x.nepblocks").exists()
    dialog.reject()


def test_a_file_is_asked_for_only_when_a_block_is_ticked(mine: MainWindow) -> None:
    mine.actions_by_name["share_blocks"].trigger()
    dialog = share_dialog(mine)
    dialog.list.item(0).setCheckState(Qt.CheckState.Unchecked)

    dialog.ask_for_file()

    assert dialog.reason.text == "Tick at least one block."
    dialog.list.item(0).setCheckState(Qt.CheckState.Checked)
    dialog.ask_for_file()
    [asked] = dialog.findChildren(QFileDialog)
    assert Path(asked.selectedFiles()[0]).suffix == ENDING
    asked.reject()
    dialog.reject()


def test_without_own_blocks_nothing_is_shared(window: MainWindow, qtbot: QtBot) -> None:
    window.files.new()
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())

    window.actions_by_name["share_blocks"].trigger()

    assert not window.findChildren(ShareDialog)
    assert [card.message.sentence for card in window.message_area.cards] == [
        "There are no blocks of your own to share."
    ]


# Take in, and update


@pytest.mark.strangers
def test_python_of_a_pack_stays_a_strangers(mine: MainWindow, tmp_path: Path) -> None:
    editor = mine.files.document.editor
    header_stack = editor.project.stack_of(header(mine))
    add(editor, B("code.lines", {"code": "import shutil"}), InStack(header_stack.id, 1))
    path = file_of(mine, tmp_path / "waving.nepblocks")
    begin_another(mine)  # what was typed is the person's: the pack of somebody else is read here
    path.write_bytes(path.read_bytes().replace(b"import shutil", b"import ctypes"))
    mine.files.open(path)
    assert "Python" in mine.message_area.cards[-1].message.sentence
    palette = palette_of(mine)
    palette.fill()

    palette.use(next(one for one in palette.shelf.entries if palette.shelf.pack_of(one)))
    document = mine.files.document
    document.save(tmp_path / "mine.nep")

    concerns = concerns_of(document.project, document.editor.language, tmp_path)
    assert [one.text for one in concerns] == ["import ctypes"]
    assert mine.services.runner.gate.unapproved(concerns) == concerns


def file_of(window: MainWindow, path: Path, version: int = 1, says: str = "") -> Path:
    """A pack of the own block of the window's project, as somebody else would send it."""
    editor = window.files.document.editor
    if says:
        say = next(b for b in editor.project.blocks.values() if b.type == "robot.say")
        editor.apply(SetField(say.id, "text", says))
    about = About("theirs", version, "Ada", "CC BY 4.0")
    pack = packed(editor.project, editor.language, [own_of(window)], about, "Waving")
    write_pack(pack, path)
    return path


def test_a_pack_that_is_dropped_on_the_window_lands_in_the_library(
    mine: MainWindow, tmp_path: Path
) -> None:
    path = file_of(mine, tmp_path / "waving.nepblocks")
    begin_another(mine)
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier

    mine.dropEvent(QDropEvent(QPointF(9, 9), Qt.DropAction.CopyAction, data, buttons, keys))

    [card] = mine.message_area.cards
    assert card.message.title == "“Waving” is in your library"
    assert "1 block" in card.message.sentence
    assert "Ada" in card.message.sentence
    assert "CC BY 4.0" in card.message.sentence
    assert "Python" not in card.message.sentence
    assert kept(mine) == ["wave 0"]
    assert mine.files.document.path is None, "the project stays open"


def test_a_bad_file_is_told_and_nothing_of_it_is_kept(mine: MainWindow, tmp_path: Path) -> None:
    path = tmp_path / "bad.nepblocks"
    path.write_bytes(b'{"format": "nep-studio-project", "version": 2}')

    mine.files.open(path)

    [card] = mine.message_area.cards
    assert card.message.title == "These blocks cannot be used"
    assert card.message.checklist
    assert not mine.workbench.helpers.palette.library.folder.exists()


def test_a_newer_version_is_offered_and_never_taken_by_itself(
    mine: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    first = file_of(mine, tmp_path / "1.nepblocks")
    second = file_of(mine, tmp_path / "2.nepblocks", 2, "Hello again")
    begin_another(mine)
    mine.files.open(first)
    palette = palette_of(mine)
    palette.fill()
    palette.use(next(one for one in palette.shelf.entries if palette.shelf.pack_of(one)))
    editor = mine.files.document.editor
    saved = tmp_path / "with_copy.nep"
    mine.files.document.save(saved)
    mine.files._show(None)
    Library(palette.library.folder).take_in(second, editor.language)

    mine.files.open(saved)

    editor = mine.files.document.editor
    qtbot.waitUntil(lambda: "This project uses version 1 of “Waving”" in told(mine))
    assert "Hello again" not in said(mine)
    assert "update_own_block" in entries(mine, header(mine))
    card = next(c for c in mine.message_area.cards if "version 1" in c.message.title)
    assert card.message.sentence == "Version 2 is in your library."
    card.message.answers[0].do()
    assert "Hello again" in said(mine)
    assert told(mine)[-1] == "The blocks of “Waving” are version 2 now"
    assert not any("version 1" in one for one in told(mine))
    assert "update_own_block" not in entries(mine, header(mine))
    editor.history.undo()
    assert "Hello again" not in said(mine)


def said(window: MainWindow) -> list[object]:
    blocks = window.files.document.project.blocks.values()
    return [block.fields.get("text") for block in blocks if block.type == "robot.say"]


def test_a_block_whose_places_are_others_now_is_told_and_shown(
    mine: MainWindow, tmp_path: Path
) -> None:
    first = file_of(mine, tmp_path / "1.nepblocks")
    editor, own = mine.files.document.editor, own_of(mine)
    name = editor.new_parameter("name", "text")
    editor.change_procedure(own, ["wave", "to", name], gives_value=False)
    second = file_of(mine, tmp_path / "2.nepblocks", 2)
    begin_another(mine)
    mine.files.open(first)
    palette = palette_of(mine)
    palette.fill()
    palette.use(next(one for one in palette.shelf.entries if palette.shelf.pack_of(one)))
    mine.files.open(second)
    card = next(c for c in mine.message_area.cards if "uses version 1" in c.message.title)

    card.message.answers[0].do()

    project = mine.files.document.project
    call = next(b.id for b in project.blocks.values() if b.type == CALL + own_of(mine))
    done = mine.message_area.cards[-1].message
    assert done.kind == "warning"
    assert done.checklist == (
        "1 block that uses them has other places now: look at what is in them.",
    )
    mine.workbench.canvas.selection.clear()
    done.answers[0].do()
    assert list(mine.workbench.canvas.selection.ids) == [call]
    done.answers[1].do()
    assert title(project.procedures[own_of(mine)]) == "wave (times)"

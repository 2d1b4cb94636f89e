"""A Spanish teacher reads problems, refusals and errors of files in Spanish."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QLabel, QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.ui.canvas.painting.overlay import badge_rect
from nep_studio.ui.shell.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def in_spanish(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window in Spanish, with the karate example."""
    window.studio.choose_language("es")
    window.files.open_example(paths.examples() / "karate_greeting.nep")
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    qtbot.waitUntil(lambda: window.workbench.checks._check is None)
    return window


@pytest.fixture
def spanish(in_spanish: MainWindow, qtbot: QtBot) -> MainWindow:
    """The same, whose robot and nodes are deleted, and which waits for an unknown gesture."""
    window = in_spanish
    editor = window.files.document.editor
    for page in ("robots", "nodes"):
        for stack in list(editor.project.pages[page]):
            editor.apply(DeleteBlocks(stack.body[0], len(stack.body)))
    hat = editor.create("event.gesture", editor.new_stack("behaviour", 40, 2000))
    editor.apply(SetField(hat, "gesture", "saltar"))
    qtbot.waitUntil(lambda: len(window.workbench.checks.problems) >= 2)
    return window


def shown_words(widget: QWidget) -> str:
    return "\n".join(label.text() for label in widget.findChildren(QLabel))


def test_the_problems_panel_is_spanish(spanish: MainWindow, qtbot: QtBot) -> None:
    button = spanish.toolbar.widgetForAction(spanish.actions_by_name["check"])

    qtbot.mouseClick(button, LEFT)

    qtbot.waitUntil(lambda: len(spanish.workbench.problems.rows) >= 2)
    rows = spanish.workbench.problems.rows
    told = "\n".join(shown_words(row) for row in rows)
    assert "NAO no está en la página Robots." in told
    assert "Nada reconoce todavía el gesto “saltar”." in told
    assert "O elige otro robot en este bloque." in told
    assert "Añadir NAO" in [row.fix_button.text() for row in rows if row.fix_button]


def test_the_bubble_of_a_badge_is_spanish(spanish: MainWindow, qtbot: QtBot) -> None:
    canvas = spanish.workbench.canvas
    canvas.show_page("behaviour")
    missing = next(p for p in spanish.workbench.checks.problems if p.kind == "robot_missing")

    badge = badge_rect(canvas.page_layout.placed(missing.block), canvas)
    at = canvas.sight.camera.to_view(badge.center().x() + 4, badge.center().y())
    qtbot.mouseClick(canvas.viewport(), LEFT, pos=at.toPoint())

    bubble = spanish.workbench.bubble
    assert "NAO no está en la página Robots." in shown_words(bubble)
    assert "Añadir NAO" in [button.text() for button in bubble.buttons]
    qtbot.keyClick(bubble, Qt.Key.Key_Escape)


def test_a_refused_paste_is_told_in_spanish(spanish: MainWindow, qtbot: QtBot) -> None:
    canvas = spanish.workbench.canvas
    QApplication.clipboard().setText('print("hello"')
    canvas.setFocus()

    qtbot.keyClick(canvas, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)

    qtbot.waitUntil(lambda: bool(spanish.message_area.cards))
    [card] = spanish.message_area.cards
    assert card.message.title == "Esto no encaja"
    assert "Línea 1: Python no entiende esto" in card.message.sentence


def test_a_file_that_is_no_project_is_told_in_spanish(
    in_spanish: MainWindow, chooser, tmp_path: Path, qtbot: QtBot
) -> None:
    chooser.path = tmp_path / "cuento.nep"
    chooser.path.write_text('{"format": "story"}', encoding="utf-8")

    in_spanish.actions_by_name["open"].trigger()

    qtbot.waitUntil(lambda: bool(in_spanish.message_area.cards))
    told = in_spanish.message_area.cards[-1].message
    assert told.title == "Este proyecto no se puede usar"
    assert str(told.sentence) == "cuento.nep no es un proyecto de NEP Studio."
    assert tuple(map(str, told.checklist)) == (
        "Elige un archivo guardado por NEP Studio; su nombre acaba en .nep.",
    )

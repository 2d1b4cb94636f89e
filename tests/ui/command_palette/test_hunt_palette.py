"""The palette is opened from places that do not last."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtWidgets import QApplication, QLineEdit
from pytestqt.qtbot import QtBot

from nep_studio.ui.shell.command_palette import CommandPalette
from nep_studio.ui.shell.main_window import MainWindow


def test_it_closes_when_the_field_from_which_it_was_opened_is_gone(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot
) -> None:
    canvas = karate.workbench.canvas
    blocks = canvas.editor.project.blocks.values()
    say = next(block.id for block in blocks if block.type == "robot.say")
    canvas.show_block(say)
    assert canvas.fields.open(say, "text")
    field = QApplication.focusWidget()
    assert field is not None
    assert field is not canvas

    palette.open()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    qtbot.keyClick(palette.line, Qt.Key.Key_Escape)

    assert not palette.isVisible()


def test_it_closes_when_what_had_the_keyboard_was_deleted(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot
) -> None:
    line = QLineEdit(karate)
    line.show()
    line.setFocus()
    qtbot.waitUntil(line.hasFocus)

    palette.open()
    line.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    qtbot.keyClick(palette.line, Qt.Key.Key_Escape)

    assert not palette.isVisible()

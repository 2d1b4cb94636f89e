"""The program is killed in the middle of the work, and offers it again at the next start."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from nep_studio import settings
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.project.journal import recover
from nep_studio.ui.documents import new_document
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.support import RecoveryDialog

WORK = """
import sys
from pathlib import Path
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from nep_studio import paths
from nep_studio.ui.shell.app import Studio, make_application
from nep_studio.ui.shell.main_window import MainWindow

app = make_application()
window = MainWindow(Studio(app))
window.show()
window.start(None)
window.files.open_example(paths.examples() / "karate_greeting.nep")
canvas = window.workbench.canvas
canvas.setFocus()
window.activateWindow()
QTest.keyClick(canvas, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
QTest.keyClick(canvas, Qt.Key.Key_Delete)
edited = not window.files.document.project.pages["behaviour"]
QTest.keyClick(canvas, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
canvas.selection.set([window.files.document.project.pages["behaviour"][0].body[1]])
QTest.keyClick(canvas, Qt.Key.Key_Delete)
print(f"edited {edited} {len(window.files.document.project.blocks)}", flush=True)
app.exec()
"""


def killed_at_work(home: Path) -> int:
    """Edit in a window of a child process, kill it; how many blocks its project had."""
    environment = {**os.environ, settings.FOLDER_VARIABLE: str(home)}
    environment["QT_QPA_PLATFORM"] = "offscreen"
    child = subprocess.Popen(
        [sys.executable, "-c", WORK], env=environment, stdout=subprocess.PIPE, text=True
    )
    with child:
        assert child.stdout is not None
        edited, blocks = child.stdout.readline().split()[1:]
        child.kill()
    assert edited == "True"
    return int(blocks)


def dialog_of(window: MainWindow, qtbot: QtBot) -> RecoveryDialog:
    qtbot.waitUntil(lambda: bool(window.findChildren(RecoveryDialog)))
    return window.findChildren(RecoveryDialog)[0]


def test_work_of_a_killed_window_is_restored_whole(
    window: MainWindow, home: Path, qtbot: QtBot
) -> None:
    blocks = killed_at_work(home)
    window.offer_recovery()
    dialog = dialog_of(window, qtbot)

    qtbot.mouseClick(dialog.restore_button, Qt.MouseButton.LeftButton)

    assert window.files.document.project.name == "Karate greeting"
    assert len(window.files.document.project.blocks) == blocks
    assert window.isWindowModified()


def test_restored_work_is_kept_until_it_is_saved(
    window: MainWindow, home: Path, qtbot: QtBot
) -> None:
    killed_at_work(home)
    window.offer_recovery()
    qtbot.mouseClick(dialog_of(window, qtbot).restore_button, Qt.MouseButton.LeftButton)

    window.files.document.close(keep=True)  # as another kill would leave it

    [again] = recover(settings.journal_folder(), window.studio.language)
    assert again.name == "Karate greeting"


def test_discarded_work_is_not_offered_again(window: MainWindow, home: Path, qtbot: QtBot) -> None:
    leave_a_journal(window)
    window.offer_recovery()
    dialog = dialog_of(window, qtbot)

    qtbot.mouseClick(dialog.discard_button, Qt.MouseButton.LeftButton)

    assert recover(settings.journal_folder(), window.studio.language) == []


def test_a_look_shows_the_blocks_and_changes_nothing(
    window: MainWindow, home: Path, qtbot: QtBot
) -> None:
    leave_a_journal(window)
    window.offer_recovery()
    dialog = dialog_of(window, qtbot)

    qtbot.mouseClick(dialog.look_button, Qt.MouseButton.LeftButton)

    assert not dialog.picture.pixmap().isNull()
    assert window.files.document is None


def test_a_window_at_work_keeps_its_journal_to_itself(window: MainWindow) -> None:
    window.files.new()
    window.files.document.editor.apply(RenameProject("Mine"))

    assert recover(settings.journal_folder(), window.studio.language) == []


def test_a_saved_and_closed_project_leaves_nothing_to_recover(
    window: MainWindow, chooser, tmp_path: Path
) -> None:
    chooser.path = tmp_path / "saved.nep"
    window.files.new()
    window.files.document.editor.apply(RenameProject("Saved"))
    window.files.save()
    window.files.close()

    assert recover(settings.journal_folder(), window.studio.language) == []
    assert list(settings.journal_folder().iterdir()) == []


def leave_a_journal(window: MainWindow) -> None:
    """A journal whose window is no more."""
    document = new_document(window.studio.language)
    document.editor.apply(RenameProject("Lost"))
    document.close(keep=True)

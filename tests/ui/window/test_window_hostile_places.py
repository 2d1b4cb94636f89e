"""Places that fail: a full disk, a folder that cannot be written, damaged settings."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel

from nep_studio import paths
from nep_studio.settings import FOLDER_VARIABLE, Settings
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow

pytestmark = pytest.mark.long

resource = pytest.importorskip("resource")


def told(window: MainWindow) -> str:
    labels = window.message_area.findChildren(QLabel)
    return "\n".join(label.text() for label in labels if label.isVisible())


def drop(window: MainWindow, path: Path) -> bool:
    """Drop a file onto the window; whether the window takes it."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    copy, left, plain = (
        Qt.DropAction.CopyAction,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    enter = QDragEnterEvent(QPoint(200, 200), copy, data, left, plain)
    enter.ignore()
    QApplication.sendEvent(window, enter)
    if enter.isAccepted():
        let_go = QDropEvent(QPointF(200, 200), copy, data, left, plain)
        QApplication.sendEvent(window, let_go)
    return enter.isAccepted()


@contextmanager
def full_disk() -> Iterator[None]:
    """No file of this process may have more than 200 bytes; not for long: pytest writes one too."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)


def test_on_a_full_disk_nothing_is_saved_and_nothing_is_lost(
    karate: MainWindow, chooser, tmp_path: Path
) -> None:
    chooser.path = tmp_path / "mine.nep"
    chooser.path.write_bytes(b"what was there")

    with full_disk():
        karate.files.save_as()

    assert "The project is not saved" in told(karate)
    assert chooser.path.read_bytes() == b"what was there"
    assert [path.name for path in tmp_path.glob("*.nep*")] == ["mine.nep"]


def test_without_a_folder_of_its_own_the_program_works_and_says_what_is_missing(
    qapp: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qtbot
) -> None:
    blocked = tmp_path / "blocked"
    blocked.write_text("a file where the folder should be")
    monkeypatch.setenv(FOLDER_VARIABLE, str(blocked))
    window = MainWindow(Studio(qapp, Settings(blocked)))
    qtbot.addWidget(window)
    window.show()
    window.start(None)

    QTest.mouseClick(window.start_page.new_button, Qt.MouseButton.LeftButton)

    assert "Save often" in told(window)
    assert window.files.document is not None
    window.workbench.retire()
    window.files.document.close()
    window.files.document = None


def test_settings_that_are_damaged_count_as_none(qapp: QApplication, home: Path, qtbot) -> None:
    home.mkdir(parents=True)
    damage = b"[window]\ngeometry=@ByteArray(\xff\x00)\nrow=@Variant(\x00)\n[look]\ntheme=plaid\n"
    (home / "settings.ini").write_bytes(damage + os.urandom(2000))

    window = MainWindow(Studio(qapp, Settings(home)))
    qtbot.addWidget(window)
    window.show()
    window.start(None)

    assert window.start_page.new_button.isVisible()
    window.workbench.retire()


@pytest.mark.parametrize("name", ["large.nep", "FOLDER.nep", "no_picture.png"])
def test_what_is_no_project_is_refused_in_words_when_it_is_dropped(
    window: MainWindow, tmp_path: Path, qtbot, name: str
) -> None:
    path = tmp_path / name
    if "FOLDER" in name:
        path.mkdir()
    else:
        path.write_bytes(b"{")
        os.truncate(path, 300 * 2**20 if "large" in name else 5)

    is_taken = drop(window, path)

    assert is_taken
    qtbot.waitUntil(lambda: name in told(window))
    assert window.files.document is None


def test_a_project_with_capitals_in_its_ending_can_be_dropped(
    window: MainWindow, tmp_path: Path, qtbot
) -> None:
    path = tmp_path / "KARATE.NEP"
    path.write_bytes((paths.examples() / "karate_greeting.nep").read_bytes())

    is_taken = drop(window, path)

    assert is_taken
    qtbot.waitUntil(lambda: window.files.document is not None)


def test_a_text_file_is_not_taken(window: MainWindow, tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("Dear robot")

    assert not drop(window, tmp_path / "letter.txt")

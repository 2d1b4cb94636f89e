"""The documentation opens in the browser, or a message says why not and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QObject, QUrl, Slot
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from nep_studio.ui.messages import Messages
from nep_studio.ui.plugins.help.help_controller import open_documentation
from nep_studio.ui.words import use_language


class Browser(QObject):
    """Stands where the browser of the computer would."""

    def __init__(self) -> None:
        super().__init__()
        self.opened: list[str] = []
        QDesktopServices.setUrlHandler("file", self, "open")

    @Slot(QUrl)
    def open(self, url: QUrl) -> None:
        self.opened.append(url.toLocalFile())


@pytest.fixture
def pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The first pages in English and German."""
    monkeypatch.setattr("nep_studio.paths.documentation_folder", lambda: tmp_path)
    (tmp_path / "de").mkdir()
    for page in (tmp_path / "index.html", tmp_path / "de" / "index.html"):
        page.touch()
    return tmp_path


@pytest.fixture
def messages(qtbot: QtBot) -> Messages:
    window = QWidget()
    qtbot.addWidget(window)
    return Messages(window)


@pytest.fixture
def browser() -> Browser:
    yield (made := Browser())
    QDesktopServices.unsetUrlHandler("file")
    made.deleteLater()


@pytest.mark.parametrize(("code", "page"), [("en", "index.html"), ("de", "de/index.html")])
def test_the_first_page_opens_in_the_language_of_the_window(
    pages: Path, messages: Messages, browser: Browser, code: str, page: str
) -> None:
    use_language(code)
    try:
        open_documentation(messages)
    finally:
        use_language("en")

    assert [Path(opened) for opened in browser.opened] == [pages / page]
    assert not messages.history


def test_pages_that_are_not_there_are_told_with_what_to_do(
    pages: Path, messages: Messages, browser: Browser
) -> None:
    (pages / "index.html").unlink()

    open_documentation(messages)

    [told] = [each.message for each in messages.history]
    assert told.title == "The documentation cannot be shown"
    assert "tools/build_site.py" in str(told.checklist[0]) and "F1" in str(told.checklist[-1])
    assert browser.opened == []

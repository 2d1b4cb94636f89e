"""What a program keeps is forgotten from the menu Run, and comes back by Undo."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_studio.ui.plugins.kept import forget
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]


@pytest.fixture
def kept(karate: MainWindow, tmp_path: Path) -> Path:
    document = karate.files.document
    assert document is not None
    document.path = tmp_path / "game.nep"
    file = tmp_path / "game.kept.json"
    file.write_text('{"score": 7}', encoding="utf-8")
    return file


def titles(window: MainWindow) -> list[str]:
    return [card.message.title for card in window.message_area.cards]


def test_what_is_kept_is_forgotten_and_comes_back(karate: MainWindow, kept: Path) -> None:
    karate.host.actions["forget_kept"].trigger()

    assert not kept.exists()
    card = karate.message_area.cards[-1]
    card.message.answers[0].do()
    assert kept.read_text(encoding="utf-8") == '{"score": 7}'


def test_what_has_been_kept_since_is_not_written_over(karate: MainWindow, kept: Path) -> None:
    assert forget(karate.host)
    undo = karate.message_area.cards[-1].message.answers[0]
    kept.write_text('{"score": 1}', encoding="utf-8")

    undo.do()

    assert kept.read_text(encoding="utf-8") == '{"score": 1}'
    assert titles(karate)[-1] == "This does not fit"


def test_where_nothing_is_kept_that_is_told(karate: MainWindow, kept: Path) -> None:
    kept.unlink()

    assert not forget(karate.host)
    assert titles(karate)[-1] == "Nothing is kept of this program."

"""A window whose network is opened on the loopback, at free ports and with keys of its own."""

from __future__ import annotations

import threading
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from nep_core.networks.security.pairing import pair
from nep_studio.ui.plugins.sharing import SharingKit
from nep_studio.ui.plugins.sharing import dialog as dialog_module
from nep_studio.ui.plugins.sharing.dialog import SharingDialog
from nep_studio.ui.plugins.sharing.refusal_words import Place
from nep_studio.ui.shell.main_window import MainWindow

HOST = "127.0.0.1"
WAIT_MS = 20_000


@pytest.fixture
def kit(window: MainWindow, tmp_path: Path, free_port: int) -> SharingKit:
    """The window's own; its dialog asks for the addresses of ``Place(HOST)`` only."""
    [found] = window.actions_by_name.findChildren(SharingKit)
    sharing = found.sharing
    sharing.keys, sharing.ports = tmp_path / "own.keys", (free_port, free_port + 1)
    sharing.is_announced = False
    return found


@pytest.fixture
def here_only(monkeypatch: pytest.MonkeyPatch) -> None:
    """This computer is reached at the loopback, and looks for no networks around."""
    defaults = SharingDialog.__init__.__defaults__
    assert defaults is not None
    places = (*defaults[:-1], lambda: [Place(HOST, "lo")])
    monkeypatch.setattr(SharingDialog.__init__, "__defaults__", places)
    monkeypatch.setattr("nep_studio.ui.plugins.sharing.pages.SEARCH_S", 0.0)


def opened_dialog(window: MainWindow, kit: SharingKit) -> dialog_module.SharingDialog:
    """The dialog, as the menu opens it."""
    window.actions_by_name["open_network"].trigger()
    assert kit.dialog is not None
    return kit.dialog


def is_on(dialog: SharingDialog, qtbot: QtBot, page: str) -> None:
    """Wait for a page."""
    area = dialog.areas[page]
    qtbot.waitUntil(lambda: dialog.pages.currentWidget() is area, timeout=WAIT_MS)


def pair_by(code: str, port: int, keys: Path) -> None:
    """Do what the second computer does, in a thread."""
    args = (HOST, port, code, keys)
    threading.Thread(target=pair, args=args, daemon=True).start()

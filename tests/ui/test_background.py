"""Work in the background: its results come in the thread of Qt, or not at all."""

from __future__ import annotations

import threading

from PySide6.QtCore import QCoreApplication, QEvent, QObject
from pytestqt.qtbot import QtBot

from nep_studio.ui.background import Background


def test_the_result_is_told_in_the_thread_of_qt(qtbot: QtBot) -> None:
    owner, told = QObject(), []
    background = Background(owner)

    background.start(
        threading.get_ident, lambda there: told.append((there, threading.get_ident())), name="work"
    )

    qtbot.waitUntil(lambda: bool(told))
    [(there, here)] = told
    assert here == threading.get_ident() != there


def test_what_is_posted_is_done_in_order(qtbot: QtBot) -> None:
    owner, done = QObject(), []
    background = Background(owner)

    for number in range(100):
        background.post(lambda number=number: done.append(number))

    assert done == []
    qtbot.waitUntil(lambda: len(done) == 100)
    assert done == sorted(done)


def test_nothing_is_told_when_the_parent_has_gone(qtbot: QtBot) -> None:
    owner, told, may_end = QObject(), [], threading.Event()
    background = Background(owner)
    thread = background.start(may_end.wait, told.append, name="work")

    owner.deleteLater()
    QCoreApplication.sendPostedEvents(owner, QEvent.Type.DeferredDelete)
    may_end.set()
    thread.join(10.0)
    QCoreApplication.processEvents()

    assert told == []

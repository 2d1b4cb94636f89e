"""News of threads that look for robots: nothing is told any more once nobody wants it."""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.connecting.dialog import RobotTest


def test_a_test_tells_its_steps_and_its_end(qtbot: QtBot) -> None:
    test, told = RobotTest(), []
    test.checked.connect(lambda check: told.append((check.step, check.is_ok)))

    with qtbot.waitSignal(test.ended, timeout=20_000):
        test.start("no robot", "", "", "NAO")

    assert told == [("name", False)]


def test_news_that_are_on_their_way_when_it_is_stopped_are_not_told(qtbot: QtBot) -> None:
    test, told = RobotTest(), []
    test.checked.connect(told.append)
    test.ended.connect(told.append)
    test.start("no robot", "", "", "NAO")
    thread = test._thread
    assert thread is not None
    thread.join(20.0)

    test.stop()
    QCoreApplication.processEvents()

    assert not thread.is_alive()
    assert told == []

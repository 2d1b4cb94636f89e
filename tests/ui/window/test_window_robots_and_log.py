"""The robots and the log in the window: they follow the project, the language and a real run."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from nep_core.networks.master import Master
from nep_studio import paths
from nep_studio.ui.plugins.log import LogPanel
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.widgets.layouts import LatePanel

RUN_MS = 30_000


def shown(window: MainWindow, kind: type[QWidget]) -> QWidget:
    panels = window.workbench.panels
    [found] = [panel.widget for panel in panels.all if type(panel.widget) is kind]
    panels.show(found)
    return found.opened() if isinstance(found, LatePanel) else found


@pytest.fixture
def two_robots(window: MainWindow, qtbot: QtBot) -> MainWindow:
    window.files.open_example(paths.examples() / "two_robots_talk.nep")
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    return window


def test_the_robots_of_the_page_are_shown_before_run(two_robots: MainWindow, qtbot: QtBot) -> None:
    panel = shown(two_robots, RobotsPanel)

    qtbot.waitUntil(lambda: list(panel.cards) == ["NAO", "NAO2"])
    assert {card.health.text() for card in panel.cards.values()} == {"Not started"}


def test_a_robot_that_is_taken_off_the_page_goes(two_robots: MainWindow, qtbot: QtBot) -> None:
    panel = shown(two_robots, RobotsPanel)
    qtbot.waitUntil(lambda: len(panel.cards) == 2)

    two_robots.files.document.close()
    two_robots.files.new()

    qtbot.waitUntil(lambda: "NAO2" not in panel.cards)


def test_a_run_is_told_line_by_line_and_its_robots_speak(
    two_robots: MainWindow, master: Master, qtbot: QtBot
) -> None:
    log, robots = shown(two_robots, LogPanel), shown(two_robots, RobotsPanel)
    said: set[str] = set()

    def is_told() -> bool:
        said.update(card.facts.text() for card in robots.cards.values())
        lines = [line.what for line in log.what_happens.model.lines()]
        return any(line.startswith("says “Hello! I am NAO") for line in lines)

    two_robots.running.runner.run()
    qtbot.waitUntil(is_told, timeout=RUN_MS)
    words = "Says “Hello! I am NAO. Who are you?”"
    qtbot.waitUntil(lambda: is_told() and any(words in one for one in said), timeout=RUN_MS)
    two_robots.running.runner.stop()

    qtbot.waitUntil(lambda: two_robots.running.runner.state == "idle", timeout=RUN_MS)
    first = log.what_happens.model.lines()[0]
    assert first.what.startswith("Run at ")

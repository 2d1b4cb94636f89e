"""A program that waits for a person: Run shows who acts, and waits for the person's press."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.run.plan import VIRTUAL_WATCH, PlannedNode
from nep_studio.ui.plugins.person.panel import HumanPanel
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.checklist.person import Person
from tests.ui.running.window_use import WAIT_MS, Seen, health, press, state_is

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def person(window: MainWindow, qtbot: QtBot) -> Person:
    """Somebody who has put “when the gesture karate is made, say …” onto an empty page."""
    window.files.new()
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    made = Person(window, qtbot)
    made.from_palette("event.gesture", QPoint(120, 120))
    hat = made.block("event.gesture").id
    made.from_palette("robot.say", made.foot(hat) + QPoint(36, 18))
    assert len(made.body()) == 2
    return made


def panel_of(window: MainWindow, kind: type):
    return next(one.widget for one in window.workbench.panels.all if isinstance(one.widget, kind))


def watches(window: MainWindow) -> set[str]:
    """The watches that run."""
    runner = window.running.runner
    return {one.name for one in runner.local.running if one.node == VIRTUAL_WATCH}


def test_run_shows_robot_and_person_and_waits_for_the_press(
    person: Person, window: MainWindow, qtbot: QtBot
) -> None:
    seen = Seen(window)
    robots, human = panel_of(window, RobotsPanel), panel_of(window, HumanPanel)
    for panel in window.workbench.panels.all:
        if panel.widget in (robots, human):
            panel.action.setChecked(False)  # also who has closed them once sees them again

    press(window, qtbot, "run")
    state_is(window, qtbot, "running")

    assert robots.isVisible() and human.isVisible()
    assert window.workbench.canvas.page == "behaviour"
    [button] = human.waiting.buttons
    qtbot.waitUntil(lambda: human.stimuli.has_watch, timeout=WAIT_MS)
    made = [one for one in seen.messages if isinstance(one, m.HumanBehavior)]
    assert made == [] and seen.said() == []  # nobody has moved
    qtbot.mouseClick(button, LEFT)
    qtbot.waitUntil(lambda: seen.said() == ["Hello"], timeout=WAIT_MS)


def test_a_watch_that_was_left_running_is_the_one_that_run_uses(
    person: Person, window: MainWindow, qtbot: QtBot
) -> None:
    runner = window.running.runner
    runner.start_node(PlannedNode(VIRTUAL_WATCH, "left", {}), is_wanted=True)
    qtbot.waitUntil(lambda: health(window, "left") == "ready", timeout=WAIT_MS)
    pid = runner.local.launcher.nodes["left"].pid

    press(window, qtbot, "run")
    state_is(window, qtbot, "running")

    assert watches(window) == {"left"}
    assert runner.local.launcher.nodes["left"].pid == pid
    press(window, qtbot, "stop")
    state_is(window, qtbot, "idle")
    assert watches(window) == {"left"}


def test_a_watch_of_the_program_moves_alone(karate: MainWindow, qtbot: QtBot) -> None:
    runner = karate.running.runner
    runner.start_node(PlannedNode(VIRTUAL_WATCH, "left", {}), is_wanted=True)
    qtbot.waitUntil(lambda: watches(karate) == {"left"}, timeout=WAIT_MS)

    press(karate, qtbot, "run")

    qtbot.waitUntil(lambda: watches(karate) == {"watch"}, timeout=WAIT_MS)

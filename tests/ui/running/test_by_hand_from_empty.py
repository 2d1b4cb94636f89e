"""A program that waits for a person: Run shows who acts, and waits for the person's press."""

from __future__ import annotations

import socket

import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.blocks.operations.fixes import use_real_robot
from nep_studio.blocks.places import InStack
from nep_studio.run.plan import VIRTUAL_WATCH, PlannedNode
from nep_studio.ui.message_cards import MessageCard
from nep_studio.ui.plugins.connecting.dialog import ConnectDialog
from nep_studio.ui.plugins.person.panel import HumanPanel
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.running.needs import in_the_way_to
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.words import tr
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


@pytest.mark.parametrize("scale", [1.0, 1.5])
def test_what_the_program_waits_for_is_in_sight_when_run_is_pressed_at_the_person(
    person: Person, window: MainWindow, qtbot: QtBot, scale: float
) -> None:
    human = panel_of(window, HumanPanel)
    window.studio.choose_text_scale(scale)
    window.resize(1280, 720)
    window.workbench.panels.show(human)
    qtbot.waitUntil(human.run_button.isVisible)

    qtbot.mouseClick(human.run_button, LEFT)  # it goes, and the keyboard must not go far below
    state_is(window, qtbot, "running")

    [button] = human.waiting.buttons
    qtbot.waitUntil(lambda: button.visibleRegion().boundingRect() == button.rect())
    assert not human.run_button.isVisible()
    assert window.height() <= 728  # the screen of a laptop, less its task bar
    window.studio.choose_text_scale(1.0)


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


def test_a_wrong_address_is_told_during_a_run_as_the_connect_dialog_tells_it(
    window: MainWindow, qtbot: QtBot
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        nowhere = f"127.0.0.1:{server.getsockname()[1]}"
    window.files.new()
    editor = window.files.document.editor
    with editor.history.as_own():
        use_real_robot(editor, "NAO", nowhere, "connect a robot")
        hat = editor.create("event.started", editor.new_stack("behaviour", 40.0, 40.0))
        say = editor.create("robot.say", InStack(editor.project.stack_of(hat).id, 1))

    press(window, qtbot, "run")

    def end() -> MessageCard | None:
        found = (one for one in window.message_area.cards if "Run again" in labels(one))
        return next(found, None)

    qtbot.waitUntil(lambda: end() is not None, timeout=WAIT_MS)
    advice = in_the_way_to("NAO", nowhere)
    assert advice is not None
    assert end().message.checklist == tuple(map(tr, advice.checklist))
    assert window.message_area.cards == [end()]  # none still says that the program runs
    assert window.workbench.canvas.selection.ids == (say,)
    qtbot.mouseClick(end().buttons[labels(end()).index("Find it and test the connection")], LEFT)
    [dialog] = window.findChildren(ConnectDialog)
    assert dialog.isVisible() and dialog.address.text() == nowhere
    dialog.reject()


def labels(card: MessageCard) -> list[str]:
    return [button.text() for button in card.buttons]

"""A person goes elsewhere while a program is about to run, or the window does."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest
from PySide6.QtCore import QCoreApplication, QObject
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio import paths
from nep_studio.blocks.edits.content import SetField
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.words import tr
from tests.blocks.block_building import B, build
from tests.ui.running.window_use import LONG_WAIT, WAIT_MS, Seen, block_of, press, state_is

pytestmark = pytest.mark.long

WAITING = [B("event.started"), LONG_WAIT]
OTHER = paths.examples() / "dance.nep"


@pytest.fixture
def slow_checks(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a project of thousands of blocks: the checks take many turns."""
    monkeypatch.setattr("nep_studio.ui.running.runner.SLICE_S", 0.0)


def settled(window: MainWindow, qtbot: QtBot) -> None:
    """Wait until all that was about to happen has happened."""
    qtbot.waitUntil(lambda: window.running.runner.controller.state == "idle")
    found = qtbot.waitSignal(window.workbench.checks.found)
    with found:
        window.workbench.checks.start()
    for _ in range(50):
        QCoreApplication.processEvents()


def test_a_project_that_is_opened_while_another_is_checked_does_not_run(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen], slow_checks: None
) -> None:
    open_program(WAITING)
    window.running.runner.run()
    assert window.running.runner.controller.state == "checking"

    window.files.open_example(OTHER)
    settled(window, qtbot)

    assert window.running.runner.state == "idle"
    assert window.running.runner.controller.request is None


def test_a_project_that_is_opened_while_another_runs_again_does_not_run(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen]
) -> None:
    seen = open_program(WAITING)
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    press(window, qtbot, "run")
    assert window.running.runner.state == "stopping"

    window.files.open_example(OTHER)
    state_is(window, qtbot, "idle")
    settled(window, qtbot)

    assert seen.states == ["starting", "running", "stopping", "idle"]


def test_an_example_that_was_not_opened_after_all_lets_no_other_project_run(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen], answer: Callable
) -> None:
    seen = open_program(WAITING)
    editor = window.files.document.editor
    editor.apply(SetField(block_of(window, "control.wait"), "seconds", 3), "")
    window.running.try_example(OTHER)
    answer(window, "Cancel")

    editor.history.undo()
    window.files.open_example(OTHER)
    settled(window, qtbot)

    assert seen.states == []


def test_a_language_that_is_chosen_during_the_checks_does_not_skip_them(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen], slow_checks: None
) -> None:
    seen = open_program([B("event.started"), B("robot.say", {"robot": "Nobody"})])
    window.running.runner.run()

    window.studio.choose_language("en")
    assert window.running.runner.controller.state == "checking"
    settled(window, qtbot)

    assert seen.states == []


def test_nothing_starts_once_the_window_is_closed(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen]
) -> None:
    seen = open_program(WAITING)
    window.running.runner.run()

    window.close()
    window.running.runner.start_node(window.running.planned()[0])
    for _ in range(50):
        QCoreApplication.processEvents()

    assert seen.states == []
    assert not window.running.runner.is_connected


def test_a_change_while_a_program_runs_is_no_new_state(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen]
) -> None:
    seen = open_program(WAITING)
    press(window, qtbot, "run")

    editor = window.files.document.editor
    state_is(window, qtbot, "starting")
    editor.apply(SetField(block_of(window, "control.wait"), "seconds", 3), "")
    state_is(window, qtbot, "running")

    assert window.running.is_stale
    assert seen.states == ["starting", "running"]


def test_a_program_of_the_help_does_not_light_blocks_of_the_canvas(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen]
) -> None:
    seen = open_program(WAITING)
    help_editor = build(window.studio.language, [B("event.started"), LONG_WAIT])
    assert help_editor.project.blocks.keys() & window.files.document.project.blocks.keys()

    window.running.try_project(help_editor.project)
    state_is(window, qtbot, "running")
    qtbot.waitUntil(lambda: _tells_lines(seen), timeout=WAIT_MS)

    assert set().union(*seen.glowing) == set()


def _tells_lines(seen: Seen) -> bool:
    return any(isinstance(one, m.ProgramState) and one.lines for one in seen.messages)


def test_a_tap_that_goes_with_its_parent_hears_no_more(window: MainWindow, qtbot: QtBot) -> None:
    runner = window.running.runner
    with qtbot.waitSignal(runner.connected, timeout=WAIT_MS):
        runner.open_network()
    parent = QObject()
    runner.tap("/hunted", parent=parent)
    qtbot.waitUntil(lambda: "nep-tap-/hunted" in _threads())

    parent.deleteLater()

    qtbot.waitUntil(lambda: "nep-tap-/hunted" not in _threads(), timeout=5000)


def test_a_message_that_cannot_be_sent_does_not_silence_the_next(
    window: MainWindow, qtbot: QtBot
) -> None:
    runner = window.running.runner
    with qtbot.waitSignal(runner.connected, timeout=WAIT_MS):
        runner.open_network()
    tap = runner.tap("/hunted", parent=window)
    heard: list[object] = []
    tap.arrived.connect(lambda batch: heard.extend(one.message for one in batch))

    def is_heard() -> bool:  # the tap may begin to listen only now
        runner.send("/hunted", {"whole": 1})
        return {"whole": 1} in heard

    runner.send("/hunted", {"half a letter": "\ud800"})

    qtbot.waitUntil(is_heard, timeout=WAIT_MS)


def _threads() -> set[str]:
    return {thread.name for thread in threading.enumerate()}


def test_a_program_goes_on_in_another_language(
    window: MainWindow, qtbot: QtBot, open_program: Callable[..., Seen]
) -> None:
    seen = open_program(WAITING)
    press(window, qtbot, "run")
    state_is(window, qtbot, "running")
    wait = block_of(window, "control.wait")
    qtbot.waitUntil(lambda: wait in window.running.stage.marks.glowing, timeout=WAIT_MS)
    states, workbench = list(seen.states), window.workbench

    for code in ("de", "ja", "qps-rtl", "en", "de"):
        window.studio.choose_language(code)
        QCoreApplication.processEvents()

    assert seen.states == states and window.running.runner.state == "running"
    assert window.workbench is workbench and wait in window.running.stage.marks.glowing
    assert window.actions_by_name["run"].text() == tr("Run again")
    press(window, qtbot, "stop")
    state_is(window, qtbot, "idle")
    assert window.actions_by_name["run"].text() == tr("Run")

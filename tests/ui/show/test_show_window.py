"""Show mode covers the screen, plays, begins again after errors, and is left on purpose only."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest
from PySide6.QtCore import QPoint, QRect, Qt, QTimer
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.ui.plugins.show import leaving, performance
from nep_studio.ui.plugins.show.window import ShowWindow
from nep_studio.ui.shell.main_window import MainWindow
from tests.blocks.block_building import B

pytestmark = pytest.mark.long

Begin = Callable[..., ShowWindow]
WAIT_MS = 30_000
SAY = [B("event.started"), B("robot.say", {"text": "Good evening"})]
WAITS = [B("event.gesture", {"gesture": "karate"}), B("robot.say", {"text": "Ha"})]
FAILS = [B("event.started"), B("code.lines", {"code": "1 / 0"})]


@pytest.fixture
def hurry(monkeypatch: pytest.MonkeyPatch) -> None:
    """Seconds of a pause go by quickly."""
    monkeypatch.setattr(performance, "TICK_MS", 20)


@pytest.fixture
def hold_less_long(monkeypatch: pytest.MonkeyPatch) -> None:
    """Six steps of the bar are enough to leave."""
    monkeypatch.setattr(leaving, "HOLD_MS", 6 * leaving.STEP_MS)


def state_is(show: ShowWindow, qtbot: QtBot, state: str) -> None:
    qtbot.waitUntil(lambda: show.performance.state == state, timeout=WAIT_MS)


def press(button, qtbot: QtBot) -> None:
    assert button.isVisible() and button.isEnabled()
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def test_it_covers_the_screen_and_the_window_waits_behind(
    window: MainWindow, open_program, show: Begin
) -> None:
    open_program(SAY, name="The play")

    shown = show()

    assert shown.isFullScreen() and not window.isVisible()
    assert shown.title.text() == "The play"
    assert shown.run_button.isVisible() and not shown.stop_button.isVisible()


def test_run_plays_and_tells_in_large_words_what_the_robot_says(
    open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show()

    press(shown.run_button, qtbot)
    qtbot.waitUntil(lambda: "Good evening" in shown.words.lines, timeout=WAIT_MS)
    state_is(shown, qtbot, "ready")

    assert shown.run_button.isVisible()
    assert shown.performance.restarts.total == 0


def test_stop_stops_and_nothing_begins_again(open_program, show: Begin, qtbot: QtBot) -> None:
    open_program(WAITS)
    shown = show(again=True)
    press(shown.run_button, qtbot)
    state_is(shown, qtbot, "playing")

    press(shown.stop_button, qtbot)
    state_is(shown, qtbot, "ready")

    assert shown.run_button.isVisible()


def test_a_show_that_ended_begins_again_where_that_is_wanted(
    hurry: None, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show(again=True, runs_at_once=True)

    qtbot.waitUntil(lambda: shown.performance.restarts.total == 2, timeout=WAIT_MS)

    assert "begun again" in shown.state_words.text()


def test_a_program_that_fails_is_begun_again_and_then_needs_attention(
    hurry: None, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(FAILS)
    shown = show(restarts=2, runs_at_once=True)

    state_is(shown, qtbot, "attention")

    assert shown.performance.restarts.total == 2
    assert shown.attention.isVisible()
    assert "rest" in shown.attention.headline.text()
    assert "error" in shown.attention.text.text()
    assert "Then press Run." in shown.attention.text.text()
    press(shown.run_button, qtbot)
    assert shown.performance.restarts.total == 0


def test_stop_ends_the_waiting_too(hurry: None, open_program, show: Begin, qtbot: QtBot) -> None:
    open_program(FAILS)
    shown = show(restarts=50, runs_at_once=True)
    state_is(shown, qtbot, "waiting")

    press(shown.stop_button, qtbot)

    assert shown.performance.state == "ready"
    assert not shown.performance._clock.isActive()


def test_a_killed_robot_node_does_not_end_the_show(
    window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(WAITS)
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")
    board = window.running.runner.board
    qtbot.waitUntil(lambda: board.nodes.get("NAO") is not None and board.nodes["NAO"].pid > 0)
    old = board.nodes["NAO"].pid

    psutil.Process(old).kill()

    qtbot.waitUntil(
        lambda: board.nodes["NAO"].pid not in (0, old) and board.nodes["NAO"].is_there,
        timeout=WAIT_MS,
    )
    assert shown.performance.state == "playing"
    assert shown.isVisible()


def test_a_killed_program_goes_on_or_begins_again(
    hurry: None, window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(WAITS)
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")
    board = window.running.runner.board
    qtbot.waitUntil(lambda: "program" in board.nodes and board.nodes["program"].pid > 0)
    old = board.nodes["program"].pid

    psutil.Process(old).kill()

    qtbot.waitUntil(lambda: board.nodes["program"].pid not in (0, old), timeout=WAIT_MS)
    state_is(shown, qtbot, "playing")


def test_a_project_that_is_not_there_yet_is_looked_for_again(
    hurry: None, window: MainWindow, show: Begin, tmp_path: Path, qtbot: QtBot
) -> None:
    path = tmp_path / "late.nep"
    shown = show(path, runs_at_once=True, restarts=1000)
    state_is(shown, qtbot, "waiting")

    path.write_bytes((paths.examples() / "karate_greeting.nep").read_bytes())

    state_is(shown, qtbot, "playing")
    assert shown.title.text() == "late"


def test_closing_the_window_by_keys_does_not_end_the_show(open_program, show: Begin) -> None:
    open_program(SAY)
    shown = show()

    shown.close()

    assert shown.isVisible()


def test_a_short_esc_does_nothing_and_a_long_one_leaves(
    hold_less_long: None, window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show()

    qtbot.keyClick(shown.run_button, Qt.Key.Key_Escape)
    was_visible = shown.isVisible()
    qtbot.keyPress(shown.run_button, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: shown.hold_bar.isVisible())
    qtbot.waitUntil(window.isVisible)

    assert was_visible
    window.messages.confirm("Back")
    assert [card.message.title for card in window.message_area.cards] == ["Back"]


def test_a_slow_computer_asks_nobody_to_hold_longer(
    monkeypatch: pytest.MonkeyPatch, window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    monkeypatch.setattr(leaving, "HOLD_MS", 20 * leaving.STEP_MS)
    open_program(SAY)
    shown = show()
    slow, turns = QTimer(shown, interval=0), []

    def hold_up() -> None:
        turns.append(1)
        time.sleep(3 * leaving.STEP_MS / 1000)

    slow.timeout.connect(hold_up)
    slow.start()

    qtbot.keyPress(shown.run_button, Qt.Key.Key_Escape)
    qtbot.waitUntil(window.isVisible, timeout=WAIT_MS)

    assert len(turns) < 15, "each has room for three steps of the bar"


def test_a_key_that_comes_as_pairs_of_press_and_release_is_held(
    hold_less_long: None, window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show()
    pairs = QTimer(interval=40)  # as remote desktops repeat a key
    pairs.timeout.connect(lambda: qtbot.keyClick(shown.run_button, Qt.Key.Key_Escape))

    shown.left.connect(pairs.stop)
    pairs.start()

    qtbot.waitUntil(window.isVisible)


def test_taps_with_pauses_between_them_are_not_held(
    hold_less_long: None, window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show()

    for _ in range(4):
        qtbot.keyClick(shown.run_button, Qt.Key.Key_Escape)
        qtbot.waitUntil(lambda: not shown.holding.is_held)

    assert shown.isVisible() and not window.isVisible()


def test_at_first_it_says_how_it_is_left(
    monkeypatch: pytest.MonkeyPatch, open_program, show: Begin, qtbot: QtBot
) -> None:
    told_ms = leaving.TOLD_MS
    monkeypatch.setattr(leaving, "TOLD_MS", 200)
    open_program(SAY)

    shown = show()

    assert told_ms == 5000
    assert shown.hold_bar.isVisible() and "hold Esc" in shown.hold_bar.words.text()
    qtbot.waitUntil(lambda: not shown.hold_bar.isVisible())


def point(shown: ShowWindow, target: QWidget) -> QPoint:
    """Move the mouse there, as the system tells the window; where that is in the window."""
    place = target.mapTo(shown, target.rect().center())
    QTest.mouseMove(shown.windowHandle(), place + QPoint(3, 3))
    QTest.mouseMove(shown.windowHandle(), place)
    return place


def test_a_corner_that_comes_with_the_pointer_is_held_to_leave(
    hold_less_long: None,
    monkeypatch: pytest.MonkeyPatch,
    window: MainWindow,
    open_program,
    show: Begin,
    qtbot: QtBot,
) -> None:
    monkeypatch.setattr(leaving, "RESTS_MS", 300)
    open_program(SAY)
    shown = show()
    qtbot.waitUntil(lambda: not shown.corner.isVisible())
    place = point(shown, shown.words)
    qtbot.waitUntil(shown.corner.isVisible)
    place = point(shown, shown.corner)

    QTest.mousePress(shown.windowHandle(), Qt.MouseButton.LeftButton, pos=place)
    QTest.mouseRelease(shown.windowHandle(), Qt.MouseButton.LeftButton, pos=place)
    after_a_click = shown.isVisible(), shown.hold_bar.isVisible()
    QTest.mousePress(shown.windowHandle(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(window.isVisible)

    assert after_a_click == (True, True)


def test_a_finger_leaves_too(
    hold_less_long: None, window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show()
    screen, place = QTest.createTouchDevice(), shown.corner.rect().center()
    place = shown.corner.mapTo(shown, place)

    touch = QTest.touchEvent(shown.windowHandle(), screen)
    touch.press(0, place, shown.windowHandle())
    touch.commit()

    qtbot.waitUntil(window.isVisible)


def test_while_it_plays_only_speech_and_what_somebody_can_do_are_shown(
    monkeypatch: pytest.MonkeyPatch, open_program, show: Begin, qtbot: QtBot
) -> None:
    monkeypatch.setattr(leaving, "RESTS_MS", 300)
    open_program(
        WAITS,
        [B("robot_events.touched", {"part": "head"}), B("robot.say", {"text": "Oh"})],
        [B("event.started"), B("robot.say", {"text": "Welcome"})],
    )
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")

    qtbot.waitUntil(lambda: shown.words.lines == ["Welcome"], timeout=WAIT_MS)
    qtbot.waitUntil(lambda: not shown.corner.isVisible())

    assert len(shown.invitations.lines) == 2
    assert "karate" in shown.invitations.lines[0].lower()
    assert "head" in shown.invitations.lines[1]
    hidden = (shown.title, shown.state_words, shown.cues, shown.cues_button, shown.run_button)
    assert [part for part in hidden if part.isVisible()] == []
    assert shown.stop_button.isVisible()
    qtbot.waitUntil(lambda: shown.words.lines == [], timeout=WAIT_MS)


def test_what_a_rule_does_is_no_time_to_begin_it_again(
    open_program, show: Begin, qtbot: QtBot
) -> None:
    hears = [B("event.gesture", {"gesture": "karate"}), B("control.wait", {"seconds": 30})]
    open_program(hears)
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")
    qtbot.waitUntil(lambda: len(shown.invitations.lines) == 1, timeout=WAIT_MS)

    qtbot.keyClick(shown.stop_button, "1")

    qtbot.waitUntil(lambda: shown.invitations.lines == [], timeout=WAIT_MS)


def test_cues_stand_ready_without_being_seen(open_program, show: Begin, qtbot: QtBot) -> None:
    open_program(WAITS)
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")

    qtbot.keyClick(shown.stop_button, "1")
    qtbot.waitUntil(lambda: "Ha" in shown.words.lines, timeout=WAIT_MS)

    place = point(shown, shown.cues_button)
    QTest.mouseClick(shown.windowHandle(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(lambda: shown.cues.isVisible() and bool(shown.cues.board.buttons))


def test_with_a_pin_only_the_pin_leaves(
    window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    window.settings.set_pin("2407")
    open_program(SAY)
    shown = show()
    shown.holding.held.emit()

    qtbot.keyClicks(shown.pin.line, "1234")
    qtbot.keyClick(shown.pin.line, Qt.Key.Key_Return)
    refused = shown.pin.words.text(), shown.isVisible()
    qtbot.keyClicks(shown.pin.line, "2407")
    qtbot.mouseClick(shown.pin.leave_button, Qt.MouseButton.LeftButton)

    assert refused == ("This is not the PIN. Try again.", True)
    assert window.isVisible()
    assert "2407" not in (window.settings.folder / "settings.ini").read_text(encoding="utf-8")


def test_what_runs_goes_on_when_the_show_is_left(
    window: MainWindow, open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(WAITS)
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")

    shown.leave()

    assert window.running.runner.state == "running"
    assert window.isVisible()


@pytest.mark.parametrize("size", [(640, 480), (1024, 600), (1080, 1920), (3840, 2160)])
def test_another_screen_shows_all_of_it(
    open_program, show: Begin, qtbot: QtBot, size: tuple[int, int]
) -> None:
    open_program(SAY, name="A play with quite a long name that somebody gave it")
    shown = show()

    shown.setWindowState(Qt.WindowState.WindowNoState)
    shown.resize(*size)

    def is_inside(widget: QWidget) -> bool:
        place = QRect(widget.mapTo(shown, QPoint(0, 0)), widget.size())
        return shown.rect().contains(place)

    parts = (shown.title, shown.state_words, shown.words, shown.run_button)
    qtbot.waitUntil(lambda: shown.size().toTuple() == size and all(map(is_inside, parts)))
    assert shown.run_button.height() >= size[1] * 0.1


def test_when_a_screen_is_unplugged_it_covers_the_one_that_is_left(
    open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(SAY)
    shown = show()
    shown.showNormal()

    QGuiApplication.instance().screenRemoved.emit(QGuiApplication.primaryScreen())

    qtbot.waitUntil(shown.isFullScreen)


def test_the_operator_has_cues_and_their_keys(open_program, show: Begin, qtbot: QtBot) -> None:
    open_program(WAITS)
    shown = show(has_cues=True, runs_at_once=True)
    state_is(shown, qtbot, "playing")

    qtbot.mouseClick(shown.cues.board.buttons[0], Qt.MouseButton.LeftButton)

    qtbot.waitUntil(lambda: any("Ha" in line for line in shown.words.lines), timeout=WAIT_MS)


def test_a_cue_of_its_operator_invites_nobody_and_its_buttons_have_the_room(
    open_program, show: Begin, qtbot: QtBot
) -> None:
    open_program(
        WAITS, [B("event.human_state", {"state": "cue_storm"}), B("robot.say", {"text": "Oh"})]
    )
    shown = show(runs_at_once=True)
    state_is(shown, qtbot, "playing")
    qtbot.waitUntil(lambda: len(shown.invitations.lines) == 1, timeout=WAIT_MS)
    assert "karate" in shown.invitations.lines[0].lower()

    QTest.mouseMove(shown, QPoint(300, 300))
    qtbot.waitUntil(shown.cues_button.isVisible)
    qtbot.mouseClick(shown.cues_button, Qt.MouseButton.LeftButton)

    assert shown.cues.isVisible() and not shown.invitations.isVisible()
    assert len([one for one in shown.cues.board.buttons if one.isVisible()]) == 2
    qtbot.mouseClick(shown.cues_button, Qt.MouseButton.LeftButton)
    assert shown.invitations.isVisible()


def test_the_action_begins_the_show(window: MainWindow, open_program, qtbot: QtBot) -> None:
    open_program(SAY)

    qtbot.keyClick(window, Qt.Key.Key_F11)

    shown = next(
        w for w in QGuiApplication.instance().topLevelWidgets() if w.objectName() == "show"
    )
    assert shown.isFullScreen()
    shown.leave()
    QTest.qWait(0)  # what was asked to be deleted goes

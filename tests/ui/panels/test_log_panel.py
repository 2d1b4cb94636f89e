"""The log panel: lines of a real run's messages, and the messages that the window told."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication, QFileDialog, QMainWindow
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.run.installation import studio_language
from nep_studio.ui.messages import Message, Messages
from nep_studio.ui.plugins.log.lines import MOST_LINES, Line, LinesModel
from nep_studio.ui.plugins.log.panel import MOST_AT_ONCE, LogPage, WhatHappens
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.look import Look, load_fonts

SAY = m.ActionRequest(id="1", robots=["NAO"], action="say", args={"text": "Impressive!"})
STARTED = m.ActionResult(id="1", robot="NAO", state="started")
KARATE = m.HumanBehavior(human_state="gesture_karate", certainty=0.87, source="karate")
READY = m.NodeState(node="NAO", type="action", event="ready")
BATCH = [
    (m.NODE_STATE, READY),
    (m.HUMAN_BEHAVIOR, KARATE),
    (m.ACTION_REQUEST, SAY),
    (m.ACTION_RESULT, STARTED),
    (m.PROGRAM_STATE, m.ProgramState(program="program", event="line", line=3)),
]


@pytest.fixture
def host(qtbot: QtBot) -> QMainWindow:
    made = QMainWindow()
    qtbot.addWidget(made)
    return made


@pytest.fixture
def runner(host: QMainWindow, tmp_path: Path) -> Iterator[Runner]:
    made = Runner(list, host, logs=tmp_path)
    yield made
    made.close()


@pytest.fixture
def look(qapp: QApplication) -> Iterator[Look]:
    load_fonts()
    made = Look(qapp, "light")
    yield made
    made.deleteLater()


@pytest.fixture
def log(host: QMainWindow, runner: Runner, look: Look, qtbot: QtBot) -> LogPage:
    made = LogPage(runner, Messages(host), studio_language, look)
    host.setCentralWidget(made)
    host.resize(900, 300)
    host.show()
    qtbot.waitExposed(host)
    return made


def words(panel: WhatHappens) -> list[tuple[str, str]]:
    return [(line.source, line.what) for line in panel.model.lines()]


def test_an_empty_log_says_what_belongs_there(log: LogPage) -> None:
    assert log.what_happens.hint.isVisible()
    assert "Press Run" in log.what_happens.hint.text()


def test_what_happens_is_told_as_it_comes(log: LogPage, runner: Runner) -> None:
    runner.arrived.emit(BATCH)

    assert words(log.what_happens) == [
        ("NAO", "ready"),
        ("karate", "recognised karate (87% certain)"),
        ("NAO", "says “Impressive!”"),
    ]
    assert log.what_happens.list.isVisible()


def test_a_run_begins_with_a_line_of_its_own_at_time_0(log: LogPage, runner: Runner) -> None:
    runner.state_changed.emit("starting")

    [line] = log.what_happens.model.lines()

    assert line.what.startswith("Run at ")
    assert line.elapsed_s == 0


def test_a_hidden_panel_tells_later_what_came_meanwhile(
    log: LogPage, runner: Runner, host: QMainWindow
) -> None:
    host.hide()
    runner.arrived.emit(BATCH)
    assert words(log.what_happens) == []

    host.show()

    assert len(words(log.what_happens)) == 3


def test_the_lines_of_a_part_and_with_some_words_can_be_shown_alone(
    log: LogPage, runner: Runner, qtbot: QtBot
) -> None:
    panel = log.what_happens
    runner.arrived.emit(BATCH)

    panel.part.setCurrentIndex(panel.part.findData("action"))
    assert [who for who, _ in words(panel)] == ["NAO", "NAO"]
    qtbot.keyClicks(panel.search, "IMPRESS")
    assert words(panel) == [("NAO", "says “Impressive!”")]
    qtbot.keyClicks(panel.search, "xyz")

    assert panel.hint.isVisible()
    assert "No line" in panel.hint.text()


def test_lines_that_say_the_same_are_counted(log: LogPage, runner: Runner) -> None:
    for _ in range(5):
        runner.arrived.emit([(m.HUMAN_BEHAVIOR, KARATE)])

    [line] = log.what_happens.model.lines()

    assert line.count == 5
    assert line.words.endswith("(5 times)")


def test_the_oldest_lines_go(qtbot: QtBot) -> None:
    model = LinesModel()

    for start in range(0, MOST_LINES + 500, 500):
        model.add([Line(0, "action", "NAO", str(number)) for number in range(start, start + 500)])

    shown = model.lines()
    assert len(shown) == model.rowCount() == MOST_LINES
    assert (shown[0].what, shown[-1].what) == ("500", str(MOST_LINES + 499))


def test_a_filtered_model_shows_what_an_unfiltered_one_would(qtbot: QtBot) -> None:
    model = LinesModel(most=10)
    model.search("even")

    model.add([Line(0, "action", "NAO", f"{'odd' if n % 2 else 'even'} {n}") for n in range(30)])

    shown = {line.what for line in model.lines()}
    assert {"even 28", "even 26"} <= shown
    assert len(model.lines()) <= 10
    model.search("")
    assert [line.what.split()[1] for line in model.lines()] == [str(n) for n in range(20, 30)]


def flood(start: int, count: int) -> list[tuple[str, m.HumanBehavior]]:
    return [
        (m.HUMAN_BEHAVIOR, m.HumanBehavior(human_state=f"state_{number}", source="watch"))
        for number in range(start, start + count)
    ]


def test_of_a_flood_of_5000_messages_the_newest_are_kept(
    log: LogPage, runner: Runner, qapp: QApplication
) -> None:
    batches = [flood(start, 167) for start in range(0, 5010, 167)]

    for batch in batches:
        runner.arrived.emit(batch)
        qapp.processEvents()

    assert log.what_happens.model.total == MOST_LINES


def test_of_one_huge_batch_the_rest_is_counted(log: LogPage, runner: Runner) -> None:
    runner.arrived.emit(flood(0, MOST_AT_ONCE + 100))

    first, *rest = log.what_happens.model.lines()

    assert first.what == "100 messages came too fast to be told one by one"
    assert len(rest) == MOST_AT_ONCE


def test_the_lines_are_copied_and_saved_as_text(
    log: LogPage, runner: Runner, tmp_path: Path
) -> None:
    runner.arrived.emit(BATCH)

    log.what_happens.copy()
    log.what_happens.save(tmp_path / "log.txt")

    copied = QGuiApplication.clipboard().text()
    assert copied.splitlines()[-1].endswith("s  NAO: says “Impressive!”")
    assert (tmp_path / "log.txt").read_text(encoding="utf-8") == copied
    QGuiApplication.clipboard().clear()


def test_a_file_that_cannot_be_written_is_told(
    log: LogPage, runner: Runner, host: QMainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    runner.arrived.emit(BATCH)
    qtbot.mouseClick(log.what_happens.buttons.save, Qt.MouseButton.LeftButton)
    [dialog] = host.findChildren(QFileDialog)

    dialog.fileSelected.emit(str(tmp_path / "nowhere" / "log.txt"))

    [told] = host.findChild(Messages).history
    assert told.message.title == "The file could not be saved"
    dialog.close()


def tell(host: QMainWindow) -> Messages:
    messages = host.findChild(Messages)
    messages.confirm("Saved")
    steps = ("Is NAO switched on?", "Is it on this network?")
    messages.tell(Message("error", "NAO does not answer", "At 192.168.1.10.", steps, "errno 113"))
    return messages


def test_what_was_told_is_kept_the_newest_first(log: LogPage, host: QMainWindow) -> None:
    tell(host)

    log.setCurrentWidget(log.told)

    titles = [log.told.list.item(row).text()[10:] for row in range(log.told.list.count())]
    assert titles == ["NAO does not answer", "Saved"]
    assert log.told.list.item(0).data(Qt.ItemDataRole.AccessibleTextRole).startswith("Error")


def test_what_is_told_while_the_tab_is_open_comes_on_top(log: LogPage, host: QMainWindow) -> None:
    log.setCurrentWidget(log.told)
    assert log.told.hint.isVisible()

    tell(host)

    assert log.told.list.count() == 2
    assert log.told.list.isVisible()


def test_all_messages_are_copied_with_their_checklists_and_details(
    log: LogPage, host: QMainWindow, qtbot: QtBot
) -> None:
    tell(host)
    log.setCurrentWidget(log.told)

    qtbot.mouseClick(log.told.copy_button, Qt.MouseButton.LeftButton)

    text = QGuiApplication.clipboard().text()
    assert text.startswith("NEP Studio ")
    for part in ("error: NAO does not answer", "  [ ] Is NAO switched on?", "errno 113"):
        assert part in text
    QGuiApplication.clipboard().clear()

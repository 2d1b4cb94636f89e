"""The log view: follows the end, reads above in peace, and stands a flood."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtGui import QGuiApplication
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.nodes.log_view import MOST_LINES, PIECE_LINES, LogTail, LogView
from nep_studio.ui.services import Studio


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "karate.log"


@pytest.fixture
def view(studio: Studio, path: Path, qtbot: QtBot) -> LogView:
    made = LogView(studio.look)
    qtbot.addWidget(made)
    made.resize(600, 300)
    made.show()
    made.show_log("karate", path, lambda: [])
    return made


def write(path: Path, *lines: str) -> None:
    with path.open("a") as file:
        file.writelines(f"{line}\n" for line in lines)


def test_lines_are_read_once_as_they_come(path: Path) -> None:
    tail = LogTail(path, lambda: [])
    write(path, "one", "two")
    first = tail.read().lines
    write(path, "three")

    assert first == ("one", "two")
    assert tail.read().lines == ("three",)
    assert tail.read().lines == ()


def test_half_a_line_waits_for_the_rest(path: Path) -> None:
    tail = LogTail(path, lambda: [])
    path.write_text("one\ntw")
    first = tail.read().lines
    path.write_text("one\ntwo\n")

    assert first == ("one",)
    assert tail.read().lines == ("two",)


def test_a_log_that_begins_anew_is_read_from_its_start(path: Path) -> None:
    tail = LogTail(path, lambda: [])
    write(path, "a long first line", "another one")
    tail.read()
    path.write_text("new\n")

    piece = tail.read()

    assert (piece.lines, piece.is_new_log) == (("new",), True)


def test_of_a_flood_the_end_is_shown(path: Path) -> None:
    tail = LogTail(path, lambda: [])
    write(path, *(f"line {number}" for number in range(200_000)))

    piece = tail.read()

    assert piece.has_gap
    assert len(piece.lines) == PIECE_LINES
    assert piece.lines[-1] == "line 199999"


def test_when_the_file_is_full_the_last_lines_come_from_the_node(path: Path) -> None:
    said = ["a", "b"]
    tail = LogTail(path, lambda: said)
    write(path, *said)
    tail.read()
    said += ["c", "d"]

    pieces = [tail.read().lines for _ in range(3)]

    assert pieces == [(), ("c", "d"), ()]


def test_without_a_file_the_last_lines_are_shown(path: Path) -> None:
    tail = LogTail(path, lambda: ["only", "these"])
    tail.read()

    assert tail.read().lines == ("only", "these")


def test_the_view_follows_the_end(view: LogView, path: Path, qtbot: QtBot) -> None:
    write(path, *(f"line {number}" for number in range(300)))

    qtbot.waitUntil(lambda: view.text.toPlainText().endswith("line 299"))

    bar = view.text.verticalScrollBar()
    assert bar.value() == bar.maximum()


def test_who_reads_above_is_not_moved(view: LogView, path: Path, qtbot: QtBot) -> None:
    write(path, *(f"line {number}" for number in range(300)))
    qtbot.waitUntil(lambda: "line 299" in view.text.toPlainText())
    view.text.verticalScrollBar().setValue(10)
    write(path, "the newest")

    qtbot.waitUntil(view.follow_button.isVisible)

    assert view.text.verticalScrollBar().value() == 10
    assert "the newest" not in view.text.toPlainText()
    view.follow_button.click()
    assert view.text.toPlainText().endswith("the newest")
    assert not view.follow_button.isVisible()


def test_what_came_meanwhile_is_written_once_for_who_goes_down_again(
    view: LogView, path: Path, qtbot: QtBot
) -> None:
    lines = [f"line {number}" for number in range(400)]
    write(path, *lines[:300])
    qtbot.waitUntil(lambda: "line 299" in view.text.toPlainText())
    bar = view.text.verticalScrollBar()
    bar.setValue(10)
    write(path, *lines[300:])
    qtbot.waitUntil(view.follow_button.isVisible)

    bar.setValue(bar.maximum())

    assert view.text.toPlainText().splitlines() == lines
    assert bar.value() == bar.maximum()


def test_words_are_found_and_those_that_are_not_are_marked(
    view: LogView, path: Path, qtbot: QtBot
) -> None:
    write(path, "first", "a needle", "last")
    qtbot.waitUntil(lambda: "last" in view.text.toPlainText())

    view.search.setText("needle")

    assert view.find_next()
    assert view.text.textCursor().selectedText() == "needle"
    view.search.setText("hay")
    assert not view.find_next()
    assert view.search.property("state") == "wrong"


def test_the_log_is_copied_and_saved(
    view: LogView, path: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    write(path, "one", "two")
    qtbot.waitUntil(lambda: "two" in view.text.toPlainText())

    view.copy()
    view.save_to(tmp_path / "copy.txt")

    assert QGuiApplication.clipboard().text() == "one\ntwo"
    assert (tmp_path / "copy.txt").read_text() == "one\ntwo\n"


def test_a_log_that_cannot_be_saved_is_told(
    view: LogView, path: Path, tmp_path: Path, qtbot: QtBot
) -> None:
    write(path, "one")

    with qtbot.waitSignal(view.saving_failed):
        view.save_to(tmp_path / "no folder" / "copy.txt")


def test_a_hidden_log_is_not_read(view: LogView) -> None:
    view.hide()

    assert not view.is_reading


def test_a_flood_of_200000_lines_does_not_stop_the_window(
    view: LogView, path: Path, qtbot: QtBot
) -> None:
    busy, last = [], [time.thread_time()]

    def beat() -> None:  # how long the window's own thread worked since the last one
        now = time.thread_time()
        busy.append(now - last[0])
        last[0] = now

    timer = QTimer(interval=5)
    timer.timeout.connect(beat)
    timer.start()
    with path.open("a") as file:
        for number in range(0, 200_000, 2000):
            file.writelines(
                f"{line}: a line of a usual length, as nodes write\n"
                for line in range(number, number + 2000)
            )
            file.flush()
            qtbot.wait(10)  # a node writes on and on, while the window lives
    qtbot.waitUntil(lambda: "199999:" in view.text.toPlainText())

    timer.stop()
    assert view.text.blockCount() <= MOST_LINES
    assert max(busy) < 0.5

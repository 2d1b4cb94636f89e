"""The study kit in the window: off at first, seen while it is on, and gone when it is deleted."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QFileDialog, QWidget
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.project import RenameProject
from nep_studio.help.texts import block_page
from nep_studio.problems import Problem
from nep_studio.run.controller import Ended
from nep_studio.run.plan import Ending
from nep_studio.study.records import BROOKE, Reply, Sitting, StudyFolder
from nep_studio.ui.plugins.help.help_controller import HelpController
from nep_studio.ui.plugins.study import StudySign
from nep_studio.ui.plugins.study.form import QuestionnaireDialog, ResultsDialog
from nep_studio.ui.plugins.study.start import StartDialog, StudyRecorder
from nep_studio.ui.shell.main_window import MainWindow

Click = Callable[[QWidget, str], None]


@pytest.fixture
def recorder(window: MainWindow) -> StudyRecorder:
    return window.findChild(StudyRecorder)


def dialog(window: MainWindow, kind: type[QDialog], action: str) -> QDialog:
    window.actions_by_name[action].trigger()
    [found] = [one for one in window.findChildren(kind) if one.isVisible()]
    return found


def told(recorder: StudyRecorder) -> list[str]:
    return [event.what for event in recorder.folder.events()]


def sign(window: MainWindow) -> StudySign:
    return window.statusBar().findChild(StudySign)


def test_nothing_is_recorded_unless_it_is_asked_for(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    window.files.new()
    window.running.runner.state_changed.emit("running")
    window.messages.refuse("This does not go.")

    assert not recorder.is_on
    assert not recorder.folder.folder.exists()
    assert not sign(window).isVisible()
    assert not window.actions_by_name["study_stop"].isEnabled()


def test_a_study_says_what_is_recorded_and_is_seen_until_it_is_stopped(
    window: MainWindow, recorder: StudyRecorder, qtbot: QtBot
) -> None:
    start = dialog(window, StartDialog, "study_start")
    start.participant_fields.conditions.setText("blocks, text")
    qtbot.mouseClick(start.start_button, Qt.MouseButton.LeftButton)

    assert recorder.sitting == Sitting("P01", "blocks", recorder.sitting.started_s)
    assert sign(window).isVisible()
    assert sign(window).words.words == "A study is recorded: P01, blocks"
    qtbot.mouseClick(sign(window).stop_button, Qt.MouseButton.LeftButton)
    assert not sign(window).isVisible()
    assert told(recorder) == ["study_started", "study_stopped"]


def test_what_is_recorded_can_be_read_at_any_time(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    recorder.start(Sitting("P01"))

    window.actions_by_name["study_recorded"].trigger()

    sentence = window.messages.history[-1].message.sentence
    assert "Not kept: names of people" in sentence
    assert str(recorder.folder.folder) in sentence


def test_the_second_participant_begins_with_the_other_condition(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    recorder.folder.set_conditions(["blocks", "text"])
    recorder.folder.add_reply(Reply("P01", "blocks", [4] * 10))

    start = dialog(window, StartDialog, "study_start")
    assert start.participant_fields.participant == "P02"
    assert start.participant_fields.chosen_condition == "text"
    assert start.participant_fields.order.text() == "The order for P02: text, blocks"
    start.participant_fields.code.setText("P01")

    assert start.participant_fields.chosen_condition == "text"  # P01 has met the blocks already


@pytest.mark.parametrize("code", ["", "Anna Smith", "a" * 21, "=1+1"])
def test_a_name_is_no_code(window: MainWindow, recorder: StudyRecorder, code: str) -> None:
    start = dialog(window, StartDialog, "study_start")

    start.participant_fields.code.setText(code)

    assert not start.start_button.isEnabled()


def test_what_happens_in_a_session_is_kept(
    window: MainWindow, recorder: StudyRecorder, qtbot: QtBot
) -> None:
    recorder.start(Sitting("P01"))
    window.files.new()
    document = window.files.document
    document.editor.apply(RenameProject("One"))
    document.editor.apply(RenameProject("Two"))
    window.running.runner.run_asked.emit()
    window.running._ran = document  # as when a run begins
    for state in ("starting", "running", "paused", "running", "stopping", "idle"):
        window.running.runner.state_changed.emit(state)
    ending = Ending(Problem("NAO does not answer"))
    end = Ended(ending, was_stopped=False, had_begun=True, runs_again=False)
    window.running.runner.told.emit(end)
    window.running.runner.ended.emit(ending)
    window.actions_by_name["shortcuts"].trigger()

    events = {event.what: event for event in recorder.folder.events()}
    assert told(recorder) == [
        "study_started",
        "project_opened",
        "run_asked",
        "edits",
        "run_started",
        "first_run",
        "stop_pressed",
        "error_told",
        "run_ended",
        "help_opened",
    ]
    assert events["edits"].number == 2
    assert 0 <= events["first_run"].number < 60
    assert events["error_told"].words == events["run_ended"].words == "NAO does not answer"
    assert events["help_opened"].words == "Keyboard shortcuts"


def test_the_pages_of_the_help_that_are_read_are_kept(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    window.files.new()
    recorder.start(Sitting("P01"))
    [desk] = window.findChildren(HelpController)

    desk.open(block_page("robot.say"))
    desk.open(block_page("robot.say"))

    read = [event.words for event in recorder.folder.events() if event.what == "help_opened"]
    assert read[-1] == "block/robot.say"
    assert read.count("block/robot.say") == 1


def test_a_run_that_began_before_the_study_does_not_begin_again_after_a_pause(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    recorder.start(Sitting("P01"))

    for state in ("paused", "running", "idle"):
        window.running.runner.state_changed.emit(state)
    window.running.runner.ended.emit(Ending())

    assert told(recorder) == ["study_started", "run_ended"]


def test_only_the_first_run_of_a_sitting_is_the_first(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    recorder.start(Sitting("P01"))

    for state in ("starting", "running", "idle", "starting", "running"):
        window.running.runner.state_changed.emit(state)
        if state == "idle":
            window.running.runner.ended.emit(Ending())

    assert told(recorder).count("run_started") == 2
    assert told(recorder).count("first_run") == 1


def test_the_questionnaire_is_answered_with_the_keyboard(
    window: MainWindow, recorder: StudyRecorder, qtbot: QtBot
) -> None:
    form = dialog(window, QuestionnaireDialog, "study_form")
    for row, digit in zip(form.rows, "6275526251", strict=True):
        row.buttons[0].setFocus()
        qtbot.keyClick(row.buttons[0], digit)
    assert form.note.text() == "All items are answered."
    qtbot.keyClick(form.rows[3].buttons[4], Qt.Key.Key_Backspace)
    assert form.note.text().startswith("1 item is open.")

    qtbot.mouseClick(form.save_button, Qt.MouseButton.LeftButton)

    [reply] = recorder.folder.replies()
    assert reply.answers == [6, 2, 7, None, 5, 2, 6, 2, 5, 1]
    assert (reply.participant, reply.questionnaire) == ("P01", "sus-7")


def test_options_can_be_clicked_on_their_words_and_are_told_to_screen_readers(
    window: MainWindow, recorder: StudyRecorder, qtbot: QtBot
) -> None:
    form = dialog(window, QuestionnaireDialog, "study_form")
    option = form.rows[0].buttons[6]

    qtbot.mouseClick(option, Qt.MouseButton.LeftButton, pos=option.rect().center())

    assert form.rows[0].answer == 7
    assert option.accessibleName() == "Strongly agree, 7 of 7"
    assert "use this interface frequently" in option.accessibleDescription()


def test_an_empty_questionnaire_cannot_be_kept(window: MainWindow, recorder: StudyRecorder) -> None:
    form = dialog(window, QuestionnaireDialog, "study_form")

    assert not form.save_button.isEnabled()
    form.rows[0].choose(3)
    assert form.save_button.isEnabled()
    form.rows[0].clear()
    assert not form.save_button.isEnabled()


def test_brookes_questionnaire_has_five_options(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    form = dialog(window, QuestionnaireDialog, "study_form")

    form.which.setCurrentIndex(form.which.findData(BROOKE))

    assert {len(row.buttons) for row in form.rows} == {5}
    assert form.participant_fields.isVisible()


def test_a_study_that_is_on_tells_the_questionnaire_who_answers(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    recorder.start(Sitting("K7", "text"))

    form = dialog(window, QuestionnaireDialog, "study_form")

    assert (form.participant_fields.participant, form.participant_fields.chosen_condition) == (
        "K7",
        "text",
    )


def test_results_are_shown_as_in_the_paper_and_saved_for_spreadsheets(
    window: MainWindow, recorder: StudyRecorder, qtbot: QtBot, tmp_path: Path
) -> None:
    recorder.folder.add_reply(Reply("P01", "a", [7, 1] * 5))
    recorder.folder.add_reply(Reply("P02", "a", [4] * 10))
    results = dialog(window, ResultsDialog, "study_results")

    assert results.overall.text() == "Overall SUS score (out of 100): 75.0"
    assert results.items.item(0, 1).text() == "5.5"
    assert [results.people.item(row, 2).text() for row in (0, 1)] == ["100.0", "50.0"]
    qtbot.mouseClick(results.answers_button, Qt.MouseButton.LeftButton)
    [chooser] = results.findChildren(QFileDialog)
    chooser.fileSelected.emit(str(tmp_path / "answers.csv"))
    chooser.close()

    with (tmp_path / "answers.csv").open(encoding="utf-8-sig", newline="") as file:
        assert [row["score"] for row in csv.DictReader(file)] == ["100.0", "50.0"]
    assert window.messages.history[-1].message.title == "answers.csv is saved: 2 rows"


def test_all_can_be_deleted_after_a_question(
    window: MainWindow, recorder: StudyRecorder, answer: Click, qtbot: QtBot
) -> None:
    recorder.start(Sitting("P01"))
    recorder.folder.add_reply(Reply("P01", "", [4] * 10))
    results = dialog(window, ResultsDialog, "study_results")

    qtbot.mouseClick(results.delete_button, Qt.MouseButton.LeftButton)
    answer(window, "Delete all")

    qtbot.waitUntil(lambda: not recorder.folder.folder.exists())
    assert not recorder.is_on
    assert "Nobody has answered" in results.overall.text()


def test_a_study_goes_on_in_another_language_and_after_a_new_start(
    window: MainWindow, recorder: StudyRecorder
) -> None:
    recorder.start(Sitting("P01"))

    window.studio.choose_language("es")

    assert window.findChildren(StudyRecorder) == [recorder]
    assert sign(window).isVisible()
    assert StudyFolder(recorder.folder.folder).sitting() == recorder.sitting


def test_a_folder_that_cannot_be_written_is_told(
    window: MainWindow, recorder: StudyRecorder, home: Path
) -> None:
    recorder.folder.folder.parent.mkdir(parents=True, exist_ok=True)
    recorder.folder.folder.write_text("not a folder")

    recorder.start(Sitting("P01"))

    assert not recorder.is_on
    assert window.messages.history[-1].message.title == "The study cannot be kept"

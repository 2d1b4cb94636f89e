"""Training in a process of its own: the real one once, else a small one that speaks like it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
import pytest
from msgspec.structs import replace
from pytestqt.qtbot import QtBot

from faults import Fault, Text
from nep_studio.blocks.own_gestures import keep_gesture, own_recogniser
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.results.findings import findings_of
from nep_studio.ui.plugins.gestures.results.training import Training, TrainingFolder
from nep_studio.ui.plugins.gestures.results.worker import Done, Failed, Progress, Ready, read_line
from nodes.perceptual.recognition.streams import UNKNOWN
from nodes.recordings import read_recordings
from tests.ui.trainer.results_controller import desk, look
from tests.ui.trainer.results_material import put_session, report, session, spans_of

pytestmark = pytest.mark.long

__all__ = ["desk", "look"]

SPEAKS = """
import json, pathlib, sys
print('{"ready": true}', flush=True)
for line in sys.stdin:
    asked = json.loads(line)
"""
LEARNS = """
    print('{"progress": 0.5, "step": "Learning the gestures…"}', flush=True)
    pathlib.Path(asked["output"]).write_bytes(b"a model")
    print(json.dumps({"done": asked["output"], "seconds": 0.2, "report": REPORT}), flush=True)
"""
REPORT = {"trees": report([("karate", "karate", 3)], {"karate": 3})}
MakeTraining = Callable[..., Training]


@pytest.fixture
def make_training(desk: GestureController) -> Iterator[MakeTraining]:
    made: list[Training] = []

    def make(what_it_does: str = LEARNS) -> Training:
        script = f"REPORT = {REPORT!r}\n{SPEAKS}{what_it_does}"
        made.append(Training(desk, command=lambda: [sys.executable, "-c", script]))
        made[-1].trains_by_itself = False
        return made[-1]

    yield make
    for one in made:
        one.close()


@pytest.fixture
def recorded(desk: GestureController) -> GestureController:
    """The desk of a project in which karate was recorded three times."""
    put_session(desk, session(["karate"], 3))
    return desk


def test_the_real_process_learns_two_gestures_and_the_project_keeps_them(
    desk: GestureController, qtbot: QtBot
) -> None:
    put_session(desk, session(["karate", "katana"], 3), has_rotation=False)
    training = Training(desk)
    steps: list[str] = []
    training.changed.connect(lambda: steps.append(training.step))
    try:
        with qtbot.waitSignal(training.trained):
            training.train()
    finally:
        training.close()

    assert desk.is_up_to_date
    assert desk.recogniser.gestures == ("karate", "katana")
    assert findings_of(desk.recogniser.report)["gmr"].takes == {"karate": 3, "katana": 3}
    assert findings_of(desk.recogniser.report)["trees"].curves["karate"]
    assert "Learning the gestures…" in steps
    assert desk.editor.history.undo_label == "train the gestures"


def test_what_was_learned_is_one_step_and_stale_after_a_change(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot
) -> None:
    training = make_training()

    with qtbot.waitSignal(training.trained):
        training.train()
    assert not training.is_stale
    gesture = recorded.gestures["karate"]
    recorded.change(
        "delete a take", [keep_gesture("karate", replace(gesture, takes=gesture.takes[1:]))]
    )

    assert training.is_stale
    recorded.editor.history.undo()
    recorded.editor.history.undo()
    assert own_recogniser(recorded.editor.project) is None


def test_a_cancelled_training_keeps_nothing_and_a_new_process_gets_warm(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot
) -> None:
    training = make_training("    print('{\"progress\": 0.4}', flush=True)\n")
    training.train()
    qtbot.waitUntil(lambda: training.progress > 0.4)

    training.cancel()

    assert not training.is_training
    assert recorded.recogniser is None
    qtbot.waitUntil(lambda: training._worker.is_ready)


@pytest.mark.parametrize(
    ("does", "says"),
    [
        ("    sys.exit(3)\n", "ended in the middle"),
        ("    sys.stderr.write('MemoryError'); sys.exit(1)\n", "too little memory"),
        ("    import os; os.kill(os.getpid(), 9)\n", "too little memory"),
        (
            '    print(json.dumps({"fault": {"code": "none_marked", "sentence": {"text": "Keine'
            ' Geste ist markiert."}, "checklist": [{"text": "Eine markieren."}]}}), flush=True)\n',
            "Keine Geste ist markiert.",
        ),
        ('    print(json.dumps({"done": "/nowhere"}), flush=True)\n', "could not be written"),
    ],
    ids=["crash", "memory", "killed", "told", "no file"],
)
def test_a_training_that_does_not_go_says_why_and_can_be_tried_again(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot, does: str, says: str
) -> None:
    training = make_training(does)

    with qtbot.waitSignal(training.failed):
        training.train()

    assert says in str(training.problem.sentence)
    assert training.problem.checklist
    assert not training.is_training
    assert not training.why_not


def test_a_program_that_is_not_there_is_told(recorded: GestureController, qtbot: QtBot) -> None:
    training = Training(recorded, command=lambda: ["/no/such/program"])

    training.train()

    qtbot.waitUntil(lambda: training.problem is not None)
    training.close()


def test_a_process_that_ends_while_it_waits_is_started_again_by_the_next_training(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot
) -> None:
    training = make_training(LEARNS)
    training.warm()
    qtbot.waitUntil(lambda: training._worker.is_ready)
    training._worker._process.kill()
    qtbot.waitUntil(lambda: not training._worker.is_running)

    assert training.problem is None
    with qtbot.waitSignal(training.trained):
        training.train()


def test_a_full_disk_is_told(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot, monkeypatch
) -> None:
    def no_room(path: Path, recording: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("nep_studio.ui.plugins.gestures.results.training.write_recording", no_room)
    training = make_training()

    with qtbot.waitSignal(training.failed):
        training.train()

    assert "disk is full" in str(training.problem.sentence)


def test_it_trains_by_itself_after_a_change_but_not_after_undo(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot
) -> None:
    training = make_training()
    training._soon.setInterval(0)

    with qtbot.waitSignal(training.trained):
        training.set_by_itself(True)
    recorded.editor.history.undo()
    recorded.refresh()

    assert training.is_stale or recorded.recogniser is None
    assert not training._soon.isActive()
    assert recorded.editor.history.redo_label == "train the gestures"


def test_what_takes_long_is_not_done_by_itself(
    recorded: GestureController, make_training: MakeTraining
) -> None:
    training = make_training()
    training.seconds = 10.0

    training.set_by_itself(True)

    assert not training.is_quick
    assert not training._soon.isActive()


def test_another_project_gets_nothing_of_a_training(
    recorded: GestureController, make_training: MakeTraining
) -> None:
    training = make_training("    pass\n")
    training.train()

    recorded.files.new()
    recorded.refresh()

    assert not training.is_training


def test_an_empty_project_says_what_is_missing(
    desk: GestureController, make_training: MakeTraining
) -> None:
    training = make_training()

    training.train()

    assert not training.is_training
    assert "Add a gesture" in training.why_not


def test_the_folder_marks_takes_and_what_is_unknown(recorded: GestureController) -> None:
    gesture, recording = recorded.gestures["karate"], recorded.recordings["s1"]
    takes = (replace(gesture.takes[0], left_out=True), *gesture.takes[1:])
    folder = TrainingFolder()
    gestures = {"karate": replace(gesture, takes=takes)}
    recordings = {
        "s1": replace(recording, forgotten=((0.0, 0.1),)),
        "e1": replace(recording, everyday=True),
    }

    shares = list(folder.update(gestures, recordings))
    [read] = read_recordings(folder.recordings)
    [everyday] = read_recordings(folder.recordings / "everyday")
    folder.close()

    assert shares == [0.5, 1.0]
    spans = spans_of(read)
    assert [name for name, *_ in spans].count("karate") == 2
    assert [name for name, *_ in spans].count(UNKNOWN) == 2
    assert (read.person, read.wrist, read.source) == ("Ann_Lee", "right", "s1")
    assert everyday.labels is None
    assert not folder.path.exists()


def test_only_what_is_different_is_written_again(recorded: GestureController) -> None:
    folder = TrainingFolder()
    first = {"s1": recorded.recordings["s1"], "s2": recorded.recordings["s1"]}
    list(folder.update(recorded.gestures, first))
    before = {path.name: path.stat().st_mtime_ns for path in folder.recordings.glob("*.csv")}

    list(folder.update(recorded.gestures, {"s1": first["s1"]}))

    after = {path.name: path.stat().st_mtime_ns for path in folder.recordings.glob("*.csv")}
    folder.close()
    assert after == {"s1.csv": before["s1.csv"]}


def test_lines_of_the_process_are_read_and_others_are_left_out() -> None:
    assert read_line(b'{"ready": true}') == Ready(True)
    assert read_line(b'{"progress": 0.5, "step": "Learning"}') == Progress(0.5, "Learning")
    assert read_line(json.dumps({"done": "x", "seconds": 2, "report": {}}).encode()) == Done("x", 2)
    fault = Fault("no", Text("No."), (Text("Do."),))
    assert read_line(msgspec.json.encode({"fault": fault})) == Failed(fault)
    for noise in (b"", b"a warning", b"[1, 2]", b"3", b"{}", b'{"progress": "much"}', b"\xff"):
        assert read_line(noise) is None

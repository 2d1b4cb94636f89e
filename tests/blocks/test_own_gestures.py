"""The gestures of a project: kept in its file, undone step by step, offered by its blocks."""

from __future__ import annotations

import time
from array import array
from pathlib import Path

import pytest

import nep_studio.blocks.own_gestures as own_gestures_module
from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.errors import ProjectFileError
from nep_studio.blocks.files import load, save
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    OwnTake,
    floats_of,
    free_gesture_name,
    keep_gesture,
    keep_recogniser,
    keep_recording,
    own_gestures,
    own_recogniser,
    own_recordings,
    packed_samples,
    trained_gestures,
    training_digest,
    unpacked_samples,
)
from nep_studio.run.installation import studio_language
from tests.blocks.block_building import B, build

ROWS = array("f", [0.0, 0.5, 1.0, 9.5, 0.25, -0.5, 2.0, 9.0, 0.5, 0.0, 1.5, 10.0])
RECORDING = OwnRecording(0.5, 4.0, packed_samples(ROWS.tobytes()), person="Ann", wrist="left")
WAVE = OwnGesture("Große Welle", takes=(OwnTake("t1", "r1", 0.1, 0.5),))


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


@pytest.fixture
def editor(language: Language) -> Editor:
    editor = build(language, [B("event.gesture"), B("control.wait")])
    editor.apply(keep_recording("r1", RECORDING), "record")
    editor.apply(keep_gesture("wave", WAVE), "record")
    return editor


def learn(editor: Editor, *names: str) -> None:
    learned = OwnRecogniser(training_digest(editor.project), names, "AAAA")
    editor.apply(keep_recogniser(learned), "train")


def why(editor: Editor) -> list[str]:
    return [str(problem.sentence) for problem in check(editor.project, editor.language)]


def test_gestures_recordings_and_what_was_learned_are_in_the_file(editor, language, tmp_path):
    learn(editor, "wave")

    save(editor.project, tmp_path / "mine.nep")
    read = load(tmp_path / "mine.nep", language)

    assert own_gestures(read) == {"wave": WAVE}
    assert own_recordings(read) == {"r1": RECORDING}
    assert own_recogniser(read) == own_recogniser(editor.project)
    assert floats_of(unpacked_samples(own_recordings(read)["r1"].samples)) == ROWS


def test_the_longest_id_of_a_recording_is_read_like_any_other(editor):
    longest = "r" * 40

    editor.apply(keep_recording(longest, RECORDING), "record")

    assert longest in own_recordings(editor.project)


def test_a_gesture_is_a_choice_of_the_blocks_as_soon_as_it_is_there(editor):
    table = editor.language.of(editor.project).choices["gestures"]

    assert next(iter(table.items())) == ("wave", "Große Welle")
    assert "karate" in table


def test_a_change_of_gestures_is_undone_like_any_other(editor):
    editor.apply(keep_gesture("wave", None), "delete a gesture")

    editor.history.undo()

    assert own_gestures(editor.project) == {"wave": WAVE}


def test_the_digest_changes_with_what_can_be_learned_and_with_nothing_else(editor):
    before = training_digest(editor.project)

    editor.apply(keep_gesture("wave", OwnGesture("Wave", 3, 0.5, WAVE.takes)), "rename")
    assert training_digest(editor.project) == before
    left_out = OwnTake("t1", "r1", 0.1, 0.5, left_out=True)
    editor.apply(keep_gesture("wave", OwnGesture("Wave", takes=(left_out,))), "leave out")

    assert training_digest(editor.project) != before


def test_a_gesture_that_is_not_learned_yet_is_told_and_a_learned_one_is_not(editor):
    block = next(b.id for b in editor.project.blocks.values() if b.type == "event.gesture")
    editor.apply(SetField(block, "gesture", "wave"), "choose")

    assert "The gesture “Große Welle” is not learned yet." in why(editor)
    learn(editor, "wave")

    assert not [sentence for sentence in why(editor) if "Welle" in sentence or "wave" in sentence]


def test_only_gestures_that_are_still_there_count_as_learned(editor):
    learn(editor, "wave", "gone")

    assert list(trained_gestures(editor.project)) == ["wave"]


@pytest.mark.parametrize(
    ("title", "taken", "name"),
    [
        ("Große Welle!", (), "grosse_welle"),
        ("Wave", ("wave", "wave_2"), "wave_3"),
        ("空手", (), "gesture"),
        ("3 claps", (), "gesture_3_claps"),
        ("Nothing", (), "nothing_2"),
    ],
)
def test_a_title_becomes_a_name_that_no_other_gesture_has(title, taken, name):
    assert free_gesture_name(title, taken) == name


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("gesture_Wave", {"title": "Wave"}, "small letters"),
        ("gesture_wave", {"title": ""}, "title"),
        ("gesture_wave", {"title": "Wave", "certainty": 7}, "certainty"),
        ("gesture_wave", {"title": "Wave", "takes": [[]]}, "take"),
        (
            "gesture_wave",
            {"title": "W", "takes": [{"id": "a", "recording": "r", "start_s": 2, "end_s": 1}]},
            "end after its start",
        ),
        ("recording_r1", {"seconds": 1, "rate_hz": 50, "samples": "no base64!"}, "unpacked"),
        ("recording_r1", {"seconds": 1, "rate_hz": 50, "samples": ""}, "samples"),
        ("recording_r1", {"seconds": -1, "rate_hz": 50, "samples": RECORDING.samples}, "below 0"),
        ("recogniser", {"trained_on": "x", "gestures": "wave", "file": ""}, "gestures"),
    ],
)
def test_a_file_with_unusable_gestures_is_refused_in_words(
    language: Language, tmp_path: Path, key: str, value: object, told: str
) -> None:
    project = build(language, [B("event.started")]).project
    project.extra[key] = value
    save(project, tmp_path / "odd.nep")

    with pytest.raises(ProjectFileError, match=told):
        load(tmp_path / "odd.nep", language)


@pytest.mark.parametrize(
    "rows",
    [
        [0.0, 1.0, 1.0, float("nan")],
        [0.0, 1.0, float("inf"), 1.0],
        [1.0, 0.0, 0.0, 9.8, 0.5, 0.0, 0.0, 9.8],
        [0.0, 1.0, 1.0],
    ],
)
def test_samples_that_no_sensor_sends_are_refused(
    language: Language, tmp_path: Path, rows: list[float]
) -> None:
    project = build(language, [B("event.started")]).project
    samples = packed_samples(array("f", rows).tobytes())
    project.extra["recording_r1"] = {"seconds": 1, "rate_hz": 50, "samples": samples}
    save(project, tmp_path / "odd.nep")

    with pytest.raises(ProjectFileError, match="recording"):
        load(tmp_path / "odd.nep", language)


def test_samples_that_unpack_to_more_than_fits_are_refused():
    bomb = packed_samples(bytes(13_000_000))

    with pytest.raises(ValueError, match="too many"):
        unpacked_samples(bomb)


def test_a_recording_with_very_many_deleted_takes_opens_at_once(language: Language, tmp_path: Path):
    project = build(language, [B("event.started")]).project
    samples = packed_samples(array("f", [0.0, 0.0, 0.0, 9.8]).tobytes())
    value = {"seconds": 1, "rate_hz": 50, "samples": samples, "forgotten": [[0, 1]] * 30_000}
    project.extra["recording_r1"] = value
    save(project, tmp_path / "many.nep")

    began_s = time.process_time()
    load(tmp_path / "many.nep", language)

    assert time.process_time() - began_s < 3.0


def test_the_training_data_are_digested_once_for_each_change(language: Language, monkeypatch):
    editor = build(language, [B("event.started")])
    reckoned: list[str] = []

    def reckon(_project: object) -> str:
        reckoned.append(f"digest {len(reckoned)}")
        return reckoned[-1]

    monkeypatch.setattr(own_gestures_module, "_digest", reckon)

    first = [training_digest(editor.project) for _ in range(3)]
    editor.apply(keep_gesture("wave", OwnGesture("Wave")), "add a gesture")
    second = training_digest(editor.project)

    assert (first, second) == (["digest 0"] * 3, "digest 1")

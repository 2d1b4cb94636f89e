"""The gestures of a project as files for its nodes, and the nodes that are planned for them."""

from __future__ import annotations

import os
from array import array
from base64 import b64encode
from pathlib import Path

import pytest
from msgspec.structs import replace

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.language import Language
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecogniser,
    OwnRecording,
    OwnTake,
    keep_gesture,
    keep_recogniser,
    keep_recording,
    own_gestures,
    own_recordings,
    packed_samples,
    training_digest,
)
from nep_studio.project.kept_files import (
    GESTURES_FOLDER,
    MOST_KEPT,
    RecogniserFile,
    TakeFiles,
    labels_of,
    recogniser_file,
    spans_of,
    take_files,
)
from nep_studio.run.installation import all_problems, studio_language
from nep_studio.run.plan import Choices, PlannedNode, plan
from nodes.perceptual.recognition.streams import takes_of
from nodes.recordings import read_recordings
from tests.blocks.block_building import B, build

RATE_HZ = 50.0
MODEL = b"a model"


@pytest.fixture(scope="module")
def language() -> Language:
    return studio_language()


@pytest.fixture
def editor(language: Language, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Editor:
    """A project whose rule waits for a wave, which it has learned."""
    monkeypatch.setattr("nep_studio.project.kept_files.cache_folder", lambda: tmp_path)
    rows = array("f")
    for number in range(300):
        rows.extend([number / RATE_HZ, 0.1 * (number % 7), 0.0, 9.8])
    samples = packed_samples(rows.tobytes())
    takes = (OwnTake("a", "r1", 1.0, 2.0), OwnTake("b", "r1", 3.0, 4.0, left_out=True))
    editor = build(language, [B("event.gesture"), B("control.wait")])
    editor.apply(keep_recording("r1", OwnRecording(6.0, RATE_HZ, samples)), "record")
    editor.apply(keep_gesture("wave", OwnGesture("Wave", takes=takes)), "record")
    digest = training_digest(editor.project)
    learned = OwnRecogniser(digest, ("wave",), b64encode(MODEL).decode())
    editor.apply(keep_recogniser(learned), "train")
    editor.apply(SetField(editor.project.pages["behaviour"][0].body[0], "gesture", "wave"), "wave")
    return editor


def planned(editor: Editor, node: str) -> list[PlannedNode]:
    nodes = plan(editor.project, editor.language, Choices(), Path())
    return [one for one in nodes if one.node == node]


def test_one_node_recognises_all_that_the_project_has_learned(editor):
    (node,) = planned(editor, "perceptual/gesture")

    assert node.files is not None
    node.files.write()

    assert Path(str(node.parameters["model"])).read_bytes() == MODEL
    assert "gesture" not in node.parameters


def test_a_gesture_that_needs_more_certainty_says_so_to_its_node(editor):
    editor.apply(keep_gesture("wave", OwnGesture("Wave", 0, 0.6)), "set the certainty")

    (node,) = planned(editor, "perceptual/gesture")

    assert node.parameters["certainties"] == "wave 0.6"


def test_a_gesture_node_of_the_page_recognises_what_the_project_has_learned(editor, language):
    launch = B("nodes.launch", {"node": "perceptual/gesture", "name": "mine"})
    build(language, [launch], page="nodes", editor=editor)

    (node,) = planned(editor, "perceptual/gesture")

    assert (node.name, bool(node.parameters["model"])) == ("mine", True)
    assert not [
        p
        for p in all_problems(editor.project, editor.language, Path())
        if "mine" in str(p.sentence)
    ]


def test_the_virtual_watch_makes_the_gestures_of_the_project(editor):
    (watch,) = planned(editor, "sensory/virtual_watch")

    assert watch.files is not None
    watch.files.write()
    (recording,) = read_recordings(Path(str(watch.parameters["takes"])))

    assert "gestures" not in watch.parameters  # it waits until somebody asks
    made = [
        (one.gesture, round(one.start_s, 1), round(one.end_s, 1)) for one in takes_of(recording)
    ]
    assert made == [("wave", 1.0, 2.0)]


def test_the_same_gestures_have_the_same_files(editor):
    assert take_files(editor.project) == take_files(editor.project)
    assert recogniser_file(editor.project) == recogniser_file(editor.project)


def test_a_damaged_recogniser_is_told_when_it_is_written(tmp_path):
    with pytest.raises(OSError, match="train the gestures again"):
        RecogniserFile(tmp_path / "x", "no base64!").write()


def test_only_the_newest_files_are_kept_in_the_cache(tmp_path, monkeypatch):
    monkeypatch.setattr("nep_studio.project.kept_files.cache_folder", lambda: tmp_path / "cache")
    text = b64encode(MODEL).decode()

    for number in range(25):
        for parent in (tmp_path / "cache" / GESTURES_FOLDER, tmp_path / "mine"):
            RecogniserFile(parent / f"{number}", text).write()

    assert len(list((tmp_path / "cache" / GESTURES_FOLDER).iterdir())) == MOST_KEPT
    assert len(list((tmp_path / "mine").iterdir())) == 25


def test_a_model_that_is_used_again_is_not_forgotten_for_newer_ones(tmp_path, monkeypatch):
    monkeypatch.setattr("nep_studio.project.kept_files.cache_folder", lambda: tmp_path)
    text = b64encode(MODEL).decode()
    files = [RecogniserFile(tmp_path / GESTURES_FOLDER / f"{number}", text) for number in range(25)]
    for age, file in enumerate(files[:MOST_KEPT]):
        file.write()
        os.utime(file.folder, (1000 + age, 1000 + age))

    files[0].write()  # as the project does before it starts a node with it
    for file in files[MOST_KEPT:]:
        file.write()

    assert files[0].path.is_file()
    assert not files[1].folder.exists()


def test_a_name_of_several_lines_stays_in_its_line(editor, tmp_path):
    gestures, recordings = own_gestures(editor.project), own_recordings(editor.project)
    named = {key: replace(one, person='A\nB, "C"') for key, one in recordings.items()}

    TakeFiles(tmp_path / "takes", gestures, named).write()
    (recording,) = read_recordings(tmp_path / "takes")

    assert recording.person == "A_B_C_"
    assert len(recording.t) == 300


def test_a_take_counts_more_than_a_deleted_one_that_it_covers():
    gesture = OwnGesture("Wave", takes=(OwnTake("a", "r", 1.0, 2.0), OwnTake("b", "r", 2.0, 3.0)))
    recording = OwnRecording(4.0, 2.0, "", forgotten=((1.5, 3.5),))

    labels = labels_of(
        [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5], spans_of("r", recording, {"wave": gesture})
    )

    assert labels == ["", "", "wave", "", "wave", "wave", "wave", "?"]

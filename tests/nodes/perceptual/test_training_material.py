"""What is learned from: recordings of a folder, made fit for each other, with remarks."""

from dataclasses import replace

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.dataset import learn, read_material
from nodes.perceptual.recognition.streams import mirrored
from nodes.recordings import write_recording
from nodes.sensory.arm.people import simulate_everyday, simulate_session


@pytest.fixture(scope="module")
def session():
    return simulate_session(5, ("karate",), 3)


@pytest.fixture(scope="module")
def idle():
    return simulate_everyday(5, 20.0)


def folder_of(path, *recordings, everyday=()):
    (path / "everyday").mkdir()
    for number, recording in enumerate(recordings):
        write_recording(path / f"{number}.csv", recording)
    for number, recording in enumerate(everyday):
        write_recording(path / "everyday" / f"{number}.csv", recording)
    return path


def test_the_folder_everyday_holds_movement_without_gestures(tmp_path, session, idle):
    walking = replace(idle, labels=["walking"] * 900 + ["?"] * (len(idle.t) - 900))

    material = read_material(folder_of(tmp_path, session, everyday=[walking, idle]))

    assert len(material.recordings) == 1
    assert set(material.everyday[0].labels) == {"", "?"}
    assert not any(material.everyday[1].labels or ())
    assert material.remarks == ()


def test_what_is_marked_with_a_question_mark_is_no_take_of_anything(tmp_path, session):
    labels = list(session.labels)
    first = labels.index("karate")
    end = labels.index("", first)
    labels[first:end] = ["?"] * (end - first)

    model = learn(read_material(folder_of(tmp_path, replace(session, labels=labels))), ["gmr"])

    assert model.names == ("karate",)
    assert model.gestures[0].takes == 2


def test_a_gyroscope_in_some_recordings_only_is_told_and_not_learned_from(tmp_path, session):
    silent = replace(session, gyr=None)

    material = read_material(folder_of(tmp_path, session, silent))
    model = learn(material, ["gmr"])

    assert "1 of 2 recordings have no rotation (gyroscope)" in str(material.remarks[0])
    assert {one.channels.gyroscope for one in model.recognisers} == {False}
    assert [one.gyroscope for one in model.sensors] == [True, False]


def test_gravity_in_some_recordings_only_is_told_and_not_learned_from(tmp_path, session):
    material = read_material(folder_of(tmp_path, session, replace(session, gravity_included=False)))

    assert "1 of 2 recordings have no gravity" in str(material.remarks[0])


def test_everyday_movement_of_a_poorer_sensor_does_not_make_the_gestures_poorer(
    tmp_path, session, idle
):
    material = read_material(folder_of(tmp_path, session, everyday=[replace(idle, gyr=None), idle]))

    assert len(material.everyday) == 1
    assert "1 of 2 recordings of everyday movement are not used" in str(material.remarks[0])
    assert material.has_rotation


def test_a_recording_of_the_other_wrist_is_learned_from_as_its_mirror_image(tmp_path, session):
    right = [replace(session, wrist="right", device="Pixel Watch")] * 2
    acc, gyr = mirrored(session.acc, session.gyr)
    left = replace(session, acc=acc, gyr=gyr, wrist="left")

    material = read_material(folder_of(tmp_path, *right, left))

    assert material.wrist == "right"
    assert np.allclose(material.recordings[2].acc, session.acc, atol=1e-4)
    assert np.allclose(material.recordings[2].gyr, session.gyr, atol=1e-4)
    assert material.recordings[0].device == "Pixel Watch"
    assert "1 of 3 recordings were made on another wrist" in str(material.remarks[0])


def test_gestures_that_were_recorded_too_seldom_are_named(tmp_path):
    few = simulate_session(5, ("karate",), 1)

    material = read_material(folder_of(tmp_path, few))

    assert tuple(map(str, material.remarks)) == (
        "karate was recorded only once: record it 3 times at least, better 5.",
    )


def test_recordings_without_a_pause_are_told(tmp_path, session):
    first = session.labels.index("karate")
    end = session.labels.index("", first)
    part = slice(first, end)
    cut = replace(
        session,
        t=session.t[part] - session.t[first],
        acc=session.acc[part],
        gyr=session.gyr[part],
        labels=session.labels[part],
    )

    with pytest.raises(RecordingError, match="hardly anything but gestures") as told:
        learn(read_material(folder_of(tmp_path, cut, cut)), ["trees"])
    assert told.value.checklist

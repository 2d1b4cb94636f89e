"""A simulated person makes recorded gestures, and nobody feels where the recording begins."""

from dataclasses import replace
from itertools import groupby

import numpy as np
import pytest

from nep_core.errors import ParameterError, RecordingError
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.streams import mirrored, takes_of
from nodes.perceptual.recognition.training import train
from nodes.recordings import write_recording
from nodes.sensory.arm.gestures import gesture_named
from nodes.sensory.arm.people import simulate_session
from nodes.sensory.virtual_watch import LEAD_S, OwnGesture, Wearer, read_repertoire, recorded_take

RATE_HZ = 50


@pytest.fixture(scope="module")
def session():
    """Two gestures under names of their own, three times each."""
    made = simulate_session(7, ("karate", "hand_up"), 3)
    labels = [{"karate": "chop", "hand_up": "ask"}.get(label, "") for label in made.labels]
    return replace(made, labels=labels)


@pytest.fixture(scope="module")
def folder(session, tmp_path_factory):
    path = tmp_path_factory.mktemp("takes")
    write_recording(path / "ann.csv", session)
    return path


def felt(wearer, seconds, batch=7):
    """What the watch feels, all in one: t, acc, gyr, labels."""
    parts = [wearer.samples(batch) for _ in range(int(seconds * RATE_HZ / batch))]
    return (
        np.concatenate([part.t for part in parts]),
        np.concatenate([part.acc for part in parts]),
        np.concatenate([part.gyr for part in parts]),
        [label for part in parts for label in part.labels],
    )


def steps(values):
    return np.linalg.norm(np.diff(values, axis=0), axis=1)


def make(gesture, seconds=8.0, seed=0, number=105):
    wearer = Wearer(number, RATE_HZ, seed)
    felt(wearer, 1.0)
    wearer.ask(gesture)
    return felt(wearer, seconds)


def own(recording, name):
    takes = [recorded_take(recording, take) for take in takes_of(recording) if take.gesture == name]
    return OwnGesture(name, tuple(takes))


def test_recorded_gestures_can_be_asked_for_beside_those_of_the_paper(folder):
    repertoire = read_repertoire(str(folder))

    assert len(repertoire.find("chop").takes) == 3
    assert repertoire.find("karate") == gesture_named("karate")
    with pytest.raises(ParameterError, match='knows no gesture "wave"') as told:
        repertoire.find("wave")
    assert "chop, ask" in str(told.value.checklist[0]) or "ask, chop" in str(
        told.value.checklist[0]
    )


def test_what_was_recorded_on_the_other_wrist_is_mirrored(session, tmp_path):
    acc, gyr = mirrored(session.acc, session.gyr)
    write_recording(tmp_path / "a.csv", replace(session, wrist="right"))
    write_recording(tmp_path / "b.csv", replace(session, acc=acc, gyr=gyr, wrist="left"))

    takes = read_repertoire(str(tmp_path)).find("chop").takes

    assert len(takes) == 6
    assert np.allclose(takes[0].gyr, takes[3].gyr, atol=1e-3)


def test_a_folder_that_cannot_be_read_is_told(tmp_path):
    with pytest.raises(RecordingError, match="has no recordings"):
        read_repertoire(str(tmp_path))


def test_a_recorded_gesture_is_made_and_everyday_movement_goes_on(folder):
    t, _acc, _gyr, labels = make(read_repertoire(str(folder)).find("chop"))

    made = np.flatnonzero([label == "chop" for label in labels])
    assert np.all(np.diff(made) == 1)
    assert 1.2 < len(made) / RATE_HZ < 2.6
    assert t[made[0]] - t[0] == pytest.approx(LEAD_S, abs=0.05)
    assert np.allclose(np.diff(t), 1 / RATE_HZ)
    assert labels[-1] == ""


@pytest.mark.parametrize("kind", ["whole", "without gravity", "without rotation", "cut off"])
def test_nobody_feels_where_the_recording_begins_and_ends(session, kind):
    changed = {
        "whole": session,
        "without gravity": replace(
            session, acc=session.acc - [0.0, 0.0, 9.81], gravity_included=False
        ),
        "without rotation": replace(session, gyr=None),
        "cut off": replace(session, labels=["chop"] * 90 + [""] * (len(session.t) - 90)),
    }[kind]
    gesture = own(changed, "chop")

    for seed in range(4):
        _, acc, gyr, labels = make(gesture, 4.5, seed)
        inside = np.array(labels) == "chop"
        edges = np.flatnonzero(np.diff(inside.astype(int)))
        lead = np.arange(len(acc) - 1) < edges[0]
        assert steps(acc)[lead].max() < 3.0
        assert steps(gyr)[lead].max() < 1.0
        assert steps(acc)[edges].max() < max(2.0, steps(acc)[inside[1:]].max())
        assert np.abs(gyr).max() < 20


def test_gravity_free_recordings_get_the_gravity_of_the_wrist(session):
    moving = replace(session, acc=np.zeros_like(session.acc), gyr=None, gravity_included=False)

    _, acc, _, labels = make(own(moving, "chop"))

    size = np.linalg.norm(acc[np.array(labels) == "chop"], axis=1)
    assert size == pytest.approx(9.81, abs=0.6)


def test_each_time_another_take_is_made_until_all_were_made(session):
    first = own(session, "chop").takes[0]
    takes = tuple(replace(first, moving=np.full_like(first.moving, 5.0 * n)) for n in (1, 3, 5))
    wearer = Wearer(105, RATE_HZ, 0)

    strengths = []
    for _ in takes:
        wearer.ask(OwnGesture("chop", takes))
        _, acc, _, labels = felt(wearer, 8.0)
        strengths.append(np.linalg.norm(acc[np.array(labels) == "chop"], axis=1).mean())

    assert np.diff(sorted(strengths)).min() > 5


def test_the_same_seed_and_requests_give_the_same_samples(folder):
    gesture = read_repertoire(str(folder)).find("chop")

    first, again, other = make(gesture), make(gesture), make(gesture, seed=1)

    assert np.array_equal(first[1], again[1])
    assert np.array_equal(first[2], again[2])
    assert not np.array_equal(first[1], other[1])


def test_own_and_paper_gestures_wait_for_each_other(folder):
    chop = read_repertoire(str(folder)).find("chop")
    wearer = Wearer(105, RATE_HZ, 0)

    for gesture in (gesture_named("karate"), chop, gesture_named("karate"), chop):
        assert wearer.ask(gesture)
    assert wearer.is_busy
    _, _, _, labels = felt(wearer, 22.0)

    order = [label for label, _ in groupby(labels) if label]
    assert order == ["karate", "chop", "karate", "chop"]
    assert not wearer.is_busy


def test_no_more_gestures_wait_than_somebody_could_remember(folder):
    chop = read_repertoire(str(folder)).find("chop")
    wearer = Wearer(105, RATE_HZ, 0)

    assert sum(wearer.ask(chop) for _ in range(100)) <= 21


def test_what_is_made_is_recognised_by_what_was_learned_from_the_recordings(folder, session):
    repertoire = read_repertoire(str(folder))
    model = train([session], (), ["gmr"])

    for name in ("chop", "ask"):
        t, acc, gyr, _ = make(repertoire.find(name), 8.0, number=7)
        spotter = Spotter(model, method="gmr")
        found = spotter.push(t, acc, gyr) + spotter.flush()
        assert name in [one.gesture for one in found]

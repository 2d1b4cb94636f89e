"""What the gesture benchmark learns from, tests on, leaves out and tells."""

import json
from dataclasses import replace

import numpy as np
import pytest

from benchmarks import _gesture_trials as trials
from benchmarks import gestures
from benchmarks._gesture_folder import read_gesture_folder, split_sessions
from benchmarks._gesture_report import as_data, at_best, rows_of
from benchmarks._gesture_scores import CLEAN, Score
from benchmarks._gesture_sensors import LOSSY, NO_GYROSCOPE, SLOW, TURNED, worse
from nep_core.errors import RecordingError
from nodes.perceptual.recognition.streams import takes_of
from nodes.perceptual.recognition.validation import Totals
from nodes.recordings import write_recording
from nodes.sensory.arm.people import simulate_everyday, simulate_session

pytestmark = pytest.mark.long

RATE_HZ = 33.0


def session_of(person, gesture, takes):
    return simulate_session(person, [gesture], takes, RATE_HZ)


@pytest.fixture
def folder(tmp_path):
    """Two simulated people, two gestures, three takes each; one file a gesture."""
    for person in (103, 104):
        for gesture in ("karate", "katana"):
            one = replace(session_of(person, gesture, 3), person=f"p{person}")
            write_recording(tmp_path / f"p{person}_{gesture}.csv", one)
    return tmp_path


@pytest.fixture
def idle(tmp_path):
    """Everyday movement of another simulated person."""
    place = tmp_path / "everyday"
    place.mkdir()
    write_recording(place / "somebody.csv", simulate_everyday(105, 10.0))
    return place


def write_marked(path, gesture_at, *, count=200, rate_hz=50.0):
    """A hand-made recording whose gesture column is 1 in the given spans of samples."""
    lines = ["t_s,ax,ay,az,gesture"]
    for at in range(count):
        is_made = any(first <= at < end for first, end in gesture_at)
        lines.append(f"{at / rate_hz},{np.sin(at)},0,9.81,{int(is_made)}")
    path.write_text("\n".join(lines), encoding="utf-8")


def test_a_folder_has_people_their_gestures_and_everyday_movement(folder, idle):
    found = read_gesture_folder(folder)

    assert list(found.people) == ["p103", "p104"]
    assert found.gestures == ("karate", "katana")
    assert [one.source for one in found.everyday] == ["somebody"]
    assert found.is_simulated
    assert found.notes == ()


def test_a_folder_of_folders_is_read_as_that_with_the_gestures(folder, idle, tmp_path):
    place = tmp_path / "data"
    (place / "gestures_of_ann").mkdir(parents=True)
    idle.rename(place / "everyday_watch")
    for path in folder.glob("*.csv"):
        path.rename(place / "gestures_of_ann" / path.name)

    found = read_gesture_folder(place)

    assert found.name == "gestures_of_ann"
    assert [one.source for one in found.everyday] == ["somebody"]


def test_the_first_takes_are_learned_from_and_the_rest_of_the_stream_is_tested_on(folder):
    sessions = read_gesture_folder(folder).people["p103"]

    parts = split_sessions(sessions, 2)

    assert [len(takes_of(one)) for one in parts.training] == [2, 2]
    assert [len(takes_of(one)) for one in parts.rest] == [1, 1]
    heard_s = sum(float(one.t[-1]) for one in (*parts.training, *parts.rest))
    assert heard_s == pytest.approx(sum(float(one.t[-1]) for one in sessions), abs=0.2)


def test_a_gesture_with_too_few_takes_is_left_out_and_said(folder):
    write_recording(folder / "p103_batting.csv", session_of(103, "batting", 1))
    sessions = (*read_gesture_folder(folder).people["p103"], session_of(103, "batting", 1))

    parts = split_sessions(sessions, 2)

    assert parts.notes == ("batting was made only once: left out",)
    assert {take.gesture for one in parts.training for take in takes_of(one)} == {
        "karate",
        "katana",
    }


def test_takes_of_several_gestures_in_one_stream_are_split_each_by_itself():
    mixed = simulate_session(103, ["karate", "katana"], 3, RATE_HZ)

    parts = split_sessions((mixed,), 2)

    learned = [take.gesture for one in parts.training for take in takes_of(one)]
    tested = [take.gesture for one in parts.rest for take in takes_of(one)]
    assert sorted(learned) == ["karate", "karate", "katana", "katana"]
    assert sorted(tested) == ["karate", "katana"]


@pytest.mark.parametrize(
    "names",
    [
        ["ann_wave", "ann_wave_2"],
        ["ann_wave_session1", "ann_wave_session2"],
        ["ann_wave_1", "ann_wave_2", "ann_clap_1", "ann_clap_2"],
    ],
)
def test_several_sessions_of_a_gesture_are_one_gesture(tmp_path, names):
    for name in names:
        write_marked(tmp_path / f"{name}.csv", [(20, 60)])

    found = read_gesture_folder(tmp_path)

    assert set(found.gestures) <= {"wave", "clap"}
    assert len(found.people["ann"]) == len(names)
    assert any("another session of wave" in note for note in found.notes)


def test_gestures_whose_names_are_numbered_stay_apart(tmp_path):
    for number in (1, 2, 3):
        write_marked(tmp_path / f"ann_digit_{number}.csv", [(20, 60)])

    assert read_gesture_folder(tmp_path).gestures == ("digit_1", "digit_2", "digit_3")


def test_files_that_cannot_be_used_are_left_out_and_named(tmp_path):
    write_marked(tmp_path / "ann_wave.csv", [(20, 60), (100, 140)])
    write_marked(tmp_path / "ann_slow.csv", [(20, 60)], rate_hz=5.0)
    write_marked(tmp_path / "ann_still.csv", [])
    write_marked(tmp_path / "ann_blink.csv", [(20, 24), (100, 140)])
    (tmp_path / "ann_text.csv").write_text("a poem", encoding="utf-8")

    found = read_gesture_folder(tmp_path)

    notes = "\n".join(found.notes)
    assert found.gestures == ("blink", "wave")
    assert "ann_slow is left out: 5.0 samples a second are too few" in notes
    assert "ann_still is left out: no gesture is marked in it" in notes
    assert "ann_blink: a take of 0.1 s is left out" in notes
    assert "ann_text.csv is left out" in notes


def test_one_person_alone_is_measured_without_other_people(folder):
    for path in folder.glob("p104*"):
        path.unlink()

    planned, notes = trials.plan_trials(read_gesture_folder(folder), (1, 2), is_quick=True)

    assert {one.name for one in planned} == {"personal, 1 example", "personal, 2 examples"}
    assert "other people: there is one person only: left out" in notes


def test_a_gesture_that_nobody_else_makes_is_not_asked_of_other_peoples_model(folder):
    write_recording(
        folder / "p103_batting.csv", replace(session_of(103, "batting", 2), person="p103")
    )

    planned, notes = trials.plan_trials(read_gesture_folder(folder), (), is_quick=True)

    tested = {take.gesture for one in planned[0].rest for take in takes_of(one)}
    assert tested == {"karate", "katana"}
    assert "other people, p103: nobody else makes batting: left out" in notes


def test_a_whole_trial_tells_ours_and_the_references_at_once(folder, idle, monkeypatch):
    monkeypatch.setattr(trials, "simulated_everyday", lambda: [simulate_everyday(1, 8.0)])
    monkeypatch.setattr(trials, "METHODS", trials.METHODS[:1])
    planned, _ = trials.plan_trials(read_gesture_folder(folder), (2,), is_quick=False)
    training, rest = (
        tuple(worse(one, NO_GYROSCOPE) for one in part)
        for part in (planned[0].training, planned[0].rest)
    )
    one = replace(planned[0], training=training, rest=rest, is_thorough=False)

    scores = trials.hold_trials([one], workers=1)

    by_method = {score.method: score for score in at_best(scores)}
    assert set(by_method) == {trials.METHODS[0], trials.WARPING, trials.PAPER}
    ours = by_method[trials.METHODS[0]]
    assert ours.problem == ""
    assert (ours.totals.made, ours.marked) == (2, 2)
    assert ours.idle_s == pytest.approx(10, abs=0.1)
    assert by_method[trials.WARPING].accuracy == 1.0


def test_goals_are_for_ours_and_a_reference_is_named_with_its_threshold(folder, idle):
    name = "personal, 5 examples"
    pairs = Totals((("karate", "karate"), ("karate", "")))
    ours = Score(name, "trees", CLEAN, 0.75, pairs, false=1, idle_s=60.0)
    low = Score(name, trials.WARPING, CLEAN, 0.5, Totals(), idle_s=60.0)
    high = replace(low, threshold=0.6, totals=pairs)

    rows = rows_of(read_gesture_folder(folder), [ours, low, high], [], ["something"])

    by_name = {row["name"].partition(": ")[2]: row for row in rows}
    assert by_name["something"]["value"] is None
    f1 = by_name[f"{name}, trees: F1"]
    assert (f1["value"], f1["goal"], f1["ok"]) == (0.667, "at least 0.95", False)
    assert f1["reference"] == 0.667
    assert by_name[f"{name}, trees: false triggers"]["ok"] is False
    assert "goal" not in by_name[f"{name}, DTW 1-NN (best threshold 0.6): F1"]


def test_a_reference_is_also_told_with_no_more_false_triggers_than_ours_may_have(folder, idle):
    good = Totals((("karate", "karate"),))
    half = Totals((("karate", "karate"), ("karate", "")))
    loose = Score("other people", trials.WARPING, CLEAN, 0.5, good, false=3, idle_s=60.0)
    strict = replace(loose, threshold=0.6, totals=half, false=0)

    rows = rows_of(read_gesture_folder(folder), [loose, strict], [], [])

    values = {row["name"].partition(": ")[2]: row["value"] for row in rows}
    assert values["other people, DTW 1-NN (best threshold 0.5): F1"] == 1.0
    calm = "other people, DTW 1-NN (at most 0.1 false triggers a minute): F1"
    assert values[calm] == 0.667


def test_the_data_for_programs_counts_every_pair(folder):
    score = Score("personal", "trees", CLEAN, 0.75, Totals((("a", "a"), ("a", "a"), ("", "b"))))

    data = as_data(read_gesture_folder(folder), [score], [score], [])

    kept = json.loads(json.dumps(data))["scores"][0]
    assert kept["pairs"] == [["", "b", 1], ["a", "a", 2]]
    assert kept["from_nothing"] == 1
    assert kept["false_a_minute"] is None
    assert data["simulated"] is True


def test_a_worse_sensor_feels_the_same_movement_less_well():
    clean = session_of(103, "karate", 1)

    slow, lossy = worse(clean, SLOW), worse(clean, LOSSY)
    turned, without = worse(clean, TURNED), worse(clean, NO_GYROSCOPE)

    assert slow.rate_hz == pytest.approx(25, rel=0.01)
    assert len(lossy.t) == pytest.approx(0.8 * len(clean.t), rel=0.02)
    assert len(lossy.labels) == len(lossy.t)
    sizes = [np.linalg.norm(one.acc, axis=1) for one in (turned, clean)]
    assert sizes[0] == pytest.approx(sizes[1])
    cosines = (turned.acc * clean.acc).sum(axis=1) / sizes[0] / sizes[1]
    assert np.degrees(np.arccos(np.clip(cosines, -1, 1))).max() <= 20.001
    assert without.gyr is None


@pytest.mark.parametrize("kind", ["nowhere", "empty", "unmarked"])
def test_a_folder_without_gestures_is_told_and_what_to_do(tmp_path, kind, capsys):
    place = tmp_path / kind
    if kind != "nowhere":
        place.mkdir()
    if kind == "unmarked":
        write_marked(place / "ann_wave.csv", [])

    code = gestures.main([str(place)])

    told = capsys.readouterr().err
    assert code == 2
    assert str(place) in told
    assert "person_gesture.csv" in told


def test_a_folder_with_single_takes_of_one_person_cannot_be_measured(tmp_path):
    write_marked(tmp_path / "ann_wave.csv", [(20, 60)])

    with pytest.raises(RecordingError, match="too few takes"):
        gestures.measure(tmp_path, workers=1)


def test_the_environment_names_the_folder_for_all_benchmarks(tmp_path, monkeypatch):
    monkeypatch.setenv("NEP_GESTURES", str(tmp_path / "nowhere"))

    with pytest.raises(RecordingError, match="nowhere is not a folder"):
        gestures.run()

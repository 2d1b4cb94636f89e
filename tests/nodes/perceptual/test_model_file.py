"""Model files: written whole, read back, and refused in words when they are not right."""

from dataclasses import replace

import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.model import (
    Sensor,
    model_bytes,
    read_model,
    with_triggers,
    write_model,
)
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.training import train
from tests.nodes.perceptual.changed_models import rewritten

pytestmark = pytest.mark.long

SENSOR = {"device": "watch", "rate_hz": 50.0, "gravity": True, "gyroscope": True}


@pytest.fixture
def file(tmp_path, model):
    path = tmp_path / "mine.gestures"
    write_model(path, model)
    return path


def test_a_model_that_was_written_recognises_as_before(file, model, stranger):
    again = read_model(file)

    assert (again.gestures, again.trained_on, again.report) == (
        model.gestures,
        model.trained_on,
        model.report,
    )
    part = slice(0, 1500)
    movement = (stranger.t[part], stranger.acc[part], stranger.gyr[part])
    for method in ("trees", "gmr"):
        found = [Spotter(one, method=method).push(*movement) for one in (model, again)]
        assert found[0]
        assert [one.gesture for one in found[0]] == [one.gesture for one in found[1]]
        certainties = [[one.certainty for one in each] for each in found]
        assert certainties[0] == pytest.approx(certainties[1], abs=1e-3)


def test_triggers_wrist_and_sensors_are_kept(tmp_path, model):
    path = tmp_path / "mine.gestures"
    sensors = (Sensor("Pixel Watch", 50.0, True, True), Sensor("", 33.3, False, False))

    write_model(path, replace(with_triggers(model, {"karate": 0.6}), wrist="left", sensors=sensors))
    again = read_model(path)

    assert again.triggers == {"hand_up": 0.75, "karate": 0.6}
    assert (again.wrist, again.sensors) == ("left", sensors)


def test_a_model_of_another_version_is_refused_with_what_to_do(file):
    def be_old(about):
        about["version"] = 1

    with pytest.raises(RecordingError, match="version 1; this program reads version 2") as told:
        read_model(rewritten(file, be_old))
    assert told.value.checklist


@pytest.mark.parametrize("triggers", [{"jump": 0.5}, {"karate": 0.0}, {"karate": 1.2}])
def test_a_trigger_that_makes_no_sense_is_told(model, triggers):
    with pytest.raises(RecordingError) as told:
        with_triggers(model, triggers)
    assert told.value.checklist


def test_the_report_of_a_training_tells_what_each_certainty_catches(model):
    report = model.report["trees"]

    curve = report["curves"]["karate"]
    assert [point["certainty"] for point in curve] == [round(0.05 * n, 2) for n in range(1, 20)]
    assert set(curve[0]) == {"certainty", "caught", "false_everyday_per_hour", "false_in_others"}
    caught = [point["caught"] for point in curve]
    assert caught == sorted(caught, reverse=True)
    take = report["left_out"][0]
    assert set(take) == {"gesture", "source", "start_s", "certainty", "recognised"}
    assert len(report["left_out"]) == sum(report["takes"].values())
    assert len(report["people"]) == 3
    assert all(one["right"] <= one["made"] for one in report["people"].values())


def test_the_same_recordings_give_the_same_bytes(sessions):
    first, second = (train(sessions[:1], methods=["trees"]) for _ in range(2))

    assert model_bytes(first) == model_bytes(second)

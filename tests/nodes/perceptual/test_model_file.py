"""Model files: written whole, read back, and refused in words when they are not right."""

from dataclasses import replace

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import Channels, describe_1, feature_count_1
from nodes.perceptual.recognition.model import (
    TRIGGER,
    Sensor,
    model_bytes,
    read_model,
    with_triggers,
    write_model,
)
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.training import train
from tests.nodes.perceptual.changed_models import rewritten

SIGNALS_1 = (
    1.17683, 1.61665, 0.72346, 1.7472, -2.1769, 1.86131, 1.30244, 2.38787, -0.12307,
    -0.16018, -0.00716,
)  # fmt: skip
FEATURES_1 = 0.33601  # the mean; both as version 1 computed them
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


def test_a_model_of_version_1_is_still_read(tmp_path, model):
    def be_old(about):
        about["version"] = 1
        del about["wrist"], about["sensors"]
        for gesture in about["gestures"]:
            del gesture["trigger"]
        for recogniser in about["recognisers"]:
            del recogniser["features"]

    path = tmp_path / "old.gestures"
    old = [one for one in model.recognisers if not one.channels.gyroscope]
    write_model(path, replace(model, recognisers=tuple(old)))

    again = read_model(rewritten(path, be_old))

    assert again.names == model.names
    assert set(again.triggers.values()) == {TRIGGER}
    assert (again.wrist, again.sensors) == ("", ())
    assert {(one.method, one.features) for one in again.recognisers} == {("trees", 1)}
    write_model(path, again)
    assert {one.features for one in read_model(path).recognisers} == {1}


def test_a_model_of_version_1_that_has_no_trees_must_be_trained_again(file):
    def be_old(about):
        about["recognisers"] = [
            one | {"features": 1} for one in about["recognisers"] if one["method"] == "gmr"
        ]

    with pytest.raises(RecordingError, match="learned by an earlier version") as told:
        read_model(rewritten(file, be_old))
    assert told.value.checklist


def test_models_of_version_1_see_windows_as_they_did():
    raw = np.random.default_rng(1).normal(0, 3, (2, 32, 6))

    windows = describe_1(raw, np.array([20, 60]), Channels(gravity=True, gyroscope=True))

    assert windows.features.shape == (2, feature_count_1(Channels(True, True)))
    assert windows.signals[0, 0] == pytest.approx(SIGNALS_1, abs=1e-4)
    assert windows.features[:, -1] == pytest.approx(np.log([0.4, 1.2]))
    assert windows.features.mean() == pytest.approx(FEATURES_1, abs=1e-4)


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

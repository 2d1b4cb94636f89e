"""Model files: written whole, read back, and refused in words when they are not right."""

import json
import pickle
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import Channels
from nodes.perceptual.recognition.features_1 import describe_1, feature_count_1
from nodes.perceptual.recognition.model import TRIGGER, Sensor, with_triggers
from nodes.perceptual.recognition.model_file import model_bytes, read_model, write_model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.training import train

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


def rewritten(path, change_about=None, **changes):
    """The same file with its JSON or some arrays changed; None leaves an array out."""
    with np.load(path, allow_pickle=False) as content:
        arrays = dict(content)
    about = json.loads(arrays["about"].tobytes())
    if change_about:
        change_about(about)
    arrays["about"] = np.frombuffer(json.dumps(about).encode(), np.uint8)
    arrays |= changes
    kept = {name: array for name, array in arrays.items() if array is not None}
    with path.open("wb") as out:
        np.savez(out, **kept)
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


def test_another_version_is_told(file):
    rewritten(file, lambda about: about.update(version=7, gestures="something new"))

    with pytest.raises(RecordingError, match=r"mine\.gestures is a gesture model of version 7"):
        read_model(file)


def test_a_file_that_is_not_there_is_told(tmp_path):
    with pytest.raises(RecordingError, match=r"There is no gesture model .*none\.gestures"):
        read_model(tmp_path / "none.gestures")


@pytest.mark.parametrize("content", [b"", b"PK\3\4", b"t_s,ax,ay,az\n0,1,2,3\n", b"\0" * 5000])
def test_a_file_that_is_no_model_is_told(tmp_path, content):
    path = tmp_path / "mine.gestures"
    path.write_bytes(content)

    with pytest.raises(RecordingError, match=r"mine\.gestures is not a gesture model") as told:
        read_model(path)
    assert told.value.checklist


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9, 0.999])
def test_a_truncated_model_is_told(file, part):
    content = file.read_bytes()
    file.write_bytes(content[: int(len(content) * part)])

    with pytest.raises(RecordingError, match="damaged"):
        read_model(file)


def test_any_flipped_byte_is_noticed_or_harmless(file):
    content = file.read_bytes()
    for at in np.random.default_rng(0).integers(0, len(content), 60):
        changed = bytearray(content)
        changed[at] ^= 0xFF
        file.write_bytes(changed)
        try:
            read_model(file)
        except RecordingError as error:
            assert "mine.gestures" in error.sentence


@pytest.mark.parametrize(
    "change",
    [
        lambda about: about.update(gestures=[]),
        lambda about: about.update(rate_hz=51),
        lambda about: about.update(recognisers=[]),
        lambda about: about["recognisers"][0].update(method="magic"),
        lambda about: about["recognisers"][0].update(gyroscope="yes"),
        lambda about: about["recognisers"][0].update(gravity=False),
        lambda about: about["gestures"].pop(),
        lambda about: about["gestures"][0].update(longest_s=1e9),
        lambda about: about["gestures"][0].update(shortest_s=0),
        lambda about: about["gestures"][0].update(name=""),
        lambda about: about["gestures"][0].update(name=" "),
        lambda about: about["gestures"][0].update(name="x" * 101),
        lambda about: about["gestures"][0].update(name="\x1b[2Jkarate"),
        lambda about: about["gestures"][0].update(name="two\nlines"),
        lambda about: about["gestures"][0].update(name=about["gestures"][1]["name"]),
        lambda about: about["gestures"][0].update(trigger=0),
        lambda about: about["gestures"][0].update(trigger=1.5),
        lambda about: about["gestures"][0].update(trigger="often"),
        lambda about: about.update(wrist="foot"),
        lambda about: about.update(sensors="a watch"),
        lambda about: about.update(sensors=[SENSOR] * 101),
        lambda about: about.update(sensors=[SENSOR | {"device": "\x1b[2J"}]),
        lambda about: about.update(sensors=[SENSOR | {"device": "x" * 201}]),
        lambda about: about.update(sensors=[SENSOR | {"rate_hz": None}]),
        lambda about: about.update(format="something else"),
        lambda about: about.pop("gestures"),
    ],
)
def test_a_description_that_does_not_fit_its_numbers_is_told(file, change):
    rewritten(file, change)

    with pytest.raises(RecordingError, match="damaged"):
        read_model(file)


@pytest.mark.parametrize("packing", [zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_another_packing_is_told_before_it_is_opened(file, packing):
    with zipfile.ZipFile(file, "w", packing) as archive:
        archive.writestr("about.npy", b"{}" * 500)

    with pytest.raises(RecordingError, match="damaged") as told:
        read_model(file)
    assert "packed" in told.value.details


def test_an_encrypted_model_is_told(file):
    content = bytearray(file.read_bytes())
    member = content.index(b"PK\1\2")
    content[member + 8] |= 1
    file.write_bytes(content)

    with pytest.raises(RecordingError, match="damaged") as told:
        read_model(file)
    assert "encrypted" in told.value.details


@pytest.mark.parametrize(
    "header",
    [
        b"{'descr': '<f8', 'shape': (",
        b'"""',
        b"  {\n {",
        b"\n  1\n 2",
        b"(" * 9000,
        b"-" * 9000 + b"1",
        b"{[]: 1}",
        b"{'descr': (), 'fortran_order': False, 'shape': (1,)}",
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (10**99, 0)}",
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (1" + b"0" * 40 + b", 0)}",
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
        b"{'descr': '<c16', 'fortran_order': False, 'shape': (0,)}",
        b"{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (0,)}",
    ],
)
def test_a_hostile_header_of_an_array_is_told(file, header):
    with zipfile.ZipFile(file, "a") as archive:
        size = len(header).to_bytes(2, "little")
        archive.writestr("9.bad.npy", b"\x93NUMPY\1\0" + size + header)

    with pytest.raises(RecordingError, match="damaged") as told:
        read_model(file)
    assert told.value.checklist


def test_a_folder_is_no_model(tmp_path):
    with pytest.raises(RecordingError, match="is a folder, not a gesture model") as told:
        read_model(tmp_path)
    assert told.value.checklist


def test_a_missing_array_is_told(file):
    rewritten(file, **{"0.votes": None})

    with pytest.raises(RecordingError, match="damaged"):
        read_model(file)


def test_code_in_a_model_file_is_never_run(file, tmp_path):
    class Trap:
        def __reduce__(self):
            return (tmp_path.joinpath("ran").touch, ())

    trap = np.array([Trap()], dtype=object)
    rewritten(file, **{"0.usual_score": trap})
    with pytest.raises(RecordingError, match="damaged"):
        read_model(file)
    file.write_bytes(pickle.dumps(Trap()))
    with pytest.raises(RecordingError, match="not a gesture model"):
        read_model(file)

    assert not (tmp_path / "ran").exists()


def test_a_file_that_claims_to_be_huge_is_told_at_once(file):
    header = b"\x93NUMPY\x01\x00\x76\x00{'descr': '<f8', 'fortran_order': False, 'shape': (%d,), }"
    with zipfile.ZipFile(file, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("9.claim.npy", (header % 10**13).ljust(127) + b"\n")
    with pytest.raises(RecordingError, match="damaged") as told:
        read_model(file)
    assert "claims" in told.value.details

    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("about.npy", b"\0" * 201_000_000)
    with pytest.raises(RecordingError, match="damaged") as told:
        read_model(file)
    assert "far larger" in told.value.details

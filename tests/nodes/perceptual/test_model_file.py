"""Model files: written whole, read back, and refused in words when they are not right."""

import json
import pickle
import zipfile

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.model_file import model_bytes, read_model, write_model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.training import train


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
    for method in ("trees", "gmr"):
        found = [
            Spotter(one, method=method).push(stranger.t, stranger.acc, stranger.gyr)
            for one in (model, again)
        ]
        assert [one.gesture for one in found[0]] == [one.gesture for one in found[1]]
        certainties = [[one.certainty for one in each] for each in found]
        assert certainties[0] == pytest.approx(certainties[1], abs=1e-3)


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
        lambda about: about.update(format="something else"),
        lambda about: about.pop("gestures"),
    ],
)
def test_a_description_that_does_not_fit_its_numbers_is_told(file, change):
    rewritten(file, change)

    with pytest.raises(RecordingError, match="damaged"):
        read_model(file)


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

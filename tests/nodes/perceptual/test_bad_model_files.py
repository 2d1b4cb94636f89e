"""Model files that are not right, or mean harm: refused in words, and nothing of them is run."""

import pickle
import zipfile

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.model import read_model, write_model
from tests.nodes.perceptual.changed_models import rewritten

SENSOR = {"device": "watch", "rate_hz": 50.0, "gravity": True, "gyroscope": True}


@pytest.fixture(scope="module")
def good(tmp_path_factory, model):
    """The bytes of a file that is right."""
    path = tmp_path_factory.mktemp("model") / "mine.gestures"
    write_model(path, model)
    return path.read_bytes()


@pytest.fixture
def file(tmp_path, good):
    path = tmp_path / "mine.gestures"
    path.write_bytes(good)
    return path


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
            assert "mine.gestures" in str(error.sentence)


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

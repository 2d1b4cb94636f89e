"""Bluetooth devices described by files, and what their messages mean."""

import math
import re
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import dev
from nep_core.errors import NodeStartError
from nodes.sensory.connectors import bluetooth as rooms
from nodes.sensory.connectors.bluetooth import Decoder, profiles, read_profile

G = 9.80665
ROOT = Path(dev.__file__).parent
KNOWN = profiles()
MINE = """
title = "Mine"
about = "Made here."
service = "6e657000-0000-4000-8000-0000000000aa"
[[characteristics]]
uuid = "6e657000-0000-4000-8000-0000000000ab"
"""
ACC = ",".join(f'{{is="{axis}",type="int16",unit="g"}}' for axis in ("ax", "ay", "az"))


def decoder(name):
    return Decoder(KNOWN[name].characteristics[0])


def written(tmp_path, text):
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def own_decoder(tmp_path, fields, more=""):
    text = f"{MINE}{more}\nfields = [{fields}]\n"
    return Decoder(read_profile(written(tmp_path, text)).characteristics[0])


def test_a_thingy_on_a_table_feels_one_g_upwards():
    message = bytes.fromhex("FAFFF4FFF603") + struct.pack("<3h", 32, -64, 0) + bytes(6)

    [reading] = decoder("thingy52").readings(message)

    assert reading.acc == pytest.approx((-6 * G / 1024, -12 * G / 1024, 1014 * G / 1024))
    assert reading.gyr == pytest.approx((math.radians(1), math.radians(-2), 0))
    assert reading.stamp is None
    assert reading.gravity_included


@pytest.mark.parametrize(
    ("said", "felt"),
    [
        ((0, 0, -1024), (0, 0, 1.024 * G)),  # face up
        ((1000, 0, 0), (-G, 0, 0)),  # tilted to the right: up is to the left
        ((0, 1000, 0), (0, G, 0)),  # logo up
    ],
)
def test_a_microbit_gets_androids_signs(said, felt):
    [reading] = decoder("microbit").readings(struct.pack("<3h", *said))

    assert reading.acc == pytest.approx(felt)
    assert reading.gyr is None


def test_a_watch_that_lies_face_up_feels_one_g_upwards():
    [reading] = decoder("pinetime").readings(struct.pack("<3h", 0, 0, -1024))

    assert reading.acc == pytest.approx((0, 0, G))


def test_six_numbers_are_thousandths_of_g_and_tenths_of_a_degree():
    [reading] = decoder("six_int16").readings(struct.pack("<6h", 0, -500, 1000, 900, 0, -1800))

    assert reading.acc == pytest.approx((0, -G / 2, G))
    assert reading.gyr == pytest.approx((math.pi / 2, 0, -math.pi))


def test_several_samples_in_one_message_are_all_read(tmp_path):
    own = own_decoder(tmp_path, ACC, 'byte_order = "big"\nheader = 1')

    found = own.readings(b"\x07" + struct.pack(">6h", 1, 2, 3, 4, 5, 6))

    assert [reading.acc for reading in found] == [(G, 2 * G, 3 * G), (4 * G, 5 * G, 6 * G)]


def test_a_counter_that_begins_anew_goes_on(tmp_path):
    own = own_decoder(tmp_path, '{is="t",type="uint16",unit="ms"},' + ACC)

    stamps = [own.readings(struct.pack("<H3h", t, 0, 0, 1))[0].stamp for t in (65_530, 4, 14)]

    assert stamps == pytest.approx([65.530, 65.540, 65.550])


def test_other_types_and_axes_that_are_turned_round(tmp_path):
    fields = ",".join(
        f'{{is="{axis}",type="float32",unit="m/s²",scale={scale}}}'
        for axis, scale in (("az", -1.0), ("ay", 1.0), ("ax", 2.0))
    )

    [reading] = own_decoder(tmp_path, fields).readings(struct.pack("<3f", -9.5, 1.0, 0.25))

    assert reading.acc == (0.5, 1.0, 9.5)


@pytest.mark.parametrize("data", [b"", b"\x00", bytes(5), bytes(7)])
def test_messages_of_another_length_are_none(data):
    assert decoder("microbit").readings(data) is None


def test_numbers_that_are_none_are_refused(tmp_path):
    fields = ",".join(f'{{is="{axis}",type="float32",unit="g"}}' for axis in ("ax", "ay", "az"))
    own = own_decoder(tmp_path, fields)

    assert own.readings(struct.pack("<3f", math.nan, 0, 0)) is None
    assert own.readings(struct.pack("<3f", 0, math.inf, 0)) is None
    assert own.readings(struct.pack("<3f", 0, 0, 1e30)) is None


@given(name=st.sampled_from(sorted(KNOWN)), data=st.binary(max_size=64))
def test_whatever_a_device_sends_makes_whole_readings_or_none(name, data):
    found = decoder(name).readings(data)

    for reading in found or []:
        assert reading.acc is not None
        assert all(math.isfinite(value) for value in (*reading.acc, *(reading.gyr or ())))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("title = ", "Invalid"),
        ('title = "x"', "missing required field"),
        (MINE + "fields = []", "length >= 1"),
        (MINE + 'fields = [{is="ax",type="int16",unit="g"}]', "belong together"),
        (MINE + f'fields = [{ACC},{{is="ax",type="int16",unit="g"}}]', "there twice"),
        (MINE + 'fields = [{is="skip",type="int16"}]', "no characteristic has ax"),
        (MINE + f"fields = [{ACC}]".replace('"g"', '"deg/s"'), "ax cannot be in deg/s"),
        (MINE + f"fields = [{ACC}]".replace("int16", "int24"), "Invalid enum value 'int24'"),
        (MINE.replace("6e657000", "6e65") + f"fields = [{ACC}]", "badly formed"),
        (MINE + f"fields = [{ACC}]\ncolour = 3", "unknown field"),
        (f"{MINE}fields = [{ACC}]\n[[writes]]\nuuid='x'\nbytes='0g'", "Expected"),
    ],
)
def test_a_file_that_is_wrong_is_told_with_the_reason(tmp_path, text, reason):
    with pytest.raises(NodeStartError, match=r"mine\.toml cannot be used") as told:
        read_profile(written(tmp_path, text))

    assert reason in str(told.value)


def test_the_example_of_the_documentation_is_a_profile(tmp_path):
    text = (ROOT / "docs" / "imu_profiles.md").read_text(encoding="utf-8")
    [example] = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)

    profile = read_profile(written(tmp_path, example))

    assert Decoder(profile.characteristics[0]).readings(struct.pack("<H3hB", 5, 0, 0, -1000, 1))
    assert all(f"`{name}.toml`" in text for name in KNOWN)


def test_a_file_of_the_user_goes_before_ours(tmp_path, monkeypatch):
    folder = tmp_path / "imu_profiles"
    folder.mkdir()
    (folder / "microbit.toml").write_text(f"{MINE}fields = [{ACC}]", encoding="utf-8")
    monkeypatch.setattr(rooms, "certificate_folder", lambda: tmp_path)

    found = profiles()

    assert found["microbit"].title == "Mine"
    assert set(found) == set(KNOWN)

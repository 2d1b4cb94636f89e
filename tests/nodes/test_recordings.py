"""Recordings are read as they are, or refused with a sentence."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import RecordingError
from nodes.recordings import (
    MAX_SAMPLES,
    Recording,
    read_recording,
    read_recordings,
    write_recording,
)

HEADER = "t_s,ax,ay,az,gx,gy,gz,gesture\n"
ROW = "{t:.2f},0.1,-0.2,9.8,0.01,0.02,0.03,{gesture}\n"


def recorded(folder, text, name="j_bounce_up.csv"):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def rows(gestures):
    return "".join(ROW.format(t=number * 0.02, gesture=g) for number, g in enumerate(gestures))


def refusal(path):
    with pytest.raises(RecordingError) as raised:
        read_recording(path)
    assert raised.value.checklist
    return str(raised.value.sentence)


def test_person_and_gesture_come_from_the_file_name(tmp_path):
    recording = read_recording(recorded(tmp_path, HEADER + rows("0110")))

    assert recording.person == "j"
    assert recording.labels == ["", "bounce_up", "bounce_up", ""]
    assert recording.gravity_included
    assert recording.rate_hz == pytest.approx(50)
    assert recording.acc[0] == pytest.approx([0.1, -0.2, 9.8])
    assert recording.gyr[0] == pytest.approx([0.01, 0.02, 0.03])


def test_gestures_may_be_named_on_each_line(tmp_path):
    recording = read_recording(recorded(tmp_path, HEADER + rows(["none", "wave", "", "wave"])))

    assert recording.labels == ["", "wave", "", "wave"]


def test_a_watch_with_milliseconds_and_activities(tmp_path):
    text = (
        "x_acc,y_acc,z_acc,x_gyro,y_gyro,z_gyro,timestamp,label\n"
        "0.3,-3.5,9.1,-0.01,-0.07,0.09,1657533977810,SEATED\n"
        "0.4,-3.6,9.0,-0.04,-0.06,0.08,1657533977820,SEATED\n"
        "0.4,-3.6,9.0,-0.04,-0.06,0.08,1657533977830,WALKING\n"
    )

    recording = read_recording(recorded(tmp_path, text))

    assert recording.t == pytest.approx([0, 0.01, 0.02])
    assert recording.labels is None
    assert recording.person == ""
    assert recording.gyr[0] == pytest.approx([-0.01, -0.07, 0.09])


@pytest.mark.parametrize(
    "text",
    [
        "az;ay;ax;time\n3;2;1;0,00\n3;2;1;0,02\n",  # semicolons and decimal commas, other order
        "Time (ms),Accelerometer X,Accelerometer Y,Accelerometer Z\n0,1,2,3\n20,1,2,3\n",
        '"t","x","y","z"\n"0.00","1","2","3"\n\n"0.02","1","2","3"\n',
        "timestamp_ns,acc_x,acc_y,acc_z\r\n0,1,2,3\r\n20000000,1,2,3\r\n",
        "\ufefft,x,y,z\n5.00,1,2,3\n5.02,1,2,3",
    ],
)
def test_other_ways_to_write_the_same(tmp_path, text):
    recording = read_recording(recorded(tmp_path, text))

    assert recording.acc == pytest.approx(np.array([[1, 2, 3], [1, 2, 3]], float))
    assert recording.t == pytest.approx([0, 0.02])
    assert recording.gyr is None


def test_a_sensor_without_gravity_is_told_by_its_numbers_or_its_name(tmp_path):
    still = "0.00,0.1,0.1,0.1\n0.02,0.1,0.1,0.1\n"
    earth = "0.00,0,0,9.8\n0.02,0,0,9.8\n"

    assert read_recording(recorded(tmp_path, "t,x,y,z\n" + earth)).gravity_included
    assert not read_recording(recorded(tmp_path, "t,x,y,z\n" + still)).gravity_included
    linear = "t,lin_ax,lin_ay,lin_az\n"
    assert not read_recording(recorded(tmp_path, linear + earth)).gravity_included


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (HEADER + rows("0") + "0.02,hello,0,9,0,0,0,0\n", 'Line 3 of j_bounce_up.csv has "hello"'),
        (HEADER + rows("0") + "0.02,,0,9,0,0,0,0\n", "Line 3 of j_bounce_up.csv has nothing"),
        (HEADER + rows("0") + "0.02,nan,0,9,0,0,0,0\n", "Line 3 of j_bounce_up.csv has a number"),
        (HEADER + rows("0") + "0.02,-inf,0,9,0,0,0,0\n", "not finite"),
        (
            HEADER + rows("0") + "0.02,1e300,0,9,0,0,0,0\n",
            "Line 3 of j_bounce_up.csv has the number",
        ),
        (HEADER + rows("0") + "1e300,1,0,9,0,0,0,0\n", "has the number 1e+300, which no sensor"),
        (HEADER + rows("00") + "3600.1,1,0,9,0,0,0,0\n", "Line 4 of j_bounce_up.csv is more than"),
        (HEADER + rows("0") + "0.02,\x1b[2J,0,9,0,0,0,0\n", 'has "?[2J" in column 2'),
        (HEADER + rows("0") + "0.02,1,2\n", "Line 3 of j_bounce_up.csv has only 3 columns"),
        (HEADER + rows("00") + "0.01,1,2,9,0,0,0,0\n", "go backwards at line 4"),
        (HEADER + "0,1,2,9,0,0,0,0\n" * 2, "are all the same"),
        ("t,x\n0,1\n1,1\n", "needs the columns t_s, ax, ay and az; its header, line 1, names t, x"),
        ("0.00,1,2,3\n0.02,1,2,3\n", "has no header: line 1 holds numbers already"),
        (HEADER, "has too few samples: 0"),
        (HEADER + rows("0"), "has too few samples: 1"),
        ("", "is empty"),
        ("\n \n# person: x\n", "is empty"),
        (b"t,x,y,z\n\xff\xfe1,2,3,4\n", "is not a text file (UTF-8)"),
        ((HEADER + rows("00")).encode("utf-16"), "is not a text file"),
        (b"\x89PNG\r\n\x00\x00\x00", "is not a text file; a recording is a CSV file"),
        ("x" * 70_000, "is one endless line"),
    ],
)
def test_what_is_no_recording_is_refused_with_its_place(tmp_path, text, said):
    assert said in refusal(recorded(tmp_path, text))


def test_a_recording_with_a_break_of_a_year_says_where_to_cut_it(tmp_path):
    year_ms = 365 * 24 * 3_600_000
    times = [*range(0, 1000, 20), *range(year_ms, year_ms + 1000, 20)]
    text = "time_ms,x,y,z\n" + "".join(f"{time},1,2,9\n" for time in times)

    with pytest.raises(RecordingError, match=r"Line 52 .* more than an hour later") as told:
        read_recording(recorded(tmp_path, text))

    assert "save line 52 and all below it" in str(told.value.checklist[0])


def test_a_file_that_is_not_there_and_a_folder_are_told_apart(tmp_path):
    assert "There is no recording" in refusal(tmp_path / "gone.csv")
    assert "is a folder" in refusal(tmp_path)


def test_ten_million_lines_are_refused_by_their_size_without_reading_them(tmp_path):
    line = ROW.format(t=0, gesture=0).encode()
    path = tmp_path / "long.csv"
    with path.open("wb") as file:
        file.write(HEADER.encode() + line * 2000)
        file.truncate(10_000_000 * len(line))  # sparse: reading it all would take minutes

    assert f"may have {MAX_SAMPLES:,}" in refusal(path)


def test_a_folder_of_recordings_is_read_in_the_order_of_names(tmp_path):
    for name in ("b_wave.csv", "a_wave.csv", "notes.txt"):
        recorded(tmp_path, HEADER + rows("0110"), name)

    assert [recording.person for recording in read_recordings(tmp_path)] == ["a", "b"]


def test_a_folder_without_recordings_says_what_belongs_there(tmp_path):
    with pytest.raises(RecordingError, match="has no recordings"):
        read_recordings(tmp_path)
    with pytest.raises(RecordingError, match="is not a folder") as told:
        read_recordings(tmp_path / "gone")
    assert told.value.checklist


@given(
    labels=st.lists(st.sampled_from(["", "wave", "turn left", 'a"b', "x,y"]), min_size=2),
    acc=st.floats(-1e3, 1e3),
    has_gyro=st.booleans(),
    has_gravity=st.booleans(),
)
def test_what_is_written_is_read_back(tmp_path_factory, labels, acc, has_gyro, has_gravity):
    n = len(labels)
    path = tmp_path_factory.mktemp("recordings") / "j_session.csv"
    recording = Recording(
        "j_session", np.arange(n) / 50, np.full((n, 3), acc), np.ones((n, 3)) if has_gyro else None,
        labels, has_gravity, person="Ana Lía", simulated=True,
    )  # fmt: skip

    write_recording(path, recording)
    read = read_recording(path)

    assert read.t == pytest.approx(recording.t)
    assert read.acc == pytest.approx(recording.acc, rel=1e-5, abs=1e-9)
    assert (read.gyr is None) == (not has_gyro)
    assert len(set(read.labels)) == len(set(labels))
    assert (read.gravity_included, read.person, read.simulated) == (has_gravity, "Ana_Lía", True)


def test_a_recording_that_cannot_be_written_whole_leaves_the_old_one(tmp_path):
    path = recorded(tmp_path, "old")
    broken = Recording("x", np.arange(3.0), np.zeros((3, 3)), None, ["", ""], True)

    with pytest.raises(IndexError):
        write_recording(path, broken)

    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


@given(st.binary(max_size=400))
def test_no_bytes_at_all_crash_the_reader(tmp_path_factory, data):
    path = tmp_path_factory.mktemp("recordings") / "any.csv"
    path.write_bytes(b"t,x,y,z\n" + data)

    try:
        recording = read_recording(path)
    except RecordingError as error:
        assert "any.csv" in str(error.sentence)
    else:
        assert np.isfinite(recording.acc).all()


def test_a_vigorous_gesture_without_gravity_is_not_taken_for_gravity(tmp_path):
    t = np.arange(0, 10, 0.02)
    shaken = np.where((t % 2 < 1.4)[:, None], 12 * np.sin(20 * t)[:, None] + [0, 8, 0], 0.1)
    lines = "".join(
        f"{at:.2f},{x:.3f},{y:.3f},{z:.3f}\n" for at, (x, y, z) in zip(t, shaken, strict=True)
    )

    recording = read_recording(recorded(tmp_path, "t_s,ax,ay,az\n" + lines))

    assert 6 < np.median(np.linalg.norm(recording.acc, axis=1)) < 14
    assert not recording.gravity_included


def test_where_and_with_what_a_recording_was_made_is_kept(tmp_path):
    recording = read_recording(recorded(tmp_path, HEADER + rows("0110")))

    write_recording(tmp_path / "b.csv", replace(recording, wrist="left", device="My\n watch"))
    again = read_recording(tmp_path / "b.csv")
    (tmp_path / "b.csv").write_text("# wrist: foot\n# device: \x1b[2J\n" + HEADER + rows("0110"))
    strange = read_recording(tmp_path / "b.csv")

    assert (again.wrist, again.device) == ("left", "My watch")
    assert (strange.wrist, strange.device) == ("", "[2J")


def test_a_question_mark_marks_what_nobody_knows(tmp_path):
    recording = read_recording(recorded(tmp_path, HEADER + rows("0?10")))

    assert recording.labels == ["", "?", "bounce_up", ""]

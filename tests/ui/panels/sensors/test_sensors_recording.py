"""Recording while it comes: what is on the disk can be read, whatever happens."""

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from nep_core.errors import RecordingError
from nep_core.wire.messages import Imu
from nep_studio.ui.plugins.sensors.recorder import Recording
from nodes.recordings import read_recording
from tests.conftest import PROJECT

pytestmark = pytest.mark.long


def imu(start_s: float, count: int = 30, source: str = "watch", **more: object) -> Imu:
    t = start_s + np.arange(count) / 50
    acc = [(float(np.sin(x)), 0.25, 9.8) for x in t]
    gyr = [(0.1, float(np.cos(x)), -0.3) for x in t]
    return Imu(source=source, rate_hz=50, t=t.tolist(), acc=acc, gyr=gyr, **more)


@pytest.fixture
def recording(tmp_path: Path) -> Recording:
    made = Recording(tmp_path / "new folder", "walk")
    made.open()
    return made


def test_a_recording_can_be_read_back(recording: Recording) -> None:
    batches = [imu(100 + 0.6 * at) for at in range(4)]

    for batch in batches:
        recording.add(batch)
    [path] = recording.close()

    read = read_recording(path)
    assert path.name == "walk.csv"
    assert read.t == pytest.approx(np.arange(120) / 50, abs=1e-5)
    assert read.acc == pytest.approx(np.concatenate([b.acc for b in batches]), rel=1e-4)
    assert read.gyr == pytest.approx(np.concatenate([b.gyr for b in batches]), rel=1e-4)
    assert read.gravity_included
    assert not read.simulated
    assert recording.samples == 120
    assert recording.size_bytes == path.stat().st_size


def test_what_is_recorded_can_be_read_at_every_moment(recording: Recording) -> None:
    recording.add(imu(0.0, simulated=True, gravity_included=False))

    read = read_recording(recording.paths[0])

    assert len(read.t) == 30
    assert (read.simulated, read.gravity_included) == (True, False)
    recording.close()


def test_each_sensor_and_each_clock_has_a_file_of_its_own(recording: Recording) -> None:
    recording.add(imu(0.0))
    recording.add(imu(0.0, source="phone"))
    recording.add(imu(0.6))
    recording.add(imu(0.3))  # its clock was set back
    recording.add(imu(90_000.0))  # a day later

    paths = recording.close()

    assert [path.name for path in paths] == ["walk.csv", "walk_2.csv", "walk_3.csv", "walk_4.csv"]
    assert [len(read_recording(path).t) for path in paths] == [60, 30, 30, 30]


def test_numbers_that_cannot_be_read_back_are_left_out(recording: Recording) -> None:
    batch = imu(0.0)
    batch.acc[3] = (float("nan"), 0.0, 0.0)
    batch.t[10] = batch.t[9]

    recording.add(batch)
    recording.add(Imu(source="watch", rate_hz=50, t=[9.0], acc=[]))

    assert len(read_recording(recording.close()[0]).t) == 28


def test_a_recording_of_nothing_leaves_no_file(recording: Recording) -> None:
    recording.add(imu(0.0, count=1))

    assert recording.close() == []
    assert list(recording.folder.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_told_with_a_checklist(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")

    with pytest.raises(RecordingError) as told:
        Recording(tmp_path / "file" / "in it", "walk").open()

    assert "cannot be written" in str(told.value.sentence)
    assert told.value.checklist


RECORD = """
import resource, sys
from pathlib import Path
from nep_core.errors import RecordingError
from tests.ui.panels.sensors.test_sensors_recording import imu
from nep_studio.ui.plugins.sensors.recorder import Recording
if len(sys.argv) > 2:
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]),) * 2)
recording = Recording(Path(sys.argv[1]), "walk")
recording.open()
at = 0
try:
    while True:
        recording.add(imu(0.6 * at))
        at += 1
        if at == 20:
            sys.stdout.write("twenty\\n")
            sys.stdout.flush()
except RecordingError as error:
    recording.close()
    sys.stdout.write(f"{recording.samples} {error.sentence}")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits of file sizes are POSIX")
def test_on_a_full_disk_what_was_recorded_is_kept(tmp_path: Path) -> None:
    child = subprocess.run(
        [sys.executable, "-c", RECORD, str(tmp_path), "40000"],
        cwd=PROJECT,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )

    samples, _, sentence = child.stdout.splitlines()[-1].partition(" ")
    assert "cannot be written" in sentence
    assert len(read_recording(tmp_path / "walk.csv").t) == int(samples) > 500


@pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX")
def test_a_program_that_is_killed_leaves_a_file_that_can_be_read(tmp_path: Path) -> None:
    child = subprocess.Popen(
        [sys.executable, "-c", RECORD, str(tmp_path)],
        cwd=PROJECT,
        stdout=subprocess.PIPE,
        text=True,
    )
    with child:
        assert child.stdout is not None
        child.stdout.readline()
        child.send_signal(signal.SIGKILL)

    assert len(read_recording(tmp_path / "walk.csv").t) >= 600

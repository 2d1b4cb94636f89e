"""Recordings are played as if live."""

import time

import numpy as np
import pytest

from nodes.recordings import read_recording, write_recording
from nodes.sensory.arm.people import perform

pytestmark = pytest.mark.long


@pytest.fixture
def karate(tmp_path):
    path = tmp_path / "103_karate.csv"
    write_recording(path, perform("karate", 103, 0))
    return path


def test_every_sample_arrives_with_the_times_of_the_recording(listener, karate):
    recording = read_recording(karate)
    listener.start("replay", recording=str(karate), speed=4)

    listener.state("ready", "seconds to play")
    began_s = time.monotonic()
    listener.state("running", "the recording has ended")
    took_s = time.monotonic() - began_s

    batches = listener.batches_until(lambda batch: batch.t[-1] >= recording.t[-1] - 1e-9)
    t = [at for batch in batches for at in batch.t]
    assert t == pytest.approx(recording.t.tolist())
    assert np.array_equal([row for batch in batches for row in batch.acc], recording.acc)
    assert took_s == pytest.approx(recording.t[-1] / 4, rel=0.3)
    assert {batch.rate_hz for batch in batches} == {recording.rate_hz}
    assert all(batch.simulated for batch in batches)


def test_it_stays_when_the_recording_has_ended_unless_told_to_quit(listener, karate):
    stays = listener.start("replay", recording=str(karate), speed=50)
    listener.state("running", "the recording has ended")
    assert stays.poll() is None
    stays.terminate()
    assert stays.wait(5) == 0

    quits = listener.start("replay", recording=str(karate), speed=50, quit_at_end=True)
    assert quits.wait(10) == 0


def test_a_folder_is_played_in_the_order_of_names_on_one_clock(listener, tmp_path, karate):
    write_recording(tmp_path / "101_katana.csv", perform("katana", 101, 0))
    listener.start("replay", recording=str(tmp_path), speed=50)

    listener.state("running", "plays 101_katana")
    listener.state("running", "plays 103_karate")
    listener.state("running", "the recording has ended")

    batches = listener.batches_until(lambda batch: batch.source == "103_karate")
    t = [at for batch in batches for at in batch.t]
    assert np.all(np.diff(t) > 0)


def test_a_loop_plays_again_on_the_same_clock(listener, karate):
    listener.start("replay", recording=str(karate), speed=50, loop=True)

    batches = listener.batches_until(lambda batch: batch.t[-1] > 30)

    assert np.all(np.diff([at for batch in batches for at in batch.t]) > 0)


def test_it_starts_at_a_second(listener, karate):
    recording = read_recording(karate)
    listener.start("replay", recording=str(karate), speed=50, start_s=2.0)

    batches = listener.batches_until(lambda batch: batch.t[-1] > recording.t[-1] - 2.001)

    assert batches[0].t[0] == 0
    assert np.array_equal([row for batch in batches for row in batch.acc], recording.acc[100:])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("t,x,y,z\n0,1,2,3\n1,a,2,3\n", 'Line 3 of bad.csv has "a"'),
        ("t,x,y,z\n0,1,2,3\n1,1,2,3\n", "cannot start at second 60"),
    ],
)
def test_what_cannot_be_played_ends_the_node_with_a_sentence(listener, tmp_path, text, said):
    (tmp_path / "bad.csv").write_text(text)

    node = listener.start("replay", recording=str(tmp_path / "bad.csv"), start_s=60)
    _out, words = node.communicate(timeout=10)

    assert node.returncode == 1
    assert said in words
    assert "Traceback" not in words

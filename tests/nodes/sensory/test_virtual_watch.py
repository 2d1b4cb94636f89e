"""The virtual watch as a process of its own."""

import time
from dataclasses import replace

import numpy as np
import pytest

from nep_core.wire.messages import GESTURE_REQUEST, GestureRequest
from nodes.recordings import write_recording
from nodes.sensory.arm.people import simulate_session

pytestmark = pytest.mark.long


def test_it_sends_small_batches_in_real_time_and_says_that_it_is_simulated(listener):
    listener.start("virtual_watch", rate_hz=50, person=103)
    listener.state("ready", "simulated person 103")

    began_s = time.monotonic()
    batches = listener.batches_for(2.0)
    took_s = time.monotonic() - began_s

    t = [at for batch in batches for at in batch.t]
    assert np.allclose(np.diff(t), 0.02)
    assert took_s - 0.4 < t[-1] - t[0] < took_s + 0.1
    assert max(len(batch.t) for batch in batches) <= 10
    assert all(batch.simulated and batch.gravity_included for batch in batches)
    assert all(len(batch.acc) == len(batch.gyr) == len(batch.t) for batch in batches)
    assert batches[0].source == "simulated person 103"


def test_it_may_live_faster_than_real_time_by_a_clock_of_its_own(listener):
    listener.start("virtual_watch", rate_hz=50, person=103, speed=4)
    listener.state("ready", "4 times as fast as real time")

    began_s = time.monotonic()
    batches = listener.batches_for(2.0)
    took_s = time.monotonic() - began_s

    t = [at for batch in batches for at in batch.t]
    assert np.allclose(np.diff(t), 0.02)
    assert took_s * 2 < t[-1] - t[0] < took_s * 4 + 1
    assert {batch.rate_hz for batch in batches} == {50}


def test_a_gesture_is_made_on_request_and_announced(listener):
    listener.start("virtual_watch", person=103)
    listener.state("ready")
    requests = listener.publisher(GESTURE_REQUEST)

    requests.send(GestureRequest(gesture="karate"))

    listener.state("running", "makes the gesture karate (simulated person 103)")
    begun_s = time.monotonic()
    listener.state("running", "goes on with everyday movement")
    assert 1.2 < time.monotonic() - begun_s < 3


def test_another_person_may_be_asked_for(listener):
    listener.start("virtual_watch", person=103, speed=4)
    listener.state("ready")

    listener.publisher(GESTURE_REQUEST).send(GestureRequest(gesture="hand_up", person=105))

    listener.state("running", "simulated person 105 puts the watch on")
    listener.state("running", "makes the gesture hand_up (simulated person 105)")


def test_an_unknown_gesture_is_told_with_the_known_ones_and_nothing_ends(listener):
    listener.start("virtual_watch")
    listener.state("ready")

    listener.publisher(GESTURE_REQUEST).send(GestureRequest(gesture="wave"))

    warning = listener.state("warning", 'no gesture "wave"')
    [step] = warning.fault.checklist
    assert "karate" in str(step)
    assert listener.imu.receive(2) is not None


def test_a_schedule_is_followed(listener):
    listener.start("virtual_watch", gestures="0 karate")

    listener.state("running", "makes the gesture karate")


def test_it_moves_by_itself_only_when_it_is_to(listener):
    listener.start("virtual_watch", by_itself=True, speed=4)

    listener.state("running", "makes the gesture")


def test_a_wrong_schedule_ends_the_node_with_a_sentence(listener):
    node = listener.start("virtual_watch", gestures="3 wave")

    _out, said = node.communicate(timeout=10)

    assert node.returncode == 1
    assert 'knows no gesture "wave"' in said
    assert "Traceback" not in said


def test_recorded_gestures_are_made_too_and_are_still_called_simulated(listener, tmp_path):
    session = simulate_session(7, ("karate",), 2)
    labels = ["wave" if label else "" for label in session.labels]
    write_recording(tmp_path / "ann.csv", replace(session, labels=labels))
    listener.start("virtual_watch", gestures="0 wave", takes=str(tmp_path), person=103, speed=4)

    listener.state("running", "makes the gesture wave (simulated person 103)")
    listener.publisher(GESTURE_REQUEST).send(GestureRequest(gesture="wave"))
    listener.state("running", "goes on with everyday movement")
    listener.state("running", "makes the gesture wave (simulated person 103)")

    assert listener.imu.receive(2).simulated

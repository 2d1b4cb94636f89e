"""The trainer's desk: the project's gestures as they change, and the sensor that is heard."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import Imu
from nep_studio.blocks.own_gestures import (
    OwnGesture,
    OwnRecording,
    OwnTake,
    keep_gesture,
    keep_recording,
)
from nep_studio.blocks.program import PAGES
from nep_studio.ui.plugins.gestures.gesture_controller import SILENT_S, GestureController
from nep_studio.ui.plugins.gestures.live import (
    KEPT_S,
    LiveStream,
    Samples,
    packed,
    thinned,
    unpacked,
)
from nep_studio.ui.running.runner import Heard

REST = np.tile([0.0, 0.0, 9.81], (100, 1))


def samples(seconds: float = 2.0, rate_hz: float = 50.0) -> Samples:
    t = np.arange(round(seconds * rate_hz)) / rate_hz
    acc = np.stack([np.sin(t), np.cos(t), 9.81 + 0 * t], axis=1)
    return Samples(t, acc, acc / 10)


def recording_of(measured: Samples, **more: object) -> OwnRecording:
    return OwnRecording(
        seconds=measured.seconds,
        rate_hz=measured.rate_hz,
        samples=packed(measured),
        has_rotation=measured.gyr is not None,
        **more,
    )


def test_a_change_is_one_step_that_can_be_undone(desk: GestureController, qtbot: QtBot) -> None:
    gesture = OwnGesture("Karate", takes=(OwnTake("t1", "r1", 0.5, 1.0),))

    with qtbot.waitSignal(desk.changed):
        desk.change(
            "record takes",
            [keep_recording("r1", recording_of(samples())), keep_gesture("karate", gesture)],
        )

    assert list(desk.gestures) == ["karate"]
    assert desk.editor.history.undo_label == "record takes"
    assert len(desk.take_samples(gesture.takes[0])) == 26

    with qtbot.waitSignal(desk.changed):
        desk.editor.history.undo()
    assert not desk.gestures
    assert not desk.recordings


def test_another_project_brings_its_own_gestures_and_person(
    desk: GestureController, qtbot: QtBot
) -> None:
    recording = recording_of(samples(), person="Ana", wrist="left", recorded="2026-01-02T03:04:05")
    desk.change("record", [keep_recording("r1", recording)])

    with qtbot.waitSignal(desk.changed):
        desk.files.new()

    assert not desk.recordings
    assert desk.person == "Me"


def test_a_change_of_blocks_is_no_change_here(desk: GestureController, qtbot: QtBot) -> None:
    with qtbot.assertNotEmitted(desk.changed, wait=120):
        desk.editor.create("event.started", desk.editor.new_stack(PAGES[0], 0, 0))


def test_the_desk_hears_the_last_half_minute(desk: GestureController, push) -> None:
    for _ in range(20):
        push(REST)

    live = desk.live
    assert live is not None
    assert live.last().seconds == pytest.approx(KEPT_S, abs=0.1)
    assert live.rate_hz == pytest.approx(50, rel=0.01)
    assert not live.has_rotation


def test_another_sensor_takes_over_only_when_the_first_is_silent(
    desk: GestureController, push, clock
) -> None:
    push(REST, source="watch")

    push(REST[:5], source="phone")
    assert desk.live.source == "watch"

    clock.time_s += SILENT_S + 1
    push(REST[:5], source="phone", wrist="hand")
    assert desk.live.source == "phone"
    assert desk.wrist == "hand"


def test_hostile_samples_leave_a_stream_that_rises() -> None:
    stream = LiveStream("watch")
    batches = [
        Imu(source="w", rate_hz=50, t=[0, 0.02, 0.02, 0.01], acc=[(1, 1, 1)] * 4),
        Imu(source="w", rate_hz=50, t=[0.04, float("nan"), 0.06], acc=[(1, 1, 1)] * 3),
        Imu(source="w", rate_hz=50, t=[0.08, 0.1], acc=[(float("inf"), 1, 1), (1, 1, 1)]),
        Imu(source="w", rate_hz=50, t=[0.12], acc=[]),
        Imu(source="w", rate_hz=0, t=[-500.0, -499.98], acc=[(1, 1, 1)] * 2),
        Imu(source="w", rate_hz=1e9, t=[], acc=[]),
    ]

    for number, batch in enumerate(batches):
        stream.hear(batch, 10.0 + number)

    kept = stream.last()
    assert len(kept) == 7
    assert (np.diff(kept.t) > 0).all()
    assert np.isfinite(kept.acc).all()


def test_a_flood_takes_no_more_memory_and_is_thinned_when_it_is_kept() -> None:
    stream = LiveStream("watch")
    flood = Imu(
        source="w", rate_hz=10_000, t=(np.arange(50_000) / 1e4).tolist(), acc=[(1, 2, 3)] * 50_000
    )

    stream.hear(flood, 1.0)

    assert len(stream.last()) == 30_000
    assert thinned(stream.last()).rate_hz == pytest.approx(200)


def test_what_is_packed_is_read_back(desk: GestureController) -> None:
    measured = samples()

    back = unpacked(recording_of(measured))

    assert np.allclose(back.t, measured.t, atol=1e-6)
    assert np.allclose(back.acc, measured.acc, atol=1e-5)
    assert np.allclose(back.gyr, measured.gyr, atol=1e-6)


def test_two_nodes_with_one_message_are_two_sensors_only_by_their_source(
    desk: GestureController,
) -> None:
    message = Imu(source="", rate_hz=50, t=[0.0, 0.02], acc=[(0, 0, 9.8)] * 2)

    desk.hear([Heard(0.0, message, "one"), Heard(0.0, message, "other")])

    assert list(desk.streams) == ["one", "other"]


def test_a_hand_that_is_changed_on_the_phone_is_changed_here(desk: GestureController) -> None:
    def hear(t: float, wrist: str) -> None:
        acc = [(0.0, 0.0, 9.81)]
        message = Imu(source="phone", rate_hz=50.0, t=[t], acc=acc, wrist=wrist)
        desk.hear([Heard(0.0, message, "watch")])

    hear(0.0, "left")
    assert desk.wrist == "left"

    hear(0.02, "hand")

    assert desk.wrist == "hand"

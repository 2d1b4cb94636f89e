"""Recording without hands: counted, found by itself, ended by itself, and kept as one step."""

from __future__ import annotations

from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.gestures.gesture_controller import SILENT_S, GestureController
from nep_studio.ui.plugins.gestures.project_gestures import Keeping
from nep_studio.ui.plugins.gestures.recording import (
    COUNT_MS,
    RecordingSession,
    TakeSession,
    session_words,
)
from tests.ui.trainer.trainer_data import joined, real, rest, stroke, takes


@pytest.fixture
def keeping(desk: GestureController) -> Keeping:
    return Keeping(desk)


@pytest.fixture
def session(desk: GestureController) -> TakeSession:
    return TakeSession(desk, desk)


@pytest.fixture
def ended(session: TakeSession, keeping: Keeping) -> list[RecordingSession]:
    """The sessions that ended; each is kept as the page keeps it."""
    found: list[RecordingSession] = []

    def keep(one: RecordingSession) -> None:
        found.append(one)
        if one.takes:
            keeping.keep_session(one.gesture, one.samples, one.takes, one.forgotten)

    session.ended.connect(keep)
    return found


def begin(session: TakeSession, keeping: Keeping, push, wanted: int = 5) -> str:
    """A gesture whose recording has passed its countdown."""
    name = keeping.new_gesture("Wave")
    push(*rest(2.0))
    assert session.start(name, wanted)
    session.skip_countdown()
    return name


def test_five_takes_in_a_row_are_found_counted_and_kept_as_one_step(
    session: TakeSession,
    keeping: Keeping,
    ended: list[RecordingSession],
    push,
    desk: GestureController,
) -> None:
    name = begin(session, keeping, push)
    counts: list[int] = []
    session.movement_found.connect(lambda _one: counts.append(session.taken))

    push(*takes(7))

    assert counts == [1, 2, 3, 4, 5]
    assert not session.is_on
    assert ended[0].ending == "complete"
    assert len(desk.gestures[name].takes) == 5
    recording = desk.recordings[desk.gestures[name].takes[0].recording]
    assert recording.has_rotation
    assert recording.person == "Me"
    assert all(0.5 < t.end_s - t.start_s < 1.2 for t in desk.gestures[name].takes)
    assert session_words(ended[0]) == "5 takes are kept."
    desk.editor.history.undo()
    desk.refresh()
    assert not desk.recordings
    assert not desk.gestures[name].takes


def test_the_countdown_goes_from_three_and_can_be_called_off(
    session: TakeSession, keeping: Keeping, push, qtbot: QtBot, ended: list[RecordingSession]
) -> None:
    name = keeping.new_gesture("Wave")
    push(*rest(1.0))
    session._counting.setInterval(1)
    counts = [3]
    session.changed.connect(lambda: counts.append(session.count))

    session.start(name)
    qtbot.waitUntil(lambda: session.state == "takes")

    assert counts == [3, 3, 2, 1, 0]
    assert COUNT_MS > 500
    session.stop()
    session._counting.setInterval(60_000)
    session.start(name)
    session.stop()
    assert session.state == "idle"
    assert len(ended) == 1


def test_without_a_sensor_nothing_is_recorded(session: TakeSession, keeping: Keeping) -> None:
    assert not session.start(keeping.new_gesture("Wave"))
    assert not session.start_everyday(30)


def test_a_weak_take_is_shown_with_its_reason_and_does_not_count(
    session: TakeSession,
    keeping: Keeping,
    ended: list[RecordingSession],
    push,
    desk: GestureController,
) -> None:
    name = begin(session, keeping, push, wanted=4)

    push(*joined(takes(3), stroke(strength=2.4), takes(1)))

    assert [one.fault for one in ended[0].movements] == ["", "", "", "still", ""]
    assert len(desk.gestures[name].takes) == 4
    recording = next(iter(desk.recordings.values()))
    assert len(recording.forgotten) == 1
    assert "1 movement does not count: too still." in session_words(ended[0])


def test_a_person_stops_and_what_is_there_is_kept_without_reaching_for_the_key(
    session: TakeSession,
    keeping: Keeping,
    ended: list[RecordingSession],
    push,
    desk: GestureController,
) -> None:
    name = begin(session, keeping, push)

    push(*joined(takes(2), stroke()))
    session.stop()

    assert ended[0].ending == "stopped"
    assert len(desk.gestures[name].takes) == 2


def test_nothing_is_lost_when_the_watch_falls_silent(
    session: TakeSession,
    keeping: Keeping,
    ended: list[RecordingSession],
    push,
    clock,
    qtbot: QtBot,
    desk: GestureController,
) -> None:
    name = begin(session, keeping, push)
    push(*takes(3))

    clock.time_s += SILENT_S + 1
    qtbot.waitUntil(lambda: bool(ended))

    assert ended[0].ending == "lost"
    assert len(desk.gestures[name].takes) == 3
    assert session_words(ended[0]).startswith("The watch or phone fell silent")


def test_a_recording_without_takes_leaves_nothing_and_says_what_to_do(
    session: TakeSession,
    keeping: Keeping,
    ended: list[RecordingSession],
    push,
    desk: GestureController,
) -> None:
    begin(session, keeping, push)

    push(*rest(3.0))
    session.stop()

    assert not desk.recordings
    assert session_words(ended[0]).startswith("No take was found.")


def test_who_begins_a_moment_early_is_recorded_whole(
    session: TakeSession,
    keeping: Keeping,
    ended: list[RecordingSession],
    push,
    desk: GestureController,
) -> None:
    name = keeping.new_gesture("Wave")
    push(*rest(2.0))
    session.start(name, 1)
    push(*[part[:10] for part in stroke()])
    session.skip_countdown()

    push(*joined(tuple(part[10:] for part in stroke()), rest(2.0)))

    assert len(desk.gestures[name].takes) == 1
    take = desk.gestures[name].takes[0]
    assert take.end_s - take.start_s == pytest.approx(0.9, abs=0.3)


@pytest.mark.parametrize("name", ["j_turn_left", "l_bounce_up", "na_forward"])
def test_real_people_record_five_takes_in_a_row(
    name: str,
    shared_data: Path,
    session: TakeSession,
    keeping: Keeping,
    push,
    desk: GestureController,
    ended: list[RecordingSession],
) -> None:
    acc, gyr, rate_hz = real(shared_data, name)
    gesture = keeping.new_gesture("Mine")
    push(acc[:30], gyr[:30], rate_hz=rate_hz, gravity_included=False)
    session.start(gesture)
    session.skip_countdown()

    push(acc[30:], gyr[30:], rate_hz=rate_hz, gravity_included=False)

    assert ended[0].ending == "complete"
    assert len(desk.gestures[gesture].takes) == 5
    assert not next(iter(desk.recordings.values())).gravity_included


def test_everyday_movement_ends_by_itself_and_is_kept(
    session: TakeSession, keeping: Keeping, push, desk: GestureController
) -> None:
    push(*rest(1.0))
    session.everyday_ended.connect(keeping.keep_everyday)
    session.start_everyday(5.0)
    session.skip_countdown()

    push(*rest(2.5))
    assert session.share == pytest.approx(0.5, abs=0.05)
    push(*rest(3.0))

    assert session.state == "idle"
    recording = next(iter(desk.recordings.values()))
    assert recording.everyday
    assert recording.seconds == pytest.approx(5.0, abs=0.2)
    keeping.delete_recording(next(iter(desk.recordings)))
    assert not desk.recordings


def test_a_cancelled_recording_keeps_nothing(
    session: TakeSession,
    keeping: Keeping,
    push,
    desk: GestureController,
    ended: list[RecordingSession],
) -> None:
    begin(session, keeping, push)
    push(*takes(2))

    session.cancel()

    assert not desk.recordings
    assert not ended

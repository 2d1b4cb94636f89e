"""What the trainer changes in the project: each change is one step, named, and can be undone."""

from __future__ import annotations

import numpy as np
import pytest

from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.live import Samples
from nep_studio.ui.plugins.gestures.project_gestures import Keeping
from nep_studio.ui.plugins.gestures.samples import Badges
from tests.ui.trainer.test_gesture_controller import samples
from tests.ui.trainer.trainer_data import stroke


@pytest.fixture
def keeping(desk: GestureController) -> Keeping:
    return Keeping(desk)


def keep(keeping: Keeping, name: str, *spans: tuple[float, float]) -> list[str]:
    """Takes of a gesture in one recording of eight seconds."""
    return keeping.keep_session(name, samples(8.0), spans)


def undone(desk: GestureController) -> str:
    """Take the last step back; gives its name."""
    label = desk.editor.history.undo_label
    desk.editor.history.undo()
    desk.refresh()
    return label


def test_a_gesture_is_made_renamed_and_deleted(desk: GestureController, keeping: Keeping) -> None:
    name = keeping.new_gesture(" Karate ")
    again = keeping.new_gesture("Karate")
    keeping.rename_gesture(name, "Blow")

    assert (name, again) == ("karate", "karate_2")
    assert [one.title for one in desk.gestures.values()] == ["Blow", "Karate"]
    assert desk.editor.language.choices["gestures"]["karate"] == "Blow"

    keep(keeping, name, (1, 2))
    keeping.delete_gesture(name)
    assert list(desk.gestures) == ["karate_2"]
    assert not desk.recordings
    assert undone(desk) == "delete a gesture"
    assert len(desk.gestures[name].takes) == 1
    assert len(desk.recordings) == 1


def test_a_deleted_take_is_forgotten_not_learned_as_nothing(
    desk: GestureController, keeping: Keeping
) -> None:
    name = keeping.new_gesture("Wave")
    first, second = keep(keeping, name, (1, 2), (4, 5))

    keeping.delete_takes([first])

    recording = next(iter(desk.recordings.values()))
    assert recording.forgotten == ((1.0, 2.0),)
    keeping.delete_takes([second])
    assert not desk.recordings
    assert undone(desk) == "delete a take"
    assert undone(desk) == "delete a take"
    assert [take.id for take in desk.gestures[name].takes] == [first, second]
    assert not next(iter(desk.recordings.values())).forgotten


def test_a_take_is_given_to_another_gesture(desk: GestureController, keeping: Keeping) -> None:
    wave, blow = keeping.new_gesture("Wave"), keeping.new_gesture("Blow")
    ids = keep(keeping, wave, (1, 2), (4, 5))

    keeping.relabel_takes(ids[:1], blow)
    keeping.relabel_takes(ids[:1], blow)
    keeping.relabel_takes(ids[:1], "gone")

    assert [take.id for take in desk.gestures[blow].takes] == ids[:1]
    assert [take.id for take in desk.gestures[wave].takes] == ids[1:]
    assert undone(desk) == "give a take to another gesture"
    assert len(desk.gestures[wave].takes) == 2


def test_a_take_is_left_out_trimmed_and_both_can_be_undone(
    desk: GestureController, keeping: Keeping
) -> None:
    name = keeping.new_gesture("Wave")
    (take,) = keep(keeping, name, (1, 2))

    keeping.leave_out([take], True)
    keeping.trim_take(take, -3, 1.5)
    keeping.trim_take(take, 1.45, 1.5)

    kept = desk.gestures[name].takes[0]
    assert kept.left_out
    assert (kept.start_s, kept.end_s) == (0, 1.5)
    assert undone(desk) == "change where a take begins and ends"
    assert undone(desk) == "leave out a take"


def test_a_take_is_never_trimmed_into_the_one_beside_it(
    desk: GestureController, keeping: Keeping
) -> None:
    name = keeping.new_gesture("Wave")
    first, second, third = keep(keeping, name, (1, 2), (3, 4), (5, 6))

    keeping.trim_take(second, 0.0, 8.0)

    takes = {take.id: take for take in desk.gestures[name].takes}
    assert takes[first].end_s < takes[second].start_s < takes[second].end_s
    assert takes[second].end_s < takes[third].start_s
    keeping.trim_take(third, 5.9, 6.0)
    assert desk.find_take(third)[1] == takes[third]


def test_people_are_renamed_and_deleted_with_what_they_recorded(
    desk: GestureController, keeping: Keeping
) -> None:
    name = keeping.new_gesture("Wave")
    desk.set_wearer("Ana", "left")
    keep(keeping, name, (1, 2))
    desk.set_wearer("Bo")
    keep(keeping, name, (1, 2), (3, 4))

    assert desk.people == ["Ana", "Bo"]
    keeping.rename_person("Bo", "Bob")
    assert desk.people == ["Ana", "Bob"]
    assert desk.person == "Bob"
    keeping.delete_person("Bob")
    assert desk.people == ["Ana"]
    assert len(desk.gestures[name].takes) == 1
    assert undone(desk) == "delete a person"
    assert len(desk.gestures[name].takes) == 3
    assert {one.wrist for one in desk.recordings.values()} == {"left"}


def test_remarkable_takes_have_a_badge(desk: GestureController, keeping: Keeping) -> None:
    name = keeping.new_gesture("Wave")
    usual, weak = stroke(0.8), stroke(0.8, strength=1.0)
    parts = [*[usual] * 4, weak]
    measured = Samples(
        samples(4.0).t[: 5 * len(usual[0])],
        *map(np.concatenate, zip(*parts, strict=True)),
    )
    spans = [(0.0, 0.78), (0.8, 1.58), (1.6, 1.8), (2.4, 3.18), (3.2, 3.98)]

    ids = keeping.keep_session(name, measured, spans)

    badges = Badges(desk).all()
    assert badges == {ids[2]: "too short", ids[4]: "too still"}

"""What a report means in plain words, the most helpful first."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.plugins.gestures.results.advice import Known, advice_on, false_triggers, headline
from nep_studio.ui.plugins.gestures.results.findings import (
    Findings,
    LeftOut,
    Point,
    between,
    findings_of,
    id_of_take,
)
from nep_studio.ui.plugins.gestures.results.threshold import both_sides
from tests.ui.trainer.results_material import report, takes_of

NAMES = {"karate": "Karate", "katana": "Katana"}
TEN = {"karate": 10, "katana": 10}


def known(takes: int = 10, everyday_s: float = 600.0, **people: object) -> Known:
    gestures = {
        name: OwnGesture(title, takes=takes_of(name, takes)) for name, title in NAMES.items()
    }
    return Known(gestures, ["Ann Lee", "Ben"], everyday_s)


def findings(*confusion: tuple[str, str, int], **more: object) -> Findings:
    takes = more.pop("takes", TEN)
    return findings_of({"trees": report(list(confusion), takes, **more)})["trees"]


def words(found: Findings, project: Known | None = None) -> list[str]:
    return [one.words for one in advice_on(found, project or known())]


def test_a_gesture_mistaken_for_another_is_told_with_what_to_do() -> None:
    found = findings(
        ("karate", "karate", 8),
        ("karate", "katana", 2),
        ("katana", "katana", 10),
        left_out=[("karate", 3, 0.5, "katana"), ("karate", 7, 0.5, "katana")],
    )

    [first, *_] = advice_on(found, known())

    assert first.words == "“Karate” is mistaken for “Katana” 2 times in 10: record 3 more, larger."
    assert (first.kind, first.what, first.gesture) == ("problem", "record", "karate")
    assert first.takes == ("karate_3", "karate_7")
    assert headline(found) == "18 of 20 takes were recognised by what the others taught"


def test_gestures_taken_for_each_other_are_told_once() -> None:
    found = findings(
        ("karate", "karate", 7),
        ("karate", "katana", 3),
        ("katana", "katana", 8),
        ("katana", "karate", 2),
    )

    said = words(found)

    assert "“Karate” and “Katana” are taken for each other 5 times in 20" in said[0]
    assert not any("mistaken" in one for one in said)


def test_a_missed_gesture_is_told() -> None:
    found = findings(("karate", "karate", 7), ("karate", "", 3), ("katana", "katana", 10))

    assert words(found)[0].startswith("“Karate” is missed 3 times in 10: record 3 more")


def test_once_is_said_as_once() -> None:
    five = {"karate": 5, "katana": 5}
    found = findings(
        ("karate", "karate", 4), ("karate", "katana", 1), ("katana", "katana", 5), takes=five
    )

    assert "“Karate” is mistaken for “Katana” once in 5: record 3 more, larger." in words(found)


def test_false_triggers_are_told_with_the_point_that_is_set() -> None:
    right = [("karate", "karate", 10), ("katana", "katana", 10)]
    found = findings(*right, rate=20.0)
    strict = known()
    gestures = {name: OwnGesture(title, certainty=0.9) for name, title in NAMES.items()}

    assert "Everyday movement is taken for “Karate” about 3 times an hour" in words(found)[0]
    assert not any("an hour" in one for one in words(found, Known(gestures, (), 600.0)))
    assert strict.title("karate") == "Karate"


def test_a_take_that_is_not_like_the_others_is_named() -> None:
    found = findings(
        ("karate", "karate", 9),
        ("karate", "katana", 1),
        ("katana", "katana", 10),
        left_out=[("karate", 4, 0.3, "katana"), ("katana", 2, 0.2, "katana")],
    )

    said = words(found)

    assert "Take 5 of “Karate” looks like “Katana”: is it in the right place?" in said
    assert any(one.startswith("Take 3 of “Katana” is not like the others") for one in said)


def test_takes_that_are_gone_are_not_named() -> None:
    left_out = LeftOut("karate", "r1", 3.0, 0.1, "katana")
    gestures = {"karate": OwnGesture("Karate", takes=takes_of("karate", 1))}

    assert id_of_take(left_out, gestures) == ""
    assert id_of_take(LeftOut("karate", "r1", 0.1, 0.1, ""), gestures) == "karate_0"
    assert id_of_take(LeftOut("jump", "r1", 0.1, 0.1, ""), gestures) == ""


def test_the_person_whose_gestures_are_not_found_is_named_as_written() -> None:
    right = [("karate", "karate", 10), ("katana", "katana", 10)]
    found = findings(*right, people={"Ann_Lee": (10, 3), "Ben": (10, 9)})

    said = words(found)

    assert said[0] == (
        "The gestures of Ben are recognised, those of Ann Lee are not: record more with Ann Lee."
    )


def test_when_all_is_well_it_says_so() -> None:
    found = findings(("karate", "karate", 10), ("katana", "katana", 10))

    [only] = advice_on(found, known())

    assert (only.kind, only.what) == ("good", "try")
    assert only.words == "All 2 gestures are told apart well. Try them out."


def test_few_takes_one_gesture_and_no_everyday_movement_are_tips() -> None:
    found = findings(("karate", "karate", 4), takes={"karate": 4})

    said = words(found, known(everyday_s=0.0))

    assert said[0] == "The gesture is recognised well. Try it out."
    assert "Record “Karate” once more: 5 takes are recognised better." in said
    assert "Nothing could be mistaken for “Karate” yet: add a second gesture." in said
    assert any("a minute of everyday movement" in one for one in said)


def test_a_single_take_cannot_be_checked() -> None:
    found = findings(takes={"karate": 1, "katana": 5})

    [only] = advice_on(found, known())

    assert "“Karate” was recorded once. Record it 4 more times" in only.words
    assert headline(found) == "Learned, but not checked yet"


@pytest.mark.parametrize(
    "damaged", [{"trees": None}, {"trees": {"takes": 3}}, {"remarks": []}, {}, {"trees": {}}]
)
def test_a_report_that_cannot_be_read_is_left_out(damaged: dict) -> None:
    assert findings_of(damaged) == {}


POINTS = tuple(Point(c / 20, 1 - c / 20, 20.0 - c, c) for c in range(1, 20))


@given(st.floats(0.0, 1.0))
def test_between_two_points_the_curve_lies_between_them(certainty: float) -> None:
    found = between(POINTS, certainty)

    assert 0.05 - 1e-9 <= found.caught <= 0.95 + 1e-9
    assert abs(found.caught - (1 - min(max(certainty, 0.05), 0.95))) < 1e-6


def test_both_sides_of_a_point_are_one_sentence() -> None:
    found = findings(("karate", "karate", 10), rate=6.0)

    assert both_sides(found, "karate", 0.75) == "Caught 5 of 10 — false about 0.9 times an hour"
    assert both_sides(found, "karate", 0.5).startswith("Caught 10 of 10 — false about 2.4 times")
    assert both_sides(found, "karate", 0.5).endswith("once at another gesture")
    assert "no false one in 10 minutes" in both_sides(found, "karate", 0.95)
    assert both_sides(found, "jump", 0.5) == ""


def test_without_everyday_movement_false_triggers_are_not_known() -> None:
    found = findings(("karate", "karate", 10), everyday_s=0.0)

    assert "not known yet" in both_sides(found, "karate", 0.75)


def test_false_triggers_are_told_an_hour_and_simulated_people_are_called_so() -> None:
    found = findings(("karate", "karate", 10), everyday_s=600.0)
    none = findings(("karate", "karate", 10), everyday_s=0.0)

    said = false_triggers(found, is_simulated=False)

    assert said == "About 6 false triggers an hour, in 10 min of everyday movement"
    assert false_triggers(found, is_simulated=True).endswith("of simulated people")
    assert false_triggers(none, is_simulated=True) == ""

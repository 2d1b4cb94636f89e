from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nao_stage import ANIMATIONS, BODY, Stage

from robots.body import actor
from robots.body.actor import FINAL, REMEMBERED_REQUESTS
from robots.body.driver import ActionRequest

pytestmark = pytest.mark.long


def test_a_request_is_accepted_started_and_done() -> None:
    stage = Stage()

    stage.do("look", yaw_deg=45, pitch_deg=10)

    assert stage.told == ["0 accepted", "0 started", "0 done"]
    assert np.degrees(stage.robot.angles[:2]) == pytest.approx([45, 10])


def test_looking_too_far_goes_as_far_as_the_head_goes_and_says_so() -> None:
    stage = Stage()

    result = stage.do("look", yaw_deg=90, pitch_deg=30)

    assert result.state == "done"
    assert "90 degrees to the left, 12 down" in result.description


@pytest.mark.parametrize(
    ("start", "goal"),  # test_nao_ways_between_postures.py goes between all others
    [
        *((start, "Rest") for start in ("Stand", "Sit", "LyingBack", "LyingBelly")),
        *((start, start) for start in ("Stand", "LyingBelly")),
    ],
)
def test_it_goes_to_rest_or_stays_as_it_is_in_a_believable_time(start: str, goal: str) -> None:
    stage = Stage(start)

    stage.ask("1", "do", posture=f"posture_{goal}")
    seconds = stage.finish()

    assert stage.robot.posture == goal
    assert stage.robot.angles == pytest.approx(BODY.posture_angles(goal), abs=1e-3)
    assert seconds < 16 and (start == goal or seconds > 0.5)
    assert (stage.relative_speeds <= 0.3).all()


def test_the_paper_story_plays_one_after_the_other() -> None:
    stage = Stage()
    stage.ask("a", "say", text="Impressive!", gesture="no_gesture")
    stage.finish()
    stage.ask("b", "do", posture="posture_stand")
    stage.ask("c", "imitate", animal="cat")
    stage.ask("d", "play", animation="karate")
    stage.finish()

    assert [t for t in stage.told if "accepted" not in t] == [
        "a started", "a done", "b started", "b done", "c started", "c done", "d started", "d done",
    ]  # fmt: skip


def test_an_animation_for_standing_gets_the_robot_up_first() -> None:
    stage = Stage("Sit")

    assert stage.do("play", animation="karate").state == "done"
    assert stage.robot.posture == "StandInit"


def test_a_wave_while_sitting_leaves_it_sitting() -> None:
    stage = Stage("Sit")
    legs = BODY.posture_angles("Sit")[8:20]

    stage.do("play", animation="wave")

    assert stage.robot.posture == "Sit"
    assert all((row[8:20] == legs).all() for row in stage.angles)
    assert stage.robot.angles == pytest.approx(BODY.posture_angles("Sit"), abs=1e-3)


def test_speaking_walking_and_looking_go_together() -> None:
    stage = Stage()
    stage.ask("say", "say", text="I walk and look and talk.")
    stage.ask("walk", "walk", forward_m=0.1)
    stage.ask("look", "look", yaw_deg=30)

    stage.pass_time(0.02)

    assert {t for t in stage.told if "started" in t} == {
        "say started",
        "walk started",
        "look started",
    }


def test_a_wave_waits_for_the_arm_that_speaks_with_gestures() -> None:
    stage = Stage()
    stage.ask("say", "say", text="Hello there, how are you today?", gesture="explain")
    stage.ask("wave", "play", animation="wave")

    stage.finish()

    assert stage.told.index("say done") < stage.told.index("wave started")


def test_a_mirrored_wave_uses_the_left_arm() -> None:
    stage = Stage()
    right = [i for i, joint in enumerate(BODY.joints) if joint.limb == "right_arm"]

    stage.ask("1", "play", animation="wave", mirror=True)
    stage.finish()

    assert all((row[right] == stage.angles[0][right]).all() for row in stage.angles)
    highest = min(row[BODY.index["LShoulderPitch"]] for row in stage.angles)
    assert highest == pytest.approx(-1.15, abs=0.01)


def test_stretch_makes_it_longer_and_reverse_ends_where_it_began() -> None:
    plain, long = Stage(), Stage()
    plain.ask("1", "play", animation="nod")
    long.ask("1", "play", animation="nod", stretch=3.0)

    assert long.finish() > 2.5 * plain.finish()
    assert Stage().do("play", animation="bow", reverse=True).state == "done"


def test_a_request_that_comes_again_is_answered_and_not_played_again() -> None:
    stage = Stage()
    stage.ask("1", "turn", degrees=45)
    stage.pass_time(0.5)
    stage.ask("1", "turn", degrees=45)
    stage.finish()
    stage.ask("1", "turn", degrees=45)
    stage.finish()

    assert stage.told == ["1 accepted", "1 started", "1 started", "1 done", "1 done"]
    assert stage.robot.base[2] == pytest.approx(math.radians(45))


def test_a_robot_that_is_far_behind_can_be_asked_again_after_a_second_of_its_life() -> None:
    stage = Stage()
    stage.ask("1", "walk", forward_m=2.0)
    stage.pass_time(1.0)
    start_m = stage.robot.base[0]

    stage.results += stage.actor.step(stage.now_s + 1000.0)

    assert 0.0 < stage.robot.base[0] - start_m < 0.1  # m: of the 20 that the walk lasts
    stage.ask("1", "walk", forward_m=2.0)
    assert stage.told == ["1 accepted", "1 started", "1 started"]


def test_it_remembers_some_hundred_requests_and_never_forgets_one_that_runs() -> None:
    stage = Stage()
    stage.ask("long", "say", text="words " * 500)
    stage.pass_time(0.01)
    stage.ask("", "fly")  # an id as poor as a stranger's node may send
    for number in range(2 * REMEMBERED_REQUESTS):
        stage.ask(str(number), "fly")

    stage.ask("long", "say", text="words " * 500)
    stage.ask(str(2 * REMEMBERED_REQUESTS - 1), "fly")

    assert stage.told[-2:] == ["long started", "999 failed"]
    assert len(stage.actor._over) == REMEMBERED_REQUESTS


def test_only_so_many_requests_wait_and_who_asks_for_more_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(actor, "MOST_WAITING", 20)
    stage = Stage()
    for number in range(21):  # the first is under way
        stage.actor.request(look(str(number)))
        if not number:
            stage.actor.step(0.0)

    [refused] = stage.actor.request(look("one more"))
    [stopped, *_] = stage.actor.request(
        ActionRequest(id="end", robots=["NAO"], action="stop", args={"request": "7"})
    )
    [asked] = stage.actor.request(look("in its place"))

    assert refused.state == "failed" and refused.description.startswith("20 requests wait")
    assert (stopped.state, asked.state) == ("cancelled", "accepted")


def look(request_id: str) -> ActionRequest:
    return ActionRequest(id=request_id, robots=["NAO"], action="look")


def test_stop_cancels_everything_at_once_and_the_robot_comes_to_rest_smoothly() -> None:
    stage = Stage()
    stage.ask("dance", "play", animation="dance")
    stage.ask("say", "say", text="La la la, la la la, la la la, and so on and on and on it goes")
    stage.ask("later", "play", animation="bow")
    stage.pass_time(3.0)

    stage.ask("stop", "stop")
    told = stage.told[-4:]
    stage.finish()

    assert sorted(told[:3]) == ["dance cancelled", "later cancelled", "say cancelled"]
    assert told[3] == "stop done"
    assert stage.robot.saying == ""
    assert (stage.relative_speeds <= 1.001).all()
    jerks = np.abs(np.diff(stage.relative_speeds[-150:], axis=0))
    assert jerks.max() < 0.1
    assert not stage.driver.moving


def test_after_a_stop_in_the_middle_of_a_step_it_stands_on_both_feet() -> None:
    stage = Stage()
    stage.ask("walk", "walk", forward_m=1.0)
    stage.pass_time(4.0)
    stage.ask("stop", "stop")
    x = stage.robot.base[0]

    stage.finish()

    legs = BODY.columns(["legs"])
    assert stage.robot.angles[legs] == pytest.approx(BODY.posture_angles("StandInit")[legs])
    assert x < stage.robot.base[0] < x + 0.02


def test_stopping_one_request_leaves_the_others_alone() -> None:
    stage = Stage()
    stage.ask("wave", "play", animation="wave")
    stage.ask("walk", "walk", forward_m=0.2)
    stage.ask("after", "play", animation="hand_up")
    stage.pass_time(1.0)

    stage.ask("stop", "stop", request="wave")
    stage.finish()

    assert "wave cancelled" in stage.told
    assert {"walk done", "after done"} <= set(stage.told)
    assert stage.robot.base[0] == pytest.approx(0.2)
    assert (stage.relative_speeds <= 1.001).all()


def test_stopping_when_nothing_is_done_is_done() -> None:
    assert Stage().do("stop").state == "done"


@pytest.mark.parametrize(
    ("action", "args", "words"),
    [
        ("fly", {}, 'no action "fly". Possible actions: say, do, imitate, play'),
        ("say", {}, 'there is no text. It takes text, gesture (may be left out)'),
        ("say", {"text": 5}, "text should be text, not a whole number. It takes"),
        ("say", {"text": "x" * 6000}, "text should be text of length at most 5000"),
        ("turn", {"degrees": "left"}, "degrees should be a number, not text"),
        ("turn", {"degrees": math.nan}, "degrees should be a number"),
        ("turn", {"degrees": math.inf}, "degrees should be a number at most 3600"),
        ("walk", {"forward_m": 1e9}, "forward_m should be a number at most 20"),
        ("play", {"animation": "jump"}, 'no animation "jump". Possible: '),
        ("play", {"animation": "nod", "stretch": 0}, "stretch should be a number at least 0.1"),
        ("imitate", {"animal": "wave"}, 'no animal "wave". Possible: cat, '),
        ("do", {"posture": "posture_fly"}, "posture_lying_belly"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_fails_with_a_sentence_about_what_can(
    action: str, args: dict[str, Any], words: str
) -> None:
    result = Stage().do(action, **args)

    assert result.state == "failed"
    assert words in result.description


def test_it_hears_its_name_and_all() -> None:
    actor = Stage().actor

    def is_asked(*robots: str) -> bool:
        return actor.is_asked(ActionRequest(id="1", robots=list(robots), action="stop"))

    assert [is_asked("NAO2"), is_asked("NAO2", "NAO"), is_asked("all"), is_asked()] == [
        False, True, True, True,
    ]  # fmt: skip


def asked(action: str, **args: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.tuples(st.just(action), st.fixed_dictionaries(args))


short_m, choose = st.floats(-0.1, 0.1), st.sampled_from
actions = st.one_of(
    asked("say", text=st.text(max_size=20), gesture=choose(["no_gesture", "greet", "sad"])),
    asked(
        "play",
        animation=choose(ANIMATIONS.names()),
        mirror=st.booleans(),
        reverse=st.booleans(),
        stretch=st.floats(0.1, 2),
    ),
    asked("do", posture=choose(sorted(BODY.postures))),
    asked("walk", forward_m=short_m, left_m=short_m),
    asked("turn", degrees=st.floats(-30, 30)),
    asked("look", yaw_deg=st.floats(-120, 120), pitch_deg=st.floats(-40, 40)),
    asked("leds", group=st.just("AllLeds"), colour=st.just("#123456")),
    asked("stop", request=choose(["", "", "1"])),
)


@given(st.lists(st.tuples(actions, st.floats(0, 1.5), st.integers(0, 1)), max_size=6))
@settings(max_examples=25, deadline=None)
def test_whatever_is_asked_ends_once_and_the_body_stays_within_its_limits(plan: list) -> None:
    stage = Stage()
    for number, ((action, args), pause_s, priority) in enumerate(plan):
        stage.ask(str(number), action, priority, **args)
        stage.pass_time(pause_s)
    stage.finish()

    ends = Counter(result.id for result in stage.results if result.state in FINAL)
    assert ends == Counter(str(number) for number in range(len(plan)))
    assert (stage.relative_speeds <= 1.001).all()
    assert BODY.clamped(np.array(stage.angles))[1] == []
    assert not stage.actor.schedule.running

"""The Python that blocks about robots and goals make, and what is told before it runs."""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import pytest
from block_building import B, build
from sound_programs import kinds, only, sound

from nep_studio.blocks.checks import check
from nep_studio.blocks.edits.project import AddPage
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language


def body(language: Language, *stack: B) -> str:
    """The Python of one rule, without what stands around it."""
    text = generate_program(build(language, list(stack), variables=("x",)).project, language).text
    return text.partition('behavior = Behavior("Test")\n')[2].strip().removesuffix("behavior.run()")


@pytest.mark.parametrize(
    ("block", "line"),
    [
        (B("robot_moves.open_hand"), 'nao.open_hand("left")'),
        (B("robot_moves.move_joint"), 'nao.move_joint("HeadYaw", 30)'),
        (B("robot_moves.play_changed", {"mirror": True}), 'nao.play("wave", mirror=True)'),
        (B("robot_moves.start_walking"), "nao.start_walking(50, 0, 0)"),
        (B("robot_moves.walk_to"), "nao.walk(0.3, 0, turn_deg=90)"),
        (B("robot_moves.awareness"), "nao.awareness(True)"),
        (B("robot_moves.look_at"), "nao.look_at(1, 0, 0.5)"),
        (B("robot_speech.say_with_voice", {"speed": 80}), 'nao.say("Hello", speed=80)'),
        (B("robot_speech.wait_for_word", groups={"more": 1}),
         'nao.wait_for_word("yes", "no", seconds=10)'),
        (B("robot_lights.brightness"), 'nao.leds_brightness("EarLeds", 50)'),
        (B("sensing.remember"), 'remember("touched_head", 30)'),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)  # fmt: skip
def test_a_block_makes_the_call_that_a_teacher_would_show(
    language: Language, block: B, line: str
) -> None:
    assert body(language, B("event.started"), block).strip().splitlines()[-1] == f"    {line}"


def test_a_question_has_branches_for_its_answers(language: Language) -> None:
    ask = B(
        "robot_speech.ask",
        {"word.2": "no"},
        bodies={"do.1": [B("robot.say")], "otherwise_do.1": [B("robot.stop")]},
        groups={"answer": 2, "otherwise": 1},
    )

    assert body(language, B("event.started"), ask).splitlines()[2:] == [
        '    answer = nao.ask("Do you like robots?", ["yes", "no"], seconds=10)',
        '    if answer == "yes":',
        '        nao.say("Hello")',
        '    elif answer == "no":',
        "        pass",
        "    else:",
        "        nao.stop()",
        "",
        "",
    ]


@pytest.mark.parametrize(
    ("hat", "lines"),
    [
        (B("robot_events.touched"),
         ['@behavior.when("touched_head", source="NAO")', "def when_touched_head():"]),
        (B("robot_events.heard", {"word": "Good morning!"}),
         ['@behavior.when_heard("Good morning!")', "def when_heard_Good_morning():"]),
        (B("robot_events.sees_face_of", {"again.1": "restart"}, groups={"repeated": 1}),
         ['@behavior.when_noticed("face", "Anna", again="restart", source="NAO")',
          "def when_face_Anna():"]),
        (B("robot_events.sensor"),
         ['@behavior.when_true(lambda: nao.sensor("sonar_left") < 30)',
          "def when_sonar_left_is_under():"]),
        (B("robot_events.idle"), ["@behavior.when_idle(60)", "def when_idle():"]),
        (B("goal.goal", {"priority": "high"}, groups={"stop": 1}),
         ['@behavior.goal("greet", when="seen_face", priority="high", stop="touched_head")',
          "def goal_greet():"]),
        (B("goal.when_goal"),
         ['@behavior.when_goal("greet", "stopped")', "def when_greet_stopped():"]),
    ],
    ids=lambda value: value.type if isinstance(value, B) else "",
)  # fmt: skip
def test_a_hat_makes_its_decorator(language: Language, hat: B, lines: list[str]) -> None:
    assert body(language, hat, B("robot.say")).splitlines()[:2] == lines


def test_choices_by_chance_and_in_turn_are_functions(language: Language) -> None:
    for block, name in (("goal.one_of", "one_of"), ("goal.in_turn", "in_turn")):
        text = body(language, B("event.started"), B(block, bodies={"do.1": [B("robot.say")]}))

        assert f"    {name}(part_1, part_2)" in text.splitlines()


def test_repeating_until_a_state_is_a_loop(language: Language) -> None:
    loop = B("goal.until_state_at_most", bodies={"do": [B("robot.say")]})

    assert body(language, B("event.started"), loop).splitlines()[2:4] == [
        '    for _ in until_state("touched_head", 10):',
        '        nao.say("Hello")',
    ]


def with_needy_picture(language: Language) -> Language:
    picture = language.definitions["robot_camera.take_picture"]
    needy = replace(picture, flags=frozenset({*picture.flags, "needs_real_robot"}))
    definitions = {**language.definitions, needy.id: needy}
    return replace(language, definitions=definitions, _own=WeakKeyDictionary())


def test_what_needs_a_real_robot_is_told_before_it_runs(language: Language) -> None:
    language = with_needy_picture(language)
    picture = [B("event.started"), B("robot_camera.take_picture")]
    problem = only(sound(language, picture), language)

    assert (problem.kind, problem.severity) == ("needs_real_robot", "warning")
    assert "takes the picture" in str(problem.sentence) and problem.checklist


def test_what_needs_a_real_robot_is_told_on_its_own_page(language: Language) -> None:
    language = with_needy_picture(language)
    editor = sound(language)
    editor.apply(AddPage("more", "More", 1))
    picture = [B("event.started"), B("robot_camera.take_picture")]
    build(language, picture, page="more", editor=editor)

    problem = only(editor, language)

    assert (problem.kind, problem.page) == ("needs_real_robot", "more")


def test_every_robot_may_take_pictures(language: Language) -> None:
    for driver in ({}, {"driver": "naoqi", "address": "192.168.1.10"}):
        editor = build(language, [B("event.started"), B("robot_camera.take_picture")])
        build(language, [B("robots.robot", driver)], page="robots", editor=editor)

        assert check(editor.project, language) == []


def test_hats_for_different_parts_are_different_rules(language: Language) -> None:
    touched = [
        [B("robot_events.touched", {"part": part}), B("robot.say")]
        for part in ("head", "hand_left", "head")
    ]
    goals = [[B("goal.goal", {"name": name}), B("robot.say")] for name in ("a", "b")]

    assert kinds(sound(language, *touched, *goals), language) == ["same_trigger"]


def test_a_resting_robot_must_wake_up_before_it_walks(language: Language) -> None:
    rest, wake, walk = B("robot_moves.rest"), B("robot_moves.wake_up"), B("robot.walk")

    refused = kinds(sound(language, [B("event.started"), rest, walk]), language)
    woken = kinds(sound(language, [B("event.started"), rest, wake, walk]), language)

    assert (refused, woken) == (["not_standing"], [])

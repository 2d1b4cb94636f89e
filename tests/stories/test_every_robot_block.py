"""Every block about robots runs on the virtual NAO, through the Python that it makes."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.tasks import wait_until
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.run.installation import studio_language
from tests.stories.robot_theatre import B, RobotTheatre

pytestmark = pytest.mark.long

LANGUAGE = studio_language()
CATEGORIES = ("robot", "robot_moves", "robot_speech", "robot_lights")
STARTED = B("event.started")
LOOKED_AT_ELSEWHERE = "robot_camera"
"""These need a face and a file; they are run with them in test_robot_blocks_on_both_robots."""
ACTIONS = {
    "robot.say": "say",
    "robot.do": "do",
    "robot_moves.open_hand": "hand",
    "robot_moves.move_joint": "move_joint",
    "robot_moves.lock": "stiffness",
    "robot_moves.rest": "rest",
    "robot_moves.point_at": "point_at",
    "robot_moves.track": "track",
    "robot_speech.set_volume": "volume",
    "robot_lights.random_eyes": "random_eyes",
}
"""What some blocks ask the robot for."""


def statements(language: Language) -> list[Definition]:
    """The blocks that ask a robot to do something."""
    return [
        definition
        for definition in language.definitions.values()
        if "robot" in definition.slots and definition.shape in ("statement", "c", "cap")
        if "apart" not in definition.flags  # it does what is in it
    ]


def questions(language: Language) -> list[Definition]:
    return [d for d in language.definitions.values() if "robot" in d.slots and d.is_value]


@pytest.fixture
def theatre(network: PeerNetwork, join: Callable[[str], PeerNetwork]) -> Iterator[RobotTheatre]:
    theatre = RobotTheatre(network, join("outside"))
    yield theatre
    theatre.close()


@pytest.mark.parametrize("category", CATEGORIES)
def test_every_statement_about_robots_is_done(theatre: RobotTheatre, category: str) -> None:
    theatre.sense("face", name="Anna", place=(1.0, 0.3, 0.5))
    played = [d for d in statements(LANGUAGE) if d.category.id == category]
    blocks = [B("robot_moves.wake_up"), B("robot.do", {"posture": "posture_stand"})]
    for definition in played:
        blocks += [B("robot.do"), B("robot_moves.lock", {"part": "body"})]
        blocks += [B(definition.id), B("robot.stop")]

    theatre.play([STARTED, *blocks])

    assert len(played) > 4
    failed = [result for result in theatre.results if result.state == "failed"]
    assert failed == []
    for block, action in ACTIONS.items():
        if block.startswith(f"{category}."):
            assert "done" in theatre.ended(action), block


def test_no_statement_is_left_out() -> None:
    played = {
        d.id
        for d in statements(LANGUAGE)
        if d.category.id in CATEGORIES or d.category.id == LOOKED_AT_ELSEWHERE
    }

    assert played == {d.id for d in statements(LANGUAGE)}


def test_every_question_to_a_robot_is_answered(theatre: RobotTheatre) -> None:
    theatre.sense("mark", name="64", place=(1.0, 0.0, 0.5))
    # nobody is there to say a number, and that question insists on one
    asked = [one for one in questions(LANGUAGE) if one.id != "robot_speech.ask_number"]

    theatre.play(
        [STARTED, *(B("variable.set", {"variable": "v1"}, {"value": B(d.id)}) for d in asked)]
    )

    assert len(asked) > 14


def test_questions_about_the_robot_tell_the_truth(theatre: RobotTheatre) -> None:
    theatre.sense("sonar_left", 0.25)
    theatre.sense("hand_left")
    theatre.sense("face", name="Anna", place=(0.5, 0.0, 0.4))
    wait_until(lambda: theatre.told and "face_anna" in theatre.told[-1].sees)
    truths = [
        B("robot_senses.is_touched", {"part": "hand"}),
        B("robot_senses.sees_face_of"),
        B("robot_senses.person_is"),
        B("robot_senses.is_in"),
        B("robot_senses.is_doing", {"doing": "awake"}),
        B(
            "logic.compare",
            {"comparison": "equal", "b": 25},
            {"a": B("robot_senses.sensor")},
        ),
        B(
            "logic.compare",
            {"comparison": "equal", "b": "de"},
            {"a": B("robot_speech.language")},
        ),
    ]
    checks = [
        B(
            "control.if",
            inputs={"condition": truth},
            bodies={"do": [B("robot.say", {"text": f"true {number}"})]},
        )
        for number, truth in enumerate(truths)
    ]

    theatre.play([STARTED, B("robot_speech.set_language", {"language": "de"}), *checks])

    assert {f"true {number}" for number in range(len(truths))} <= theatre.said()


def test_a_question_to_the_person_takes_the_branch_of_the_answer(theatre: RobotTheatre) -> None:
    def ask(seconds: float, *said: str) -> B:
        bodies = {f"do.{n}": [B("robot.say", {"text": t})] for n, t in enumerate(said[:2], 1)}
        bodies["otherwise_do.1"] = [B("robot.say", {"text": said[2]})]
        groups = {"answer": 2, "otherwise": 1}
        return B("robot_speech.ask", {"word.2": "no", "seconds": seconds}, {}, bodies, groups)

    theatre.answers = ["no"]
    theatre.play([STARTED, ask(30, "A yes", "A no", "A nothing")])
    theatre.answers = []
    theatre.play([STARTED, ask(0.5, "B yes", "B no", "B nothing")])

    assert {"A no", "B nothing"} <= theatre.said()
    assert not {"A yes", "A nothing", "B yes", "B no"} & theatre.said()


def test_every_hat_about_robots_and_goals_fires(theatre: RobotTheatre) -> None:
    hats = {
        "robot_events.touched": lambda: theatre.sense("head_middle"),
        "robot_events.heard": lambda: theatre.sense("word", name="Hello"),
        "robot_events.sees": lambda: theatre.sense("face", place=(3.0, 0.0, 0.5)),
        "robot_events.sees_face_of": lambda: theatre.sense("face", name="Anna"),
        "robot_events.sees_mark": lambda: theatre.sense("mark", name="64"),
        "robot_events.person": lambda: theatre.sense("face", place=(0.5, 0.0, 0.5)),
        "robot_events.sensor": lambda: theatre.sense("sonar_left", 0.2),
        "robot_events.emotion": lambda: theatre.person_is("emotion_happy"),
        "robot_events.idle": lambda: None,
        "goal.goal": lambda: theatre.person_is("please"),
        "goal.when_goal": lambda: theatre.person_is("enough"),
        "goal.goal_when": lambda: theatre.sense("bumper_left"),
        "goal.goal_asked": lambda: theatre.person_is("wanted"),
    }
    fields = {
        "robot_events.idle": {"seconds": 0.5},
        "goal.goal": {"state": "please", "stop_state.1": "enough"},
        "goal.goal_when": {"name": "look"},
        "goal.goal_asked": {"name": "help"},
    }
    touched = B("robot_senses.is_touched", {"part": "bumper_left"})
    stay = B("control.wait", {"seconds": 60})
    stacks = []
    for hat in hats:
        asked = {"condition": touched} if hat == "goal.goal_when" else {}
        groups = {"stop": 1} if hat == "goal.goal" else {}
        first = B(hat, fields.get(hat, {}), asked, groups=groups)
        said = B("robot.say", {"text": hat})
        stacks.append([first, said, *([stay] if hat == "goal.goal" else [])])
    wanted = [B("event.human_state", {"state": "wanted"}), B("goal.pursue", {"name": "help"})]
    begun = [STARTED, B("robot.say", {"text": "begun"})]
    playing = theatre.play_along(*stacks, wanted, begun)
    wait_until(lambda: "begun" in theatre.said())

    for hat, make in hats.items():
        make()
        wait_until(lambda hat=hat: hat in theatre.said())

    theatre.end_program(playing)
    assert set(hats) == {
        d.id
        for d in LANGUAGE.definitions.values()
        if d.shape == "hat" and d.category.id in ("robot_events", "goal")
    }


def test_loops_and_choices_around_robot_blocks_run(theatre: RobotTheatre) -> None:
    def say(text: str) -> list[B]:
        return [B("robot.say", {"text": text})]

    turns = B("goal.in_turn", bodies={"do.1": say("first"), "do.2": say("second")})
    chance = B("goal.one_of", bodies={"do.1": say("chance"), "do.2": say("chance")})
    until = B("goal.until_state", {"state": "heard_yes"}, bodies={
        "do": [B("robot_speech.wait_for_word", {"seconds": 5})]
    })  # fmt: skip
    most = B("goal.until_state_at_most", {"state": "never", "times": 2}, bodies={"do": [turns]})

    theatre.play([STARTED, chance, most, until, *say("over")])

    assert {"chance", "first", "second", "over"} <= theatre.said()

"""The programs of ``programs/*.toml`` are played on robots, and do what each says it does."""

from __future__ import annotations

import datetime
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from nep_studio.blocks.checks import check
from nep_studio.blocks.generate.program import generate_program
from nep_studio.help.texts import examples
from tests.stories.block_theatre import BlockTheatre, block_theatre
from tests.stories.programs_in_blocks import LANGUAGE, programs

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blocks"))
from block_building import read_program

PROGRAMS = programs()
POLLING = ("control.forever", "control.while", "goal.until_state")
KNOWN = {"calls_itself"}
"""What is told of a program that is right: good to know, no fault."""

Play = Callable[[BlockTheatre], None]


@pytest.fixture(scope="module")
def theatre() -> Iterator[BlockTheatre]:
    with block_theatre() as made:
        yield made


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_needs_no_python_and_asks_nothing_over_and_over(name: str) -> None:
    project = PROGRAMS[name].project()

    types = {block.type for block in project.blocks.values()}

    assert not [each for each in types if each.startswith("code.") or each in POLLING]
    assert {problem.kind for problem in check(project, LANGUAGE)} <= KNOWN


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_python_of_a_program_is_read_back_as_the_same_blocks(name: str) -> None:
    project = PROGRAMS[name].project()
    code = generate_program(project, LANGUAGE.of(project)).text

    again = read_program(code, LANGUAGE, project)

    assert generate_program(again, LANGUAGE.of(again)).text == code
    types = [sorted(block.type for block in each.blocks.values()) for each in (project, again)]
    assert types[0] == types[1]


# What people do and see when a program runs, by its name.


def dialogue(theatre: BlockTheatre) -> None:
    theatre.touch("head_front")
    theatre.answer("tea", "yes")
    theatre.says("Tea with milk, please wait.")
    theatre.rests(1)
    theatre.touch("head_front")
    theatre.answer("juice")
    theatre.says("Juice, please wait.")


def receptionist(theatre: BlockTheatre) -> None:
    theatre.does("do", posture="posture_sit")
    theatre.show("face")
    theatre.does("do", posture="posture_stand")
    theatre.says("Welcome to the museum.")
    theatre.touch("head_front")
    theatre.says("We are open until six.", "Welcome to the museum.", "Nobody wants me.")
    theatre.does("do", posture="posture_sit")


def interrupted_guide(theatre: BlockTheatre) -> None:
    theatre.show("face")
    theatre.says(OLDEST, "And here is the newest, which is a little longer to tell of.")
    theatre.touch("head_front")
    theatre.says("The exit is over there.", "Where were we?")
    theatre.says("And here is the newest, which is a little longer to tell of.")
    theatre.says("That was the tour.")
    assert theatre.said().count(OLDEST) == 1


def quiz(theatre: BlockTheatre) -> None:
    theatre.answer("Paris")
    theatre.says("Right.")
    theatre.answer("eight")
    theatre.says("Right.", "Colour of the sky?")
    theatre.answer("Green")  # at once, and not when a minute is over
    theatre.says("green is not right, it is blue", "You have 2 of 3 points.")
    theatre.ends()


def phone_book(theatre: BlockTheatre) -> None:
    theatre.tell("call")
    theatre.answer("Ben")
    theatre.says("I do not know ben")
    theatre.rests(1)
    theatre.tell("add")
    theatre.answer("Ben", "56")
    theatre.says("I know ben now.")
    theatre.rests(2)
    theatre.tell("call")
    theatre.answer("Ben")
    theatre.says("56")
    theatre.rests(3)
    theatre.tell("call")
    theatre.answer("Anna")
    theatre.says("12 34")


def daily_schedule(theatre: BlockTheatre) -> None:
    theatre.says("Off to school.", "Good night.")
    assert theatre.said() == ["Off to school.", "Good night."]


def high_score(theatre: BlockTheatre) -> None:
    plays_for(theatre, 1, "7", "A new record!")
    plays_for(theatre, 2, "4", "The best is 7")
    plays_for(theatre, 3, "nine", "A new record!")


def plays_for(theatre: BlockTheatre, number: int, points: str, sentence: str) -> None:
    """Play a round, the first, second ... of the program, and tell how many points it was."""
    theatre.touch("head_front")
    theatre.answer(points)
    theatre.says(sentence)
    theatre.rests(number)


def gesture_and_posture(theatre: BlockTheatre) -> None:
    theatre.person_is("gesture_karate")
    time.sleep(2.2)  # the gesture is too old when the arm is raised
    theatre.person_is("arm_raised")
    time.sleep(0.3)
    assert not theatre.begun("play")
    theatre.person_is("gesture_karate")
    theatre.does("play", animation="karate")


def battery_first(theatre: BlockTheatre) -> None:
    theatre.show("face")
    theatre.says("Once upon a time.", "There was a robot.")
    theatre.feel("battery", 0.1)
    theatre.says("I need power.")
    theatre.feel("battery", 0.9)
    theatre.says("That was good.")
    theatre.says("It lived happily ever after in a castle on a hill.")
    assert theatre.said().count("Once upon a time.") == 1


def walked_tree(theatre: BlockTheatre) -> None:
    walked = [theatre.does("walk").args["forward_m"] for _ in range(6)]
    theatre.says("That was a tree.")
    theatre.ends()
    assert walked == [0.4, 0.2, -0.2, 0.2, -0.2, -0.4]


def two_robots(theatre: BlockTheatre) -> None:
    theatre.says("Who is there?")
    theatre.says("It is me.", robot="NAO2")
    theatre.says("Come in.")
    theatre.says("Thank you.", robot="NAO2")
    theatre.ends()


def workers(theatre: BlockTheatre) -> None:
    theatre.says("All is done.")
    theatre.ends()
    done = [*theatre.said("NAO"), *theatre.said("NAO2"), *theatre.said("NAO3")]
    assert sorted(done) == ["All is done.", "I cook", "I paint", "I sing", "I sweep"]
    assert theatre.said("NAO2") and theatre.said("NAO3")


def choir(theatre: BlockTheatre) -> None:
    theatre.says("That was the choir.")
    theatre.ends()
    assert theatre.said("NAO") == ["la la NAO", "la la NAO", "That was the choir."]
    assert theatre.said("NAO2") == ["la la NAO2", "la la NAO2"]
    assert theatre.said("NAO3") == ["la la NAO3", "la la NAO3"]


def simon_says(theatre: BlockTheatre) -> None:
    rows = []
    for _ in range(3):
        rows.append(theatre.hears())
        theatre.answer(*rows[-1].replace(" and ", ", ").split(", "))
    theatre.says("You have a good memory.")
    theatre.ends()
    assert [len(row.replace(" and ", ", ").split(", ")) for row in rows] == [1, 2, 3]


def guess_the_number(theatre: BlockTheatre) -> None:
    low, high, heard = 1, 20, ""
    while heard != "You have found it.":
        assert low <= high
        guess = (low + high) // 2
        theatre.answer(str(guess))
        heard = theatre.hears()
        low, high = (guess + 1, high) if heard == "More." else (low, guess - 1)
    theatre.ends()


def rock_paper_scissors(theatre: BlockTheatre) -> None:
    theatre.answer("Paper")
    results = {"rock": "You win.", "paper": "Nobody wins.", "scissors": "I win."}
    theatre.says(results[theatre.hears().removeprefix("I have ")])
    theatre.ends()


def times_tables(theatre: BlockTheatre) -> None:
    for number in range(3):
        a, _, b = theatre.hears().split()
        product = int(a) * int(b)
        theatre.answer(str(product) if number else "1")
        if not number:
            theatre.says(f"It is {product}")
    theatre.says("2 of three were right.")
    theatre.ends()


def countdown(theatre: BlockTheatre) -> None:
    theatre.says("10", "9")
    theatre.touch("head_front")
    theatre.says("Stopped.")
    assert "1" not in theatre.said() and "Lift off!" not in theatre.said()


def traffic_light(theatre: BlockTheatre) -> None:
    theatre.does("leds", colour="#ff0000")
    theatre.touch("hand_left")
    for colour in ("#00ff00", "#ffff00", "#ff0000"):
        theatre.does("leds", colour=colour)


def vote_counter(theatre: BlockTheatre) -> None:
    theatre.rests(0)
    theatre.tell("result")
    theatre.says("Nobody has voted yet.")
    for number, name in enumerate(("Ben", "Anna", "Anna"), 1):
        theatre.rests(number)
        theatre.tell("vote")
        theatre.answer(name)
    theatre.rests(4)
    theatre.tell("result")
    theatre.says("anna has won with 2")


def shopping_list(theatre: BlockTheatre) -> None:
    theatre.tell("buy")
    theatre.answer("bread")
    theatre.says("So we need milk and bread")
    theatre.rests(1)
    theatre.tell("done")
    theatre.answer("milk")
    theatre.says("Still to buy: bread")


def weather(theatre: BlockTheatre) -> None:
    sky = theatre.hears().split()[2]
    theatre.says({"sunny": "Take a cap", "rainy": "Take an umbrella"}[sky])
    theatre.does("play", animation={"sunny": "cheer", "rainy": "sneeze"}[sky])
    theatre.ends()


def random_dance(theatre: BlockTheatre) -> None:
    moves = {theatre.does("play").args["animation"] for _ in range(4)}
    theatre.says("What a dance.")
    theatre.ends()
    assert moves <= {"wave", "clap", "bow"}


def alarm_clock(theatre: BlockTheatre) -> None:
    theatre.says("Wake up!")
    theatre.touch("head_front")
    theatre.enters("snoozing")
    theatre.enters("ringing")
    theatre.says("Wake up!")
    theatre.touch("hand_left")
    theatre.says("Good morning.")
    theatre.enters("asleep")


def hide_and_seek(theatre: BlockTheatre) -> None:
    theatre.says("1", "2", "3", "4", "5", "I am coming!")
    theatre.show("face")
    theatre.says("Found you.")
    theatre.ends()


def translator(theatre: BlockTheatre) -> None:
    theatre.answer("cat")
    theatre.says("chat")
    theatre.answer("robot")
    theatre.says("I have not learned that.")
    theatre.ends()


def story(theatre: BlockTheatre) -> None:
    theatre.says("You are at a crossing.")
    theatre.answer("left", "yes")
    theatre.says("There is the treasure.", "The end.")
    theatre.ends()


def told_problem(theatre: BlockTheatre) -> None:
    theatre.answer("banana", "banana", "banana")
    said = theatre.hears()
    theatre.says("What next?")
    theatre.ends()
    assert said.startswith("Sorry. ") and "has heard no number" in said


def touch_race(theatre: BlockTheatre) -> None:
    theatre.touch("hand_left")  # too early
    theatre.says("Go!")
    theatre.touch("hand_right")
    theatre.says("right was faster.", "In less than a minute.")
    theatre.ends()
    assert "left was faster." not in theatre.said()


def museum_plan(theatre: BlockTheatre) -> None:
    theatre.says("I go to the corridor", "I go to the gallery", "These are the sunflowers")
    theatre.ends()


def patrol(theatre: BlockTheatre) -> None:
    theatre.says("Nobody on the left.", "Nobody on the right.", "Nobody on the left.")
    theatre.feel("battery", 0.1)
    theatre.says("I must rest.")
    theatre.feel("battery", 0.9)
    theatre.says("Nobody on the left.")


def asked_goal(theatre: BlockTheatre) -> None:
    theatre.tell("guest")
    theatre.answer("Clara")
    theatre.says("Hello clara")


def teacher(theatre: BlockTheatre) -> None:
    theatre.answer("three", "five", "four")
    theatre.says("Well done.")
    theatre.ends()
    assert "It is four." not in theatre.said()


OLDEST = "Here is the oldest picture."
CLOCK = """
import datetime, time
import nep_core.program.triggers as triggers
moments = {moments}
triggers.LOOK_AT_CLOCK_S = 0.2
triggers.local_now = lambda: moments[min(len(moments) - 1, int((time.monotonic() - began) / 3))]
began = time.monotonic()
"""
"""Lets the clock of the computer show one moment for three seconds, and then another: a busy
computer looks late."""
THURSDAY = [datetime.datetime(2026, 11, 26, 8, 0, 1), datetime.datetime(2026, 11, 26, 19, 30)]
CLOCKS = {
    "daily_schedule": CLOCK.format(moments=THURSDAY),
    "alarm_clock": CLOCK.format(moments=[datetime.datetime(2026, 11, 27, 7, 0, 5)]),
}
PLAYS = {
    each.__name__: each
    for each in (
        dialogue,
        receptionist,
        interrupted_guide,
        quiz,
        phone_book,
        daily_schedule,
        high_score,
        gesture_and_posture,
        battery_first,
        walked_tree,
        two_robots,
        workers,
        choir,
        simon_says,
        guess_the_number,
        rock_paper_scissors,
        times_tables,
        countdown,
        traffic_light,
        vote_counter,
        shopping_list,
        weather,
        random_dance,
        alarm_clock,
        hide_and_seek,
        translator,
        story,
        told_problem,
        touch_race,
        museum_plan,
        patrol,
        asked_goal,
        teacher,
    )
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_does_what_it_says(theatre: BlockTheatre, name: str) -> None:
    with theatre.plays(PROGRAMS[name].project(), prepare=CLOCKS.get(name, "")):
        PLAYS[name](theatre)
        assert not theatre.failures()


def test_the_best_score_is_kept_for_the_next_run(theatre: BlockTheatre) -> None:
    project = PROGRAMS["high_score"].project()
    project.name = "high_score_again"
    with theatre.plays(project):
        plays_for(theatre, 1, "12", "A new record!")

    with theatre.plays(project):
        plays_for(theatre, 1, "11", "The best is 12")
        assert not theatre.failures()


# The page of the help “Three ways to say it”: what is said three ways is done three ways.


def karate_greeting(theatre: BlockTheatre) -> None:
    for _ in range(2):
        time.sleep(PAUSE_S)
        theatre.person_is("gesture_karate")
        theatre.does("play", animation="bow")
        theatre.says("Impressive!")


def quiz_rules(theatre: BlockTheatre) -> None:
    theatre.touch("head_front")
    theatre.answer("eight", "cat")
    theatre.says("That is right.")


def quiz_tree(theatre: BlockTheatre) -> None:
    theatre.answer("eight")
    theatre.says("That is right.")
    theatre.ends()


def quiz_states(theatre: BlockTheatre) -> None:
    theatre.touch("head_front")
    theatre.answer("eight")
    theatre.says("That is right.")
    assert "That is not right." not in theatre.said()


def museum_guide(theatre: BlockTheatre) -> None:
    theatre.show("face")
    theatre.says("Welcome to the museum.", PICTURE)
    theatre.touch("head_front")
    theatre.says("The exit is over there.")


PAUSE_S = 1.2
"""So long no gesture is made: states are not entered yet, and a tree would see the same one."""
PICTURE = "On this side you see the oldest picture."
GOES_ON = {"guide_rules": True, "guide_tree": True, "guide_states": False}
"""Whether the tour goes on where it was, behind what has interrupted it."""
WAYS: dict[str, Play] = {
    **{f"karate_{way}": karate_greeting for way in ("rules", "tree", "states")},
    "quiz_rules": quiz_rules,
    "quiz_tree": quiz_tree,
    "quiz_states": quiz_states,
    **dict.fromkeys(GOES_ON, museum_guide),
}


@pytest.mark.parametrize("name", WAYS)
def test_each_of_the_three_ways_does_what_the_page_says(theatre: BlockTheatre, name: str) -> None:
    project = examples()[name].project(LANGUAGE, "en", name)

    with theatre.plays(project):
        if name.endswith("states"):
            time.sleep(PAUSE_S)
        WAYS[name](theatre)
        if GOES_ON.get(name):
            theatre.says(PICTURE)
        assert not theatre.failures()

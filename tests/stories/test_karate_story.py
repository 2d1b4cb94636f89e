"""The paper's own test: a karate gesture, and NAO says "Impressive!"."""

from __future__ import annotations

import sys
from collections.abc import Callable

import psutil
import pytest

from nep_studio import paths
from tests.stories.playing import SPEED, Event, Play, kill, node_is, playing, result_of, says

pytestmark = pytest.mark.long

KARATE = paths.examples() / "karate_greeting.nep"
KILLED = ("karate", "watch")
"""In this order: a watch that is started again makes the gesture again, for who is back by then."""


def test_a_karate_gesture_makes_nao_say_impressive_and_play_its_sequence() -> None:
    with playing(KARATE, "--speed", SPEED) as play:
        assert play.finish() == 0, play.errors()

    made = next(e for e in play.events if "makes the gesture karate" in e.get("description", ""))
    seen = next(e for e in play.events if e["topic"] == "/human_behavior")
    assert made["time"] < seen["time"]
    assert seen["human_state"] == "gesture_karate"
    assert play.rules() == ["gesture_karate"]
    assert play.said() == [
        "Show me a karate chop!",
        "Impressive!",
        "I can do that, too.",
        "Thank you for the lesson, master.",
        "Now I have to rest.",
    ]
    assert [e["event"] for e in play.events if e["topic"] == "/program_state"][-1] == "finished"
    assert not [e for e in play.events if e.get("event") in ("crashed", "warning")]


@pytest.mark.skipif(sys.platform == "win32", reason="kills with SIGKILL")
def test_killed_nodes_are_told_and_started_again_and_the_story_goes_on() -> None:
    with playing(KARATE, "--speed", SPEED) as play:
        play.wait_for(node_is("watch", "ready"))  # the last to start

        for node in KILLED:
            crashed = kill_and_await(play, node)
            assert crashed["description"] == f"{node} was killed; it is started again"

        sentence = play.find(says("Thank you for the lesson, master."))
        play.find(result_of(sentence, "started"))

        kill(play.pids["NAO"])  # it says the sentence again when it is back

        play.wait_for(node_is("NAO", "crashed"))
        play.wait_for(node_is("NAO", "ready"))
        assert play.finish() == 0, play.errors()
    assert "Impressive!" in play.said()
    assert play.said()[-1] == "Now I have to rest."


@pytest.mark.skipif(sys.platform == "win32", reason="kills with SIGKILL")
def test_the_talk_goes_on_without_the_master_and_newcomers_join_the_next() -> None:
    with playing(KARATE, "--speed", SPEED) as play:
        play.wait_for(node_is("watch", "ready"))
        master = master_of(play)

        kill(master.pid)

        assert "killed" in play.wait_for(node_is("master", "crashed"))["description"]
        for node in KILLED:
            kill_and_await(play, node)
        sentence = play.find(says("Impressive!"))
        play.find(result_of(sentence, "done"))
        play.interrupt()
        assert play.finish() == 0, play.errors()


def kill_and_await(play: Play, node: str) -> Event:
    """Kill a node and wait until it is back; what was said of its end."""
    pid = play.pids[node]
    kill(pid)
    crashed = play.wait_for(node_is(node, "crashed"))
    play.wait_for(is_back(node, pid))
    return crashed


def is_back(node: str, old_pid: int) -> Callable[[Event], bool]:
    """Whether a new process of a node tells that it works.

    Who finds it late, through a new master, hears the newest of its states only: its first "ready"
    or a sign of life after that.
    """
    return lambda e: (
        any(node_is(node, state)(e) for state in ("ready", "alive")) and (e["pid"] != old_pid)
    )


def master_of(play: Play) -> psutil.Process:
    """The master's process, a child of the session."""
    children = psutil.Process(play.process.pid).children()
    return next(child for child in children if "master" in child.cmdline())

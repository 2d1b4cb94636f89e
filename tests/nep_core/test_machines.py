"""State machines in a program: entering and leaving, what sets a transition off, errors, waits."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program.machines import StateRefused
from nep_core.program.messages import tell
from nep_core.program.tasks import wait
from tests.nep_core.goal_playing import WAIT_S, Join, Scene


@pytest.fixture
def scene(network: PeerNetwork, join: Join) -> Iterator[Scene]:
    scene = Scene(network, join("person"))
    yield scene
    scene.end()


def stay(scene: Scene, name: str, seconds: float = WAIT_S, *, first: bool = False) -> None:
    """A state in whose activity is written when it begins, comes to its end, or is cut."""

    @scene.behavior.state(name, first=first)
    def activity() -> None:
        scene.diary.write(f"in {name}")
        try:
            wait(seconds)
        except BaseException:
            scene.diary.write(f"{name} cut")
            raise
        scene.diary.write(f"{name} done")


def way(scene: Scene, source: str, target: str, **options: object) -> None:
    """A transition that writes its way."""
    scene.behavior.transition(source, target, **options)(  # type: ignore[arg-type]
        lambda: scene.diary.write(f"{source} > {target}")
    )


def test_a_touch_leads_from_the_first_state_to_the_next_and_ends_what_was_done(
    scene: Scene,
) -> None:
    stay(scene, "waiting", first=True)
    stay(scene, "talking")
    way(scene, "waiting", "talking", when="touched_head")
    scene.begin()
    assert scene.diary.next() == "in waiting"

    scene.does("touched_head")

    assert [scene.diary.next() for _ in range(3)] == [
        "waiting cut",
        "waiting > talking",
        "in talking",
    ]
    assert scene.behavior.is_in("talking") and scene.behavior.state_now() == "talking"


def test_what_the_person_does_counts_only_in_the_state_that_names_it(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    stay(scene, "talking")
    way(scene, "talking", "waiting", when="touched_head")
    way(scene, "waiting", "talking", when="wave")
    scene.begin()
    scene.diary.next()

    scene.does("touched_head")
    scene.does("wave")

    assert [scene.diary.next() for _ in range(3)] == [
        "waiting cut",
        "waiting > talking",
        "in talking",
    ]


def test_a_state_whose_blocks_are_done_goes_on(scene: Scene) -> None:
    stay(scene, "greeting", 0.05, first=True)
    stay(scene, "waiting")
    way(scene, "greeting", "waiting", done=True)
    scene.begin()

    assert [scene.diary.next() for _ in range(4)] == [
        "in greeting",
        "greeting done",
        "greeting > waiting",
        "in waiting",
    ]


def test_the_first_of_several_ways_that_are_open_is_taken(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    way(scene, "waiting", "left", when=lambda: True)
    way(scene, "waiting", "right", when=lambda: True)
    scene.begin()

    assert [scene.diary.next() for _ in range(3)] == ["in waiting", "waiting cut", "waiting > left"]


def test_time_in_a_state_and_messages_set_ways_off(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    stay(scene, "asleep")
    way(scene, "waiting", "asleep", after=0.2)
    way(scene, "asleep", "waiting", told="morning")
    began_s = time.monotonic()
    scene.begin()

    said = [scene.diary.next() for _ in range(4)]
    assert said[2:] == ["waiting > asleep", "in asleep"]
    assert time.monotonic() - began_s >= 0.2
    tell("morning")

    assert [scene.diary.next() for _ in range(3)] == [
        "asleep cut",
        "asleep > waiting",
        "in waiting",
    ]


def test_go_to_in_the_state_itself_ends_it_there(scene: Scene) -> None:
    stay(scene, "playing")

    @scene.behavior.state("waiting", first=True)
    def activity() -> None:
        scene.diary.write("in waiting")
        scene.behavior.go_to("playing")
        scene.diary.write("never")

    scene.begin()

    assert [scene.diary.next() for _ in range(2)] == ["in waiting", "in playing"]


def test_go_to_in_a_rule_goes_on_with_the_rule(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    stay(scene, "playing")

    @scene.behavior.when("touched_head")
    def rule() -> None:
        scene.behavior.go_to("playing")
        wait(0.3)
        scene.diary.write("rule done")

    scene.begin()
    scene.diary.next()
    scene.does("touched_head")

    assert [scene.diary.next() for _ in range(3)] == ["waiting cut", "in playing", "rule done"]


def test_several_machines_are_in_a_state_each(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    scene.behavior.state("off", first=True, machine="lamp")(lambda: scene.diary.write("off"))
    scene.behavior.transition("off", "on", when="wave", machine="lamp")(lambda: None)
    scene.begin()
    assert {scene.diary.next(), scene.diary.next()} == {"in waiting", "off"}

    scene.does("wave")

    while not scene.behavior.is_in("on", "lamp"):
        wait(0.01)
    assert scene.behavior.is_in("waiting")


def test_the_network_hears_which_machine_is_in_which_state(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    scene.behavior.transition("off", "on", when="wave", machine="lamp")(lambda: None)
    scene.behavior.state("off", first=True, machine="lamp")(lambda: None)
    scene.begin()

    scene.does("wave")

    heard = set[tuple[str, str]]()
    while len(heard) < 3:
        told = scene.told.receive(WAIT_S)
        assert told is not None, heard
        if told.event == "state_entered":
            heard.add((told.machine, told.rule))
    assert heard == {("", "waiting"), ("lamp", "off"), ("lamp", "on")}


def test_a_state_that_is_not_there_is_an_error_that_names_those_that_are(scene: Scene) -> None:
    stay(scene, "waiting", first=True)
    scene.begin()
    scene.diary.next()

    with pytest.raises(StateRefused, match=r"“wating”.*waiting"):
        scene.behavior.go_to("wating")


def test_a_condition_that_fails_is_told_once_and_another_way_stays_open(scene: Scene) -> None:
    stay(scene, "waiting", first=True)

    def broken() -> bool:
        raise ValueError("broken")

    way(scene, "waiting", "left", when=broken)
    way(scene, "waiting", "right", when="wave")
    scene.begin()
    scene.diary.next()

    event = scene.told.receive(WAIT_S)
    while event is not None and event.event != "rule_failed":
        event = scene.told.receive(WAIT_S)
    assert event is not None
    scene.does("wave")

    assert [scene.diary.next() for _ in range(2)] == ["waiting cut", "waiting > right"]


def test_an_activity_that_fails_stays_in_its_state(scene: Scene) -> None:
    @scene.behavior.state("waiting", first=True)
    def activity() -> None:
        raise ValueError("broken")

    way(scene, "waiting", "left", done=True)
    way(scene, "waiting", "right", when="wave")
    scene.begin()
    event = scene.told.receive(WAIT_S)
    while event is not None and event.event != "rule_failed":
        event = scene.told.receive(WAIT_S)

    scene.does("wave")

    assert scene.diary.next() == "waiting > right"


def test_the_same_state_twice_is_refused(scene: Scene) -> None:
    stay(scene, "waiting")

    with pytest.raises(StateRefused, match="twice"):
        stay(scene, "waiting")

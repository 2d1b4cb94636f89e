"""What stands around the robots is kept in the project, and what makes no sense is left out."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.wire.messages import Thing
from nep_studio.blocks.program import Project
from nep_studio.project.surroundings import (
    FARTHEST_M,
    KEY,
    MOST_THINGS,
    kept_things,
    moved,
    named,
    new_thing,
    replaced,
    to_keep,
    turned,
)

ORIGIN = (0.0, 0.0, 0.0)


def project_with(kept: object) -> Project:
    project = Project("Test")
    project.extra[KEY] = kept
    return project


def test_things_that_are_kept_come_back_as_they_were() -> None:
    things = [new_thing("person", ORIGIN, []), new_thing("mark", ORIGIN, [], "70")]

    assert kept_things(project_with(to_keep(things))) == things
    assert to_keep([]) is None
    assert kept_things(Project("Test")) == []


@pytest.mark.parametrize(
    "kept",
    [
        "person",
        [{"id": "a", "kind": "dragon", "place": [0, 0, 0]}],
        [{"id": "a", "kind": "ball", "place": [1e9, 0, 0]}],
        [{"id": "", "kind": "ball", "place": [0, 0, 0]}],
        [{"id": "a", "kind": "ball", "place": [0, 0, 0], "size": [0, 1, 1]}],
        [{"id": "a", "kind": "ball", "place": [0, 0, 0], "name": "two\nlines"}],
    ],
)
def test_what_makes_no_sense_in_a_file_is_left_out(kept: object) -> None:
    assert kept_things(project_with(kept)) == []


def test_a_file_with_very_many_things_gives_some_of_them() -> None:
    many = [{"id": f"ball{n}", "kind": "ball", "place": [0, 0, 0]} for n in range(500)]

    assert len(kept_things(project_with(many))) == MOST_THINGS


def test_a_person_is_put_before_the_robot_and_looks_at_it() -> None:
    person = new_thing("person", (1.0, 1.0, math.pi / 2), [])

    assert person.place[:2] == pytest.approx((1.0, 2.2))
    assert person.heading == pytest.approx(-math.pi / 2)
    assert person.name == "Anna"


def test_many_things_stand_beside_each_other_with_names_of_their_own() -> None:
    there: list[Thing] = []
    for _ in range(8):
        there.append(new_thing("mark", ORIGIN, there))

    places = [thing.place for thing in there]
    assert len({thing.name for thing in there}) == len({thing.id for thing in there}) == 8
    assert all(
        math.dist(one, other) > 0.2 for n, one in enumerate(places) for other in places[n + 1 :]
    )


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(-1e3, 1e3))
def test_whatever_is_done_to_a_thing_it_can_be_kept(x: float, y: float, angle: float) -> None:
    thing = named(turned(moved(new_thing("person", ORIGIN, []), x, y), angle), " A\n b\t" * 40)

    assert kept_things(project_with(to_keep([thing]))) == [thing]
    assert all(abs(part) <= FARTHEST_M for part in thing.place)
    assert abs(thing.heading) <= math.pi + 1e-3


def test_a_changed_thing_keeps_its_place_in_the_list() -> None:
    first, second = new_thing("ball", ORIGIN, []), new_thing("person", ORIGIN, [])

    changed = replaced([first, second], named(first, "x"))

    assert [thing.id for thing in changed] == [first.id, second.id]
    assert changed[0].name == "x"

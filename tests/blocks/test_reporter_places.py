"""Which reporter made a call of the generated Python."""

from __future__ import annotations

import re

import pytest
from block_building import B, build

from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.generate.source_map import ReporterPlaces


def seen(gesture: str) -> B:
    return B("sensing.times_seen", {"state": f"gesture_{gesture}"})


def plus(a: B, b: B) -> B:
    return B("math.arithmetic", {"operation": "add"}, {"a": a, "b": b})


def is_more(a: B, b: B) -> B:
    return B("logic.compare", {"comparison": "greater"}, {"a": a, "b": b})


@pytest.fixture
def editor(language):
    fork = B(
        "control.if",
        inputs={
            "condition": is_more(seen("karate"), seen("clap")),
            "also_condition.1": is_more(seen("wave"), seen("katana")),
        },
        bodies={"do": [B("robot.say", inputs={"text": seen("batting")})]},
        groups={"also": 1},
    )
    put = B("variable.set", {"variable": "v1"}, {"value": plus(seen("clap"), seen("clap"))})
    return build(language, [B("event.started"), put, fork], variables=("é",))


def places(text: str) -> dict[str, str]:
    """The places of all calls of times_seen, with the gesture that each asks for."""
    found = {}
    for number, line in enumerate(text.splitlines(), start=1):
        for call in re.finditer(r'times_seen\("gesture_(\w+)"\)', line):
            begin, end = (len(line[:at].encode()) for at in call.span())
            found[f"@{number}:{begin}-{end}"] = call[1]
    return found


def test_every_call_of_a_reporter_leads_to_its_block(editor) -> None:
    code = generate_program(editor.project, editor.language)
    known = ReporterPlaces(code, editor.project, editor.language)

    found = {place: known.block_at(place) for place in places(code.text)}

    told = {p: editor.project.blocks[block].fields["state"] for p, block in found.items() if block}
    assert told == {p: f"gesture_{gesture}" for p, gesture in places(code.text).items()}
    assert len(set(found.values())) == 7


def test_a_disabled_reporter_has_no_place(editor) -> None:
    block = next(
        b for b in editor.project.blocks.values() if b.fields.get("state") == "gesture_wave"
    )
    block.disabled = True

    code = generate_program(editor.project, editor.language)
    known = ReporterPlaces(code, editor.project, editor.language)

    assert {known.block_at(place) for place in places(code.text)} == {
        b.id
        for b in editor.project.blocks.values()
        if b.type == "sensing.times_seen" and b is not block
    }


@pytest.mark.parametrize("place", ["", "x", "@", "@0:0-1", "@1:0-5", "@99999:0-5", "@12:0-1"])
def test_other_places_have_no_reporter(editor, place: str) -> None:
    code = generate_program(editor.project, editor.language)

    assert ReporterPlaces(code, editor.project, editor.language).block_at(place) is None

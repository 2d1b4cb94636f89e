"""The cues of a project are what its rules really wait for, and what an operator made of them."""

from __future__ import annotations

import ast
from pathlib import Path

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.wire.states import state_of_thing, state_of_word
from nep_studio import paths
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import load, save
from nep_studio.blocks.generate.program import generate_program
from nep_studio.project.triggers import KEY, Cue, arranged, cues_of, kept_cues, own_cue, to_keep
from nep_studio.run.installation import studio_language
from tests.blocks.block_building import B, build

LANGUAGE = studio_language()
EXAMPLES = sorted(paths.examples().glob("*.nep"))


def waited_for(python: str) -> set[str]:
    """The states that the rules of a generated program wait for, read from its Python."""
    states = set()
    for function in ast.walk(ast.parse(python)):
        for call in getattr(function, "decorator_list", []):
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
                states |= states_of(call)
    return states


def states_of(call: ast.Call) -> set[str]:
    values = [ast.literal_eval(one) for one in call.args if isinstance(one, ast.Constant)]
    match call.func.attr:
        case "when":
            return set(values)
        case "when_heard":
            return {state_of_word(values[0])}
        case "when_noticed":
            return {state_of_thing(*values)}
        case "goal":
            options = {one.arg: one.value for one in call.keywords}
            named = (options[key] for key in ("when", "stop") if key in options)
            return {one.value for one in named if isinstance(one, ast.Constant)}  # no condition
    return set()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_there_is_a_cue_for_each_state_that_the_python_of_an_example_waits_for(path: Path) -> None:
    project = load(path, LANGUAGE)

    states = {cue.state for cue in cues_of(project, LANGUAGE)}

    assert waited_for(generate_program(project, LANGUAGE).text) <= states


def test_every_hat_that_waits_for_a_state_has_a_cue() -> None:
    hats = [d.id for d in LANGUAGE.definitions.values() if d.shape == "hat"]
    for hat in hats:
        if hat.startswith("my."):
            continue
        editor = build(LANGUAGE, [B(hat)], [B("goal.goal")])
        build(LANGUAGE, [B("robots.robot")], page="robots", editor=editor)

        states = {cue.state for cue in cues_of(editor.project, LANGUAGE)}

        assert waited_for(generate_program(editor.project, LANGUAGE).text) <= states, hat


def test_a_rule_that_hears_one_robot_only_is_sent_in_the_name_of_that_robot() -> None:
    hat = B("robot_events.touched", {"robot": "NAO2", "part": "head"})

    [cue] = cues_of(build(LANGUAGE, [hat]).project, LANGUAGE)

    assert (cue.state, cue.source, cue.kind) == ("touched_head", "NAO2", "touch")


def test_words_of_questions_are_cues_and_disabled_rules_are_not() -> None:
    question = B("robot_speech.ask", {"word.1": "yes"}, groups={"answer": 1})
    editor = build(LANGUAGE, [B("event.started"), question], [B("event.gesture")])
    last = editor.project.pages["behaviour"][-1].body[0]
    editor.project.blocks[last].disabled = True

    cues = cues_of(editor.project, LANGUAGE)

    assert [(cue.state, cue.words) for cue in cues] == [("heard_yes", "yes")]


def test_what_an_operator_arranged_stays_and_new_rules_come_after_it() -> None:
    kept = [Cue("b", colour="#112233"), Cue("own", is_own=True), Cue("gone"), Cue("a", key="1")]

    cues = arranged([Cue("a"), Cue("new"), Cue("b")], kept)

    assert [cue.state for cue in cues] == ["b", "own", "a", "new"]
    assert cues[0].colour == "#112233"
    assert cues[2].key == "1"


def test_cues_are_saved_with_the_project_and_can_be_taken_back(tmp_path: Path) -> None:
    editor = build(LANGUAGE, [B("event.gesture")])
    cues = [own_cue("storm"), own_cue("Good morning!", is_word=True)]
    editor.apply(SetExtra(KEY, to_keep(cues)))
    save(editor.project, tmp_path / "cues.nep")

    again = kept_cues(load(tmp_path / "cues.nep", LANGUAGE))
    editor.history.undo()

    assert again == cues
    assert [cue.state for cue in again] == ["storm", "heard_good_morning"]
    assert kept_cues(editor.project) == []


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 5) | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=6), inner),
    max_leaves=8,
)
ENTRIES = st.lists(
    st.fixed_dictionaries({}, optional={"state": JSON, "key": JSON, "kind": JSON, "label": JSON})
)


@given(JSON | ENTRIES)
def test_whatever_a_file_says_of_cues_what_is_kept_makes_sense(value: object) -> None:
    editor = build(LANGUAGE, [B("event.started")])
    editor.project.extra[KEY] = value

    cues = kept_cues(editor.project)

    assert all(cue.state and (cue.key in "123456789" or not cue.key) for cue in cues)
    assert len({cue.id for cue in cues}) == len(cues)
    assert kept_cues(editor.project) == [msgspec.convert(one, Cue) for one in to_keep(cues)]


@pytest.mark.parametrize("text", ["", "  ", "…", "two\nlines", "!?"])
def test_a_cue_needs_letters(text: str) -> None:
    with pytest.raises(EditRefused):
        own_cue(text)


@pytest.mark.parametrize("key", ["blocks", "name", "version", "", "two words"])
def test_nothing_is_kept_in_the_place_of_the_program(key: str) -> None:
    editor = build(LANGUAGE, [B("event.started")])

    with pytest.raises(EditRefused):
        editor.apply(SetExtra(key, [1]))


def test_what_cannot_be_written_or_is_too_much_is_refused() -> None:
    editor = build(LANGUAGE, [B("event.started")])
    deep: list[object] = []
    for _ in range(30):
        deep = [deep]

    for value in (object(), ["x" * 300_000], deep, "\ud800"):
        assert editor.why_not(SetExtra(KEY, value)) is not None

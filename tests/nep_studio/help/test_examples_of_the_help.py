"""Every example of the help loads, has no fault, becomes Python, and shows what it is to show."""

from __future__ import annotations

import re
import tomllib

import pytest

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import load, to_bytes
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.copying import paste
from nep_studio.blocks.program import PAGES, Project
from nep_studio.help import texts as help_examples
from nep_studio.help.texts import (
    Example,
    NotationError,
    example_of,
    examples,
    help_folder,
    translated_texts,
)
from nep_studio.run.installation import studio_language

LANGUAGE = studio_language()
ALL = sorted(examples())
OTHERS = sorted({path.parent.name for path in help_folder().glob("*/examples.toml")})
QUOTED = re.compile(r'"(?:[^"\\]|\\.)*"')


def project_of(name: str) -> Project:
    return examples()[name].project(LANGUAGE, "en", name)


def names_in(program: str) -> set[str]:
    return {tomllib.loads(f"text = {quoted}")["text"] for quoted in QUOTED.findall(program)}


def test_every_block_has_an_example():
    assert [block for block in LANGUAGE.definitions if example_of(block) is None] == []


@pytest.mark.parametrize("name", ALL)
def test_an_example_has_all_blocks_that_it_shows(name):
    project = project_of(name)

    types = {block.type for block in project.blocks.values()}

    assert set(examples()[name].blocks) <= types
    assert len(project.blocks) <= 16


@pytest.mark.parametrize("name", ALL)
def test_an_example_has_no_fault(name):
    problems = check(project_of(name), LANGUAGE)

    real = {p.kind for p in problems if p.kind != "needs_real_robot"}
    needs = any(
        "needs_real_robot" in LANGUAGE.definitions[b].flags for b in examples()[name].blocks
    )
    assert real == set()
    assert needs or not problems


@pytest.mark.parametrize("code", OTHERS)
def test_no_example_has_a_fault_in_another_language(code):
    projects = {name: example.project(LANGUAGE, code, name) for name, example in examples().items()}

    faults = {name: {p.kind for p in check(it, LANGUAGE)} for name, it in projects.items()}

    assert {name: kinds for name, kinds in faults.items() if kinds - {"needs_real_robot"}} == {}


@pytest.mark.parametrize("code", OTHERS)
def test_two_names_of_an_example_are_not_one_in_another_language(code):
    told = translated_texts(code)
    names = {name: names_in(example.program) for name, example in examples().items()}

    assert {
        name: each
        for name, each in names.items()
        if len({told.get(text, text) for text in each}) < len(each)
    } == {}


@pytest.mark.parametrize("name", ALL)
def test_an_example_becomes_python_and_is_the_same_when_it_is_saved(name, tmp_path):
    project = project_of(name)
    path = tmp_path / "example.nep"
    path.write_bytes(to_bytes(project))

    again = load(path, LANGUAGE)

    code = generate_program(again, LANGUAGE.of(again)).text
    assert code == generate_program(project, LANGUAGE.of(project)).text
    compile(code, name, "exec")


@pytest.mark.parametrize("name", ALL)
def test_an_example_can_be_put_into_a_program_page_by_page(name):
    editor = Editor(Project("Mine"), LANGUAGE)

    for page in PAGES:
        clip = examples()[name].clip(LANGUAGE, "en", page)
        if clip.stacks:
            paste(editor, clip, page, 40, 40)

    whole = examples()[name].clip(LANGUAGE, "en")
    assert len(editor.project.blocks) == len(whole.project.blocks)


def test_an_example_with_a_gesture_brings_a_watch_that_makes_it_and_a_node_that_knows_it():
    project = project_of("karate")

    launched = [b.fields for b in project.blocks.values() if b.type == "nodes.launch"]

    assert [fields["node"] for fields in launched] == [
        "sensory/virtual_watch",
        "perceptual/gesture",
    ]
    assert "karate" in launched[0]["parameters"]["gestures"]
    assert any(block.type == "robots.robot" for block in project.blocks.values())


def test_texts_of_examples_are_translated_and_words_are_not(monkeypatch):
    monkeypatch.setattr(
        help_examples, "translated_texts", lambda code: {"That tickles.": "Das kitzelt."}
    )

    project = examples()["touched_state"].project(LANGUAGE, "de", "x")

    values = [value for block in project.blocks.values() for value in block.fields.values()]
    assert "Das kitzelt." in values
    assert "touched_head" in values


def test_every_text_that_people_see_in_an_example_is_quoted():
    for example in examples().values():
        for word in re.findall(r"(?:text|question|word|item\.\d+)=([^\s)\"(]+)", example.program):
            assert word.replace(".", "").isdigit() or word == "en", (example.name, word)


@pytest.mark.parametrize(
    ("program", "why"),
    [
        ("robot.fly", "there is no block robot.fly"),
        ("robot.say text", "text has no value"),
        ("control.if condition=(logic.truth truth=true", "not closed"),
        ('robot.say text="a" )', "what is )"),
        ("robot.say\n  robot.say", "has no mouth"),
        ("robot.say §§ =", "no value"),
    ],
)
def test_a_fault_in_an_example_is_named(program, why):
    with pytest.raises(NotationError, match=re.escape(why)):
        Example("x", (), program).project(LANGUAGE, "en", "x")


def test_mouths_are_filled_in_the_order_of_the_lines():
    written = help_examples.read(
        "control.if condition=(logic.truth truth=true)\n"
        '  robot.say text="a"\n'
        "  control.repeat times=2\n"
        '    robot.say text="b"\n'
        " otherwise_do.1:\n"
        '  robot.say text="c"\n'
        'robot.say text="d"\n'
    )

    [[first, last]] = written.stacks
    assert [block.type for block in first.bodies[""]] == ["robot.say", "control.repeat"]
    assert first.bodies[""][1].bodies[""][0].values == {"text": "b"}
    assert first.bodies["otherwise_do.1"][0].values == {"text": "c"}
    assert last.values == {"text": "d"}


def test_words_without_a_place_and_kept_variables_are_written_down():
    example = Example(
        "x",
        (),
        'kept "best"\n'
        "event.started\n"
        'event.tell message="dance" wait=true\n'
        'variable.set variable="best" value=1\n'
        'variable.set variable="other" value=2\n',
    )

    project = example.project(LANGUAGE, "en", "x")

    code = generate_program(project, LANGUAGE.of(project)).text
    assert 'tell("dance", wait=True)' in code
    assert "kept.best = 1" in code
    assert "other = 2" in code and "kept.other" not in code

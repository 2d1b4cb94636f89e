"""A project is offered what its robots can, and told where a block asks its robot for more."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest
from block_building import B, build
from sound_programs import block_of, kinds, only

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField, SetFlag
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language, translated
from nep_studio.blocks.operations.fixes import apply_fix
from nep_studio.blocks.text import sentence
from nep_studio.run.installation import table_of

RESOURCES = Path(__file__).resolve().parents[2] / "resources"
ROBOTS = RESOURCES / "robots"
LISA = B("robots.robot", {"name": "Lisa", "driver": "virtual_pepper"})
NAO = B("robots.robot", {"name": "NAO", "driver": "virtual"})
SLOTS = {
    "postures": ("robot.do", "posture"),
    "say_gestures": ("robot.say", "gesture"),
    "animals": ("robot.imitate", "animal"),
    "animations": ("robot.play", "animation"),
}


def values(robot: str, table: str) -> list[str]:
    """The values that the file of a kind of robot has."""
    data = tomllib.loads((ROBOTS / robot / "robot.toml").read_text(encoding="utf-8"))
    return list(data["choices"][table])


def lacking(table: str) -> list[str]:
    pepper = values("pepper", table)
    return [value for value in values("nao", table) if value not in pepper]


def program(language: Language, robots: list[B], *blocks: B) -> Editor:
    editor = build(language, [B("event.started"), *blocks])
    if robots:
        build(language, robots, page="robots", editor=editor)
    return editor


def asks(table: str, value: str, robot: str = "Lisa") -> B:
    block, slot = SLOTS[table]
    return B(block, {"robot": robot, slot: value})


def offered(editor: Editor, table: str) -> list[str]:
    block, name = SLOTS[table]
    made = editor.project.blocks[block_of(editor, block)]
    slot = editor.language.definitions[block].slots[name]
    return list(editor.language.choices_of(slot, made, name))


@pytest.mark.parametrize("table", SLOTS)
@pytest.mark.parametrize(("kind", "entry"), [("nao", NAO), ("pepper", LISA)])
def test_one_robot_is_offered_what_it_can(
    language: Language, table: str, kind: str, entry: B
) -> None:
    name = str(entry.fields["name"])
    editor = program(language, [entry], asks(table, values("pepper", table)[0], name))

    assert offered(editor, table) == values(kind, table)
    assert list(editor.language.choices[table]) == values(kind, table)
    assert check(editor.project, language) == []


def test_a_project_without_a_robot_is_offered_what_a_nao_can(language: Language) -> None:
    editor = program(language, [], asks("animals", "dog"))

    assert offered(editor, "animals") == values("nao", "animals")


@pytest.mark.parametrize("table", SLOTS)
def test_of_several_robots_each_block_is_offered_what_its_own_can(
    language: Language, table: str
) -> None:
    value = values("pepper", table)[0]
    of = {
        robot: offered(program(language, [LISA, NAO], asks(table, value, robot)), table)
        for robot in ("NAO", "Lisa", "*", "Somebody")
    }

    assert of["NAO"] == values("nao", table) and of["Lisa"] == values("pepper", table)
    assert set(of["*"]) == set(of["Somebody"]) == set(values("nao", table))


@pytest.mark.parametrize(
    ("table", "value"), [(table, value) for table in SLOTS for value in lacking(table)]
)
def test_what_a_pepper_lacks_is_told_at_the_block(
    language: Language, table: str, value: str
) -> None:
    editor = program(language, [LISA], asks(table, value))

    problem = only(editor, language)

    assert (problem.kind, problem.severity) == ("robot_lacks", "error")
    assert problem.block == block_of(editor, SLOTS[table][0])
    label = language.choices[table][value]
    assert str(problem.sentence).endswith(f"“{label}” is not there for Lisa (Pepper).")
    assert [str(step) for step in problem.checklist] == [
        "Choose another one.",
        "Or choose another robot in this block.",
    ]


def test_so_much_does_a_pepper_lack() -> None:
    assert {table: len(lacking(table)) for table in SLOTS} == {
        "postures": 4,
        "say_gestures": 1,
        "animals": 9,
        "animations": 22,
    }


def test_the_fix_chooses_what_the_robot_has(language: Language) -> None:
    editor = program(language, [LISA], asks("animals", "dog"))
    problem = only(editor, language)

    block = apply_fix(editor, problem)

    assert problem.fix is not None and str(problem.fix.label) == "Choose “cat”"
    assert editor.project.blocks[block].fields["animal"] == "cat"
    assert check(editor.project, language) == []


def test_the_fix_lets_another_robot_do_it_that_can(language: Language) -> None:
    editor = program(language, [LISA, NAO], asks("animals", "dog"))
    problem = only(editor, language)

    block = apply_fix(editor, problem)

    assert problem.fix is not None and str(problem.fix.label) == "Let NAO do it"
    assert editor.project.blocks[block].fields["robot"] == "NAO"
    assert check(editor.project, language) == []


def test_what_all_robots_are_asked_each_of_them_must_have(language: Language) -> None:
    lisa_2 = B("robots.robot", {"name": "Mona", "driver": "virtual_pepper"})
    editor = program(language, [LISA, NAO, lisa_2], asks("animals", "dog", "*"))

    problem = only(editor, language)

    assert str(problem.sentence).endswith("is not there for Lisa (Pepper), Mona (Pepper).")
    assert problem.fix is not None and str(problem.fix.label) == "Choose “cat”"


def test_another_kind_of_robot_changes_at_once_what_is_offered_and_told(
    language: Language,
) -> None:
    editor = program(language, [NAO], asks("animals", "dog", "NAO"))
    robot, told = block_of(editor, "robots.robot"), []
    editor.history.listen(lambda changes: told.append(changes.whole))

    editor.apply(SetField(robot, "driver", "virtual_pepper"))
    as_pepper = offered(editor, "animals"), kinds(editor, language)
    editor.history.undo()

    assert as_pepper == (values("pepper", "animals"), ["robot_lacks"])
    assert offered(editor, "animals") == values("nao", "animals")
    assert kinds(editor, language) == []
    assert told == [True, True]


def test_a_robot_that_is_switched_off_counts_no_more(language: Language) -> None:
    editor = program(language, [LISA, NAO], asks("animals", "dog", "*"))
    before = kinds(editor, language)

    editor.apply(SetFlag(block_of(editor, "robots.robot"), "disabled", True))

    assert before == ["robot_lacks"] and kinds(editor, language) == []


def test_what_a_robot_lacks_keeps_its_words(language: Language) -> None:
    editor = program(language, [LISA], asks("postures", "posture_lying_back"))

    words = sentence(editor.project, language, block_of(editor, "robot.do"))

    assert str(words) == "Lisa takes the posture lie on the back"


def test_a_pepper_s_parts_of_the_body_are_those_that_it_has(language: Language) -> None:
    editor = program(language, [LISA])
    choices = editor.language.choices
    body = json.loads((ROBOTS / "pepper" / "body.json").read_text(encoding="utf-8"))

    joints = {name for part in choices["body_parts"] for name in choices[f"joints.{part}"]}

    assert list(choices["body_parts"]) == ["head", "left_arm", "right_arm", "legs"]
    assert joints == {joint["name"] for joint in body["joints"] if "Hand" not in joint["name"]}


def test_a_pepper_has_words_of_its_own_in_every_language(language: Language) -> None:
    for code in ("de", "es", "fr", "it", "ja"):
        table = table_of(code)
        editor = program(translated(language, table), [LISA])

        label = editor.language.choices["postures"]["posture_stand_init"]

        assert label == table["choices"]["pepper.postures"]["posture_stand_init"]
        assert label != table["choices"]["postures"]["posture_stand_init"]


def test_python_that_asks_for_what_the_robot_lacks_is_a_block_with_a_problem(
    language: Language,
) -> None:
    editor = program(language, [LISA], asks("animals", "cat"))
    code = generate_program(editor.project, language).text

    update_from_python(editor, code.replace('"cat"', '"dog"'))

    block = editor.project.blocks[block_of(editor, "robot.imitate")]
    assert block.fields["animal"] == "dog"
    assert kinds(editor, language) == ["robot_lacks"]

"""Block sentences in other languages: slots move, nothing is lost, wrong entries stay English."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from nep_studio import paths
from nep_studio.blocks.definitions import Group, SentenceError, Slot
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language, faults, translated, translated_parts
from nep_studio.blocks.text import sentence
from nep_studio.run.installation import studio_language, table_of
from tests.blocks.block_building import B, build

TABLES = sorted((paths.resources() / "translations").glob("*.toml"))


@pytest.fixture(scope="module")
def english() -> Language:
    return studio_language()


def names(parts) -> list[str]:
    return [p.name for p in parts if isinstance(p, Slot | Group)]


def test_slots_may_stand_elsewhere_in_a_translated_sentence(english: Language) -> None:
    say = english.definitions["robot.say"]

    parts = translated_parts(say, "{text} は {gesture} と {robot} が言う")

    assert names(parts) == ["text", "gesture", "robot"]
    assert parts[0] is say.slots["text"]


@pytest.mark.parametrize(
    "wrong",
    [
        "{robot} dice {text}",
        "{robot} {robot} dice {text} con {gesture}",
        "{robot} dice {text} con {gesture} {more}",
        "{robot} dice {text} con {gesture",
        "{robot} dice {text} con [more: {gesture}]",
        "{robot} dice {text} con {gesture} ]",
    ],
)
def test_a_sentence_with_other_slots_is_refused(english: Language, wrong: str) -> None:
    with pytest.raises(SentenceError):
        translated_parts(english.definitions["robot.say"], wrong)


def test_groups_keep_their_names_and_what_is_in_them(english: Language) -> None:
    definition = english.definitions["control.if"]

    parts = translated_parts(
        definition,
        "si {condition} {do} [also: si no, si {also_condition} {also_do}]"
        " [otherwise: si no {otherwise_do}]",
    )

    assert names(parts) == names(definition.parts)
    with pytest.raises(SentenceError):
        translated_parts(
            definition,
            "si {condition} {do} [also: {also_condition}] [otherwise: {otherwise_do} {also_do}]",
        )


def test_the_buttons_of_groups_say_the_translated_words(english: Language) -> None:
    spanish = translated(
        english,
        {
            "blocks": {
                "control.if": "si {condition} {do} [otherwise: si no {otherwise_do}]"
                " [also: o si {also_condition} {also_do}]"
            }
        },
    )

    groups = spanish.definitions["control.if"].groups

    assert list(groups) == list(english.definitions["control.if"].groups)
    assert [group.parts[0] for group in groups.values()] == ["o si", "si no"]


def test_a_program_reads_in_the_other_language_and_makes_the_same_code(english) -> None:
    spanish = translated(
        english,
        {
            "blocks": {"robot.say": "con {gesture} {robot} dice {text}", "control.wait": "{broken"},
            "choices": {"say_gestures": {"greet": "un saludo"}},
        },
    )
    blocks = [B("event.started"), B("robot.say", {"gesture": "greet"}), B("control.wait")]
    editor = build(english, blocks)
    _, say, wait = editor.project.pages["behaviour"][0].body

    assert sentence(editor.project, spanish, say) == "con un saludo NAO dice Hello"
    assert sentence(editor.project, spanish, wait) == "wait 1 seconds"
    assert generate_program(editor.project, spanish) == generate_program(editor.project, english)


@pytest.mark.parametrize("table", TABLES, ids=lambda path: path.stem)
def test_every_table_translates_every_block_category_and_choice(english, table) -> None:
    words = table_of(table.stem)

    assert [str(fault) for fault in faults(english, words, table.stem)] == []


def test_what_a_robot_calls_otherwise_than_nao_is_not_translated_with_its_words(
    english: Language,
) -> None:
    words = table_of("de")
    del words["choices"]["pepper.postures"]["posture_stand_init"]

    missing = [str(fault) for fault in faults(english, words, "de")]

    assert missing == ["pepper.postures.posture_stand_init: is not translated"]


def test_a_node_and_a_robot_bring_their_words_along_and_a_table_goes_before_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = 'type = "sensory"\nname = "door"\ntitle = "Door"\ndescription = "Says who comes."\n'
    robot = 'name = "pip"\ntitle = "Pip"\nnode = "action/nao"\n[translations.de.drivers]\n'
    files = {
        "nodes/sensory/door.py": "",
        "nodes/sensory/door.toml": node + 'titles = { de = "Tür", fr = "Porte" }\n',
        "resources/robots/pip/robot.toml": robot + 'virtual_pip = "ein Pip"\nother = "eigen"\n',
        "resources/translations/de.toml": '[choices.drivers]\nother = "aus der Tabelle"\n',
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    monkeypatch.setenv("NEP_NODES", str(tmp_path / "nodes"))
    monkeypatch.setattr(paths, "resources", lambda: tmp_path / "resources")

    choices = table_of("de")["choices"]

    assert choices["nodes"]["sensory/door"] == "Tür"
    assert choices["drivers"] == {"virtual_pip": "ein Pip", "other": "aus der Tabelle"}


def test_a_block_may_bring_its_translation_and_a_table_goes_before_it(english: Language) -> None:
    off = english.definitions["robot_lights.off"]
    own = replace(off, translations={"es": "{robot} apaga {group}", "it": "{robot} spegne"})
    brought = replace(
        english, definitions={own.id: own}, categories=(), choices={}, profiles=english.profiles[:1]
    )
    table = {"blocks": {own.id: "apagar {group} de {robot}"}}

    alone = translated(brought, {}, "es").definitions[own.id]
    beside = translated(brought, table, "es").definitions[own.id]

    assert names(alone.parts) == ["robot", "group"]
    assert names(beside.parts) == ["group", "robot"]
    assert translated(brought, {}, "fr").definitions[own.id].parts == off.parts
    assert list(faults(brought, {}, "es")) == []
    assert [fault.place for fault in faults(brought, {}, "it")] == [own.id]


@pytest.mark.parametrize(
    ("code", "colour", "name"),
    [
        ("en", "#ff0000", "red"),
        ("en", "#3060ff", "blue"),
        ("de", "#00AAFF", "Himmelblau"),
        ("ja", "#fefefe", "白"),
    ],
)
def test_a_colour_is_told_by_the_name_of_one_that_looks_like_it(
    code: str, colour: str, name: str
) -> None:
    language = studio_language(code)
    lights = B("robot_lights.fade", {"colour": colour})
    project = build(language, [B("event.started"), lights]).project
    block = next(one.id for one in project.blocks.values() if one.type == lights.type)

    told = sentence(project, language, block)

    assert name in told and colour not in told

"""Block definitions: what the product ships is right, and what is wrong is told with its place."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from block_building import B, build

from nep_core import Robot
from nep_studio.blocks.definition_files import load_profile
from nep_studio.blocks.definitions import Group, SentenceError, Slot, parse
from nep_studio.blocks.errors import DefinitionError
from nep_studio.blocks.from_python.naming import SourceNames
from nep_studio.blocks.from_python.values import ValueReader
from nep_studio.blocks.generate.names import API
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.text import sentence
from nep_studio.run.installation import load_language

ROBOT = Path(__file__).resolve().parents[2] / "resources" / "robots" / "nao" / "robot.toml"
HEAD = '[category]\nid = "my"\ntitle = "My"\ncolour = "my"\norder = 1\n'
GOOD = 'sentence = "{robot:robot} sings {text:text}"\nshape = "statement"\n'
DEFAULTS = 'defaults = { robot = "NAO", text = "la" }\n'
CALL = 'call = { on = "robot", method = "sing", arguments = ["text"] }\n'


def load(tmp_path: Path, *lines: str, head: str = HEAD):
    (tmp_path / "my.toml").write_text(head + "[blocks.sing]\n" + "".join(lines), encoding="utf-8")
    return load_language(tmp_path, ROBOT)


def test_a_pack_of_blocks_is_data_only(tmp_path):
    language = load(tmp_path, GOOD, DEFAULTS, CALL)

    assert list(language.definitions) == ["my.sing"]
    assert language.definitions["my.sing"].new_block("b1").fields == {"robot": "NAO", "text": "la"}


@pytest.mark.parametrize(
    ("lines", "reason"),
    [
        ((DEFAULTS, CALL), "it needs a sentence"),
        (('sentence = "a {b:nothing}"\nshape = "statement"\n',), "has no kind “nothing”"),
        (('sentence = "a {b"\nshape = "statement"\n',), "cannot be understood"),
        (('sentence = "{b:text} {b:text}"\nshape = "statement"\n',), "slot “b” is there twice"),
        (('sentence = "[a: x"\nshape = "statement"\n',), "is not closed"),
        (('sentence = "x ]*"\nshape = "statement"\n',), "without its"),
        (('sentence = "[a: [b: x]* ]*"\nshape = "statement"\n',), "is inside group"),
        (('sentence = "{b:choice}"\nshape = "statement"\n',), "a choice names its table"),
        (('sentence = "x"\nshape = "round"\n', CALL.replace('"text"', "")), "slot “robot”"),
        (('sentence = "x"\nshape = "round"\ngenerator = "if"\n',), "its shape is one of"),
        (('sentence = "x"\nshape = "reporter"\ngenerator = "text"\n',), "has a result"),
        (('sentence = "{a:body}"\nshape = "statement"\ngenerator = "if"\n',), "has the shape c"),
        ((GOOD, DEFAULTS, CALL, 'flags = ["fast"]\n'), "there is no flag “fast”"),
        ((GOOD, DEFAULTS, CALL, 'flags = ["posture"]\n'), "needs a slot “posture”"),
        ((GOOD, CALL), "slot “robot” needs a default"),
        ((GOOD, 'defaults = { robot = "NAO", text = 5 }\n', CALL), "default “text”: A text is"),
        ((GOOD, 'defaults = { robot = "NAO", text = "", x = 1 }\n', CALL), "default “x” is not"),
        ((GOOD, "defaults = 5\n", CALL), "must be tables"),
        ((GOOD, DEFAULTS, CALL, "minimum = { a = 1 }\n"), "minimum “a” does not fit"),
        ((GOOD, DEFAULTS), "either a call or a generator"),
        ((GOOD, DEFAULTS, CALL, 'generator = "if"\n'), "either a call or a generator"),
        ((GOOD, DEFAULTS, 'generator = "sing"\n'), "there is no statement generator “sing”"),
        ((GOOD, DEFAULTS, CALL.replace("sing", "sing()")), "is not the name of a function"),
        ((GOOD, DEFAULTS, CALL.replace("sing", "__class__")), "is not the name of a function"),
        ((GOOD, DEFAULTS, CALL.replace("sing", "import")), "is not the name of a function"),
        ((GOOD, DEFAULTS, CALL.replace('["text"]', '["song"]')), "uses slot “song”"),
        ((GOOD, DEFAULTS, CALL.replace('"robot"', '"text"')), "called on a robot slot"),
        ((GOOD, DEFAULTS, CALL.replace("on", "off")), "call has no key “off”"),
        ((GOOD, DEFAULTS, CALL.replace(" }", ", constants = 1 }")), "constants must be a table"),
        ((GOOD, DEFAULTS, CALL.replace(" }", ", constants = { a = [] } }")), "the constant “a”"),
        (
            (
                GOOD,
                DEFAULTS,
                CALL.replace(" }", ', keywords = { a = "text" }, constants = { a = 1 } }'),
            ),
            "“a” is a keyword and a constant",
        ),
        ((GOOD, DEFAULTS, CALL, "translations = 5\n"), "must be tables"),
        ((GOOD, DEFAULTS, CALL, "translations = { de = 5 }\n"), "sentences by their language"),
        ((GOOD, DEFAULTS, "call = { arguments = [] }\n"), "either a function, or a method"),
        ((GOOD, DEFAULTS, 'call = { function = "exec" }\n'), "nep_core has no function “exec”"),
        ((GOOD, DEFAULTS, 'call = { function = "Robot" }\n'), "nep_core has no function “Robot”"),
        ((GOOD, DEFAULTS, CALL, 'code = "import os"\n'), "a key “code” that is not known"),
    ],
)
def test_what_is_wrong_with_a_definition_is_told_with_file_and_block(tmp_path, lines, reason):
    with pytest.raises(DefinitionError) as refused:
        load(tmp_path, *lines)

    assert reason in str(refused.value.sentence)
    assert str(refused.value.sentence).startswith("In my.toml, block “sing”")


def test_a_block_brings_what_is_the_same_in_every_call_and_python_becomes_it_again(tmp_path):
    call = CALL.replace(" }", ', constants = { loud = true, pitch = -0.5, voice = "low" } }')
    plain = "[blocks.plain]\n" + GOOD.replace("sings", "plainly sings") + DEFAULTS + CALL
    begin = '[blocks.begin]\nsentence = "begin"\nshape = "hat"\ngenerator = "when_started"\n'
    language = load(tmp_path, GOOD, DEFAULTS, call, plain, begin)
    code = 'nao.sing("la", loud=True, pitch=-0.5, voice="low")'
    reader = ValueReader(language, SourceNames(robots={"nao": "NAO"}))

    editor = build(language, [B("my.begin"), B("my.sing")])
    made = [one.type for one in reader.called(ast.parse(code, mode="eval").body)]
    others = ast.parse('nao.sing("la", loud=1, pitch=-0.5, voice="low")', mode="eval").body

    assert code in generate_program(editor.project, language).text
    assert made == ["my.sing"]
    assert list(reader.called(others)) == []


@pytest.mark.parametrize(
    ("head", "reason"),
    [
        ("", "needs a [category]"),
        (HEAD.replace("order = 1", ""), "needs a title, a colour and an order"),
        (HEAD + 'page = "attic"\n', "the page is one of"),
        (HEAD + "[choices.a]\nb = 5\n", "choice “b” of a has no label"),
        (HEAD + "[choices]\na = 5\n", "[choices] must hold tables"),
        (HEAD + "= 5\n", "cannot be read"),
        (HEAD.replace("order = 1", "order = []"), "needs a title, a colour and an order"),
    ],
)
def test_what_is_wrong_with_a_category_is_told_with_its_file(tmp_path, head, reason):
    with pytest.raises(DefinitionError) as refused:
        load(tmp_path, GOOD, DEFAULTS, CALL, head=head)

    assert reason in str(refused.value.sentence) and "my.toml" in str(refused.value.sentence)


def test_a_folder_without_definitions_and_a_robot_without_a_name_are_told(tmp_path):
    with pytest.raises(DefinitionError, match="no block definitions"):
        load_language(tmp_path, ROBOT)
    robot = tmp_path / "robot.toml"
    robot.write_text('name = "x"\n')
    with pytest.raises(DefinitionError, match=r"robot\.toml needs a name, a title and a node"):
        load_profile(robot)


def test_two_files_cannot_define_the_same_block(tmp_path):
    (tmp_path / "other.toml").write_text(HEAD + "[blocks.sing]\n" + GOOD + DEFAULTS + CALL)

    with pytest.raises(DefinitionError, match=r"block “my\.sing” is defined twice"):
        load(tmp_path, GOOD, DEFAULTS, CALL)


def test_a_pack_cannot_change_the_choices_of_another(tmp_path):
    (tmp_path / "a.toml").write_text(HEAD + '[choices.again]\nnever = "never"\n')

    with pytest.raises(DefinitionError, match="the choices “again” are defined twice"):
        load(tmp_path, GOOD, DEFAULTS, CALL, head=HEAD + '[choices.again]\nalways = "x"\n')


def test_a_sentence_keeps_words_slots_and_groups_in_order():
    parts = parse("if {condition:boolean} {do:body} [also: else if {c:boolean}]* [e: else]?")

    kinds = [type(part) for part in parts]
    assert kinds == [str, Slot, Slot, Group, Group]
    assert [part.maximum for part in parts if isinstance(part, Group)] == [20, 1]
    with pytest.raises(SentenceError):
        parse("{a:text")


def test_the_blocks_of_the_product_call_only_what_programs_may(language):
    methods = {name for name in dir(Robot) if not name.startswith("_")}
    for definition in language.definitions.values():
        if definition.call is not None:
            known = methods if definition.call.on else API
            assert definition.call.name in known, definition.id
        assert definition.help


def test_the_choices_of_the_product_are_all_there(language):
    tables = {
        slot.table
        for definition in language.definitions.values()
        for slot in definition.slots.values()
        if slot.table and not slot.master
    }
    for table in tables:
        assert language.choices.get(table), table
    for definition in language.definitions.values():
        for slot in definition.slots.values():
            default = definition.defaults.get(slot.name)
            made = definition.new_block("b1")
            assert slot.kind.name != "choice" or default in language.choices_of(slot, made)
    assert language.profile.standing == {
        "posture_stand",
        "posture_stand_init",
        "posture_stand_zero",
    }


def test_every_block_of_the_behaviour_page_makes_python_as_it_comes_from_the_palette(language):
    for definition in language.definitions.values():
        if definition.page != "behaviour" or "variable" in definition.slots:
            continue
        if definition.id == "my.return":  # belongs into an own block; see test_own_blocks.py
            continue
        if "rule" in definition.slots:  # a rule is to be chosen; see test_rules_that_talk.py
            continue
        block = B(definition.id)
        if definition.shape == "hat":
            stack = [block]
        elif definition.result == "boolean":
            stack = [B("event.started"), B("control.while", inputs={"condition": block})]
        elif definition.result == "number":
            stack = [B("event.started"), B("control.wait", inputs={"seconds": block})]
        elif definition.is_value:
            stack = [B("event.started"), B("robot.say", inputs={"text": block})]
        elif "in_loop" in definition.flags:
            stack = [B("event.started"), B("control.repeat", bodies={"do": [block]})]
        else:
            stack = [B("event.started"), block]
        project = build(language, stack).project

        ast.parse(generate_program(project, language).text)
        assert all(sentence(project, language, block_id) for block_id in project.blocks)


def test_blocks_are_sentences_in_plain_text(language):
    say = B("robot.say", {"text": "Impressive!", "gesture": "explain"})
    times = B("math.arithmetic", {"b": 1}, {"a": B("variable.get", {"variable": "v1"})})
    repeat = B("control.repeat", inputs={"times": times}, bodies={"do": [say]})
    fork = B("control.if", groups={"also": 1, "otherwise": 1})
    stop = B("robot.stop", {"robot": "*"})
    editor = build(language, [B("event.started"), repeat, fork, stop], variables=("times",))
    told = {
        block.type: sentence(editor.project, language, block.id)
        for block in editor.project.blocks.values()
    }

    assert told["robot.say"] == "NAO says Impressive! with an explanation"
    assert told["control.repeat"] == "repeat times + 1 times"
    assert told["control.if"] == "if … else if … else"
    assert told["robot.stop"] == "all robots stops what it is doing"


def test_long_and_deep_sentences_are_cut(language):
    value = B("logic.truth")
    for _ in range(50):
        value = B("logic.not", inputs={"a": value})
    editor = build(
        language,
        [B("control.while", inputs={"condition": value})],
        [B("robot.say", {"text": "x" * 999})],
    )

    for block in editor.project.blocks:
        assert len(sentence(editor.project, language, block)) <= 120

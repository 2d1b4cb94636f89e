"""Own blocks: made, called, changed with all that call them, checked, saved, written as Python."""

from __future__ import annotations

import pytest
from block_building import B, build
from sound_programs import kinds

from nep_studio.blocks.checks import check
from nep_studio.blocks.edit_rules import why_not_delete_procedure
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import RemoveProcedure, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.errors import CodeRefused, EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import ProgramGenerator, generate_program
from nep_studio.blocks.places import InInput, InStack, procedure_uses, variable_uses
from nep_studio.blocks.procedures import OWN_CATEGORY
from nep_studio.blocks.program import Parameter, Project
from nep_studio.blocks.text import sentence

GREETING = '''\
"""Untitled. Made with NEP Studio."""
from nep_core import Behavior, Robot

nao = Robot("NAO")
behavior = Behavior("Untitled")


def greet_times(who, times):
    for _ in range(times):
        nao.say(f"Hello {who}")


@behavior.when_started
def when_started():
    greet_times("Ada", 2)


behavior.run()
'''


@pytest.fixture
def greeting(language) -> tuple[Editor, str, Parameter, Parameter]:
    """An own block “greet (who) (times) times” with its definition, called by a rule."""
    editor = Editor(Project(), language)
    who, times = editor.new_parameter("who", "text"), editor.new_parameter("times", "number")
    own = editor.add_procedure(["greet", who, times, "times"])
    said = B("text.join", {"item.1": "Hello "}, {"item.2": B(f"my.parameter.{own}.{who.id}")})
    body = B(
        "control.repeat",
        inputs={"times": B(f"my.parameter.{own}.{times.id}")},
        bodies={"do": [B("robot.say", inputs={"text": said})]},
    )
    call = B(f"my.call.{own}", {who.id: "Ada", times.id: 2})
    build(language, [B(f"my.define.{own}"), body], [B("event.started"), call], editor=editor)
    return editor, own, who, times


def block(editor: Editor, block_type: str) -> str:
    return next(b.id for b in editor.project.blocks.values() if b.type == block_type)


def test_an_own_block_is_a_plain_function_before_the_rules(language, greeting):
    editor, *_ = greeting

    assert generate_program(editor.project, language).text == GREETING


def test_an_own_block_is_a_sentence_with_its_values(language, greeting):
    editor, own, *_ = greeting

    assert sentence(editor.project, language, block(editor, f"my.call.{own}")) == (
        "greet Ada 2 times"
    )
    header = editor.project.blocks[block(editor, f"my.define.{own}")]
    assert sentence(editor.project, language, header.id) == "define greet who times times"


def test_own_blocks_are_saved_and_read(language, greeting):
    editor, *_ = greeting

    loaded = from_bytes(to_bytes(editor.project), "x.nep", language)

    assert to_bytes(loaded) == to_bytes(editor.project)
    assert loaded.procedures == editor.project.procedures
    assert generate_program(loaded, language).text == GREETING


def test_changing_the_sentence_changes_all_calls_in_one_step(language, greeting):
    editor, own, who, times = greeting
    generator = ProgramGenerator(editor.project, language)
    generator.generate()
    before = to_bytes(editor.project)
    renamed = Parameter(who.id, "name", "text")

    editor.change_procedure(own, [times, "times hello to", renamed], gives_value=False)

    text = generator.generate().text
    assert 'times_hello_to(2, "Ada")' in text and "def times_hello_to(times, name):" in text
    editor.history.undo()
    assert to_bytes(editor.project) == before and generator.generate().text == GREETING


def test_what_was_in_a_parameter_that_goes_lies_beside(language, greeting):
    editor, own, who, times = greeting
    call = block(editor, f"my.call.{own}")
    editor.create("math.random_integer", InInput(call, times.id))
    stacks = len(editor.project.stacks)
    before = to_bytes(editor.project)

    editor.change_procedure(own, ["greet", who], gives_value=False)

    assert len(editor.project.stacks) == stacks + 1
    assert editor.project.blocks[call].fields == {who.id: "Ada"}
    assert "unknown_own_block" in kinds(editor, language)  # the value that the loop still has
    reloaded = from_bytes(to_bytes(editor.project), "x.nep", language)
    assert to_bytes(reloaded) == to_bytes(editor.project)
    editor.history.undo()
    assert to_bytes(editor.project) == before


def test_a_call_that_comes_to_give_a_value_leaves_its_chain(language, greeting):
    editor, own, who, times = greeting

    editor.change_procedure(own, ["greet", who, times, "times"], gives_value=True)

    call = block(editor, f"my.call.{own}")
    assert editor.project.stack_of(call).body == [call]
    assert "gives_nothing" in kinds(editor, language)


def test_a_value_that_is_given_back_is_used_where_the_call_is(language):
    editor = Editor(Project(), language)
    n = editor.new_parameter("n", "number")
    own = editor.add_procedure(["double", n], gives_value=True)
    twice = B("math.arithmetic", {"operation": "multiply", "b": 2})
    twice.inputs["a"] = B(f"my.parameter.{own}.{n.id}")
    double = [B(f"my.define.{own}"), B("my.return", inputs={"value": twice})]
    wait = B("control.wait", inputs={"seconds": B(f"my.call.{own}", {n.id: 3})})
    build(language, double, [B("event.started"), wait], editor=editor)

    text = generate_program(editor.project, language).text

    assert "def double(n):\n    return n * 2\n" in text and "wait(double(3))" in text


@pytest.mark.parametrize("inside", [[], [B("control.note")]])
def test_an_own_block_that_goes_on_forever_gives_nothing_back(language, inside):
    editor = Editor(Project(), language)
    own = editor.add_procedure(["wait for me"], gives_value=True)
    forever = B("control.forever", bodies={"do": inside})
    build(language, [B(f"my.define.{own}"), forever], editor=editor)

    assert "return" not in generate_program(editor.project, language).text


def test_an_own_block_in_use_is_not_deleted_and_says_where(language, greeting):
    editor, own, *_ = greeting

    with pytest.raises(EditRefused, match="used in 1 place"):
        editor.delete_procedure(own)
    with pytest.raises(EditRefused, match="still used"):
        editor.apply(RemoveProcedure(own))
    assert procedure_uses(editor.project, own) == [block(editor, f"my.call.{own}")]


def test_an_own_block_is_deleted_with_its_definition(language, greeting):
    editor, own, *_ = greeting
    before = to_bytes(editor.project)
    with editor.transaction("delete"):
        editor.apply(DeleteBlocks(block(editor, f"my.call.{own}")))
        assert why_not_delete_procedure(editor.project, own) is None
        editor.delete_procedure(own)

    assert not editor.project.procedures
    assert not any(t.startswith("my.call") for t in editor.language.definitions)
    editor.history.undo()
    assert to_bytes(editor.project) == before
    assert f"my.call.{own}" in editor.language.definitions


def test_the_language_of_an_editor_follows_undo_and_redo(language):
    editor = Editor(Project(), language)
    same = editor.language
    own = editor.add_procedure(["dance"])
    assert f"my.call.{own}" in same.definitions

    editor.history.undo()
    assert f"my.call.{own}" not in same.definitions
    editor.history.redo()
    assert f"my.call.{own}" in same.definitions and editor.language is same
    assert f"my.call.{own}" not in language.definitions


def test_an_own_block_has_one_definition(language, greeting):
    editor, own, *_ = greeting

    with pytest.raises(EditRefused, match="one definition"):
        editor.create(f"my.define.{own}", editor.new_stack("behaviour", 0, 0))


def test_what_is_wrong_with_own_blocks_is_told(language, greeting):
    editor, own, who, _ = greeting
    stray = B("robot.say", inputs={"text": B(f"my.parameter.{own}.{who.id}")})
    build(language, [B("event.gesture"), stray, B("my.return")], editor=editor)

    assert {"parameter_outside", "outside_own_block"} <= set(kinds(editor, language))
    with pytest.raises(CodeRefused, match="known only inside"):
        generate_program(editor.project, language)


def test_a_call_without_a_definition_and_one_of_itself_are_told(language, greeting):
    editor, own, *_ = greeting
    header = block(editor, f"my.define.{own}")
    build(language, [B("event.gesture"), B(f"my.call.{own}")], editor=editor)
    again = editor.project.stack_of(header).id
    editor.create(f"my.call.{own}", InStack(again, 2))
    assert "calls_itself" in kinds(editor, language)

    editor.apply(SetFlag(header, "disabled", True))
    problem = next(p for p in check(editor.project, language) if p.kind == "no_definition")
    assert problem.severity == "error" and "greet (who) (times) times" in str(problem.sentence)


def test_the_uses_of_a_variable_are_found(language):
    loop = B("control.count", {"variable": "v1"}, bodies={"do": [B("variable.change")]})
    editor = build(language, [B("event.started"), loop], variables=("n",))

    assert variable_uses(editor.project, "v1") == [block(editor, "control.count")]


def test_the_category_of_own_blocks_is_the_one_of_the_palette(language):
    assert OWN_CATEGORY in language.categories

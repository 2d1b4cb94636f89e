"""Behaviour trees that others made: what blocks have no part for plays as in BehaviorTree.CPP.

What is expected here is what version 4 of the library does with the same trees; but of parts side
by side ours asks all in one look, as py_trees does, also when one has failed already.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_trees_language import Grower, stand_ins

import nep_core
from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.blocks.tree_files.elements import read_elements, read_file
from nep_studio.blocks.tree_files.reading import import_trees
from nep_studio.blocks.tree_files.writing import export_trees

__all__ = ["stand_ins"]

MODELS = """<TreeNodesModel><Condition ID="P"/><Condition ID="Q"/></TreeNodesModel>"""


def imported(language: Language, text: str) -> tuple[Editor, list[str]]:
    editor = Editor(Project("Trees"), language)
    told = import_trees(editor, read_elements(text.encode())).told
    assert not check(editor.project, editor.language)
    return editor, [str(one) for one in told]


def program(editor: Editor) -> str:
    return generate_program(editor.project, editor.language).text


def exported(editor: Editor) -> str:
    return export_trees(editor.project, editor.language).text


def one_tree(body: str) -> str:
    return f'<root BTCPP_format="4"><BehaviorTree ID="outer">{body}</BehaviorTree>{MODELS}</root>'


def played(text: str, failing: str = "", no: str = "") -> str:
    """What is done in a program whose own blocks are filled in, and how its tree ends.

    The own blocks in ``failing`` fail; one with a number after it so many times. ``no`` are the
    conditions that say no.
    """
    left = {one.rstrip("0123456789"): one for one in failing.split()}
    seen: list[str] = []

    def does(name: str) -> None:
        seen.append(name)
        times = left.get(name, "").removeprefix(name)
        if name in left and (not times or seen.count(name) <= int(times)):
            nep_core.fail_step()

    def answers(name: str) -> bool:
        seen.append(name)
        return name not in no.split()

    filled = re.sub(r"(def (\w+)\(.*\):\n)    # fill in .*\n", r"\1    does('\2')\n", text)
    filled = re.sub(
        r"(def (\w+)\(.*\):\n)    # find out .*\n((?:    set_.*\n)*)    return True\n",
        r"\1\3    return answers('\2')\n",
        filled,
    )
    Grower.end = None
    exec(
        compile(filled, "program.py", "exec"),
        {"__name__": "__main__", "does": does, "answers": answers},
    )
    return " ".join([*seen, str(Grower.end)])


X = '<Sequence><Script code="x := 2"/>{}</Sequence>'
PLAYED = [
    ("<IfThenElse><P/><A/><B/></IfThenElse>", "", "", "P A succeeded"),
    ("<IfThenElse><P/><A/><B/></IfThenElse>", "A", "", "P A failed"),
    ("<IfThenElse><P/><A/><B/></IfThenElse>", "", "P", "P B succeeded"),
    ("<IfThenElse><P/><A/></IfThenElse>", "", "P", "P failed"),
    (
        "<IfThenElse><P/><ForceSuccess><A/></ForceSuccess><B/></IfThenElse>",
        "A",
        "",
        "P A succeeded",
    ),
    ("<WhileDoElse><P/><A/><B/></WhileDoElse>", "", "P", "P P B succeeded"),
    ("<WhileDoElse><P/><A/><B/></WhileDoElse>", "A", "", "P A P failed"),
    ("<WhileDoElse><P/><A/></WhileDoElse>", "", "P", "P failed"),
    (
        X.format('<Switch2 variable="{x}" case_1="1" case_2="2"><A/><B/><C/></Switch2>'),
        "B",
        "",
        "B failed",
    ),
    (
        X.format('<Switch2 variable="{x}" case_1="1" case_2="3"><A/><B/><C/></Switch2>'),
        "",
        "",
        "C succeeded",
    ),
    (X.format('<A _skipIf="x == 2"/><B/>'), "", "", "B succeeded"),
    (X.format('<Fallback><A _skipIf="x == 2"/><B/></Fallback>'), "", "", "B succeeded"),
    (X.format('<Fallback><A _skipIf="x == 1"/><B/></Fallback>'), "", "", "A succeeded"),
    (X.format('<Fallback><A _while="x != 2"/><B/></Fallback>'), "", "", "B succeeded"),
    (X.format('<A _while="x == 2"/><B _failureIf="x == 2"/>'), "", "", "A failed"),
    (X.format('<A _successIf="x == 2"/><B/>'), "", "", "B succeeded"),
    (
        X.format('<Inverter><A _onFailure="x := 3" _post="x += 1"/></Inverter><B _skipIf="x==4"/>'),
        "A",
        "",
        "A succeeded",
    ),
    (X.format('<A _onSuccess="x := 5"/><ScriptCondition code="x == 5"/>'), "", "", "A succeeded"),
    (X.format('<Precondition if="x == 1" else="SUCCESS"><A/></Precondition>'), "", "", "succeeded"),
    (X.format('<Precondition if="x == 2" else="SUCCESS"><A/></Precondition>'), "A", "", "A failed"),
    (
        X.format('<BlackboardCheckInt value_A="{x}" value_B="1"><A/></BlackboardCheckInt>'),
        "",
        "",
        "failed",
    ),
    (
        '<RecoveryNode number_of_retries="2"><A/><B/></RecoveryNode>',
        "A2",
        "",
        "A B A B A succeeded",
    ),
    ('<RecoveryNode number_of_retries="1"><A/><B/></RecoveryNode>', "A", "", "A B A failed"),
    ('<RecoveryNode number_of_retries="9"><A/><B/></RecoveryNode>', "A B", "", "A B failed"),
    ('<Repeat num_cycles="3"><RunOnce><A/></RunOnce></Repeat>', "", "", "A succeeded"),
    ('<ParallelAll max_failures="2"><A/><B/><C/></ParallelAll>', "A", "", "A B C succeeded"),
    ('<ParallelAll max_failures="2"><A/><B/><C/></ParallelAll>', "A B", "", "A B C failed"),
    ('<Parallel success_count="1" failure_count="2"><A/><B/></Parallel>', "A", "", "A B succeeded"),
    ('<Parallel success_count="2" failure_count="1"><A/><B/></Parallel>', "A", "", "A B failed"),
    ('<Control ID="Fallback"><Decorator ID="Inverter"><A/></Decorator><B/></Control>', "", "",
     "A B succeeded"),
    ("<Root><Fallback><P/><A/></Fallback></Root>", "", "P", "P A succeeded"),
    ("<RoundRobin><A/><B/></RoundRobin>", "A", "", "A B succeeded"),
    ("<ReactiveSequence><A/><P/><B/></ReactiveSequence>", "", "", "A P B succeeded"),
    ('<ReactiveSequence><Script code="n := 1"/><A/></ReactiveSequence>', "", "", "A succeeded"),
]  # fmt: skip


@pytest.mark.usefixtures("stand_ins")
@pytest.mark.parametrize(("body", "failing", "no", "done"), PLAYED)
def test_it_plays_as_in_the_library_and_goes_out_and_in_again(
    language: Language, body: str, failing: str, no: str, done: str
) -> None:
    editor, _ = imported(language, one_tree(body))
    text = program(editor)
    out = exported(editor)

    assert played(text, failing, no) == done
    assert program(imported(language, out)[0]) == text
    again = Editor(Project("Trees"), language)
    update_from_python(again, text)
    assert exported(again) == out


@pytest.mark.parametrize(
    ("code", "python"),
    [
        ("a == 1 && b != 'no'", '1) and tree_value("b") != "no"'),
        ("a > 1.5 || !(b)", 'is_more(tree_value("a"), 1.5) or not'),
        ("(a + 1) * 2 <= 8", '(as_number(tree_value("a")) + 1) * 2 <= 8'),
        ("a == IDLE", '"IDLE"'),
        ("true", "Check(lambda: True)"),
    ],
)
def test_scripts_become_conditions_and_are_written_again(
    language: Language, code: str, python: str
) -> None:
    escaped = code.replace("&", "&amp;").replace("<", "&lt;")
    body = f'<Script code="a := 1; b := true"/><ScriptCondition code="{escaped}"/>'
    editor, told = imported(language, one_tree(f"<Sequence>{body}</Sequence>"))

    assert python in program(editor)
    assert all("name of C++" in one for one in told)
    assert program(imported(language, exported(editor))[0]) == program(editor)


@pytest.mark.parametrize("code", ["a & 1", "a ==", "foo(a)", "a := 1; b", "((", "'a' + 'b'"])
def test_a_script_that_blocks_cannot_say_is_told_and_kept(language: Language, code: str) -> None:
    escaped = code.replace("&", "&amp;")
    editor, told = imported(language, one_tree(f'<ScriptCondition code="{escaped}"/>'))

    assert f"The script “{code}” is more than blocks can read." in told
    assert f'<Condition ID="{escaped}"/>' in exported(editor)


def test_a_long_script_is_kept_under_a_shorter_name(language: Language) -> None:
    code = "x := y ~ 1; " * 20
    editor, told = imported(language, one_tree(f'<Script code="{code}"/>'))

    assert "more than blocks can read" in told[-1]
    assert f'<Action ID="{code[:80]}' in exported(editor)


SHARED = """<root BTCPP_format="4" main_tree_to_execute="outer">
<BehaviorTree ID="outer"><Sequence>
  <Script code="door := 'shut'; @all := 1"/>
  <SubTree ID="Open" _autoremap="true"/>
  <Say text="{door}" how="${all_right}"/>
</Sequence></BehaviorTree>
<BehaviorTree ID="Open" _description="Opens a door"><Sequence>
  <Look door="{door}" at="{goal}"/>
  <Script code="door := 'open'; all_right := @all"/>
</Sequence></BehaviorTree>
<TreeNodesModel>
  <Action ID="Say"><input_port name="text"/><input_port name="how"/>
    <input_port name="loud" default="3"/><input_port name="speed"/></Action>
</TreeNodesModel></root>"""


@pytest.mark.usefixtures("stand_ins")
def test_trees_share_values_as_the_file_says(language: Language) -> None:
    editor, told = imported(language, SHARED)
    text = program(editor)

    assert told == ["Nothing in the file sets “goal”: the first step of “outer” does it."]
    for port in ("door", "goal", "@all"):
        assert f'Input("{port}", lambda: tree_value("{port}"))' in text
    assert 'Output("all_right", "all_right")' in text
    assert 'Say(tree_value("door"), tree_value("all_right"), 3, "")' in text
    assert "# Opens a door" in text
    assert played(text) == "Look Say succeeded"
    out = exported(editor)
    assert 'loud="3"' in out and "speed=" not in out.split("<TreeNodesModel>")[0]
    assert "@all=" not in out
    assert program(imported(language, out)[0]) == text


VERSION_3 = """<root main_tree_to_execute="outer">
<BehaviorTree ID="outer"><Sequence>
  <SetBlackboard output_key="move_goal" value="1;2;3"/>
  <SubTree ID="Move" target="move_goal" output="move_result" speed="slow"/>
  <Say text="{move_result}"/>
</Sequence></BehaviorTree>
<BehaviorTree ID="Move"><SequenceStar>
  <MoveBase goal="{target}"/><Find face="it"/><SetBlackboard output_key="output" value="done"/>
</SequenceStar></BehaviorTree>
<TreeNodesModel><Action ID="Find"><output_port name="face"/></Action>
<SubTree ID="outer"/><SubTree ID="Move"/></TreeNodesModel></root>"""


@pytest.mark.usefixtures("stand_ins")
def test_version_3_names_values_without_brackets(language: Language) -> None:
    editor, told = imported(language, VERSION_3)
    text = program(editor)

    assert not told
    assert 'Input("target", lambda: tree_value("move_goal"))' in text
    assert 'Output("output", "move_result")' in text
    assert 'Input("speed", lambda: "slow")' in text
    assert 'set_tree_value("it", tree_value("face"))' in text
    assert played(text) == "MoveBase Find Say succeeded"


def test_a_model_of_a_tree_says_what_goes_in_where_nobody_does(language: Language) -> None:
    editor, told = imported(
        language,
        """<root BTCPP_format="4"><BehaviorTree ID="outer"><SubTree ID="In"/></BehaviorTree>
        <BehaviorTree ID="In"><Say text="{what}"/></BehaviorTree><TreeNodesModel>
        <SubTree ID="In"><input_port name="what" default="Hi"/></SubTree>
        </TreeNodesModel></root>""",
    )

    assert not told
    assert 'Input("what", lambda: "Hi")' in program(editor)


@pytest.mark.usefixtures("stand_ins")
def test_what_comes_out_of_a_condition_is_set_in_it(language: Language) -> None:
    body = """<ReactiveSequence><Hear said="{word}"/><Say text="{word}"/></ReactiveSequence>"""
    told_of = '<Action ID="Hear"><output_port name="said"/></Action>'
    text = one_tree(body).replace(MODELS, f"<TreeNodesModel>{told_of}</TreeNodesModel>")
    editor, told = imported(language, text)

    assert told == ["“Hear” is asked at each look before others go on: here it is a condition."]
    assert 'def Hear():\n    # find out here whether this is so\n    set_tree_value("word", 0)' in (
        program(editor)
    )
    assert played(program(editor)) == "Hear Say succeeded"
    assert '<Condition ID="Hear" word="{word}"/>' in exported(editor)


def test_what_only_the_editor_needs_is_no_news_and_a_tree_that_is_not_there_is(
    language: Language,
) -> None:
    editor = Editor(Project("Trees"), language)
    text = one_tree('<SubTree ID="Else" _collapsed="true" _uid="7" _fullpath=""/>')
    told = import_trees(editor, read_elements(text.encode())).told

    assert [*map(str, told)] == ["The tree “Else” is not in the file: import it too, or make it."]


def test_files_that_a_file_includes_are_read_with_it(language: Language, tmp_path: Path) -> None:
    (tmp_path / "trees").mkdir()
    main = tmp_path / "main.xml"
    main.write_text(
        """<root><include path="trees/door.xml"/><include path="gone.xml"/>
        <include ros_pkg="nav2" path="main.xml"/><include path="/etc/passwd"/>
        <BehaviorTree ID="outer"><SubTree ID="Door"/></BehaviorTree></root>"""
    )
    (tmp_path / "trees" / "door.xml").write_text(
        """<root><include path="../main.xml"/><BehaviorTree ID="Door"><P/></BehaviorTree>
        <TreeNodesModel><Condition ID="P"/></TreeNodesModel></root>"""
    )
    editor = Editor(Project("Trees"), language)
    told = import_trees(editor, read_file(main)).told

    assert [str(one).split("“")[1].split("”")[0] for one in told] == [
        "gone.xml",
        "main.xml",
        "/etc/passwd",
    ]
    assert 'SubTree("Door")' in program(editor)
    assert not check(editor.project, editor.language)


def test_a_switch_that_changes_what_it_asks_for_is_told(language: Language) -> None:
    body = """<Switch2 variable="{x}" case_1="1" case_2="2"><Script code="x := 2"/><A/></Switch2>"""
    _, told = imported(language, one_tree(body))

    assert told[:2] == [
        "“Switch2” has 2 parts in it, not 3: one for each case, and one for all others.",
        "“Switch2” asks for “x”, which changes in it: if it fails then, another part of it may "
        "follow.",
    ]

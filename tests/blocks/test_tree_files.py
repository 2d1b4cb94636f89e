"""Files of behaviour trees, as Groot and BehaviorTree.CPP write them: in, out, and bad ones."""

from __future__ import annotations

import random
from itertools import pairwise

import pytest

from nep_studio.blocks.checks import check
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.procedures import title
from nep_studio.blocks.program import Project
from nep_studio.blocks.tree_files.elements import DEEPEST, TreeFileError, read_elements
from nep_studio.blocks.tree_files.reading import import_trees
from nep_studio.blocks.tree_files.writing import export_trees

PATROL = """\
<?xml version="1.0" encoding="UTF-8"?>
<root BTCPP_format="4" main_tree_to_execute="Patrol">
  <BehaviorTree ID="Patrol">
    <ReactiveFallback name="patrol or charge">
      <ReactiveSequence>
        <Inverter>
          <Condition ID="BatteryLow"/>
        </Inverter>
        <KeepRunningUntilFailure>
          <SubTree ID="Visit" place="{next}" tone="friendly"/>
        </KeepRunningUntilFailure>
      </ReactiveSequence>
      <RetryUntilSuccessful num_attempts="3">
        <Timeout msec="1500">
          <Action ID="Charge"/>
        </Timeout>
      </RetryUntilSuccessful>
      <RetryUntilSuccessful num_attempts="-1">
        <Delay delay_msec="250">
          <AlwaysFailure/>
        </Delay>
      </RetryUntilSuccessful>
    </ReactiveFallback>
  </BehaviorTree>
  <BehaviorTree ID="Visit">
    <Sequence>
      <Script code="tries := 1; who := 'Anna'; again := tries; ready := true"/>
      <Parallel success_count="-1">
        <Action ID="FindFace" name="look for her" who="{who}" where="{place}"/>
        <Repeat num_cycles="2">
          <Action ID="Say" text="Hello" loud="0.5"/>
        </Repeat>
      </Parallel>
      <Parallel success_count="1">
        <ForceSuccess>
          <AlwaysSuccess/>
        </ForceSuccess>
        <ForceFailure>
          <AlwaysSuccess/>
        </ForceFailure>
      </Parallel>
      <SequenceWithMemory>
        <Fallback>
          <CoolDown seconds="30">
            <Action ID="Charge"/>
          </CoolDown>
        </Fallback>
      </SequenceWithMemory>
    </Sequence>
  </BehaviorTree>
  <TreeNodesModel>
    <Condition ID="BatteryLow"/>
    <Action ID="Charge"/>
    <Action ID="FindFace">
      <input_port name="who"/>
      <output_port name="where"/>
    </Action>
    <Action ID="Say">
      <input_port name="text"/>
      <input_port name="loud"/>
    </Action>
    <Decorator ID="CoolDown">
      <input_port name="seconds"/>
    </Decorator>
  </TreeNodesModel>
</root>
"""


def imported(language: Language, text: str, editor: Editor | None = None) -> tuple[Editor, list]:
    editor = editor or Editor(Project("Trees"), language)
    told = import_trees(editor, read_elements(text.encode())).told
    return editor, [str(one) for one in told]


def exported(editor: Editor) -> str:
    return export_trees(editor.project, editor.language).text


def test_a_file_that_is_read_is_written_the_same(language: Language) -> None:
    editor, told = imported(language, PATROL)

    assert not told
    assert exported(editor) == PATROL
    assert not check(editor.project, editor.language)


def test_what_a_file_names_becomes_own_blocks_to_be_filled(language: Language) -> None:
    editor, _ = imported(language, PATROL)

    own = [title(procedure) for procedure in editor.project.procedures.values()]
    assert own == ["BatteryLow", "Charge", "FindFace (who)", "Say (text) (loud)"]
    text = generate_program(editor.project, editor.language).text
    assert "def FindFace(who):\n    # fill in here what this does\n    set_tree_value(" in text
    assert "def BatteryLow():\n    # find out here whether this is so\n    return True" in text
    assert 'Say("Hello", 0.5)' in text


def test_stacks_are_put_below_each_other(language: Language) -> None:
    editor, _ = imported(language, PATROL)

    stacks = sorted(editor.project.pages["behaviour"], key=lambda stack: stack.y)
    for upper, lower in pairwise(stacks):
        blocks = [b.type for b in editor.project.within(upper.body)]
        rows = [one for one in blocks if not one.startswith(("tree.value", "logic.", "my.call"))]
        assert lower.y - upper.y > 40 * len(rows)


def test_an_import_is_one_step_that_is_taken_back(language: Language) -> None:
    editor = Editor(Project("Trees"), language)
    before = to_bytes(editor.project)
    imported(language, PATROL, editor)

    assert editor.history.undo()
    assert to_bytes(editor.project) == before


def test_trees_that_were_read_go_through_python_and_out_again(language: Language) -> None:
    editor, _ = imported(language, PATROL)
    text = generate_program(editor.project, editor.language).text

    again = Editor(Project("Trees"), language)
    update_from_python(again, text)

    assert generate_program(again.project, again.language).text == text
    assert exported(again) == PATROL


def test_files_of_version_3_are_read(language: Language) -> None:
    editor, told = imported(
        language,
        """<root main_tree_to_execute = "Main">
        <!---------
        ------->
        <BehaviorTree ID="Main"><SequenceStar>
          <SetBlackboard output_key="goal" value="1;2;3"/>
          <SubTree ID="Go"><remap internal="target" external="goal"/></SubTree>
          <RetryUntilSuccesful num_attempts="4"><OpenDoor/></RetryUntilSuccesful>
          <Go/>
        </SequenceStar></BehaviorTree>
        <BehaviorTree ID="Go"><MoveBase goal="{target}"/></BehaviorTree>
        </root>""",
    )

    text = exported(editor)
    assert not told
    assert "<Script code=\"goal := '1;2;3'\"/>" in text
    assert '<SubTree ID="Go" target="{goal}"/>' in text
    assert '<SubTree ID="Go"/>' in text
    assert '<RetryUntilSuccessful num_attempts="4">' in text
    assert '<Action ID="MoveBase" goal="{target}"/>' in text
    assert exported(imported(language, text)[0]) == text


def test_scripts_may_have_two_signs_that_xml_forbids(language: Language) -> None:
    editor, told = imported(
        language,
        """<root BTCPP_format="4"><BehaviorTree ID="T"><Sequence>
        <ScriptCondition code="a>1 && b != 2"/><Say text="A &amp; B"/>
        </Sequence></BehaviorTree></root>""",
    )

    assert told == ["Nothing in the file sets “a, b”: the first step of “T” does it."]
    assert '<ScriptCondition code="(a &gt; 1) &amp;&amp; (b != 2)"/>' in exported(editor)
    assert 'text="A &amp; B"' in exported(editor)


def test_what_is_not_taken_over_is_told(language: Language) -> None:
    editor, told = imported(
        language,
        """<root BTCPP_format="4"><include path="more.xml"/>
        <BehaviorTree><PipelineSequence><A/><B _onHalted="x = 1"/></PipelineSequence></BehaviorTree>
        <BehaviorTree ID="B2"><Sequence>
          <Script code="x := y &amp; 1"/><Parallel failure_count="2"/><Timeout msec="soon"/>
          <Delay delay_msec="-1"/>
        </Sequence></BehaviorTree></root>""",
    )

    assert told == [
        "The file names another one, “more.xml”: import that too.",
        "“PipelineSequence” is not known: what is in it is done in order.",
        "“_onHalted” of “B” is not taken over.",
        "Nothing in the file sets “y”: the first step of “B2” does it.",
        "The script “x := y & 1” is more than blocks can read.",
        "“failure_count” of “Parallel” is not taken over.",
        "“msec” of “Timeout” is not taken over.",
        "“delay_msec” of “Delay” is not taken over.",
    ]
    assert not check(editor.project, editor.language)


def test_names_that_the_project_has_get_a_number_and_own_blocks_are_used_again(
    language: Language,
) -> None:
    editor, _ = imported(language, PATROL)
    imported(language, PATROL, editor)

    text = exported(editor)
    assert '<BehaviorTree ID="Visit 2">' in text
    assert '<SubTree ID="Visit 2" place="{next}" tone="friendly"/>' in text
    assert len(editor.project.procedures) == 4


def test_times_that_are_values_of_the_tree_stay_so(language: Language) -> None:
    text = PATROL.replace('msec="1500"', 'msec="{limit}"').replace('="3"', '="{tries}"')

    written = exported(imported(language, text)[0])

    assert '<Timeout msec="{limit}">' in written
    assert '<RetryUntilSuccessful num_attempts="{tries}">' in written
    assert exported(imported(language, written)[0]) == written


def test_what_a_file_cannot_hold_is_told(language: Language) -> None:
    editor = Editor(Project("Trees"), language)
    update_from_python(
        editor,
        """
@behavior.tree("guide", runs="always")
def guide():
    with WhileTrue(lambda: human_state() == "seen_face"):
        @Step("greet")
        def greet():
            wait(1)

        Check(lambda: 1 < 2)
""",
    )
    out = export_trees(editor.project, editor.language)

    assert '<Action ID="greet"/>' in out.text
    assert "<ReactiveSequence>" in out.text
    assert '<ScriptCondition code="1 &lt; 2"/>' in out.text
    assert len(out.told) == 2


BOMB = """<?xml version="1.0"?><!DOCTYPE lolz [<!ENTITY lol "lol">
<!ENTITY lol2 "&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;">]>
<root><BehaviorTree ID="&lol2;"><AlwaysSuccess/></BehaviorTree></root>"""
OUTSIDE = """<!DOCTYPE root [<!ENTITY x SYSTEM "file:///etc/passwd">]>
<root><BehaviorTree ID="&x;"/></root>"""


def nested(before: str, after: str, times: int) -> bytes:
    inside = before * times + "<C/>" + after * times
    return f"<root><BehaviorTree>{inside}</BehaviorTree></root>".encode()


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (BOMB.encode(), "DOCTYPE"),
        (OUTSIDE.encode(), "DOCTYPE"),
        (b"<root>" * (DEEPEST + 1), "too large"),
        (b"<root>" + b"<a/>" * 20_000 + b"</root>", "too large"),
        (b" " * 3_000_000, "too large"),
        (nested("<IfThenElse><A/><B/>", "</IfThenElse>", 90), "too large"),
        (nested("<WhileDoElse>", "<A/><B/></WhileDoElse>", 30), "too large"),
        (nested("<A _skipIf='x' _while='x' _post='x:=1'>", "</A>", 60), "too large"),
        (b"", "no XML"),
        (b"<root><BehaviorTree></root>", "Line 1 is no XML"),
        (b'<?xml version="1.0" encoding="nothing"?><root/>', "no XML"),
        (b"\xff\xfe\x00", "no XML"),
        (b"<html><body/></html>", "no behaviour tree"),
        (b'<root BTCPP_format="4"/>', "no behaviour tree"),
        (
            "<root><BehaviorTree><Action ID='\u202e'/></BehaviorTree></root>".encode(),
            "cannot be called",
        ),
    ],
)
def test_bad_files_are_refused_in_words(language: Language, content: bytes, reason: str) -> None:
    editor = Editor(Project("Trees"), language)
    before = to_bytes(editor.project)

    with pytest.raises(TreeFileError, match=reason) as caught:
        import_trees(editor, read_elements(content))

    assert caught.value.fault.checklist
    assert to_bytes(editor.project) == before


def test_broken_files_do_no_harm(language: Language) -> None:
    rng = random.Random(3)
    for _ in range(150):
        content = bytearray(PATROL.encode())
        for _ in range(rng.randint(1, 4)):
            at = rng.randrange(len(content))
            content[at : at + rng.randint(0, 12)] = bytes(rng.choices(b'<>/"={} aZ&', k=3))
        editor = Editor(Project("Trees"), language)
        try:
            import_trees(editor, read_elements(bytes(content)))
        except TreeFileError as error:
            assert error.fault.checklist
        else:
            exported(editor)
            generate_program(editor.project, editor.language)


def test_a_project_without_trees_has_nothing_to_write(language: Language) -> None:
    with pytest.raises(TreeFileError, match="no behaviour tree in this project"):
        export_trees(Project("Empty"), language)

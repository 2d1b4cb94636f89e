"""Rules that tell, stop and try: their Python, read back, copied, checked."""

from __future__ import annotations

import pytest
from block_building import B, add, build, read_program

from nep_studio.blocks.checks import check
from nep_studio.blocks.deployment import can_be_stopped
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField, SetFlag
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.errors import CodeRefused, EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.pasting import read_snippet
from nep_studio.blocks.generate.program import ProgramGenerator, generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import copy, duplicate, from_text, paste, to_text
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence

SAY, STARTED, STOP = B("robot.say", {"text": "a"}), "event.started", "control.stop_other_rule"


def body(language: Language, *chain: B, **options: object) -> str:
    """The lines of the rule that is first in the program."""
    editor = build(language, [B(STARTED), *chain], **options)
    text = generate_program(editor.project, language).text
    assert generate_program(read_program(text, language), language).text == text
    assert not [b for b in read_program(text, language).blocks.values() if b.type[:5] == "code."]
    rule = text.partition("def when_started():\n")[2].partition("\n\n\n")[0]
    return "\n".join(line.removeprefix("    ") for line in rule.splitlines())


def head(language: Language, hat: B, *chain: B, variables: tuple[str, ...] = ()) -> str:
    """The line above the function of a rule, which reads back."""
    editor = build(language, [hat, *(chain or [SAY])], variables=variables)
    text = generate_program(editor.project, language).text
    assert generate_program(read_program(text, language), language).text == text
    return next(line for line in text.splitlines() if line.startswith("@"))


def first(editor: Editor, block_type: str) -> str:
    return next(b.id for b in editor.project.blocks.values() if b.type == block_type)


def stopping(language: Language, hat: B) -> Editor:
    """A program in which a rule stops another one."""
    editor = build(language, [B(STARTED)], [hat, SAY])
    there = editor.project.stack_of(first(editor, STARTED)).id
    add(editor, B(STOP, {"rule": first(editor, hat.type)}), InStack(there, 1))
    build(language, [B("robots.robot")], page="robots", editor=editor)
    return editor


@pytest.mark.parametrize(
    ("groups", "expected"),
    [
        ({}, 'tell("dance")'),
        ({"value": 1}, 'tell("dance", 1)'),
        ({"wait": 1}, 'tell("dance", wait=True)'),
        ({"value": 1, "wait": 1}, 'tell("dance", 1, wait=True)'),
    ],
)
def test_a_message_is_told(language: Language, groups: dict[str, int], expected: str) -> None:
    assert body(language, B("event.tell", groups=groups)) == expected


def test_what_was_told_is_any_value(language: Language) -> None:
    said = B("robot.say", inputs={"text": B("event.told_value")})

    assert body(language, said) == "nao.say(as_text(told_value()))"


@pytest.mark.parametrize(
    ("hat", "expected"),
    [
        (B("event.told"), '@behavior.when_told("dance")'),
        (
            B("event.told", {"message": "go on", "again.1": "queue"}, groups={"repeated": 1}),
            '@behavior.when_told("go on", again="queue")',
        ),
        (
            B("event.true", {}, {"condition": B("variable.get", {"variable": "v1"})}),
            "@behavior.when_true(lambda: program.ready)",
        ),
        (B("time.every", {"seconds": 2.5}), "@behavior.every(2.5)"),
        (B("time.at", {"time": "07:05"}), '@behavior.at("07:05")'),
        (B("time.at", {"days": "sunday"}), '@behavior.at("09:00", days="sunday")'),
    ],
)
def test_rules_begin_with_messages_conditions_and_times(
    language: Language, hat: B, expected: str
) -> None:
    assert head(language, hat, variables=("ready",)) == expected


def test_whether_it_came_in_time_is_an_answer_beside_the_statement(language: Language) -> None:
    within = B("control.within", {"seconds": 5}, {"condition": B("logic.truth")})
    until = B(
        "control.wait_until",
        {"seconds.1": 5},
        {"condition": B("logic.truth")},
        groups={"limit": 1},
    )
    fork = B("control.if", {}, {"condition": within}, {"do": [SAY]})

    lines = body(language, until, fork).splitlines()

    assert lines[:2] == ["wait_until(lambda: True, 5)", "if wait_until(lambda: True, 5):"]


def test_what_is_tried_is_plain_python(language: Language) -> None:
    said = B("robot.say", inputs={"text": B("control.went_wrong")})
    leave = B("control.leave_loop")
    tried = B("control.try", bodies={"do": [SAY, leave], "otherwise": [said]})

    assert body(language, B("control.forever", bodies={"do": [tried]})).splitlines() == [
        "while True:",
        "    try:",
        '        nao.say("a")',
        "        break",
        "    except Exception:",
        "        end_actions()",
        "        nao.say(what_went_wrong())",
    ]


def test_a_try_with_nothing_in_it_reads_back(language: Language) -> None:
    note = B("control.note", {"text": "nothing to do"})

    assert body(language, B("control.try"), B("control.try", bodies={"otherwise": [note]}))


def test_tries_are_nested_as_deep_as_python_allows(language: Language) -> None:
    chain = [SAY]
    for number in range(30):
        chain = [B("control.try", bodies={("do", "otherwise")[number % 2]: chain})]
        editor = build(language, [B(STARTED), *chain])
        build(language, [B("robots.robot")], page="robots", editor=editor)
        is_too_deep = any(found.kind == "too_deep" for found in check(editor.project, language))
        try:
            text = generate_program(editor.project, language).text
        except CodeRefused:
            assert is_too_deep
            break
        assert not is_too_deep
        compile(text, "program.py", "exec")
    assert 5 < number < 29


def test_a_rule_is_stopped_by_the_name_of_its_function(language: Language) -> None:
    editor = stopping(language, B("event.gesture"))
    text = generate_program(editor.project, language).text

    assert "    behavior.stop(when_gesture_karate)" in text.splitlines()
    again = read_program(text, language)
    assert generate_program(again, language).text == text
    (stop,) = (b for b in again.blocks.values() if b.type == STOP)
    assert again.blocks[str(stop.fields["rule"])].type == "event.gesture"
    assert "karate" in sentence(again, language, stop.id)
    assert check(editor.project, language) == []


def test_a_rule_is_written_anew_when_the_one_that_it_stops_has_another_name(
    language: Language,
) -> None:
    editor = stopping(language, B("event.told"))
    generator = ProgramGenerator(editor.project, language)
    assert "behavior.stop(when_told_dance)" in generator.generate().text

    editor.apply(SetField(first(editor, "event.told"), "message", "sing"))

    assert "behavior.stop(when_told_sing)" in generator.generate().text


def test_a_changed_text_still_stops_the_same_rule(language: Language) -> None:
    editor = stopping(language, B("event.told"))
    text = generate_program(editor.project, language).text

    renamed = read_program(text.replace('("dance")', '("sing")'), language, editor.project)
    other = read_program(
        text.replace('@behavior.when_told("dance")', "@behavior.every(3)"),
        language,
        editor.project,
    )

    assert "behavior.stop(when_told_sing)" in generate_program(renamed, language).text
    assert "behavior.stop(every)" in generate_program(other, language).text


@pytest.mark.parametrize("hat", [B("goal.goal"), B("goal.when_goal")])
def test_goals_are_no_rules_to_stop(language: Language, hat: B) -> None:
    editor = stopping(language, hat)

    assert not can_be_stopped(editor.project, language, first(editor, hat.type))
    with pytest.raises(CodeRefused):
        generate_program(editor.project, language)
    assert "unknown_rule" in [found.kind for found in check(editor.project, language)]


@pytest.mark.parametrize("how", ["deleted", "disabled"])
def test_a_rule_that_is_not_there_any_more_is_told_of(language: Language, how: str) -> None:
    editor = stopping(language, B("event.told"))
    hat = first(editor, "event.told")
    editor.apply(DeleteBlocks(hat, 2) if how == "deleted" else SetFlag(hat, "disabled", True))

    with pytest.raises(CodeRefused) as refused:
        generate_program(editor.project, language)
    assert refused.value.block == first(editor, STOP) and refused.value.checklist
    assert "unknown_rule" in [found.kind for found in check(editor.project, language)]
    editor.history.undo()
    assert "behavior.stop(when_told_dance)" in generate_program(editor.project, language).text


def test_copies_of_both_rules_mean_each_other(language: Language) -> None:
    editor = stopping(language, B("event.told"))
    copied = duplicate(editor, list(editor.project.blocks)[:4])
    stops = [b for b in editor.project.blocks.values() if b.type == STOP]

    assert [b.fields["rule"] for b in stops] == [first(editor, "event.told"), copied[1]]


def test_a_copy_of_the_stop_alone_means_the_same_rule(language: Language) -> None:
    editor = stopping(language, B("event.told"))
    duplicate(editor, [first(editor, STOP)])

    stops = [b.fields["rule"] for b in editor.project.blocks.values() if b.type == STOP]
    assert stops == [first(editor, "event.told")] * 2


def test_in_another_project_it_means_no_rule_by_accident(language: Language) -> None:
    editor = stopping(language, B("event.told"))
    clip = from_text(to_text(copy(editor.project, language, [first(editor, STOP)])), language)
    other = build(language, [B(STARTED)], [B("event.gesture"), SAY])

    (pasted,) = paste(other, clip, "behaviour", 0, 0)

    assert other.project.blocks[pasted].fields["rule"] == ""


def test_pasted_python_stops_the_rule_that_comes_with_it(language: Language) -> None:
    text = generate_program(stopping(language, B("event.told")).project, language).text
    rules = text[text.index("@") : text.index("\n\n\nbehavior.run")]
    editor = build(language, [B("event.gesture"), SAY])

    paste(editor, read_snippet(rules, language, editor.project), "behaviour", 0, 0)

    assert "behavior.stop(when_told_dance)" in generate_program(editor.project, language).text


def test_pasted_python_stops_a_rule_that_is_there(language: Language) -> None:
    editor = build(language, [B("event.gesture"), SAY])
    clip = read_snippet("behavior.stop(when_gesture_karate)", language, editor.project)

    assert [b.type for b in clip.project.blocks.values()] == [STOP]


def test_a_message_without_a_rule_is_told_of_and_a_rule_without_a_message(
    language: Language,
) -> None:
    editor = build(
        language,
        [B(STARTED), B("event.tell", {"message": "sing"})],
        [B("event.told", {"message": "dance"}), SAY],
    )
    build(language, [B("robots.robot")], page="robots", editor=editor)

    found = {one.kind: one for one in check(editor.project, language)}

    assert found.keys() == {"unheard_message", "untold_message"}
    assert found["unheard_message"].severity == "warning"
    assert found["unheard_message"].block == first(editor, "event.tell")
    assert found["untold_message"].severity == "info"
    editor.apply(SetField(first(editor, "event.tell"), "message", "dance"))
    assert check(editor.project, language) == []


def test_what_own_python_tells_is_not_guessed_at(language: Language) -> None:
    written = B("code.lines", {"code": 'tell("dance")'})
    editor = build(language, [B(STARTED), written], [B("event.told"), SAY])
    build(language, [B("robots.robot")], page="robots", editor=editor)

    assert check(editor.project, language) == []


def test_only_who_waits_for_a_message_gives_a_loop_its_pause(language: Language) -> None:
    kinds = []
    for groups in ({}, {"wait": 1}):
        loop = B("control.forever", bodies={"do": [B("event.tell", groups=groups)]})
        editor = build(language, [B(STARTED), loop], [B("event.told"), SAY])
        build(language, [B("robots.robot")], page="robots", editor=editor)
        kinds.append([found.kind for found in check(editor.project, language)])

    assert kinds == [["no_pause"], []]


@pytest.mark.parametrize("time", ["24:00", "9", "09:60", "ab:cd", ""])
def test_what_is_no_time_of_a_day_is_refused(language: Language, time: str) -> None:
    editor = build(language, [B("time.at"), SAY])

    with pytest.raises(EditRefused):
        editor.apply(SetField(first(editor, "time.at"), "time", time))


def test_a_time_is_read_as_people_type_it(language: Language) -> None:
    kind = language.definitions["time.at"].slots["time"].kind

    assert [kind.read(typed) for typed in ("9:05", " 09.05 ", "17:30")] == [
        "09:05",
        "09:05",
        "17:30",
    ]


def test_files_keep_all_of_it(language: Language) -> None:
    editor = stopping(language, B("event.told"))
    text = generate_program(editor.project, language).text

    again: Project = from_bytes(to_bytes(editor.project), "a.nep", language)

    assert generate_program(again, language).text == text

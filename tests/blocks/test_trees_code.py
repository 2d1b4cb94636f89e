"""Behaviour trees as blocks and as Python: both ways, what belongs where, and how they run."""

from __future__ import annotations

import pytest

from nep_studio.blocks.checks import check
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from tests.blocks.block_building import B, build, read_program

GUIDE = '''\
"""Guide. Made with NEP Studio."""
from nep_core import *

nao = Robot("NAO")
behavior = Behavior("Guide")


@behavior.tree("guide", runs="always")
def guide():
    with Fallback():
        # Nobody is here
        with Sequence(reactive=True):
            with Invert():
                Check(lambda: nao.sees("face"))

            @Step("look around")
            def look_around():
                nao.turn(45)

        with Sequence():
            @Step("say hello")
            def say_hello():
                nao.say("Hello", gesture="explain")

            with SubTree("walk"):
                Input("place", lambda: "kitchen")
                Output("answer", "answer")
            SubTree("walk")
        with Sequence(keeps_place=True):
            with Parallel():
                Check(lambda: True)
                Check(lambda: False)
            with Parallel(2):
                pass
            with WhileTrue(lambda: human_state() == "seen_face"):
                with Retry(3):
                    pass
        with Fallback(reactive=True):
            with Retry():
                pass
            with Repeat(3):
                pass
            with Repeat():
                pass
            with TimeLimit(lambda: as_number(tree_value("place"))):
                pass
            with CoolDown(30):
                pass
            with Delay(1):
                pass
            with ForceSuccess():
                pass
            with ForceFailure():
                pass


@behavior.tree("walk")
def walk():
    @Step("go")
    def go():
        nao.say(as_text(tree_value("place")))
        set_tree_value("answer", 5)
        fail_step()


@behavior.when("gesture_karate")
def when_gesture_karate():
    do_tree("walk")
    if do_tree("walk"):
        wait(1)


behavior.run()
'''


IMPORTED = """(
    Behavior, Check, CoolDown, Delay, Fallback, ForceFailure, ForceSuccess, Input,
    Invert, Output, Parallel, Repeat, Retry, Robot, Sequence, Step, SubTree, TimeLimit,
    WhileTrue, as_number, as_text, do_tree, fail_step, human_state, set_tree_value,
    tree_value, wait,
)"""
GUIDE = GUIDE.replace("*", IMPORTED, 1)


def test_trees_are_read_from_python_and_written_the_same(language: Language) -> None:
    project = read_program(GUIDE, language)

    assert not [b for b in project.blocks.values() if b.type.startswith("code.")]
    assert generate_program(project, language).text == GUIDE


def kinds(language: Language, *stacks: list[B]) -> list[str]:
    editor = build(language, *stacks)
    return [problem.kind for problem in check(editor.project, language)]


def tree(*blocks: B, name: str = "guide") -> list[B]:
    return [B("tree.tree", {"name": name}), *blocks]


def test_a_whole_tree_has_no_problem(language: Language) -> None:
    check_block = B("tree.check", inputs={"condition": B("logic.truth")})
    step = B("tree.step", bodies={"do": [B("control.wait"), B("tree.fail")]})
    note = B("control.note", {"text": "first"})

    assert not kinds(language, tree(B("tree.sequence", bodies={"do": [note, check_block, step]})))


@pytest.mark.parametrize(
    ("stack", "kind"),
    [
        (tree(B("robot.say")), "outside_tree"),
        (tree(B("tree.fallback", bodies={"do": [B("control.wait")]})), "outside_tree"),
        ([B("event.started"), B("tree.sequence")], "outside_tree"),
        (tree(B("tree.step", bodies={"do": [B("tree.step")]})), "outside_tree"),
        (tree(B("tree.input")), "outside_tree"),
        ([B("event.started"), B("tree.fail")], "outside_step"),
        ([B("event.started"), B("tree.do", {"name": "gide"})], "unknown_tree"),
        (tree(B("tree.sub_tree", {"name": "gide"})), "unknown_tree"),
        (tree(B("tree.step", bodies={"do": [B("control.leave_loop")]})), "outside_loop"),
    ],
)
def test_what_is_in_the_wrong_place_is_told(language: Language, stack: list[B], kind: str) -> None:
    assert kind in kinds(language, stack, tree(name="guide 2"))


def test_two_trees_of_one_name_are_told_and_get_another(language: Language) -> None:
    editor = build(language, tree(), tree())
    (problem,) = [one for one in check(editor.project, language) if one.kind == "same_tree"]

    assert problem.fix is not None
    assert problem.fix.data["value"] == "guide 2"


def test_values_of_a_tree_belong_into_its_mouth(language: Language) -> None:
    inner = B("tree.sub_tree", {"name": "guide"}, groups={"ports": 1})
    inner.bodies = {"ports.1": [B("tree.input"), B("tree.output")]}
    wrong = B("tree.sub_tree", {"name": "guide"}, groups={"ports": 1})
    wrong.bodies = {"ports.1": [B("tree.check", inputs={"condition": B("logic.truth")})]}

    assert not kinds(language, tree(inner))
    assert kinds(language, tree(wrong)) == ["outside_tree"]


def test_what_side_by_side_steps_add_to_a_variable_is_added_whole(language: Language) -> None:
    add = B("variable.change", {"variable": "v1"}, {"amount": B("list.length")})
    steps = [B("tree.step", {"name": name}, bodies={"do": [add]}) for name in ("a", "b")]
    editor = build(language, tree(B("tree.parallel", bodies={"do": steps})), variables=("n", "l"))

    assert generate_program(editor.project, language).text.count("with at_once: program.n += ") == 2


def test_a_tree_too_deep_for_python_is_told(language: Language) -> None:
    part = B("tree.retry")
    for _ in range(20):
        part = B("tree.retry", bodies={"do": [part]})

    assert "too_deep" in kinds(language, tree(part))


def test_a_class_of_a_persons_own_that_is_called_like_a_part_stays_theirs(
    language: Language,
) -> None:
    own = "class Step:\n    def __init__(self, name):\n        self.name = name"
    editor = build(
        language,
        [B("code.program", {"code": own})],
        [B("event.started"), B("code.lines", {"code": 'print(Step("a").name)'})],
    )

    text = generate_program(editor.project, language).text
    (imported,) = [line for line in text.split("\n") if line.startswith("from nep_core")]
    assert "class Step:" in text
    assert "Step" not in imported

"""Random behaviour trees do what docs/language.md says: generated Python against another judge."""

from __future__ import annotations

import os
import random
import re
from collections.abc import Callable
from typing import Any

import pytest
from block_building import B, build, read_program
from reference_interpreter import GivenUp
from reference_trees import Trees
from reference_values import Wrong

import nep_core
from nep_core.program import tasks, tree
from nep_core.program.tasks import Part
from nep_core.program.values import speak
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.blocks.tree_files.elements import read_elements
from nep_studio.blocks.tree_files.reading import import_trees

TREES = int(os.environ.get("NEP_RANDOM_PROGRAMS", "300"))
NAMES = ("v1", "v2")
SET_FIRST = "v3"
"""A variable that each step sets before it reads it."""


class Maker:
    """Makes a project of two random trees, one of which may hold the other."""

    def __init__(self, seed: int, language: Language) -> None:
        self._rng, self._language, self._steps = random.Random(seed), language, 0

    def project(self) -> Project:
        inner = [B("tree.tree", {"name": "inner", "runs": "when_asked"}), *self._parts(2, "")]
        outer = [B("tree.tree", {"name": "outer", "runs": "when_asked"}), *self._parts(4, "inner")]
        return build(self._language, outer, inner, variables=("a", "b", "c")).project

    def _parts(self, depth: int, other: str) -> list[B]:
        return [self._part(depth, other) for _ in range(self._rng.choice((0, 1, 1, 2, 2, 3)))]

    def _part(self, depth: int, other: str) -> B:
        pick = self._rng.choice
        sort = pick(("leaf", "row", "row", "row", "around")) if depth else "leaf"
        if sort == "leaf":
            made = pick((self._step, self._step, self._check, lambda: self._sub_tree(other)))
            return made()
        inside = {"do": self._parts(depth - 1, other)}
        if sort == "row":
            kind = pick(("sequence", "fallback", "parallel"))
            if kind == "parallel":
                limit = {"limit": pick((0, 1))}
                fields = {"enough.1": pick((0, 1, 2, 1.5))} if limit["limit"] else {}
                return B("tree.parallel", fields, bodies=inside, groups=limit)
            orders = ("memory", "reactive", "keeps")[: 3 if kind == "sequence" else 2]
            return B(f"tree.{kind}", {"order": pick(orders)}, bodies=inside)
        kind = pick(("while", "retry", "repeat", "cool_down", "time_limit", "delay", "instead"))
        if kind in ("retry", "repeat"):
            times: dict[str, Any] = {"times.1": pick((0, 1, 2, 3, 2.5))}
            plugged = {"times.1": self._variable()} if self._rng.random() < 0.2 else {}
            return B(f"tree.{kind}", times, plugged, inside, {"limit": 1})
        if kind == "while":
            return B("tree.while", inputs={"condition": self._condition()}, bodies=inside)
        if kind == "instead":
            return B(
                "tree.instead", {"outcome": pick(("invert", "success", "failure"))}, {}, inside
            )
        seconds = {"cool_down": 1000, "time_limit": 1000, "delay": 0}[kind]
        return B(f"tree.{kind}", {"seconds": seconds}, bodies=inside)

    def _variable(self) -> B:
        return B("variable.get", {"variable": self._rng.choice(NAMES)})

    def _condition(self) -> B:
        if self._rng.random() < 0.2:
            return B("logic.truth", {"truth": self._rng.choice(("true", "false"))})
        comparison = self._rng.choice(("less", "equal", "greater"))
        fields = {"comparison": comparison, "b": self._rng.randint(0, 4)}
        return B("logic.compare", fields, {"a": self._variable()})

    def _check(self) -> B:
        return B("tree.check", inputs={"condition": self._condition()})

    def _sub_tree(self, other: str) -> B:
        if not other:
            return self._check()
        ports = [
            B("tree.input", {"key": "x", "value": self._rng.randint(0, 9)}),
            B("tree.output", {"key": "y", "ours": self._rng.choice(("x", "z"))}),
        ]
        there = self._rng.random() < 0.7
        bodies = {"ports.1": ports[: self._rng.randint(1, 2)]} if there else {}
        return B("tree.sub_tree", {"name": other}, {}, bodies, {"ports": int(there)})

    def _step(self) -> B:
        self._steps += 1
        pick, name = self._rng.choice, f"step {self._steps}"
        body = [B("robot.say", {"text": name})]
        for _ in range(self._rng.randint(0, 2)):
            key = pick(("x", "y", "z"))
            body.append(
                pick(
                    (
                        B("variable.change", {"variable": pick(NAMES), "amount": 1}),
                        B("robot.say", inputs={"text": self._variable()}),
                        B("robot.say", inputs={"text": B("tree.value", {"key": key})}),
                        B("tree.set", {"key": key}, {"value": self._variable()}),
                        B("tree.set", {"key": key, "value": name}),
                    )
                )
            )
        if self._rng.random() < 0.2:
            found = B("variable.get", {"variable": SET_FIRST})
            body.append(B("variable.set", {"variable": SET_FIRST}, {"value": self._variable()}))
            body.append(B("robot.say", inputs={"text": found}))
        if self._rng.random() < 0.4:
            fails = B("control.if", inputs={"condition": self._condition()})
            fails.bodies = {"do": [B("tree.fail")]}
            body.append(fails)
        return B("tree.step", {"name": name}, bodies={"do": body})


class Listener:
    """Stands in for a robot: keeps what it is told to say."""

    said: list[str]

    def __init__(self, _name: object) -> None:
        pass

    def say(self, text: str, **_options: object) -> None:
        self.said.append(text)


class Grower:
    """Stands in for the behaviour: knows its trees, and runs the outer one."""

    end: object

    def __init__(self, _name: str, **_options: object) -> None:
        speak("en")

    def tree(self, name: str, **_options: object) -> Callable[[Callable[[], object]], object]:
        def plant(function: Callable[[], object]) -> object:
            note = lambda _error: Listener.said.append("error")  # noqa: E731
            return tree.plant(tree.Plan(name, function, lambda _nodes: None, note))

        return plant

    def run(self) -> None:
        try:
            type(self).end = "succeeded" if tree.do_tree("outer") else "failed"
        except nep_core.NepError:
            type(self).end = "error"


class AtOnce(Part):
    """A part that is done as soon as it begins, so that looks are counted by nothing but the tree.

    It runs in its thread, and is waited for.
    """

    def start(self) -> Part:
        super().start()
        self.join(10)
        return self


def played(text: str) -> list[str]:
    Listener.said, Grower.end = [], None
    exec(compile(text, "program.py", "exec"), {"__name__": "__main__"})
    return [*Listener.said, str(Grower.end)]


def expected(project: Project, language: Language) -> list[str] | None:
    trees = Trees(project, language)
    try:
        end = trees.do("outer")
    except Wrong:
        end = "error"
    except (GivenUp, RecursionError):
        return None
    return [*trees.said, end]


@pytest.fixture
def stand_ins(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nep_core, "Robot", Listener, raising=False)
    monkeypatch.setattr(nep_core, "Behavior", Grower, raising=False)
    monkeypatch.setattr(tree, "Part", AtOnce)
    monkeypatch.setattr(tree, "PERIOD_S", 0.0)
    monkeypatch.setattr(tree, "SHORTEST_S", 0.0)
    tasks.PROGRAM.cancelled.clear()


def compare(seeds: range, language: Language) -> int:
    """How many trees could be judged; each does what it must, and reads back."""
    judged = 0
    for seed in seeds:
        project = Maker(seed, language).project()
        text = generate_program(project, language).text
        assert generate_program(read_program(text, language), language).text == text, seed
        said = expected(project, language)
        if said is not None:
            judged += 1
            assert played(text) == said, f"tree {seed}:\n{text}"
    return judged


@pytest.mark.usefixtures("stand_ins")
def test_some_random_trees_do_what_the_page_says(language: Language) -> None:
    assert compare(range(25), language) >= 20


@pytest.mark.long
@pytest.mark.usefixtures("stand_ins")
def test_random_trees_do_what_the_page_says(language: Language) -> None:
    assert compare(range(25, 25 + TREES), language) >= TREES * 0.8


@pytest.mark.usefixtures("stand_ins")
def test_the_judge_finds_a_planted_difference(
    language: Language, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tree.Fallback, "_goes_on", tree.SUCCEEDED)

    with pytest.raises(AssertionError):
        compare(range(25), language)


TEA = """
<root BTCPP_format="4" main_tree_to_execute="outer">
  <BehaviorTree ID="outer">
    <Sequence>
      <Fallback><Inverter><IsCold/></Inverter><SubTree ID="Warm"/></Fallback>
      <Pour/>
    </Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Warm">
    <Fallback>
      <Microwave/>
      <RetryUntilSuccessful num_attempts="3"><LightStove/></RetryUntilSuccessful>
      <AskForHelp/>
    </Fallback>
  </BehaviorTree>
</root>
"""
"""The shape of the tutorial of BehaviorTree.CPP with a closed door, which was played so, too."""


@pytest.mark.usefixtures("stand_ins")
@pytest.mark.parametrize(
    ("lit_at", "done"),
    [
        (2, ["IsCold", "Microwave", *["LightStove"] * 2, "Pour"]),
        (9, ["IsCold", "Microwave", *["LightStove"] * 3, "AskForHelp", "Pour"]),
    ],
)
def test_a_tree_from_a_file_plays_once_its_own_blocks_are_filled_in(
    language: Language, lit_at: int, done: list[str]
) -> None:
    editor = Editor(Project("Tea"), language)
    import_trees(editor, read_elements(TEA.encode()))
    text = generate_program(editor.project, editor.language).text
    seen: list[str] = []

    def does(name: str) -> None:
        seen.append(name)
        if name == "Microwave" or (name == "LightStove" and seen.count(name) < lit_at):
            nep_core.fail_step()

    Grower.end = None
    filled = re.sub(r"(def (\w+)\(\):\n)    # fill in .*\n    .*\n", r"\1    does('\2')\n", text)
    filled = re.sub(r"(def (\w+)\(\):\n)    # find out .*\n", r"\1    does('\2')\n", filled)
    exec(compile(filled, "program.py", "exec"), {"__name__": "__main__", "does": does})

    assert seen == done
    assert Grower.end == "succeeded"

"""Behaviour trees beside those of py_trees: at each look, every node has the same status."""

from __future__ import annotations

import os
import random
from dataclasses import dataclass, field

import py_trees
import pytest
from py_trees import composites, decorators
from py_trees.common import ParallelPolicy
from py_trees.common import Status as TheirStatus

from nep_core.program import tree
from nep_core.program.tasks import CLOCK
from nep_core.program.tree import FAILED, IDLE, RUNNING, SUCCEEDED, Node, Trunk

MANY = int(os.environ.get("NEP_RANDOM_TREES", "1000"))
FEW = 60
LOOKS = 40
OURS = {
    TheirStatus.INVALID: IDLE,
    TheirStatus.RUNNING: RUNNING,
    TheirStatus.SUCCESS: SUCCEEDED,
    TheirStatus.FAILURE: FAILED,
}
_ROWS = ("sequence", "reactive sequence", "fallback", "reactive fallback", "parallel", "one of")
_AROUND = ("invert", "retry", "repeat", "limit", "force success", "force failure", "while")


@dataclass
class Spec:
    """A tree as data; a leaf has what it answers, in turn, for ever."""

    kind: str
    name: str
    children: list[Spec] = field(default_factory=list)
    number: int = 1
    answers: list[str] = field(default_factory=list)


def random_tree(rng: random.Random) -> Spec:
    names = (f"n{number}" for number in range(10_000))

    def made(depth: int) -> Spec:
        name = next(names)
        if depth == 0 or rng.random() < 0.25:
            if rng.random() < 0.4:
                answers = rng.choices((SUCCEEDED, FAILED), k=rng.randint(1, 5))
            else:
                weights = (5, 3, 2)
                answers = rng.choices((RUNNING, SUCCEEDED, FAILED), weights, k=rng.randint(1, 9))
            return Spec("leaf", name, answers=answers)
        if rng.random() < 0.4:
            truths = rng.choices((SUCCEEDED, FAILED), (3, 1), k=rng.randint(1, 6))
            number = rng.randint(1, 4)
            return Spec(rng.choice(_AROUND), name, [made(depth - 1)], number, truths)
        count = rng.randint(0, 4)
        return Spec(rng.choice(_ROWS), name, [made(depth - 1) for _ in range(count)])

    return made(rng.randint(1, 5))


class Answers:
    """Gives the answers of a leaf in turn."""

    def __init__(self, answers: list[str]) -> None:
        self._answers, self._given = answers, 0

    def next(self) -> str:
        self._given += 1
        return self._answers[(self._given - 1) % len(self._answers)]

    def is_true(self) -> bool:
        return self.next() == SUCCEEDED


# The tree as ours.


class OurLeaf(Node):
    def __init__(self, answers: list[str]) -> None:
        super().__init__()
        self._answers = Answers(answers)

    def _look(self):
        return self._answers.next()


def grow(spec: Spec, nodes: dict[str, Node]) -> None:
    if spec.kind == "leaf":
        nodes[spec.name] = OurLeaf(spec.answers)
        return
    node = {
        "sequence": tree.Sequence,
        "reactive sequence": lambda: tree.Sequence(reactive=True),
        "fallback": tree.Fallback,
        "reactive fallback": lambda: tree.Fallback(reactive=True),
        "parallel": tree.Parallel,
        "one of": lambda: tree.Parallel(1),
        "invert": tree.Invert,
        "retry": lambda: tree.Retry(spec.number),
        "repeat": lambda: tree.Repeat(spec.number),
        "limit": lambda: tree.TimeLimit(spec.number + 0.5),
        "force success": tree.ForceSuccess,
        "force failure": tree.ForceFailure,
        "while": lambda: tree.WhileTrue(Answers(spec.answers).is_true),
    }[spec.kind]()
    nodes[spec.name] = node
    with node:
        for child in spec.children:
            grow(child, nodes)


# The tree as that of py_trees.


class TheirLeaf(py_trees.behaviour.Behaviour):
    def __init__(self, name: str, answers: list[str]) -> None:
        super().__init__(name)
        self._answers = Answers(answers)

    def update(self) -> TheirStatus:
        answer = self._answers.next()
        return next(theirs for theirs, ours in OURS.items() if ours == answer)


def theirs(spec: Spec) -> py_trees.behaviour.Behaviour:
    name, inner = spec.name, [theirs(child) for child in spec.children]
    if spec.kind == "leaf":
        return TheirLeaf(name, spec.answers)
    if spec.kind in _ROWS:
        return {
            "sequence": lambda: composites.Sequence(name, True, inner),
            "reactive sequence": lambda: composites.Sequence(name, False, inner),
            "fallback": lambda: composites.Selector(name, True, inner),
            "reactive fallback": lambda: composites.Selector(name, False, inner),
            "parallel": lambda: composites.Parallel(name, ParallelPolicy.SuccessOnAll(), inner),
            "one of": lambda: composites.Parallel(name, ParallelPolicy.SuccessOnOne(), inner),
        }[spec.kind]()
    (child,) = inner
    return {
        "invert": lambda: decorators.Inverter(name, child),
        "retry": lambda: decorators.Retry(name, child, spec.number),
        "repeat": lambda: decorators.Repeat(name, child, spec.number),
        "limit": lambda: decorators.Timeout(name, child, spec.number + 0.5),
        "force success": lambda: decorators.FailureIsSuccess(name, child),
        "force failure": lambda: decorators.SuccessIsFailure(name, child),
        "while": lambda: decorators.EternalGuard(name, child, Answers(spec.answers).is_true),
    }[spec.kind]()


def both(spec: Spec, monkeypatch: pytest.MonkeyPatch) -> list[tuple[dict[str, str], ...]]:
    """What ours and theirs say of the nodes that were asked, and which run, at each look."""
    with monkeypatch.context() as patch:
        return _both(spec, patch)


def _both(spec: Spec, monkeypatch: pytest.MonkeyPatch) -> list[tuple[dict[str, str], ...]]:
    now_s = [0.0]
    monkeypatch.setattr(CLOCK, "now_s", lambda: now_s[0])
    monkeypatch.setattr(decorators.time, "monotonic", lambda: now_s[0])
    nodes: dict[str, Node] = {}
    trunk = Trunk("random", lambda _nodes: None, lambda _error: None)
    token = tree._growing.set(trunk)
    grow(spec, nodes)
    tree._growing.reset(token)
    asked: set[Node] = set()
    tick = Node.tick

    def noted(node: Node):
        asked.add(node)
        return tick(node)

    monkeypatch.setattr(Node, "tick", noted)
    root, judge, found = nodes[spec.name], theirs(spec), []
    every = list(judge.iterate())
    for _ in range(LOOKS):
        asked.clear()
        root.tick()
        names = {node.name for node in judge.tick()}
        ours = {name: node.status for name, node in nodes.items() if node in asked}
        running = {name: RUNNING for name, node in nodes.items() if node.status == RUNNING}
        of_them = {node.name: OURS[node.status] for node in every if node.name in names}
        they_run = {node.name: RUNNING for node in every if node.status == TheirStatus.RUNNING}
        found.append((ours, of_them, running, they_run))
        now_s[0] += 1.0
    return found


def check(seeds: range, monkeypatch: pytest.MonkeyPatch) -> None:
    for seed in seeds:
        spec = random_tree(random.Random(seed))
        for look, (ours, of_them, running, they_run) in enumerate(both(spec, monkeypatch)):
            assert ours == of_them, f"tree {seed}, look {look}"
            assert running == they_run, f"tree {seed}, look {look}"


def test_random_trees_do_what_those_of_py_trees_do(monkeypatch: pytest.MonkeyPatch) -> None:
    check(range(FEW), monkeypatch)


@pytest.mark.long
def test_many_random_trees_do_what_those_of_py_trees_do(monkeypatch: pytest.MonkeyPatch) -> None:
    check(range(FEW, FEW + MANY), monkeypatch)


def test_the_judge_sees_a_tree_that_does_something_else(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(tree.Invert._ends, FAILED, FAILED)

    with pytest.raises(AssertionError):
        check(range(FEW), monkeypatch)

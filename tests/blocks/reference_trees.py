"""Behaviour trees as docs/language.md has them, for the other interpreter; written from that alone.

A part is a generator: it yields at each look at which it runs, and returns how it ended. To halt
it is to close it. A step ends at the look at which it begins.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence

from reference_interpreter import STATEMENTS, Interpreter
from reference_reporters import REPORTERS
from reference_values import MOST_STEPS, GivenUp, Value, Wrong, is_yes, rounded

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project

GOOD, BAD = "succeeded", "failed"
Look = Generator[None, None, str]
Path = tuple[str, ...]


class StepFailed(Exception):
    """This step has failed."""


class Trees(Interpreter):
    """Does the trees of a project; what their steps say is kept."""

    def __init__(self, project: Project, language: Language) -> None:
        super().__init__(project, language)
        self.board: dict[str, Value] = {}
        self._looked = 0

    def do(self, name: str) -> str:
        """Do a tree from a new beginning to its end."""
        run = _Run(self)
        around, self.board = self.board, {}
        self._own = [{}]  # what steps use belongs to the whole program
        try:
            tree = run.all(self.tree(name), ())
            while True:
                self._looked += 1
                if self._looked > MOST_STEPS:
                    raise GivenUp
                try:
                    next(tree)
                except StopIteration as end:
                    return str(end.value)
        finally:
            self.board = around

    def tree(self, name: str) -> list[str]:
        for stack in self.project.pages["behaviour"]:
            block = self.project.blocks[stack.body[0]]
            if block.type == "tree.tree" and block.fields["name"] == name:
                return stack.body[1:]
        raise Wrong("no such tree")


class _Run:
    """One run of a tree: what cools down, and where it is to go on."""

    def __init__(self, trees: Trees) -> None:
        self.trees = trees
        self._cooled: set[Path] = set()
        self._places: dict[Path, int] = {}

    def all(self, chain: Sequence[str], path: Path) -> Look:
        return (yield from self._until(BAD, self._inside(chain, path)))

    def _inside(self, chain: Sequence[str], path: Path) -> list[tuple[Block, Path]]:
        blocks = [self.trees.project.blocks[b] for b in chain]
        return [(b, (*path, b.id)) for b in blocks if not b.disabled]

    def _until(self, stop: str, parts: Sequence[tuple[Block, Path]]) -> Look:
        for block, path in parts:
            if (yield from self._part(block, path)) == stop:
                return stop
        return GOOD if stop == BAD else BAD

    def _part(self, block: Block, path: Path) -> Look:
        chain = block.bodies.get("do", [])
        yes = self._yes(block) if block.type == "tree.check" else None
        if yes is not None:
            return GOOD if yes else BAD
        if block.type == "tree.step":
            return self._step(chain)
        if block.type == "tree.sub_tree":
            return (yield from self._tree(block, path))
        parts = self._inside(chain, path)
        if block.type in ("tree.sequence", "tree.fallback"):
            stop = BAD if block.type == "tree.sequence" else GOOD
            order = self.trees._choice(block, "order")
            if order == "reactive":
                return (yield from self._again(stop, parts))
            if order == "keeps":
                return (yield from self._kept(parts, path))
            return (yield from self._until(stop, parts))
        if block.type == "tree.parallel":
            return (yield from self._beside(block, parts))
        if block.type == "tree.while":
            return (yield from self._while(block, self.all(chain, path)))
        if block.type in ("tree.retry", "tree.repeat"):
            return (yield from self._times(block, chain, path))
        if block.type == "tree.cool_down" and path in self._cooled:
            return BAD
        end = yield from self.all(chain, path)
        if block.type == "tree.cool_down":
            self._cooled.add(path)
        if block.type == "tree.instead":
            outcome = self.trees._choice(block, "outcome")
            other = BAD if end == GOOD else GOOD
            return {"invert": other, "success": GOOD, "failure": BAD}[outcome]
        return end

    def _yes(self, block: Block) -> bool:
        return is_yes(self.trees.slot(block, "condition"))

    def _step(self, chain: list[str]) -> str:
        try:
            self.trees._chain(chain)
        except StepFailed:
            return BAD
        except Wrong:
            self.trees.said.append("error")
            return BAD
        return GOOD

    def _again(self, stop: str, parts: Sequence[tuple[Block, Path]]) -> Look:
        running: dict[int, Look] = {}
        while True:
            for number, (block, path) in enumerate(parts):
                looked = running.setdefault(number, self._part(block, path))
                end = _looked_at(looked)
                if end is not None:
                    del running[number]
                if end in (None, stop):
                    for later in [one for one in running if one > number]:
                        running.pop(later).close()
                if end == stop:
                    return stop
                if end is None:
                    break
            else:
                return GOOD if stop == BAD else BAD
            yield

    def _kept(self, parts: Sequence[tuple[Block, Path]], path: Path) -> Look:
        for number in range(self._places.get(path, 0), len(parts)):
            self._places[path] = number
            if (yield from self._part(*parts[number])) == BAD:
                return BAD
        self._places[path] = 0
        return GOOD

    def _beside(self, block: Block, parts: Sequence[tuple[Block, Path]]) -> Look:
        wanted = len(parts)
        if block.groups.get("limit"):
            wanted = min(wanted, rounded(self.trees.slot(block, "enough.1")))
        left = [self._part(*part) for part in parts]
        done = 0
        while True:
            ends = [(looked, _looked_at(looked)) for looked in left]
            left = [looked for looked, end in ends if end is None]
            done += sum(end == GOOD for _, end in ends)
            has_failed = any(end == BAD for _, end in ends)
            if has_failed or done >= wanted:
                for looked in left:
                    looked.close()
                return BAD if has_failed else GOOD
            yield

    def _while(self, block: Block, inside: Look) -> Look:
        while self._yes(block):
            if (end := _looked_at(inside)) is not None:
                return end
            yield
        inside.close()
        return BAD

    def _times(self, block: Block, chain: list[str], path: Path) -> Look:
        again = BAD if block.type == "tree.retry" else GOOD
        times = rounded(self.trees.slot(block, "times.1"))
        for number in range(times):
            end = yield from self.all(chain, path)
            if end != again:
                return end
            if number < times - 1:
                yield
        return again

    def _tree(self, block: Block, path: Path) -> Look:
        trees, ports = self.trees, []
        for one in (trees.project.blocks[b] for b in block.bodies.get("ports.1", [])):
            ports.append(one)
        own = {
            str(one.fields["key"]): trees.slot(one, "value")
            for one in ports
            if one.type == "tree.input"
        }
        inside = self.all(trees.tree(str(block.fields["name"])), path)
        while True:
            around, trees.board = trees.board, own
            try:
                end = _looked_at(inside)
            finally:
                trees.board = around
            if end is not None:
                break
            yield
        for one in ports:
            if one.type == "tree.output" and one.fields["key"] in own:
                around[str(one.fields["ours"])] = own[str(one.fields["key"])]
        return end


def _looked_at(part: Look) -> str | None:
    """Look at a part once: how it ended, or None while it runs."""
    try:
        next(part)
    except StopIteration as end:
        return str(end.value)
    return None


def _value(run: Interpreter, block: Block) -> Value:
    assert isinstance(run, Trees)
    key = str(block.fields["key"])
    if key not in run.board:
        raise Wrong("nothing is called so")
    return run.board[key]


def _set(run: Interpreter, block: Block) -> None:
    assert isinstance(run, Trees)
    value = run.slot(block, "value")
    run.board[str(block.fields["key"])] = value


def _fail(_run: Interpreter, _block: Block) -> None:
    raise StepFailed


REPORTERS["tree.value"] = _value
STATEMENTS["tree.set"] = _set
STATEMENTS["tree.fail"] = _fail

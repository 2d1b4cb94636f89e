"""What a running program has done to each block, as data."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from nep_core.messages import ProgramState
from nep_studio.blocks.generate.reporter_places import ReporterPlaces
from nep_studio.blocks.generate.source_map import Code

LONGEST_VALUE = 40
CALL = "@"
"""What the name of a value begins with that a call gave: "@line:begin-end"."""


@dataclass
class Marks:
    """The blocks that run, where the program pauses, how often rules fired, and what values are.

    ``glowing`` are the innermost blocks that run, ``around`` those that they were called from;
    ``values`` are by the Python name of the variable; ``results`` are what the reporters in a
    statement gave last, by the statement and the reporter. ``places`` finds a reporter's block.
    """

    code: Code = field(default_factory=lambda: Code("", ()))
    places: ReporterPlaces | None = None
    glowing: frozenset[str] = frozenset()
    around: frozenset[str] = frozenset()
    paused: dict[str, str] = field(default_factory=dict)
    counts: Counter[str] = field(default_factory=Counter)
    values: dict[str, str] = field(default_factory=dict)
    results: dict[str, dict[str, str]] = field(default_factory=dict)

    def take(self, state: ProgramState) -> None:
        """Take in what the program told."""
        match state.event:
            case "line":
                self._lines(state.lines)
            case "value":
                for name, text in state.values.items():
                    self._value(name, clipped(text))
            case "paused":
                block = self.code.block_at(state.line)
                if block is not None:
                    self.paused[state.thread] = block
            case "resumed":
                self._resumed(state.thread)
            case "rule_started":
                block = self.code.block_at(state.line)
                if block is not None:
                    self.counts[block] += 1
            case "started":
                self._begin()
            case "finished" | "failed":
                self.still()

    def still(self) -> None:
        """Nothing runs any more; counts and values stay, for whoever wants to read them."""
        self.glowing = self.around = frozenset()
        self.paused.clear()

    def _begin(self) -> None:
        """Nothing has run yet: it has just been started, perhaps again after it was killed."""
        self.still()
        self.counts.clear()
        self.values.clear()
        self.results.clear()

    def _value(self, name: str, text: str) -> None:
        if not name.startswith(CALL):
            self.values[name] = text
            return
        block = self.places.block_at(name) if self.places is not None else None
        line = int(name[1:].partition(":")[0])
        statement = self.code.block_at(line)
        if block is not None and statement is not None:
            self.results.setdefault(statement, {})[block] = text

    def _resumed(self, thread: str) -> None:
        if thread:
            self.paused.pop(thread, None)
        else:
            self.paused.clear()

    def _lines(self, lines: dict[str, list[int]]) -> None:
        inner, outer = set[str](), set[str]()
        for stack in lines.values():
            blocks = [block for line in stack if (block := self.code.block_at(line))]
            inner.update(blocks[-1:])
            outer.update(blocks[:-1])
        self.glowing, self.around = frozenset(inner), frozenset(outer - inner)
        for thread in [one for one in self.paused if one not in lines]:
            del self.paused[thread]


def clipped(text: str) -> str:
    """A value that is not too long for a block."""
    text = " ".join(text.split())
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 1]}…"

"""A target: one door of the program, the inputs it is tried with, and how they are made."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from fuzz.mutations import Mutate, flipped

HERE = Path(__file__).parent
SEEDS, FOUND = HERE / "seeds", HERE / "found"
LARGEST = 200_000
"""Bytes of an input: what is larger takes its time for no other reason than its size."""

Feed = Callable[[bytes], None]
"""Gives one input to the door; raises FaultError for what is told in a sentence, and no other."""
Open = Callable[[Path], AbstractContextManager[Feed]]
"""Opens the door; the folder is its own, empty, and goes with it."""


@dataclass(frozen=True)
class Target:
    """A door by its ``name``; ``mutate`` changes an input as its format suggests.

    ``answered`` names the kinds of errors that a library answers by itself and logs: they are no
    faults of ours. ``heavy`` names the kept inputs that are slow for their size alone: they are
    changed seldom, else they would take most of the time.
    """

    name: str
    open: Open
    mutate: Mutate = flipped
    answered: tuple[str, ...] = ()
    heavy: tuple[str, ...] = ()
    seeds_folder: Path = SEEDS

    @cached_property
    def seeds(self) -> tuple[bytes, ...]:
        """The kept inputs, in the order of their names."""
        return tuple(path.read_bytes() for path in self.seed_files)

    @property
    def seed_files(self) -> list[Path]:
        """Where they are."""
        return sorted(p for p in (self.seeds_folder / self.name).glob("*") if p.is_file())

    @cached_property
    def _light(self) -> tuple[bytes, ...]:
        named = zip(self.seed_files, self.seeds, strict=True)
        return tuple(data for path, data in named if path.name not in self.heavy)

    def input(self, seed: int, number: int) -> bytes:
        """The input of a number: first the kept ones as they are, then changes of them.

        The same for the same seed, number and kept inputs.
        """
        if number < len(self.seeds):
            return self.seeds[number]
        chance = random.Random(f"{seed}:{self.name}:{number}")
        return self.changed(chance)[:LARGEST]

    def changed(self, chance: random.Random) -> bytes:
        """A kept input with changes."""
        seeds: Sequence[bytes] = self.seeds or (b"",)
        often = seeds if not self.heavy or chance.random() < 0.01 else self._light
        data = chance.choice(often)
        if chance.random() < 0.15:  # as no format suggests
            return flipped(data, chance, seeds)
        return self.mutate(data, chance, seeds)

"""How a way of recognising gestures did in trials."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from nodes.perceptual.recognition.validation import Totals

CLEAN = ""
"""The sensor as it is: nothing is worse about it."""


@dataclass(frozen=True)
class Score:
    """How one way of recognising did in trials, at one threshold.

    ``sensor`` is CLEAN, or what was worse about it. ``false`` triggers were in ``idle_s`` of
    movement without gestures; ``right`` of ``marked`` cut-out takes were told apart.
    """

    trial: str
    method: str
    sensor: str
    threshold: float
    totals: Totals = field(default_factory=Totals)
    false: int = 0
    idle_s: float = 0.0
    right: int = 0
    marked: int = 0
    problem: str = ""

    @property
    def key(self) -> tuple[str, str, str, float]:
        """Scores with the same key are of the same kind, and may be added."""
        return self.trial, self.method, self.sensor, self.threshold

    def __add__(self, other: Score) -> Score:
        return replace(
            self,
            totals=self.totals + other.totals,
            false=self.false + other.false,
            idle_s=self.idle_s + other.idle_s,
            right=self.right + other.right,
            marked=self.marked + other.marked,
            problem=self.problem or other.problem,
        )

    @property
    def false_a_minute(self) -> float | None:
        """False triggers a minute of everyday movement; None when there was none."""
        return 60 * self.false / self.idle_s if self.idle_s else None

    @property
    def accuracy(self) -> float | None:
        """The part of the cut-out takes that were told apart."""
        return self.right / self.marked if self.marked else None

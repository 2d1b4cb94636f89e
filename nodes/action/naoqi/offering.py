"""What a node tells its robot's offering, where NAOqi programs may ask it too."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Sequence
from typing import Protocol

from nep_core.messages import ActionResult, SenseRequest


class Offering(Protocol):
    """What the node's loop tells an offered robot, and one that is not offered."""

    is_on: bool
    """Whether programs may ask the robot at any time."""
    lock: contextlib.AbstractContextManager[object]
    """To be held while the robot is touched."""
    description: str
    """Where programs reach it, in words."""

    def hear(
        self, told: Iterable[ActionResult], felt: Sequence[SenseRequest]
    ) -> list[ActionResult]:
        """Take in what happened; return the results that are to be sent on."""

    def close(self) -> None:
        """Offer it no more."""


class NotOffered:
    """A robot that only its node asks."""

    is_on = False
    description = ""

    def __init__(self) -> None:
        self.lock: contextlib.AbstractContextManager[object] = contextlib.nullcontext()

    def hear(
        self, told: Iterable[ActionResult], felt: Sequence[SenseRequest]
    ) -> list[ActionResult]:
        """Return all results."""
        return list(told)

    def close(self) -> None:
        """There is nothing to end."""

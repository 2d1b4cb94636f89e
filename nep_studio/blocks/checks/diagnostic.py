"""A diagnostic of a program as data: what is wrong, where, and what to do about it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

from faults import Words

Severity = Literal["error", "warning", "info"]
SEVERITIES: tuple[Severity, ...] = get_args(Severity)
"""The worst first."""


@dataclass(frozen=True, slots=True)
class Fix:
    """Something that the studio can do about a problem: its name, its button, what it needs."""

    name: str
    label: Words
    data: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """What is wrong with a program.

    An ``error`` keeps the program from running, a ``warning`` does not, ``info`` is good to know.
    ``kind`` is the same for all problems of a sort; ``block`` is empty when no block is meant.
    """

    severity: Severity
    kind: str
    page: str
    block: str
    sentence: Words
    checklist: tuple[Words, ...] = ()
    fix: Fix | None = None


Found = Iterator[Diagnostic | None]
"""What a check finds, one after the other; None wherever it may rest."""

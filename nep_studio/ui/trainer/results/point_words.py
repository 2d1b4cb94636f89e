"""What a recognition point of a gesture means, in one sentence with both of its sides."""

from __future__ import annotations

from nep_studio.ui.trainer.results.findings import Findings
from nep_studio.ui.words import count_words, tr

_NEVER = 0.05
"""Fewer false triggers an hour are told as none."""


def both_sides(findings: Findings, name: str, certainty: float) -> str:
    """How much is caught and how much is false at a certainty; empty when it was not measured."""
    point = findings.found_at(name, certainty)
    if point is None:
        return ""
    takes = findings.takes.get(name, 0)
    caught = tr("Caught {caught} of {all}", caught=round(point.caught * takes), all=takes)
    false = _false_words(findings, point.false_per_hour)
    others = round(point.false_in_others)
    parts = [caught, false]
    if others:
        parts.append(count_words(others, "once at another gesture", "{n} times at other gestures"))
    return " — ".join(parts)


def _false_words(findings: Findings, rate: float) -> str:
    if not findings.everyday_s:
        return tr("false triggers not known yet")
    if rate < _NEVER:
        minutes = round(findings.everyday_s / 60)
        return count_words(
            max(minutes, 1),
            "no false one in a minute of everyday movement",
            "no false one in {n} minutes of everyday movement",
        )
    return tr(
        "false about {rate} times an hour", rate=f"{rate:.0f}" if rate >= 3 else f"{rate:.1f}"
    )

"""Advice on who records, and on how much there is to learn from."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from nep_studio.ui.trainer.results.advice_parts import ENOUGH_TAKES, Advice, Known
from nep_studio.ui.trainer.results.findings import Findings
from nep_studio.ui.words import count_words, tr

_ENOUGH_EVERYDAY_S = 55.0
"""A minute, of which a moment may be missing at its ends."""
_PERSON_FOUND, _PERSON_MISSED = 0.8, 0.6


def on_people(findings: Findings, known: Known) -> Iterator[Advice]:
    """People whose gestures are not recognised by what the others taught."""
    found = [name for name, one in findings.people.items() if one.share >= _PERSON_FOUND]
    missed = [name for name, one in findings.people.items() if one.share < _PERSON_MISSED]
    for name in missed:
        person = _as_written(name, known.people)
        if found:
            other = _as_written(found[0], known.people)
            words = tr(
                "The gestures of {other} are recognised, those of {person} are not:"
                " record more with {person}.",
                other=other,
                person=person,
            )
        else:
            words = tr(
                "The gestures of {person} are seldom recognised: record more with {person}.",
                person=person,
            )
        yield Advice("problem", words, "record")


def on_few_takes(findings: Findings, known: Known) -> Iterator[Advice]:
    """Gestures with fewer takes than are enough."""
    few = {name: count for name, count in findings.takes.items() if count < ENOUGH_TAKES}
    if len(few) == 1:
        [(name, count)] = few.items()
        words = count_words(
            ENOUGH_TAKES - count,
            "Record “{gesture}” once more: {enough} takes are recognised better.",
            "Record “{gesture}” {n} more times: {enough} takes are recognised better.",
            gesture=known.title(name),
            enough=ENOUGH_TAKES,
        )
        yield Advice("tip", words, "record", name)
    elif few:
        words = tr(
            "Record each gesture {enough} times: {count} of them have fewer takes.",
            enough=ENOUGH_TAKES,
            count=len(few),
        )
        yield Advice("tip", words, "record", next(iter(few)))


def on_nothing_to_confuse(findings: Findings, known: Known) -> Iterator[Advice]:
    """What else there should be, so that it is learned what a gesture is not."""
    if len(findings.takes) == 1:
        [name] = findings.names
        words = tr(
            "Nothing could be mistaken for “{gesture}” yet: add a second gesture.",
            gesture=known.title(name),
        )
        yield Advice("tip", words, "gesture")
    if known.everyday_s < _ENOUGH_EVERYDAY_S:
        words = tr("Record a minute of everyday movement: false alarms become fewer.")
        yield Advice("tip", words, "everyday")


def all_good(findings: Findings) -> Advice:
    """That there is nothing to do better."""
    words = count_words(
        len(findings.takes),
        "The gesture is recognised well. Try it out.",
        "All {n} gestures are told apart well. Try them out.",
    )
    return Advice("good", words, "try")


def _as_written(name: str, people: Collection[str]) -> str:
    """A person's name as it is in the project: files have no spaces in names."""
    return next((one for one in people if re.sub(r"[\s,;\"]+", "_", one) == name), name)

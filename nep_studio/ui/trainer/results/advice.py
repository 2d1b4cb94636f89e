"""What the findings of a training mean in plain words, and what to do next."""

from __future__ import annotations

from collections.abc import Iterator

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.trainer.results.advice_parts import (
    ENOUGH_TAKES,
    MORE_TAKES,
    Advice,
    Known,
    takes_of_pair,
)
from nep_studio.ui.trainer.results.advice_tips import (
    all_good,
    on_few_takes,
    on_nothing_to_confuse,
    on_people,
)
from nep_studio.ui.trainer.results.findings import (
    HOUR_S,
    NOTHING,
    Findings,
    LeftOut,
    id_of_take,
)
from nep_studio.ui.words import count_words, tr

_OFTEN = 0.15
"""A mistake in so many of the takes is worth recording more."""
_FAR_BELOW = 0.4
"""A take that is recognised with so little certainty is not like the others."""
_MOSTLY_FOUND = 0.6
_FALSE_PER_HOUR = 2.0
"""More false triggers of a gesture in everyday movement disturb."""


def advice_on(findings: Findings, known: Known) -> list[Advice]:
    """Everything that is worth saying, the most helpful first; never empty."""
    if not findings.is_checked:
        return [*_too_few_to_check(findings, known)]
    found = [
        *_mistaken(findings, known),
        *_missed(findings, known),
        *_false_alarms(findings, known),
        *on_people(findings, known),
    ]
    told = {take for one in found for take in one.takes}
    found += [one for one in _outliers(findings, known) if not told.issuperset(one.takes)]
    if not found:
        found = [all_good(findings)]
    return [*found, *on_few_takes(findings, known), *on_nothing_to_confuse(findings, known)]


def headline(findings: Findings) -> str:
    """The result in one sentence."""
    if not findings.is_checked:
        return tr("Learned, but not checked yet")
    right, made = findings.right, findings.made
    return count_words(
        made,
        "{right} of 1 take was recognised by what the others taught",
        "{right} of {n} takes were recognised by what the others taught",
        right=right,
    )


def false_triggers(findings: Findings, *, is_simulated: bool) -> str:
    """How often everyday movement was taken for a gesture; ``is_simulated``: by nobody real."""
    if not findings.everyday_s or not findings.is_checked:
        return ""
    minutes, count = max(1, round(findings.everyday_s / 60)), findings.everyday_triggers
    rate = _rounded(count * HOUR_S / findings.everyday_s)
    if is_simulated and not count:
        return tr(
            "No false trigger in {minutes} min of everyday movement of simulated people",
            minutes=minutes,
        )
    if is_simulated:
        return tr(
            "About {rate} false triggers an hour, in {minutes} min of everyday movement of"
            " simulated people",
            rate=rate,
            minutes=minutes,
        )
    if not count:
        return tr("No false trigger in {minutes} min of everyday movement", minutes=minutes)
    return tr(
        "About {rate} false triggers an hour, in {minutes} min of everyday movement",
        rate=rate,
        minutes=minutes,
    )


def _too_few_to_check(findings: Findings, known: Known) -> Iterator[Advice]:
    for name, count in findings.takes.items():
        if count < 2:
            yield Advice(
                "tip",
                tr(
                    "“{gesture}” was recorded once. Record it {more} more times:"
                    " then it is checked how well it is recognised.",
                    gesture=known.title(name),
                    more=ENOUGH_TAKES - 1,
                ),
                "record",
                name,
            )


def _mistaken(findings: Findings, known: Known) -> Iterator[Advice]:
    """Gestures that are taken for others, the worst pair first."""
    pairs = {
        (made, found): count
        for (made, found), count in findings.confusion.items()
        if made != found and NOTHING not in (made, found)
    }
    told: set[tuple[str, str]] = set()
    for (made, found), count in sorted(pairs.items(), key=lambda pair: -pair[1]):
        back = pairs.get((found, made), 0)
        if (found, made) in told or count < _OFTEN * findings.takes.get(made, 1):
            continue
        told.add((made, found))
        takes = takes_of_pair(findings, known.gestures, made, found)
        if back:
            both = (*takes, *takes_of_pair(findings, known.gestures, found, made))
            yield _alike(findings, known, made, found, count + back, both)
        else:
            yield Advice(
                "problem", _mistaken_words(findings, known, made, found), "record", made, takes
            )


def _alike(
    findings: Findings, known: Known, one: str, other: str, count: int, takes: tuple[str, ...]
) -> Advice:
    made = findings.takes.get(one, 0) + findings.takes.get(other, 0)
    words = tr(
        "“{one}” and “{other}” are taken for each other {count} times in {made}:"
        " make them more different, one larger or in another direction.",
        one=known.title(one),
        other=known.title(other),
        count=count,
        made=made,
    )
    return Advice("problem", words, "takes", one, takes)


def _mistaken_words(findings: Findings, known: Known, made: str, found: str) -> str:
    return count_words(
        findings.confusion[made, found],
        "“{made}” is mistaken for “{found}” once in {all}: record {more} more, larger.",
        "“{made}” is mistaken for “{found}” {n} times in {all}: record {more} more, larger.",
        made=known.title(made),
        found=known.title(found),
        all=findings.takes.get(made, 0),
        more=MORE_TAKES,
    )


def _missed(findings: Findings, known: Known) -> Iterator[Advice]:
    counts = {name: findings.confusion.get((name, NOTHING), 0) for name in findings.names}
    for name, count in sorted(counts.items(), key=lambda item: -item[1]):
        if not count or count < _OFTEN * findings.takes[name]:
            continue
        words = count_words(
            count,
            "“{gesture}” is missed once in {all}: record {more} more, as you will make it later.",
            "“{gesture}” is missed {n} times in {all}: record {more} more, as you will make it"
            " later.",
            gesture=known.title(name),
            all=findings.takes[name],
            more=MORE_TAKES,
        )
        takes = takes_of_pair(findings, known.gestures, name, NOTHING)
        yield Advice("problem", words, "record", name, takes)


def _false_alarms(findings: Findings, known: Known) -> Iterator[Advice]:
    """Triggers in everyday movement, which would disturb."""
    rates = {}
    for name in findings.names:
        gesture = known.gestures.get(name)
        point = findings.found_at(name, gesture.certainty if gesture is not None else 0.75)
        if point is not None and point.false_per_hour >= _FALSE_PER_HOUR:
            rates[name] = point.false_per_hour
    for name, rate in sorted(rates.items(), key=lambda item: -item[1]):
        words = tr(
            "Everyday movement is taken for “{gesture}” about {rate} times an hour:"
            " set its recognition point higher, or record more of your everyday movement.",
            gesture=known.title(name),
            rate=_rounded(rate),
        )
        yield Advice("problem", words, "point", name)
    if not rates and not findings.curves and findings.everyday_triggers:
        rate = findings.everyday_triggers * HOUR_S / max(findings.everyday_s, 1.0)
        words = tr(
            "Everyday movement triggers a gesture about {rate} times an hour:"
            " record more of your everyday movement.",
            rate=_rounded(rate),
        )
        yield Advice("problem", words, "everyday")


def _outliers(findings: Findings, known: Known) -> Iterator[Advice]:
    """Single takes that are not like the others of their gesture."""
    for one in sorted(findings.left_out, key=lambda one: one.certainty):
        take = id_of_take(one, known.gestures)
        if not take or not _is_outlier(one, findings):
            continue
        values = {
            "gesture": known.title(one.gesture),
            "other": known.title(one.recognised),
            "number": _number_of(take, known.gestures[one.gesture]),
        }
        if one.recognised not in (NOTHING, one.gesture):
            words = tr(
                "Take {number} of “{gesture}” looks like “{other}”: is it in the right place?",
                **values,
            )
        else:
            words = tr(
                "Take {number} of “{gesture}” is not like the others: look at it, and delete it if"
                " it went wrong.",
                **values,
            )
        yield Advice("tip", words, "takes", one.gesture, (take,))


def _is_outlier(one: LeftOut, findings: Findings) -> bool:
    """Whether a take stands out while most of the others of its gesture are recognised."""
    right = findings.confusion.get((one.gesture, one.gesture), 0)
    if right < _MOSTLY_FOUND * findings.takes.get(one.gesture, 0):
        return False
    return one.recognised != one.gesture or one.certainty < _FAR_BELOW


def _number_of(take: str, gesture: OwnGesture) -> int:
    return [one.id for one in gesture.takes].index(take) + 1


def _rounded(rate: float) -> str:
    return f"{rate:.0f}" if rate >= 1 else f"{rate:.1f}"

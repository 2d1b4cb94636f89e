"""What the findings of a training mean in plain words, and what to do next."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QPushButton, QWidget

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import FlowLayout, in_column, in_row
from nep_studio.ui.words import count_words, tr

from .findings import HOUR_S, NOTHING, Findings, LeftOut, id_of_take
from .labels import StatusIcon, Words

# What a sentence of advice is, and what it is made from.

ENOUGH_TAKES = 5
MORE_TAKES = 3

Kind = Literal["problem", "tip", "good"]
What = Literal["", "record", "everyday", "gesture", "point", "takes", "try"]


@dataclass(frozen=True)
class Advice:
    """One sentence; ``what`` helps, with this gesture or these takes (ids)."""

    kind: Kind
    words: str
    what: What = ""
    gesture: str = ""
    takes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Known:
    """What the project has: its gestures by name, people, seconds of everyday movement."""

    gestures: Mapping[str, OwnGesture]
    people: Collection[str] = ()
    everyday_s: float = 0.0

    def title(self, name: str) -> str:
        """What a gesture is called."""
        gesture = self.gestures.get(name)
        return gesture.title if gesture is not None else name


def takes_of_pair(
    findings: Findings, gestures: Mapping[str, OwnGesture], made: str, found: str
) -> tuple[str, ...]:
    """The ids of the takes of one gesture that were taken for another, or for nothing."""
    concerned = (one for one in findings.left_out if (one.gesture, one.recognised) == (made, found))
    ids = (id_of_take(one, gestures) for one in concerned)
    return tuple(take for take in ids if take)


# Advice on who records, and on how much there is to learn from.

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
    return count_words(
        findings.made,
        "{right} of 1 take was recognised by what the others taught",
        "{right} of {n} takes were recognised by what the others taught",
        right=findings.right,
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
            words = tr(
                "“{gesture}” was recorded once. Record it {more} more times:"
                " then it is checked how well it is recognised.",
                gesture=known.title(name),
                more=ENOUGH_TAKES - 1,
            )
            yield Advice("tip", words, "record", name)


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
            words = _mistaken_words(findings, known, made, found)
            yield Advice("problem", words, "record", made, takes)


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
            "number": [each.id for each in known.gestures[one.gesture].takes].index(take) + 1,
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


def _rounded(rate: float) -> str:
    return f"{rate:.0f}" if rate >= 1 else f"{rate:.1f}"


# Shows what the findings mean: a sentence each, with a button for what helps.

MOST_SHOWN = 4
"""So many at once; the rest is shown when it is asked for."""
_SIGNS: dict[Kind, tuple[str, str]] = {
    "problem": ("triangle-alert", "warning"),
    "tip": ("lightbulb", "info"),
    "good": ("circle-check", "success"),
}


def _kind_words(kind: Kind) -> str:
    words = {"problem": tr("To do better"), "tip": tr("A tip"), "good": tr("Well done")}
    return words[kind]


def _button_words(what: What) -> str:
    words = {
        "record": tr("Record more"),
        "everyday": tr("Record everyday movement"),
        "gesture": tr("Add a gesture"),
        "point": tr("Set the point"),
        "takes": tr("Show the takes"),
        "try": tr("Try it out"),
    }
    return words.get(what, "")


class AdviceList(QWidget):
    """``asked`` gives the Advice whose button was pressed, ``takes_asked`` the ids of takes."""

    asked = Signal(object)
    takes_asked = Signal(object)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._advice: tuple[Advice, ...] = ()
        self._shows_all = False
        self.rows: list[AdviceRow] = []
        self.more = QPushButton()
        self.more.setProperty("kind", "quiet")
        self.more.clicked.connect(self._on_more)
        self._box = in_column((self.more, 0, Qt.AlignmentFlag.AlignLeading), of=self, margins=0)
        self.more.hide()

    def show_advice(self, advice: Sequence[Advice]) -> None:
        """Show these; nothing is built again when they are the same."""
        if tuple(advice) != self._advice:
            self._advice, self._shows_all = tuple(advice), False
            self._fill()

    def _fill(self) -> None:
        for row in self.rows:
            row.hide()
            row.deleteLater()
        most = len(self._advice) if self._shows_all else MOST_SHOWN
        self.rows = [AdviceRow(one, self._look, self) for one in self._advice[:most]]
        for at, row in enumerate(self.rows):
            self._box.insertWidget(at, row)
        hidden = len(self._advice) - len(self.rows)
        self.more.setVisible(hidden > 0)
        self.more.setText(count_words(hidden, "1 more tip", "{n} more tips"))

    def _on_more(self) -> None:
        self._shows_all = True
        self._fill()
        if len(self.rows) > MOST_SHOWN:
            self.rows[MOST_SHOWN].button.setFocus()


class AdviceRow(QWidget):
    """One sentence, and the buttons below it."""

    def __init__(self, advice: Advice, look: Look, of: AdviceList) -> None:
        super().__init__(of)
        self.advice = advice
        self.setAccessibleName(f"{_kind_words(advice.kind)}: {advice.words}")
        sign, self.words = StatusIcon(look), Words(advice.words)
        sign.setToolTip(_kind_words(advice.kind))
        self.button = QPushButton(_button_words(advice.what))
        self.button.clicked.connect(lambda: of.asked.emit(advice))
        self.show_takes = QPushButton(_button_words("takes"))
        self.show_takes.clicked.connect(lambda: of.takes_asked.emit(advice.takes))
        for button in (self.button, self.show_takes):
            button.setProperty("kind", "quiet")
            button.setAccessibleDescription(advice.words)
        buttons = FlowLayout(spacing=4, widgets=(self.button, self.show_takes))
        words = in_column(self.words, buttons, spacing=0)
        in_row((sign, 0, Qt.AlignmentFlag.AlignTop), (words, 1), of=self, margins=0)
        # Not before: what is shown without a parent is a window for a moment
        sign.show_icon(*_SIGNS[advice.kind])
        self.button.setVisible(bool(advice.what))
        self.show_takes.setVisible(bool(advice.takes) and advice.what != "takes")

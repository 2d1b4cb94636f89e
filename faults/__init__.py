"""What happened, as data: a sentence with places, the values that fill them, and what to try.

Every room may import this one, and it imports none. Who raises or tells something gives a template
with named values and a code; who shows it makes words of them, once, in the reader's language::

    raise PortTaken("Port {port} is used by {program}.", port=7000, program=name)

    messages.tell(told(error.fault.sentence, tr))

Nobody reads a sentence to learn what happened: that is what ``code`` and ``values`` are for.

``files`` beside it writes a file so that no fault leaves half of one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from typing import ClassVar, Protocol

import msgspec


class Text(msgspec.Struct, frozen=True, omit_defaults=True):
    """A sentence of ours, in English, with named places in curly brackets.

    ``values`` fill the places. A ``Text`` among them is ours too, and is translated with it; a
    ``str`` is a name, a path or a person's own words, and stays as it is. Several stand with
    commas between them. Without values the sentence is taken as it is, brackets and all.
    """

    text: str
    values: dict[str, Value] = {}

    def __str__(self) -> str:
        return told(self)

    def __bool__(self) -> bool:
        return bool(self.text)


LONGEST = 2000
"""So many letters of a sentence or a value from another program are told."""
DEEPEST = 4
"""So deep are texts from another program in each other; ours are three deep."""
MOST_VALUES = 50
MOST_STEPS = 20
"""More steps of a checklist than a person would read are left out."""

_STOPS = ".。"
_GOES_ON = tuple(".。;,:)；、，）")  # noqa: RUF001 - Japanese has signs of its own
"""Before these a sentence within another loses its full stop."""

_SAID = "{said}"
_PLACE = re.compile(r"\{(\w+)\}")

Value = str | int | float | bool | Text | list[str | Text]
Words = Text | str
"""A ``str`` is a sentence of ours without places, or what is no sentence of ours."""


class Fault(msgspec.Struct, frozen=True, omit_defaults=True):
    """What went wrong, for programs and for people.

    ``code`` says what, in words joined by low lines, and never changes with a language or a
    wording; ``checklist`` is what to try, in order; ``details`` are for those who help.
    """

    code: str
    sentence: Text
    checklist: tuple[Text, ...] = ()
    details: str = ""

    @property
    def values(self) -> dict[str, Value]:
        """The values by name, for programs that ask what exactly happened."""
        return self.sentence.values

    def __str__(self) -> str:
        return str(self.sentence)


class _Inner(str):
    """The words of a text that stands within another."""

    __slots__ = ()


class Tr(Protocol):
    """Makes words of a text, or of a template and its values, in a language."""

    def __call__(self, text: Words, /, **values: object) -> str:
        """Return the words."""


def plain(text: Words, /, **values: object) -> str:
    """Return the English words."""
    return told(text) if isinstance(text, Text) else filled(text, values, plain)


def told(text: Words, tr: Tr = plain) -> str:
    """Return the words of a text, and of the texts in its places, in the language of ``tr``."""
    if isinstance(text, str):
        return tr(text)
    return tr(text.text, **{name: _told(value, tr) for name, value in text.values.items()})


def filled(template: str, values: Mapping[str, object], tr: Tr) -> str:
    """Return the template with each ``{name}`` that is known filled in, and nothing else touched.

    Texts among the values are told in the language of ``tr``.

    Not ``str.format``: a template may come from another program, and could ask for attributes or
    for a billion spaces. A text without values is taken as it is, brackets and all.
    """
    if not values:
        return template
    words, end = "", 0
    for found in _PLACE.finditer(template):
        value = _told(values.get(found[1], found[0]), tr)
        goes_on = template[found.end() : found.end() + 1] in _GOES_ON
        said = value.rstrip(_STOPS) if isinstance(value, _Inner) and goes_on else str(value)
        words, end = words + template[end : found.start()] + said, found.end()
    return words + template[end:]


def fault_of(
    words: Words | Fault, /, *, code: str = "", checklist: Sequence[Words] = (), **values: object
) -> Fault:
    """Return what happened, by its words and the values of their places, if it is none yet."""
    if isinstance(words, Fault):
        return words
    return Fault(code, text_of(words, **values), tuple(_step(step, values) for step in checklist))


def fault_in(error: BaseException) -> Fault:
    """Return what an error tells of; one that is not ours is told by its own words."""
    if isinstance(error, FaultError):
        return error.fault
    name = type(error).__name__
    return Fault(f"python:{name}", verbatim(str(error) or name))


def text_of(words: Words, /, **values: object) -> Text:
    """Return a text, made of a template and its values if it is none yet.

    A fault or an error among the values is told with its sentence; what else is no value of a
    text, such as a path, with its own words.
    """
    if isinstance(words, Text):
        return words
    return Text(words, {name: _value(value) for name, value in values.items()})


def verbatim(words: str) -> Text:
    """Return somebody else's words as a text, which stay as they are in every language."""
    return Text(_SAID, {"said": words}) if words else Text("")


def reason_of(error: Exception) -> Text:
    """Return why the system refuses, in its own words: "permission denied"."""
    number = getattr(error, "errno", None)
    words = getattr(error, "strerror", None) or (os.strerror(number) if number else "")
    return Text(words.lower() or "the system gives no reason")


class FaultError(Exception):
    """An error that a person can act on: what happened, and a checklist of what to try in order.

    ``sentence`` is a template; ``values`` fill its places, and those of the checklist's steps.
    ``code`` is that of the class unless a more exact one is given.
    """

    title: ClassVar[str] = "Something went wrong"
    code: ClassVar[str] = "fault"

    def __init__(
        self,
        sentence: Words,
        /,
        *,
        checklist: Sequence[Words] = (),
        details: str = "",
        code: str = "",
        **values: object,
    ) -> None:
        fault = fault_of(sentence, code=code or self.code, checklist=checklist, **values)
        self.fault = msgspec.structs.replace(fault, details=details)
        super().__init__(str(fault))
        for step in self.fault.checklist:
            self._note(step)

    def __init_subclass__(cls, title: str = "") -> None:
        super().__init_subclass__()
        cls.title = title or cls.title
        if "code" not in vars(cls):
            cls.code = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", cls.__name__).lower()

    @classmethod
    def of(cls, fault: Fault) -> FaultError:
        """Return an error of this class that tells of a fault, such as one from another program."""
        return cls(
            fault.sentence, checklist=fault.checklist, details=fault.details, code=fault.code
        )

    def advise(self, step: Words, /, **values: object) -> None:
        """Add a step to the end of the checklist; who catches an error may know more."""
        more = text_of(step, **values)
        self.fault = msgspec.structs.replace(self.fault, checklist=(*self.fault.checklist, more))
        self._note(more)

    def _note(self, step: Text) -> None:
        self.add_note(f"  [ ] {step}")  # what a traceback of somebody's script shows, too

    @property
    def sentence(self) -> Text:
        """What happened."""
        return self.fault.sentence

    @property
    def checklist(self) -> tuple[Text, ...]:
        """What to try, in order."""
        return self.fault.checklist

    @property
    def details(self) -> str:
        """What is told to those who help."""
        return self.fault.details


def _step(step: Words, values: dict[str, object]) -> Text:
    """Give a step of a checklist those values of the sentence that it names."""
    if isinstance(step, Text):
        return step
    return text_of(step, **{name: values[name] for name in values.keys() & _PLACE.findall(step)})


def _value(value: object) -> Value:
    match value:
        case FaultError():
            return value.fault.sentence
        case Fault():
            return value.sentence
        case Text() | bool():
            return value
        case int():
            return int(value)
        case float():
            return float(value)  # not numpy's, which no message can carry
        case list() | tuple():
            return [one if isinstance(one, Text) else str(one) for one in value]
    return str(value)


# What another program told, which may be anything.


def heard(told: object, deepest: int = DEEPEST) -> Text:
    """Return what came as a template, or as an object of "text" and "values", as a text.

    Nothing of it can fail: what is too long is cut, and what is no value is told as it is.
    """
    match told:
        case str():
            return Text(_cut(told))
        case {"text": str(text), "values": dict(values)} if deepest:
            named = list(values.items())[:MOST_VALUES]
            return Text(_cut(text), {str(name): _heard(one, deepest - 1) for name, one in named})
        case {"text": str(text)}:
            return Text(_cut(text))
    return verbatim(_cut(repr(told)) if deepest else "…")


def heard_fault(told: object) -> Fault | None:
    """Return what came as the object of a fault; None when it says nothing."""
    if not isinstance(told, dict) or not (sentence := heard(told.get("sentence", ""))):
        return None
    steps = told.get("checklist")
    checklist = tuple(map(heard, steps[:MOST_STEPS])) if isinstance(steps, list) else ()
    code, details = (
        word if isinstance(word, str) else "" for word in (told.get("code"), told.get("details"))
    )
    return Fault(code, sentence, checklist, details)


def _heard(value: object, deepest: int) -> Value:
    match value:
        case bool() | float():
            return value
        case int():
            return value if value.bit_length() <= 64 else float("inf")
        case str():
            return _cut(value)
        case dict():
            return heard(value, deepest)
        case list():
            return [
                heard(one, deepest) if isinstance(one, dict) else _cut(str(one))
                for one in value[:MOST_VALUES]
            ]
    return str(value)


def _cut(words: str) -> str:
    return words if len(words) <= LONGEST else words[:LONGEST] + "…"


def _told(value: object, tr: Tr) -> object:
    match value:
        case Text():
            return _Inner(told(value, tr))
        case list():
            return ", ".join(told(one, tr) if isinstance(one, Text) else str(one) for one in value)
    return value

"""Finds the translation of a sentence whose values have been filled in already."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

LONGEST = 2000
"""Longer texts are what people wrote, not sentences of the program."""
MOST_SENTENCES = 12
"""A text of more sentences is not looked at one by one."""

_PLACE = re.compile(r"\{(\w+)\}")
_BETWEEN = re.compile(r"((?<=[.?]) +|\s*\n(?:\[ \] )?)")
"""What stands between two sentences, or between the steps of a checklist in one text."""
_WORDS_OF_OURS = {
    "description",
    "family",
    "in_words",
    "fault",
    "file_name",
    "noun",
    "outcome",
    "page",
    "part",
    "place",
    "places",
    "problem",
    "reason",
    "result",
    "samples",
    "sentence",
    "source",
    "told",
    "wanted",
    "where",
    "word",
    "why",
}
"""Places for words of the program, which are translated too; the others have people's words."""
_NOUNS = {"family", "noun", "page", "result"}
"""Places for a few words, never for a sentence with quotes in it."""
_QUOTE = "“"


LookUp = Callable[[str], str]
"""Gives the translation of words, or the words themselves where there is none."""


@dataclass(frozen=True, slots=True)
class _Template:
    pattern: str
    anchor: str
    translation: str
    ours: frozenset[str]


class MessageTemplates:
    """The sentences with places to fill, found by how they begin."""

    def __init__(self, translations: Mapping[str, str]) -> None:
        by_detail = sorted(translations, key=lambda words: -len(_PLACE.sub("", words)))
        placed = [english for english in by_detail if _PLACE.search(english)]
        self._by_first_word: dict[str, list[_Template]] = {
            word: [] for word in ("", *map(_first_word, placed))
        }
        for english in placed:
            first = _first_word(english)
            template = _template(english, translations[english])
            for kept in [self._by_first_word[first]] if first else self._by_first_word.values():
                kept.append(template)

    def translated(self, text: str, look_up: LookUp) -> str | None:
        """The translation of a filled sentence; None when no template is like it.

        Nouns and sentences in it are looked up themselves. The template with most words wins.
        Where the whole is like none, each of its sentences must be.
        """
        if len(text) > LONGEST:
            return None
        return self._filled(text, look_up) or _ended(text, look_up) or _in_parts(text, look_up)

    def _filled(self, text: str, look_up: LookUp) -> str | None:
        kept = self._by_first_word
        for template in kept.get(_first_word(text), kept[""]):
            if template.anchor in text and (found := _compiled(template.pattern).fullmatch(text)):
                values = {
                    name: _part(value, look_up) if name in template.ours else value
                    for name, value in found.groupdict().items()
                }
                return template.translation.format_map(values)
        return None


def _part(value: str, look_up: LookUp) -> str:
    """Words within a sentence: a sentence in there may lack its full stop, or begin large."""
    if (told := look_up(value)) != value:
        return told
    if (told := look_up(f"{value}.")) != f"{value}.":
        return told.rstrip(".。")
    small = value[:1].lower() + value[1:]
    return told if (told := look_up(small)) != small else value


def _ended(text: str, look_up: LookUp) -> str | None:
    """Words that are known without the full stop, such as how a node ended."""
    words = text.removesuffix(".")
    if words == text or (told := look_up(words)) == words:
        return None
    is_japanese = "\u3040" <= told[-1:] <= "\u9fff"
    return told + ("。" if is_japanese else ".")


def _in_parts(text: str, look_up: LookUp) -> str | None:
    """Several sentences, each translated; None when one of them is not known."""
    parts = _BETWEEN.split(text)
    if not 1 < len(parts) < 2 * MOST_SENTENCES:
        return None
    told = ""
    begin = 0
    while begin < len(parts):
        for end in range(len(parts), begin, -2):
            words = "".join(parts[begin:end])
            if words != text and (said := look_up(words)) != words:
                break
        else:
            return None
        told += said + "".join(parts[end : end + 1])
        begin = end + 1
    return told


def _first_word(text: str) -> str:
    """The word that a text begins with; nothing when a value is in it."""
    word, space, _ = text.partition(" ")
    return word if space and _QUOTE not in word and "{" not in word else ""


def _template(english: str, translation: str) -> _Template:
    """Prepare a sentence; quoted values are taken as they are, whatever they are called."""
    parts = _PLACE.split(english)
    literals, names = parts[::2], parts[1::2]
    pattern = re.escape(literals[0])
    for name, literal in zip(names, literals[1:], strict=True):
        filled = "[^“”:]" if name in _NOUNS and not pattern.endswith(_QUOTE) else "."
        if not pattern and name not in _WORDS_OF_OURS:
            filled = "(?:(?!: ).)"  # else “x could not: y sits” would be a “y sits”
        pattern += f"(?P<{name}>{filled}*?){re.escape(literal)}"
    ours = {
        name
        for before, name in zip(literals, names, strict=False)
        if name in _WORDS_OF_OURS and not before.endswith(_QUOTE)
    }
    anchor = max(literals, key=len)
    return _Template(pattern, anchor, translation, frozenset(ours))


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    """Compiled when a text may be like it: most sentences are never told."""
    return re.compile(pattern, re.DOTALL)

"""Finds the translation of a sentence whose values have been filled in already."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

LONGEST = 2000
"""Longer texts are what people wrote, not sentences of the program."""

_PLACE = re.compile(r"\{(\w+)\}")
_WORDS_OF_OURS = {
    "fault",
    "file_name",
    "noun",
    "page",
    "place",
    "places",
    "reason",
    "result",
    "sentence",
    "told",
    "wanted",
    "where",
}
"""Places for words of the program, which are translated too; the others have people's words."""
_NOUNS = {"noun", "page", "result"}
"""Places for a few words, never for a sentence with quotes in it."""
_QUOTE = "“"


@dataclass(frozen=True, slots=True)
class _Template:
    pattern: re.Pattern[str]
    anchor: str
    translation: str
    ours: frozenset[str]


class MessageTemplates:
    """The sentences with places to fill, found by how they begin."""

    def __init__(self, translations: Mapping[str, str]) -> None:
        self._by_first_word: dict[str, list[_Template]] = {}
        by_detail = sorted(translations, key=lambda words: -len(_PLACE.sub("", words)))
        for english in by_detail:
            if _PLACE.search(english):
                kept = self._by_first_word.setdefault(_first_word(english), [])
                kept.append(_template(english, translations[english]))

    def translated(self, text: str, look_up: Callable[[str], str]) -> str | None:
        """The translation of a filled sentence; None when no template is like it.

        Nouns and sentences in it are looked up themselves. The template with most words wins.
        """
        if len(text) > LONGEST:
            return None
        first = _first_word(text)
        for template in self._candidates(first):
            if template.anchor in text and (found := template.pattern.fullmatch(text)):
                values = {
                    name: look_up(value) if name in template.ours else value
                    for name, value in found.groupdict().items()
                }
                return template.translation.format_map(values)
        return None

    def _candidates(self, first: str) -> Iterable[_Template]:
        if first:
            yield from self._by_first_word.get(first, ())
        yield from self._by_first_word.get("", ())


def _first_word(text: str) -> str:
    """The word that a text begins with; nothing when a value is in it."""
    word, space, _ = text.partition(" ")
    return word if space and _QUOTE not in word and "{" not in word else ""


def _template(english: str, translation: str) -> _Template:
    """Compile a sentence; quoted values are taken as they are, whatever they are called."""
    parts = _PLACE.split(english)
    literals, names = parts[::2], parts[1::2]
    pattern = re.escape(literals[0])
    for name, literal in zip(names, literals[1:], strict=True):
        filled = "[^“”:]" if name in _NOUNS and not pattern.endswith(_QUOTE) else "."
        pattern += f"(?P<{name}>{filled}*?){re.escape(literal)}"
    ours = {
        name
        for before, name in zip(literals, names, strict=False)
        if name in _WORDS_OF_OURS and not before.endswith(_QUOTE)
    }
    anchor = max(literals, key=len)
    return _Template(re.compile(pattern, re.DOTALL), anchor, translation, frozenset(ours))

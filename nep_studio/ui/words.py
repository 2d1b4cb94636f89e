"""The words of the window in the language of the person who uses it."""

from __future__ import annotations

import logging
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import takewhile
from pathlib import Path

from faults import Text, Words, filled, told
from nep_studio import paths

log = logging.getLogger(__name__)

ENGLISH = "en"
PSEUDO = "qps-rtl"
"""A made-up language for tests: longer than English, written from the right, still readable."""

_RIGHT_TO_LEFT = {"ar", "dv", "fa", "he", "ks", "ku", "ps", "sd", "ug", "ur", "yi", PSEUDO}
_PLACES = re.compile(r"(\{[^{}]*\})")
_ACCENTED = str.maketrans("aeiouyAEIOUYcnCN", "àéîôûýÀÉÎÔÛÝçñÇÑ")


@dataclass(frozen=True)
class _Catalogue:
    code: str = ENGLISH
    words: Mapping[str, str] = field(default_factory=dict)


_used = _Catalogue()


def tr(text: Words, /, **values: object) -> str:
    """Return the words in the language in use, with ``{name}`` filled in from the values.

    The English text, with its places, is the key: words are told from it and never read. A text
    brings its values with it. What is not translated yet is given in English.
    """
    if isinstance(text, Text):
        return told(text, tr)
    if not text:
        return ""
    words = _pseudo(text) if _used.code == PSEUDO else _used.words.get(text) or text
    if not values:
        return words
    if words is not text and not set(_PLACES.findall(words)) <= set(_PLACES.findall(text)):
        log.warning("A message in %s cannot be filled in: %r", _used.code, text)
        words = text
    return filled(words, values, tr)


def count_words(count: int, one: str, many: str, /, **values: object) -> str:
    """Return ``one`` ("1 block") or ``many`` ("{n} blocks"), translated, with the count as n.

    Both are keys of their own in a table. A language with one form gives both the same words; one
    with more forms writes the many form so that it is right for all, as in "blocks: {n}".
    """
    return tr(one if count == 1 else many, n=count, **values)


def use_language(code: str) -> None:
    """Take the words from the table of this language; unknown ones leave the window English."""
    global _used
    _used = _catalogue(code, paths.resources()) if code in _known() else _Catalogue()


def language_code() -> str:
    """The code of the language in use, such as "en" or "ja"."""
    return _used.code


def is_right_to_left() -> bool:
    """Whether the language in use is written from right to left."""
    return _used.code in _RIGHT_TO_LEFT or _used.code.partition("-")[0] in _RIGHT_TO_LEFT


def available_languages() -> dict[str, str]:
    """The languages a person can choose: code to name, as its speakers write it."""
    return {ENGLISH: "English"} | {code: _name(code) for code in _codes()}


def _codes() -> list[str]:
    return sorted(path.stem for path in (paths.resources() / "translations").glob("*.toml"))


def _known() -> Iterable[str]:
    return {ENGLISH, PSEUDO, *_codes()}


def _name(code: str) -> str:
    return read_name(_path(code))


def read_name(path: Path) -> str:
    """The own name of a table's language, which stands before the rest: that takes long to read."""
    with path.open(encoding="utf-8") as lines:
        head = takewhile(lambda line: not line.startswith("["), lines)
        name: str = tomllib.loads("".join(head)).get("name", path.stem)
    return name


def _path(code: str) -> Path:
    return paths.resources() / "translations" / f"{code}.toml"


@lru_cache(maxsize=8)
def _catalogue(code: str, _resources: Path) -> _Catalogue:
    """The words of a language, which take long to read, from the resources in use."""
    if code in (ENGLISH, PSEUDO):
        return _Catalogue(code)
    return read_catalogue(code, _path(code))


def read_catalogue(code: str, path: Path) -> _Catalogue:
    """The words of a table."""
    table = tomllib.loads(path.read_text(encoding="utf-8"))
    return _Catalogue(code, {**table.get("messages", {}), **table.get("window", {})})


def _pseudo(text: str) -> str:
    """Lengthen a text by two fifths and accent its letters; what is filled in stays."""
    if text == "{said}" or text.endswith("·]"):
        return text  # somebody's own words, or what is told already
    parts = _PLACES.split(text)
    said = [part if _PLACES.fullmatch(part) else part.translate(_ACCENTED) for part in parts]
    return "[" + "".join(said) + "·" * (2 * len(text) // 5 + 1) + "]"

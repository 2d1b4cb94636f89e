"""The words of the window in the language of the person who uses it."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import takewhile
from pathlib import Path

from faults import Text, Words, filled, told
from faults.files import opened, read_toml, toml_of
from nep_studio import paths

log = logging.getLogger(__name__)

ENGLISH = "en"
PSEUDO = "qps-rtl"
"""A made-up language for tests: longer than English, written from the right, still readable."""

LONGEST_NAME = 60
LONGEST_HEAD = 100_000
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
    try:
        with opened(path) as file:
            lines = file.read(LONGEST_HEAD).splitlines(keepends=True)
        head = takewhile(lambda line: not line.startswith(b"["), lines)
        name = toml_of(b"".join(head).decode()).get("name", "")
    except (OSError, ValueError, RecursionError):
        return path.stem  # what is wrong is told when it is chosen
    is_name = isinstance(name, str) and name.isprintable() and 0 < len(name) <= LONGEST_NAME
    return name if is_name else path.stem


def _path(code: str) -> Path:
    return paths.resources() / "translations" / f"{code}.toml"


@lru_cache(maxsize=8)
def _catalogue(code: str, _resources: Path) -> _Catalogue:
    """The words of a language, which take long to read, from the resources in use."""
    if code in (ENGLISH, PSEUDO):
        return _Catalogue(code)
    return read_catalogue(code, _path(code))


def read_catalogue(code: str, path: Path) -> _Catalogue:
    """The words of a table; none, and a warning, when it cannot be read: they stay English then."""
    try:
        table = read_toml(path)
    except (OSError, ValueError, RecursionError) as error:
        log.warning("The words of %s cannot be read, and stay English: %s", path.name, error)
        return _Catalogue(code)
    parts = (table.get(name) for name in ("messages", "window"))
    texts = [item for part in parts if isinstance(part, dict) for item in part.items()]
    return _Catalogue(code, {key: words for key, words in texts if isinstance(words, str)})


def _pseudo(text: str) -> str:
    """Lengthen a text by two fifths and accent its letters; what is filled in stays."""
    if text == "{said}" or text.endswith("·]"):
        return text  # somebody's own words, or what is told already
    parts = _PLACES.split(text)
    said = [part if _PLACES.fullmatch(part) else part.translate(_ACCENTED) for part in parts]
    return "[" + "".join(said) + "·" * (2 * len(text) // 5 + 1) + "]"

"""The hand-written texts of the help, in the person's language or else in English."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from nep_studio import paths

ENGLISH = "en"


@dataclass(frozen=True)
class BlockText:
    """What people wrote about a block.

    ``words`` are other words by which it is searched for, ``see`` the ids of other pages,
    ``slots`` what is to be said about a slot.
    """

    about: str = ""
    tip: str = ""
    words: str = ""
    see: tuple[str, ...] = ()
    slots: Mapping[str, str] = field(default_factory=dict)


def help_folder() -> Path:
    """Where the texts, pages and examples of the help are."""
    return paths.resources() / "help"


def first_file(name: str, code: str) -> Path | None:
    """A file of the help in a language, else in English."""
    places = (help_folder() / each / name for each in (code, ENGLISH))
    return next((path for path in places if path.is_file()), None)


@cache
def block_texts(code: str) -> Mapping[str, BlockText]:
    """What is written about each block, by its id; a text that is not translated is English."""
    english = _tables("blocks", ENGLISH)
    own = {} if code == ENGLISH else _tables("blocks", code)
    return {block: _block_text({**told, **own.get(block, {})}) for block, told in english.items()}


@cache
def node_texts(code: str) -> Mapping[str, str]:
    """What is written about each node, by its id."""
    return _merged("nodes", code)


@cache
def category_texts(code: str) -> Mapping[str, str]:
    """What is written about each category of blocks, by its id."""
    return _merged("categories", code)


@cache
def error_texts(code: str) -> Mapping[str, Mapping[str, Any]]:
    """What is written about each error, by its English title: about, and what to try."""
    own = {} if code == ENGLISH else _tables("errors", code)
    return {title: {**told, **own.get(title, {})} for title, told in _tables("errors").items()}


@cache
def translated_texts(code: str) -> Mapping[str, str]:
    """The texts in examples, by the English ones."""
    path = help_folder() / code / "examples.toml"
    return {} if code == ENGLISH or not path.is_file() else _read(path)


@cache
def page_texts(code: str) -> Mapping[str, str]:
    """The How-to pages as Markdown, by name, each in the language or else in English."""
    names = sorted(path.stem for path in (help_folder() / ENGLISH).glob("*.md"))
    found = ((name, first_file(f"{name}.md", code)) for name in names)
    return {name: path.read_text(encoding="utf-8") for name, path in found if path is not None}


def _block_text(told: Mapping[str, Any]) -> BlockText:
    return BlockText(
        told.get("about", ""),
        told.get("tip", ""),
        told.get("words", ""),
        tuple(told.get("see", ())),
        told.get("slots", {}),
    )


def _merged(stem: str, code: str) -> Mapping[str, str]:
    english: dict[str, Any] = dict(_tables(stem))
    return english if code == ENGLISH else {**english, **_tables(stem, code)}


def _tables(stem: str, code: str = ENGLISH) -> dict[str, Any]:
    """Everything in the files ``<stem>.toml`` and ``<stem>_*.toml`` of a language."""
    tables: dict[str, Any] = {}
    for path in _files(stem, code):
        tables |= _read(path)
    return tables


def _files(stem: str, code: str) -> Iterator[Path]:
    folder = help_folder() / code
    yield from sorted(folder.glob(f"{stem}.toml"))
    yield from sorted(folder.glob(f"{stem}_*.toml"))


def _read(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text(encoding="utf-8"))

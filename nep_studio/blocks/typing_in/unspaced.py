"""Typed sentences of languages that are written without spaces: where their words are."""

from __future__ import annotations

import re
from collections.abc import Container

from ..operations.finding import folded

_SIGNS = "\u3040-\u30ff\u3400-\u9fff\uff66-\uff9f"
_UNSPACED = re.compile(f"[{_SIGNS}]")
_RUN = re.compile(f'"[^"]*"|“[^”]*”|「[^」]*」|[{_SIGNS}]+|\\s+|[^{_SIGNS}\\s]+')
_SHORTEST_END = 2
"""Shorter words may be the end of another one: they are looked for behind other signs only."""


def is_unspaced(text: str) -> bool:
    """Whether a text has signs of a writing without spaces, such as Japanese."""
    return _UNSPACED.search(text) is not None


def spaced(typed: str, words: Container[str]) -> str:
    """A typed sentence with spaces between its words, as far as ``words`` tell them apart.

    In “NAOがこんにちはと言う” they are “NAO が こんにちは と言う”: a word behind a name or number,
    and the word at the end. The middle is what a person says, which is left alone.
    """
    if not is_unspaced(typed):
        return typed
    pieces: list[str] = []
    before = ""
    for run in _RUN.findall(typed):
        is_behind = bool(before) and not before.isspace()
        known = _UNSPACED.match(run) is not None
        pieces += _split(run, words, is_behind=is_behind) if known else [run]
        before = run
    return " ".join(piece.strip() for piece in pieces if piece.strip())


def _split(run: str, words: Container[str], *, is_behind: bool) -> list[str]:
    plain = folded(run)
    if len(plain) != len(run) or plain in words:
        return [run]
    lengths = range(len(run) - 1, 0, -1)
    first = next((n for n in lengths if plain[:n] in words), 0) if is_behind else 0
    rest = range(len(run) - first - 1, _SHORTEST_END - 1, -1)
    last = next((n for n in rest if plain[-n:] in words), 0)
    end = len(run) - last
    return [part for part in (run[:first], run[first:end], run[end:]) if part]

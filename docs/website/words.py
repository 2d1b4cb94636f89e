"""The words of the frame of the site, in each language."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path


@cache
def _tables() -> dict[str, dict[str, str]]:
    return tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))


def word(language: str, name: str, /, **values: object) -> str:
    """A word of the frame, with ``{name}`` filled in from the values."""
    return _tables()[language][name].format_map(values)

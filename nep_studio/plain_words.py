"""How words are told where there is no window: in English, with their values filled in."""

from __future__ import annotations

from typing import Protocol


class Tr(Protocol):
    """Tells an English text in a language, with ``{name}`` filled in from the values."""

    def __call__(self, text: str, /, **values: object) -> str:
        """Return the words."""


def plain(text: str, /, **values: object) -> str:
    """Return the English words; a text without values is taken as it is."""
    return text.format_map(values) if values else text

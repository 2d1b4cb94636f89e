"""The words of a program's errors in the language in which it tells values."""

from __future__ import annotations

import logging
from functools import lru_cache

from faults import Text, Words, filled, told
from faults.files import read_toml
from nep_core.errors import NodeStartError
from nep_core.program.values import spoken_language
from nodes.resources import resource_folder

log = logging.getLogger(__name__)


def in_spoken_language(text: Words, /, **values: object) -> str:
    """Return the words of a text, or of a template and its values; in English where none are."""
    if isinstance(text, Text):
        return told(text, in_spoken_language)
    return filled(_messages(spoken_language()).get(text, text), values, in_spoken_language)


@lru_cache(maxsize=2)
def _messages(language: str) -> dict[str, str]:
    """The sentences of a language by the English ones; none for English."""
    if language == "en":
        return {}
    try:
        table = read_toml(resource_folder() / "translations" / f"{language}.toml")
    except (OSError, ValueError, RecursionError, NodeStartError):
        log.warning("the words of %s cannot be read", language, exc_info=True)
        return {}
    return {**table.get("window", {}), **table.get("messages", {})}

"""What a node may be called."""

from __future__ import annotations

import unicodedata

from nep_core.errors import ParameterError

LONGEST_NAME = 100


def check_node_name(name: str) -> str:
    """Give back ``name``, or raise ParameterError that says what is wrong with it."""
    if not name.strip():
        raise _wrong("A node has no name.")
    if len(name) > LONGEST_NAME:
        raise _wrong(f"The name {name[:20]!r}... is longer than {LONGEST_NAME} letters.")
    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in name):
        raise _wrong(f"The name {name!r} has a letter in it that cannot be written.")
    return name


def _wrong(sentence: str) -> ParameterError:
    return ParameterError(sentence, checklist=("Give the node a short name, such as watch.",))

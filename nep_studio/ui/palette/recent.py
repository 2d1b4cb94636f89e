"""The blocks that a person used last, newest first."""

from __future__ import annotations

from collections.abc import Iterable

from nep_studio.blocks.language import Language
from nep_studio.settings import Settings

MOST_RECENT = 8


def recent_types(settings: Settings, language: Language, kind: str) -> list[str]:
    """The types used last that belong on a kind of page and that there still are."""
    known = (language.definitions.get(name) for name in settings.recent_blocks)
    return [one.id for one in known if one is not None and one.page == kind][:MOST_RECENT]


def remember_types(settings: Settings, types: Iterable[str]) -> bool:
    """Put types of blocks first; own blocks belong to one project only and are left out.

    Gives whether the list is another one now.
    """
    before = settings.recent_blocks
    used = [name for name in dict.fromkeys(types) if name.count(".") == 1]
    after = [*used, *(name for name in before if name not in used)][: 3 * MOST_RECENT]
    if after == before:
        return False
    settings.recent_blocks = after
    return True

"""Find blocks of the palette by what a person types."""

from __future__ import annotations

from collections.abc import Iterable

from nep_studio.blocks.operations.finding import folded
from nep_studio.blocks.program import Project
from nep_studio.blocks.typing_in.suggesting import suggestions

from .stock import Stock

MOST_FOUND = 60


def found_samples(stock: Stock, samples: Iterable[str], typed: str, project: Project) -> list[str]:
    """The samples that fit what is typed, the best first.

    First those whose sentences are meant, also by other words and with a letter wrong; then
    those that have all the words anywhere: in a choice, in the name of the category.
    """
    meant = suggestions(typed, stock.language, project, limit=MOST_FOUND)
    rank: dict[str, int] = {}
    for suggestion in meant:
        rank.setdefault(suggestion.block_type, len(rank))
    words = folded(typed).split()
    ranked = []
    for number, sample in enumerate(dict.fromkeys(samples)):
        place = rank.get(stock.project.blocks[sample].type)
        if place is not None:
            ranked.append((place, number, sample))
        elif all(word in _said(stock, sample) for word in words):
            ranked.append((MOST_FOUND, number, sample))
    return [sample for _place, _number, sample in sorted(ranked)]


def _said(stock: Stock, sample: str) -> str:
    return folded(f"{stock.words(sample)} {stock.definition(sample).category.title}")

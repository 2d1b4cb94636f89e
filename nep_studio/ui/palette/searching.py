"""Find blocks of the palette by what a person types."""

from __future__ import annotations

from collections.abc import Iterable

from nep_studio.blocks.operations.finding import folded

from .stock import Stock


def found_samples(stock: Stock, samples: Iterable[str], typed: str) -> list[str]:
    """The samples that fit what is typed, the best first."""
    words = folded(typed).split()
    scored = []
    for number, sample in enumerate(dict.fromkeys(samples)):
        score = _score(_said(stock, sample), words)
        if score is not None:
            scored.append((-score, number, sample))
    return [sample for _score_of_it, _number, sample in sorted(scored)]


def _said(stock: Stock, sample: str) -> str:
    definition = stock.definition(sample)
    return folded(f"{stock.words(sample)} {definition.id} {definition.category.title}")


def _score(text: str, words: list[str]) -> float | None:
    """How well a text fits: each word begins a word of it, is in it, or is spread over it."""
    total, said = 0.0, text.replace(".", " ").replace("_", " ").split()
    for word in words:
        if any(one.startswith(word) for one in said):
            total += 3.0
        elif word in text:
            total += 2.0
        elif any(_is_near(word, one) for one in said):
            total += 1.0
        else:
            return None
    return total - len(said) / 100


def _is_near(word: str, other: str) -> bool:
    """Whether a word is the other but for one letter: too many, too few, or another."""
    if len(word) < 4 or abs(len(word) - len(other)) > 1:
        return False
    row = list(range(len(other) + 1))
    for number, letter in enumerate(word, start=1):
        before, row[0] = row[0], number
        for place, other_letter in enumerate(other, start=1):
            cost = before + (letter != other_letter)
            before, row[place] = row[place], min(row[place] + 1, row[place - 1] + 1, cost)
    return row[-1] <= 1

"""Finds pages of the help by what a person types: by whole words, beginnings, and nearly so."""

from __future__ import annotations

import re
from bisect import bisect_left, insort
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from nep_studio.blocks.operations.finding import folded
from nep_studio.blocks.typing_in.vocabulary import is_near, is_unspaced

TITLE, WORDS, BODY = 10.0, 8.0, 1.5
"""How much a word counts in a title, among the other words of a page, and in its text."""

EXACT, BEGUN, MEANT, NEAR = 1.0, 0.7, 0.6, 0.4
SHORTEST_TYPO = 4
MOST_FOUND = 40
WORTH = 0.12
"""A page that fits so little beside the best one is left out."""

MOST_WORDS = 8
UNIMPORTANT = frozenset(
    ("a", "an", "and", "do", "does", "how", "i", "in", "is", "it", "my", "of", "the", "to", "what")
)
"""Words of questions that say little; they count only where nothing else is asked."""

_WORD = re.compile(r"[^\W_]+")
_PAIR = 2
"""Languages without spaces are found by pairs of signs."""


@dataclass(frozen=True)
class Findable:
    """What of a page is searched: the closer to its title, the more it counts."""

    page: str
    title: str
    words: str = ""
    text: str = ""
    rank: float = 1.0


@dataclass(frozen=True)
class Hit:
    """A page that was found, and how well it fits."""

    page: str
    title: str
    score: float


@dataclass
class Index:
    """Words and the pages that have them, each with how much the word counts there.

    ``meanings`` are words of the pages by other words for them.
    """

    meanings: Mapping[str, Iterable[str]] = field(default_factory=dict)
    pages: dict[str, Findable] = field(default_factory=dict)
    _by_word: dict[str, dict[str, float]] = field(default_factory=lambda: defaultdict(dict))
    _sorted: list[str] = field(default_factory=list)

    def add(self, findable: Findable) -> None:
        """Take a page in."""
        self.pages[findable.page] = findable
        parts = ((findable.title, TITLE), (findable.words, WORDS), (findable.text, BODY))
        for text, weight in parts:
            for word in words_of(text):
                self._note(word, findable.page, weight)

    def search(self, typed: str) -> list[Hit]:
        """The pages that have all words, the best first; else those that have most of them."""
        said = words_of(typed)
        asked = ([word for word in said if word not in UNIMPORTANT] or said)[:MOST_WORDS]
        found = [self._pages_with(word) for word in asked]
        scores: dict[str, float] = defaultdict(float)
        counts: dict[str, int] = defaultdict(int)
        for pages in found:
            for page, score in pages.items():
                scores[page] += score
                counts[page] += 1
        most = max(counts.values(), default=0)
        hits = [
            Hit(page, self.pages[page].title, self._total(page, score, typed))
            for page, score in scores.items()
            if counts[page] == most
        ]
        hits.sort(key=lambda hit: (-hit.score, len(hit.title), hit.title))
        least = hits[0].score * WORTH if hits else 0.0
        return [hit for hit in hits[:MOST_FOUND] if hit.score >= least]

    def _total(self, page: str, score: float, typed: str) -> float:
        """What a page is worth: one that is called as it was typed comes first."""
        findable = self.pages[page]
        title, asked = f" {folded(findable.title)} ", f" {folded(typed).strip()} "
        named = 2.0 if title.startswith(asked) else 1.5 if asked in title else 1.0
        return score * named * findable.rank

    def _note(self, word: str, page: str, weight: float) -> None:
        if word not in self._by_word:
            insort(self._sorted, word)
        pages = self._by_word[word]
        # a word that comes often counts little more than one that comes once
        pages[page] = max(pages.get(page, 0.0), weight) + 0.05 * weight

    def _pages_with(self, word: str) -> dict[str, float]:
        """The pages that have a word, or words that it may stand for."""
        found: dict[str, float] = {}
        for known, likeness in self._alike(word).items():
            for page, weight in self._by_word[known].items():
                found[page] = max(found.get(page, 0.0), weight * likeness)
        return found

    def _alike(self, word: str) -> dict[str, float]:
        alike = {other: MEANT for other in self.meanings.get(word, ()) if other in self._by_word}
        for known in self._beginning_with(word):
            share = len(word) / len(known)
            alike[known] = EXACT if known == word else BEGUN * (0.5 + share / 2)
        if not alike and len(word) >= SHORTEST_TYPO:
            alike = {known: NEAR for known in self._sorted if _is_near(word, known)}
        return alike

    def _beginning_with(self, word: str) -> Iterable[str]:
        start = bisect_left(self._sorted, word)
        for known in self._sorted[start:]:
            if not known.startswith(word):
                return
            yield known


def words_of(text: str) -> list[str]:
    """The words of a text without case and accents; of unspaced writing, its pairs of signs."""
    found = []
    for word in _WORD.findall(folded(text)):
        if is_unspaced(word) and len(word) > _PAIR:
            found += [word[i : i + _PAIR] for i in range(len(word) - 1)]
        else:
            found.append(word)
    return found


def _is_near(typed: str, word: str) -> bool:
    """Whether a word differs by one letter, also from the beginning of a longer one."""
    return is_near(typed, word) or (
        len(word) > len(typed) + 1 and is_near(typed, word[: len(typed)])
    )

"""Flow the parts of a sentence into rows, as words flow into lines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from .boxes import Piece, Plug
from .measures import Measures

Item = Piece | Plug

PUNCTUATION = frozenset(",.;:?!°%、。，：？！")  # noqa: RUF001 signs of Japanese sentences too
"""Words that begin with one of these (a sign of a unit too) stand close to what is before them."""

UNITS = frozenset({"m", "cm", "mm", "km", "s", "ms", "kg", "m/s", "Hz", "秒", "メートル"})
"""Words that belong to the number before them."""

WIDE_PUNCTUATION = frozenset("、。，：？！")  # noqa: RUF001 signs of Japanese sentences
"""Signs that bring the room after them along."""

TIGHT = 0.34
"""The share of the usual gap that is before what belongs to the item in front of it."""

SPACE = 0.72
"""The share of it between two words of one sentence."""


@dataclass(slots=True)
class Row:
    """Items beside each other; ``height`` is that of the highest."""

    items: list[Item] = field(default_factory=list)
    width: float = 0.0
    height: float = 0.0


def width_of(item: Item) -> float:
    """How wide an item is."""
    return item.width if isinstance(item, Piece) else item.box.width


def height_of(item: Item) -> float:
    """How high an item is."""
    return item.height if isinstance(item, Piece) else item.box.height


def is_tied(item: Item) -> bool:
    """Whether an item belongs to the one before it: a comma, the minus of an item."""
    if not isinstance(item, Piece):
        return False
    if item.piece == "words":
        return item.text[:1] in PUNCTUATION or item.text in UNITS
    return item.kind == "remove" and item.key != "" and item.shape == "tied"


def gap_share(before: Item, item: Item) -> float:
    """How much of the usual gap is between two items of a row."""
    if is_tied(item):
        return TIGHT
    are_words = all(isinstance(each, Piece) and each.piece == "words" for each in (before, item))
    if are_words and isinstance(before, Piece) and before.text[-1:] in WIDE_PUNCTUATION:
        return 0.0
    return SPACE if are_words else 1.0


def flow(items: Iterable[Item], measures: Measures) -> list[Row]:
    """Put items into rows that are not wider than can be; an item that is wider has its own.

    What is tied stays with the item before it, and a short word with the field that it announces.
    """
    rows = [Row()]
    for item in items:
        row = rows[-1]
        gap = measures.gap * gap_share(row.items[-1], item) if row.items else 0.0
        is_full = row.width + gap + width_of(item) > measures.widest
        if row.items and is_full and not is_tied(item):
            row = Row()
            announcing = _announcing(rows[-1], item, measures)
            rows.append(row)
            for word in announcing:
                _append(row, word, measures)
        _append(row, item, measures)
    return rows


def place(row: Row, x: float, y: float, height: float, gap: float) -> None:
    """Give the items of a row their places, centred in its height."""
    for number, item in enumerate(row.items):
        if number:
            x += gap * gap_share(row.items[number - 1], item)
        item.x = x
        item.y = y + (height - height_of(item)) / 2
        x += width_of(item)


def _append(row: Row, item: Item, measures: Measures) -> None:
    if row.items:
        row.width += measures.gap * gap_share(row.items[-1], item)
    row.width += width_of(item)
    row.height = max(row.height, height_of(item))
    row.items.append(item)


def _announcing(row: Row, item: Item, measures: Measures) -> list[Item]:
    """Take the short words off the end of a row that announce an item of the next one."""
    last = row.items[-1]
    is_word = isinstance(last, Piece) and last.piece == "words" and not is_tied(last)
    if len(row.items) < 2 or not is_word or (isinstance(item, Piece) and item.piece == "words"):
        return []
    width = width_of(last)
    if width > measures.widest / 2.4 or width + measures.gap + width_of(item) > measures.widest:
        return []
    row.items.pop()
    row.width -= width + measures.gap * gap_share(row.items[-1], last)
    row.height = max(height_of(kept) for kept in row.items)
    return [last]

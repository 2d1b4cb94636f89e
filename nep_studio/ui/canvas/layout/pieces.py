"""Makes the pieces of a sentence: words, fields, sockets and buttons, each with its size."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from nep_studio.blocks.definitions import Slot
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.slots import Kind

from .boxes import Box, Measures, Piece, Plug
from .slot_style import MOST_LINES, amount_of, hint_word, pill_shape, shown_text

# Flow the parts of a sentence into rows, as words flow into lines.

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


def flow(items: Iterable[Item], measures: Measures, header: int = 0) -> list[Row]:
    """Put items into rows that are not wider than can be; an item that is wider has its own.

    What is tied stays with the item before it, and a short word with the field that it announces.
    The item with the number ``header`` begins a row, if there is one before it.
    """
    rows = [row := Row()]
    for number, item in enumerate(items):
        gap = measures.gap * gap_share(row.items[-1], item) if row.items else 0.0
        is_full = row.items and row.width + gap + item.width > measures.widest
        if 0 < header == number:
            rows.append(row := Row())
            gap = 0.0
        elif is_full and not is_tied(item):
            word = _announcing(row, item, measures)
            rows.append(row := Row() if word is None else Row([word], word.width, word.height))
            gap = 0.0 if word is None else measures.gap * gap_share(word, item)
        row.width += gap + item.width
        row.height = max(row.height, item.height)
        row.items.append(item)
    return rows


def place(row: Row, box: Box, x: float, y: float, height: float, gap: float) -> None:
    """Put the items of a row into a box, at their places, centred in its height."""
    before: Item | None = None
    for item in row.items:
        x += gap * gap_share(before, item) if before is not None else 0.0
        item.x, item.y = x, y + (height - item.height) / 2
        x, before = x + item.width, item
        if isinstance(item, Plug):
            box.plugs.append(item)
        else:
            box.pieces.append(item)


def _announcing(row: Row, item: Item, measures: Measures) -> Item | None:
    """Take a short word off the end of a row that announces an item of the next one."""
    last = row.items[-1]
    is_word = isinstance(last, Piece) and last.piece == "words" and not is_tied(last)
    if len(row.items) < 2 or not is_word or (isinstance(item, Piece) and item.piece == "words"):
        return None
    if (
        last.width > measures.widest / 2.4
        or last.width + measures.gap + item.width > measures.widest
    ):
        return None
    row.items.pop()
    row.width -= last.width + measures.gap * gap_share(row.items[-1], last)
    row.height = max(kept.height for kept in row.items)
    return last


HINT_SIZE = 0.82
"""How large a hint is against the other words."""

_LEAD = 0.95
_ARROW = 0.75
"""The room of the drawing before a text and of the arrow behind it, in heights of a line."""

_POINTED = {"hexagon": 1.2, "bracket": 0.5, "round": 0.35}
"""Room at the sides of a hint in these shapes, in heights of a line."""


class Pieces:
    """Makes pieces for one project, in one language and font."""

    def __init__(self, project: Project, language: Language, measures: Measures) -> None:
        self._project = project
        self._language = language
        self._measures = measures
        self._words: dict[str, tuple[tuple[str, float], ...]] = {}

    def words(self, words: str) -> Iterator[Piece]:
        """Words as pieces: one when they fit into a row, else one a word."""
        known = self._words.get(words)
        if known is None:
            width = self._measures.text_width
            known = tuple((part, width(part)) for part in self._parts(words))
            self._words[words] = known
        for text, width_of_text in known:
            yield Piece("words", 0, 0, width_of_text, self._measures.line, text)

    def slot(self, block: Block, slot: Slot, key: str) -> Piece:
        """The field of a slot, or the socket of one that takes blocks only."""
        measures, kind = self._measures, slot.kind
        if kind.name == "parameter":
            return self._pill(slot, key)
        if not kind.typed:
            return self._socket(key, kind)
        text = shown_text(self._project, self._language, block, key, slot)
        value = self._language.definitions[block.type].value(block, key)
        is_drawn = kind.mark in ("tick", "swatch")
        hint = "" if text or is_drawn else hint_word(kind)
        text, width, rows = self._fitted(text, kind)
        width = max(width, measures.text_width(hint) * HINT_SIZE) + 2 * measures.field_pad
        width += measures.line * (_ARROW * kind.opens + _LEAD * (kind.mark == "dial"))
        narrowest = measures.narrowest_field
        if kind.mark == "tick":
            width = narrowest = measures.field_height
        elif kind.mark == "bar":
            narrowest = 2 * narrowest
        height = measures.field_height + (rows - 1) * measures.line
        width = max(width, narrowest)
        piece = Piece("field", 0, 0, width, height, text, key, kind.name, kind.shape)
        piece.opens, piece.mark = kind.opens, kind.mark
        piece.hint, piece.amount = hint, amount_of(slot, value) if kind.mark else 0.0
        if kind.mark == "swatch":
            piece.text = str(value or "")
        return piece

    def button(self, action: str, group: str, number: int, label: str = "") -> Piece:
        """A round button, with a label behind it where it has one."""
        size = self._measures.button
        width = size + (self._measures.text_width(label) + self._measures.gap if label else 0.0)
        return Piece("button", 0, 0, width, size, label, group, action, number=number)

    def small_minus(self, group: str, number: int) -> Piece:
        """The button that takes an item away; it stands close behind the item."""
        size = self._measures.button * 0.72
        return Piece("button", 0, 0, size, size, "", group, "remove", "tied", number)

    def cut(self, text: str, widest: float) -> tuple[str, float]:
        """A text that is not wider than it may be, and its width."""
        measures = self._measures
        width = measures.text_width(text)
        while width > widest and len(text) > 1:
            text = text[: max(1, int(len(text) * widest / width) - 1)].rstrip() + "…"
            width = measures.text_width(text)
            if len(text) <= 2:
                break
        return text, width

    def _fitted(self, text: str, kind: Kind) -> tuple[str, float, int]:
        """A text as its field can show it, how wide it is, and of how many lines."""
        widest = self._measures.widest_field
        if not kind.has_lines or "\n" not in text:
            text, width = self.cut(text.replace("\n", " ⏎ "), widest)
            return text, width, 1
        lines = text.split("\n")
        shown = lines[:MOST_LINES]
        if len(lines) > MOST_LINES:
            shown[-1] += " …"
        cut = [self.cut(line, widest) for line in shown]
        return "\n".join(line for line, _ in cut), max(width for _, width in cut), len(cut)

    def _socket(self, key: str, kind: Kind) -> Piece:
        measures, hint = self._measures, hint_word(kind)
        side = measures.line * _POINTED.get(kind.shape, 0.4)
        width = max(measures.socket, measures.text_width(hint) * HINT_SIZE + 2 * side)
        piece = Piece("socket", 0, 0, width, measures.field_height, "", key, kind.name, kind.shape)
        piece.hint = hint
        return piece

    def _pill(self, slot: Slot, key: str) -> Piece:
        measures = self._measures
        text, width = self.cut(slot.label, measures.widest_field)
        shape = pill_shape(self._language, slot)
        side = measures.line * _POINTED.get(shape, 0.4)
        width = max(width + 2 * side, measures.socket)
        return Piece("field", 0, 0, width, measures.field_height, text, key, "parameter", shape)

    def _parts(self, words: str) -> Iterator[str]:
        """Words in parts that fit into rows; a comma or a unit at their beginning is apart."""
        width, widest = self._measures.text_width, self._measures.widest
        if words[:1] in PUNCTUATION and len(words) > 1:
            yield words[0]
            words = words[1:].lstrip()
        unit, _, following = words.partition(" ")
        if unit in UNITS and following:
            yield unit
            words = following.lstrip()
        if width(words) <= widest / 2:
            if words:
                yield words
            return
        for word in words.split():
            if width(word) <= widest:
                yield word
                continue
            step = max(1, int(len(word) * widest / width(word) * 0.9))
            yield from (word[at : at + step] for at in range(0, len(word), step))

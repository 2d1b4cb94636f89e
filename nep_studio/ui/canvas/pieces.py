"""Makes the pieces of a sentence: words, fields, sockets and buttons, each with its size."""

from __future__ import annotations

from collections.abc import Iterator

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.sentence import Slot

from .boxes import Piece
from .measures import Measures
from .rows import PUNCTUATION, UNITS
from .slot_looks import (
    LEADS,
    MOST_LINES,
    OPENS,
    amount_of,
    hint_word,
    pill_shape,
    shown_text,
    slot_shape,
)

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
        measures, kind = self._measures, slot.kind.name
        if kind == "parameter":
            return self._pill(slot, key)
        shape = slot_shape(kind)
        if not slot.kind.typed:
            return self._socket(key, kind, shape)
        text = shown_text(self._project, self._language, block, key, slot)
        value = self._language.definitions[block.type].value(block, key)
        hint = "" if text or kind in ("colour", "checkbox") else hint_word(kind)
        text, width, rows = self._fitted(text, kind)
        width = max(width, measures.text_width(hint) * HINT_SIZE) + 2 * measures.field_pad
        width += measures.line * (_ARROW * (kind in OPENS) + _LEAD * (kind in LEADS))
        narrowest = measures.narrowest_field
        if kind == "checkbox":
            width = narrowest = measures.field_height
        elif kind == "slider":
            narrowest = 2 * narrowest
        height = measures.field_height + (rows - 1) * measures.line
        piece = Piece("field", 0, 0, max(width, narrowest), height, text, key, kind, shape)
        piece.hint, piece.amount = hint, amount_of(slot, value)
        if kind == "colour":
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

    def _fitted(self, text: str, kind: str) -> tuple[str, float, int]:
        """A text as its field can show it, how wide it is, and of how many lines."""
        widest = self._measures.widest_field
        if kind != "lines" or "\n" not in text:
            text, width = self.cut(text.replace("\n", " ⏎ "), widest)
            return text, width, 1
        lines = text.split("\n")
        shown = lines[:MOST_LINES]
        if len(lines) > MOST_LINES:
            shown[-1] += " …"
        cut = [self.cut(line, widest) for line in shown]
        return "\n".join(line for line, _ in cut), max(width for _, width in cut), len(cut)

    def _socket(self, key: str, kind: str, shape: str) -> Piece:
        measures, hint = self._measures, hint_word(kind)
        side = measures.line * _POINTED.get(shape, 0.4)
        width = max(measures.socket, measures.text_width(hint) * HINT_SIZE + 2 * side)
        piece = Piece("socket", 0, 0, width, measures.field_height, "", key, kind, shape)
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

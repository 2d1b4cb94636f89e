"""Makes the Python of a new block with markers in its slots."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from ..definitions import Definition
from ..generate.expressions import Expressions
from ..generate.names import ProgramNames
from ..generate.nodes import constant
from ..generate.pieces import Assignment, Body, Function, Gap, Piece
from ..generate.printing import show
from ..generate.registry import HATS, REPORTERS, STATEMENTS
from ..language import Language
from ..program import Block, Project, split_slot
from ..sentence import Slot
from ..values import FieldValue
from .markers import VARIABLE_NAME, body_name, number_for, part_name, slot_name, word_for

_WORDS = frozenset({"text", "line", "state", "gesture", "lines", "robot"})


class Learner(Expressions):
    """Makes Python with markers; ``asked`` are the choices that the generator looked at.

    ``filled`` are the slots that it wrote as they are.
    """

    def __init__(
        self,
        language: Language,
        fields: Mapping[str, FieldValue],
        keys: Sequence[str],
        typed: frozenset[str],
        plain: str,
    ) -> None:
        super().__init__(Project("Learned"), language, ProgramNames({}, {}), REPORTERS)
        self.asked: list[str] = []
        self.filled: set[str] = set()
        self._fields_chosen = fields
        self._positions = {key: position for position, key in enumerate(keys)}
        self._typed = typed
        self._plain = plain
        self._functions = 0

    def nodes(self, definition: Definition, groups: Mapping[str, int]) -> tuple[ast.AST, ...]:
        """The Python of a new block of a definition."""
        block = self._block(definition, groups)
        if definition.shape == "hat":
            decorator = HATS[definition.generator](self, block).decorator
            return () if decorator is None else (_parsed(show(decorator)),)
        if definition.is_value:
            return (_parsed(show(REPORTERS[definition.generator](self, block))),)
        pieces = STATEMENTS[definition.generator](self, block)
        return tuple(ast.parse("\n".join(_lines(pieces))).body)

    def slot(self, block: Block, key: str) -> ast.expr:
        """A marker for a slot; the text slots of a value that is no text are markers too."""
        slot = self._slot(block, key)
        self.filled.add(key)
        if key == self._plain:
            return constant(self.definition(block).defaults[slot.name])
        if key in self._typed:
            return ast.Constant(number_for(self._positions[key]))
        return ast.Name(slot_name(key))

    def choice(self, block: Block, key: str) -> str:
        """The choice that this variant is made with."""
        self.asked.append(key)
        if key in self._fields_chosen:
            return str(self._fields_chosen[key])
        return next(iter(self.language.choices_of(self._slot(block, key))), "")

    def variable(self, block: Block) -> str:
        """A marker for the variable of a block."""
        return VARIABLE_NAME

    def begins_as(self, block: Block, kind: str) -> None:
        """Nothing begins in what is learned."""

    def part_name(self) -> str:
        """A marker for the name of a function."""
        self._functions += 1
        return part_name(self._functions)

    def _slot(self, block: Block, key: str) -> Slot:
        return self.definition(block).slots[split_slot(key)[0]]

    def _block(self, definition: Definition, groups: Mapping[str, int]) -> Block:
        """A new block whose texts are marker words."""
        block = definition.new_block("b1")
        block.groups = dict(groups)
        block.fields = {
            key: word_for(self._positions[key])
            for key, slot in definition.keys(groups)
            if slot.kind.name in _WORDS and not slot.group
        } | dict(self._fields_chosen)
        for key, slot in definition.keys(groups):
            if slot.name in definition.defaults:
                block.fields.setdefault(key, definition.defaults[slot.name])
        return block


def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _lines(pieces: Sequence[Piece]) -> Iterator[str]:
    for piece in pieces:
        if isinstance(piece, str):
            yield piece
        elif isinstance(piece, Assignment):
            yield piece.line
        elif isinstance(piece, Body):
            yield f"    {body_name(piece.slot)}"
        elif isinstance(piece, Function):
            yield f"def {piece.name}():"
            yield f"    {body_name(piece.slot)}"
        elif not isinstance(piece, Gap):
            yield str(getattr(piece, "line", ""))

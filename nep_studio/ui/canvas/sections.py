"""The sentence of a block as sections: what stands in its rows, and the mouth below each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.sentence import Group, Slot
from nep_studio.blocks.text import sentence
from nep_studio.ui.words import count_words

from .boxes import Box, Piece, Plug
from .measures import Measures
from .pieces import Pieces
from .rows import Item, Row, flow


@dataclass(slots=True)
class Section:
    """Items that flow into rows; ``mouth`` is the slot of the body below them, if there is one.

    ``header`` is the number of the item that begins a row of its own, 0 when none does.
    """

    items: list[Item] = field(default_factory=list)
    mouth: str = ""
    header: int = 0

    def rows(self, measures: Measures) -> list[Row]:
        """The items in rows."""
        if not 0 < self.header < len(self.items):  # a header without words needs no row
            return flow(self.items, measures)
        before, after = self.items[: self.header], self.items[self.header :]
        return [*flow(before, measures), *flow(after, measures)]


class SectionWriter:
    """Writes the sentence of one block after the other as sections."""

    def __init__(self, project: Project, language: Language, measures: Measures) -> None:
        self._project = project
        self._language = language
        self._measures = measures
        self._pieces = Pieces(project, language, measures)
        self._said = self._pieces.words
        self._button = self._pieces.button

    def sections(
        self, block: Block, definition: Definition | None, boxes: Mapping[str, Box]
    ) -> list[Section]:
        """The sections of a block; ``boxes`` are those of the blocks plugged into it."""
        if definition is None:
            return self._unknown(block, boxes)
        if block.collapsed:
            return [Section(self._collapsed(block))]
        sections = [Section(self._comment(block))]
        for part in definition.parts:
            if isinstance(part, Group):
                self._group(block, definition, part, boxes, sections)
            else:
                self._part(block, part, 0, boxes, sections)
        self._buttons(block, definition, sections[-1])
        return sections

    def _part(
        self,
        block: Block,
        part: str | Slot,
        number: int,
        boxes: Mapping[str, Box],
        sections: list[Section],
    ) -> None:
        """Add words, a field, a plugged block or a mouth to the sections."""
        if isinstance(part, str):
            sections[-1].items += self._said(part)
            return
        key = f"{part.name}.{number}" if number else part.name
        if part.kind.name == "body":
            sections[-1].mouth = key
            sections.append(Section())
        elif (box := boxes.get(block.inputs.get(key, ""))) is not None:
            sections[-1].items.append(Plug(key, 0.0, 0.0, box))
        else:
            sections[-1].items.append(self._pieces.slot(block, part, key))

    def _group(
        self,
        block: Block,
        definition: Definition,
        group: Group,
        boxes: Mapping[str, Box],
        sections: list[Section],
    ) -> None:
        """The parts of a group; each that may leave has a button for it, after its sentence."""
        has_body = _has_body(group)
        count = block.groups.get(group.name, 0)
        can_leave = count > definition.minimum[group.name]
        for number in range(1, count + 1):
            if has_body:
                sections[-1].header = len(sections[-1].items)
            for part in group.parts:
                is_body = isinstance(part, Slot) and part.kind.name == "body"
                if is_body and can_leave:
                    sections[-1].items.append(self._button("remove", group.name, number))
                self._part(block, part, number, boxes, sections)
            if can_leave and not has_body:
                sections[-1].items.append(self._pieces.small_minus(group.name, number))

    def _buttons(self, block: Block, definition: Definition, section: Section) -> None:
        """What adds a part to each group that may have more."""
        for group in definition.groups.values():
            count = block.groups.get(group.name, 0)
            if count < group.maximum:
                label = next((p for p in group.parts if isinstance(p, str) and p), "")
                label = label.strip(" ,") if _has_body(group) or group.maximum == 1 else ""
                section.items.append(self._button("add", group.name, count + 1, label))

    def _comment(self, block: Block) -> list[Item]:
        return [self._button("comment", "", 0)] if block.comment else []

    def _collapsed(self, block: Block) -> list[Item]:
        said = sentence(self._project, self._language, block.id)
        text, width = self._pieces.cut(said, self._measures.widest * 0.6)
        inside = sum(1 for _ in self._project.within([block.id])) - 1
        words = Piece("words", 0, 0, width, self._measures.line, text)
        items: list[Item] = [self._button("expand", "", inside), *self._comment(block), words]
        if inside:
            items += self._said("· " + count_words(inside, "1 block", "{n} blocks"))
        return items

    def _unknown(self, block: Block, boxes: Mapping[str, Box]) -> list[Section]:
        """A block of an unknown type: its type, what is plugged in, and its bodies."""
        sections = [Section([*self._said("?"), *self._said(block.type)])]
        for key, plugged in block.inputs.items():
            if plugged in boxes:
                sections[-1].items.append(Plug(key, 0.0, 0.0, boxes[plugged]))
        for key in block.bodies:
            sections[-1].mouth = key
            sections.append(Section())
        return sections


def _has_body(group: Group) -> bool:
    return any(isinstance(part, Slot) and part.kind.name == "body" for part in group.parts)

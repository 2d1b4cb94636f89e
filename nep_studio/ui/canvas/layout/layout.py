"""Lay blocks out: boxes made from the inside out, kept until something in them changes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from nep_studio.blocks.code_text import hides_python
from nep_studio.blocks.definitions import Definition, Group, Slot
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project
from nep_studio.blocks.text import sentence
from nep_studio.ui.words import count_words, tr

from .boxes import Box, Chain, Measures, Outline, Piece, Plug
from .pieces import Item, Pieces, Row, flow, place
from .slot_style import block_outline

# The sentence of a block as sections: what stands in its rows, and the mouth below each.


@dataclass(slots=True)
class Section:
    """Items that flow into rows; ``mouth`` is the slot of the body below them, if there is one.

    ``header`` is the number of the item that begins a row of its own, 0 when none does.
    """

    items: list[Item] = field(default_factory=list)
    mouth: str = ""
    header: int = 0


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
        comment: list[Item] = [self._button("comment", "", 0)] if block.comment else []
        if block.collapsed:
            said = sentence(self._project, self._language, block.id)
            text, width = self._pieces.cut(said, self._measures.widest * 0.6)
            inside = sum(1 for _ in self._project.within([block.id])) - 1
            words = Piece("words", 0, 0, width, self._measures.line, text)
            items: list[Item] = [self._button("expand", "", inside), *comment, words]
            if inside:
                items += self._said("· " + count_words(inside, "1 block", "{n} blocks"))
            if hides_python(self._project, self._language.definitions, block):
                items += self._said("· " + tr("Python inside"))
            return [Section(items)]
        sections = [Section(comment)]
        for part in definition.parts:
            if isinstance(part, Group):
                self._group(block, definition, part, boxes, sections)
            else:
                self._part(block, part, 0, boxes, sections)
        # What adds a part to each group that may have more
        for group in definition.groups.values():
            count = block.groups.get(group.name, 0)
            if count < group.maximum:
                label = next((p for p in group.parts if isinstance(p, str) and p), "")
                has_room = definition.shape != "hat"  # what begins a rule stays short
                is_said = has_room and (_has_body(group) or group.maximum == 1)
                label = label.strip(" ,") if is_said else ""
                sections[-1].items.append(self._button("add", group.name, count + 1, label))
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
            sections[-1].items.append(Plug(key, 0.0, 0.0, box.width, box.height, box))
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

    def _unknown(self, block: Block, boxes: Mapping[str, Box]) -> list[Section]:
        """A block of an unknown type: its type, what is plugged in, and its bodies."""
        sections = [Section([*self._said("?"), *self._said(block.type)])]
        for key, plugged in block.inputs.items():
            if plugged in boxes:
                box = boxes[plugged]
                sections[-1].items.append(Plug(key, 0.0, 0.0, box.width, box.height, box))
        for key in block.bodies:
            sections[-1].mouth = key
            sections.append(Section())
        return sections


def _has_body(group: Group) -> bool:
    return any(isinstance(part, Slot) and part.kind.name == "body" for part in group.parts)


@dataclass(frozen=True, slots=True)
class Gap:
    """Where blocks would go: in the chain of a stack (no slot) or in a body, at an index."""

    owner: str
    slot: str
    index: int
    width: float
    height: float


class Layout:
    """The boxes of a project's blocks.

    ``hidden`` are blocks that are being carried: their places close; ``gap`` is where they would
    go. Both change only through ``preview``.
    """

    def __init__(self, project: Project, language: Language, measures: Measures) -> None:
        self.project = project
        self.language = language
        self.measures = measures
        self.hidden: frozenset[str] = frozenset()
        self.gap: Gap | None = None
        self._writer = SectionWriter(project, language, measures)
        self._boxes: dict[str, Box] = {}
        self._leaves: dict[tuple[object, ...], Box] = {}

    def preview(self, hidden: frozenset[str], gap: Gap | None) -> set[str]:
        """Take these blocks out and open this gap; gives the stacks that look different now."""
        blocks = self.project.parents
        owners = {blocks[block].owner for block in hidden ^ self.hidden if block in blocks}
        owners |= {each.owner for each in (gap, self.gap) if each is not None and gap != self.gap}
        self.hidden, self.gap = hidden, gap
        return self.forget(owners)

    def forget(self, owners: Iterable[str]) -> set[str]:
        """Make the boxes of these blocks (or stacks) anew when next asked; gives their stacks."""
        stacks = set()
        for owner in owners:
            while owner in self.project.parents:
                self._boxes.pop(owner, None)
                owner = self.project.parents[owner].owner
            self._boxes.pop(owner, None)  # a block that is not there any more
            if owner in self.project.stacks:
                stacks.add(owner)
        return stacks

    def forget_all(self) -> None:
        """Make every box anew when next asked."""
        self._boxes.clear()
        self._leaves.clear()
        self._writer = SectionWriter(self.project, self.language, self.measures)

    def chain(
        self, block_ids: Sequence[str], *, owner: str = "", slot: str = "", shown: bool = False
    ) -> Chain:
        """Blocks below each other, at (0, 0); ``shown`` takes hidden (carried) ones too."""
        hidden = frozenset[str]() if shown else self.hidden
        ids = [i for i in block_ids if i not in hidden] if hidden else block_ids
        self._make(ids)
        boxes = [self._boxes[block_id] for block_id in ids]
        gap = self.gap
        if gap is not None and owner and gap.owner == owner and gap.slot == slot:
            boxes.insert(gap.index, _gap_box(gap, self.measures))
        ys, y, reach = [], 0.0, 0.0
        for box in boxes:
            ys.append(y)
            y += box.height
            reach = max(reach, box.reach)
        ys.append(y)
        return Chain(slot, 0.0, 0.0, boxes, ys, reach, y, self.measures.is_mirrored)

    def box(self, block_id: str) -> Box:
        """The box of one block."""
        self._make([block_id])
        return self._boxes[block_id]

    def _make(self, block_ids: Sequence[str]) -> None:
        """Make the boxes of blocks that have none, the inner ones first."""
        boxes, blocks = self._boxes, self.project.blocks
        waiting = [block_id for block_id in block_ids if block_id not in boxes]
        order: list[Block] = []
        while waiting:
            block = blocks[waiting.pop()]
            order.append(block)
            if block.inputs or block.bodies:
                waiting.extend(child for child in block.children() if child not in boxes)
        for block in reversed(order):
            boxes[block.id] = self._box(block)

    def _box(self, block: Block) -> Box:
        if block.inputs or block.bodies or block.comment or block.collapsed:
            return self._new_box(block)
        try:
            look = (block.type, block.disabled, *block.fields.items(), *block.groups.items())
            known = self._leaves.get(look)
        except TypeError:  # a field that holds settings
            return self._new_box(block)
        is_gap_owner = self.gap is not None and self.gap.owner == block.id
        definition = self.language.definitions.get(block.type)
        if is_gap_owner or definition is None or "rule" in definition.kinds:
            return self._new_box(block)  # what it says is not in its fields alone
        if known is None:
            known = self._leaves[look] = self._new_box(block)
        return known if known.block == block.id else replace(known, block=block.id)

    def _new_box(self, block: Block) -> Box:
        definition = self.language.definitions.get(block.type)
        plugged = {
            child: self._boxes[child]
            for child in block.inputs.values()
            if child not in self.hidden and not block.collapsed
        }
        sections = self._writer.sections(block, definition, plugged)
        outline = block_outline(definition, is_value=definition is None and self._is_plugged(block))
        box = Box(block.id, block.type, outline, 0.0, 0.0, (), self.measures.is_mirrored)
        box.is_disabled, box.is_collapsed = block.disabled, block.collapsed
        if outline in ("statement", "hat", "cap"):
            self._fill_statement(box, block, definition, sections)
        else:
            self._fill_value(box, sections)
        if self.measures.is_mirrored:
            # Exchange left and right inside a box
            for piece in box.pieces:
                piece.x = box.width - piece.x - piece.width
            for plug in box.plugs:
                plug.x = box.width - plug.x - plug.width
            for mouth in box.mouths:
                mouth.x = box.width - mouth.x
        return box

    def _is_plugged(self, block: Block) -> bool:
        parent = self.project.parents.get(block.id)
        owner = self.project.blocks.get(parent.owner) if parent is not None else None
        return owner is not None and block.id in owner.inputs.values()

    def _fill_statement(
        self, box: Box, block: Block, definition: Definition | None, sections: list[Section]
    ) -> None:
        measures = self.measures
        rows = [flow(section.items, measures, section.header) for section in sections]
        widest = max(row.width for section_rows in rows for row in section_rows)
        box.width = max(widest + 2 * measures.pad, measures.narrowest)
        y = measures.hat if box.outline == "hat" else 0.0
        segments, reach = [], box.width
        for number, section in enumerate(sections):
            is_bare = number > 0 and not section.items
            height = measures.foot if is_bare else self._place_rows(box, rows[number], y)
            segments.append(height + (y if number == 0 else 0.0))
            y += height
            if section.mouth:
                mouth = self._mouth(block, section.mouth, y)
                box.mouths.append(mouth)
                height = max(measures.mouth_height, mouth.height)
                segments.append(height)
                y += height
                reach = max(reach, measures.indent + mouth.width)
        box.segments, box.height, box.reach = tuple(segments), y, reach

    def _mouth(self, block: Block, key: str, y: float) -> Chain:
        mouth = self.chain(block.bodies.get(key, []), owner=block.id, slot=key)
        mouth.x, mouth.y = self.measures.indent, y
        return mouth

    def _place_rows(self, box: Box, rows: list[Row], y: float) -> float:
        """Put rows into a statement from ``y`` on; gives their height."""
        measures, top = self.measures, y
        closer = measures.row_pad if len(rows) > 1 else 0.0  # rows of one sentence belong together
        y += closer / 2
        for row in rows:
            has_only_buttons = all(
                isinstance(item, Piece) and item.piece == "button" for item in row.items
            )
            is_low = bool(row.items) and has_only_buttons
            smallest = measures.button + measures.gap if is_low else measures.row_height
            pads = measures.row_pad * (1 if has_only_buttons else 2)
            height = max(smallest, row.height + pads) - closer
            place(row, box, measures.pad, y, height, measures.gap)
            y += height
        return y + closer / 2 - top

    def _fill_value(self, box: Box, sections: list[Section]) -> None:
        """A reporter: rows inside a rounded outline; bodies of an unknown block are not shown."""
        measures = self.measures
        rows = flow([item for section in sections for item in section.items], measures)
        pad = _side_pad(box.outline, rows, measures)
        y = 0.0
        for row in rows:
            height = max(measures.field_height, row.height) + 2 * measures.value_pad
            place(row, box, pad, y, height, measures.gap)
            y += height
        widest = max(row.width for row in rows)
        box.width = box.reach = max(widest + 2 * pad, measures.socket)
        box.height, box.segments = y, (y,)


def _side_pad(outline: Outline, rows: list[Row], measures: Measures) -> float:
    """Room at the sides: pointed and round ends need more, the higher they are."""
    height = max(row.height for row in rows) + 2 * measures.value_pad
    if outline == "hexagon":
        return min(height / 2, 18 * measures.unit) + 2 * measures.unit
    return {"round": 9, "bracket": 9}.get(outline, 7) * measures.unit


def _gap_box(gap: Gap, measures: Measures) -> Box:
    size = (gap.width, gap.height, (gap.height,))
    return Box("", "", "gap", *size, is_mirrored=measures.is_mirrored, reach=gap.width)

"""Random edits of any kind, sensible and senseless, for property tests."""

from __future__ import annotations

from hypothesis import strategies as st

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import (
    AddGroup,
    AddVariable,
    CreateBlocks,
    DeleteBlocks,
    Edit,
    MoveBlocks,
    MoveStack,
    RemoveGroup,
    RemoveVariable,
    RenameProject,
    RenameVariable,
    SetComment,
    SetField,
    SetFlag,
)
from nep_studio.blocks.places import InBody, InInput, InStack, NewStack
from nep_studio.blocks.program import PAGES

TEXTS = st.sampled_from(["", "x", "y\nimport os", "größe", "NAO", "Pepper", "v1", "add", "karate"])
NAMES = TEXTS | st.text(max_size=6)
PLACES = st.floats(-1000, 1000) | st.integers(0, 500)


class Dice:
    """Draws edits that are near to being possible for a project."""

    def __init__(self, draw, editor: Editor) -> None:
        self.draw = draw
        self.editor = editor
        self.project = editor.project

    def one(self, values):
        return self.draw(st.sampled_from(sorted(values) or ["nothing"]))

    def index(self, length: int) -> int:
        """A place in a list, now and then just outside of it."""
        return self.draw(st.integers(0, length) | st.integers(-1, length + 1))

    def block(self) -> str:
        return self.one(self.project.blocks)

    def slot(self, block: str, kinds: str = "") -> str:
        """A slot of a block, of a kind where it has one."""
        there = self.project.blocks.get(block)
        definition = self.editor.language.definitions[there.type] if there else None
        keys = list(definition.keys(there.groups)) if definition else []
        fitting = [key for key, slot in keys if slot.kind.name in kinds or not kinds]
        return self.one(fitting or ["do", "value"])

    def chain(self):
        """A place in a chain: below any block, or in an empty body."""
        owners = [
            b
            for b in self.project.blocks.values()
            if self.editor.language.definitions[b.type].shape == "c"
        ]
        if owners and self.draw(st.booleans()):
            owner = self.draw(st.sampled_from(owners))
            slot = self.slot(owner.id, "body")
            return InBody(owner.id, slot, self.index(len(owner.bodies.get(slot, []))))
        stack = self.one(self.project.stacks)
        there = self.project.stacks.get(stack)
        return InStack(stack, self.index(len(there.body) if there else 0))

    def place(self, shape: str = "", page: str = PAGES[0]):
        """A place, mostly one in which a block of this shape can be."""
        page = self.draw(st.sampled_from([page, page, *PAGES]))
        position = self.index(len(self.project.pages[page]))
        stack = self.project.new_id("s")
        new = NewStack(page, stack, self.draw(PLACES), self.draw(PLACES), position)
        if shape == "hat" or not self.project.blocks or self.draw(st.integers(0, 3)) == 0:
            return new
        if shape in ("reporter", "boolean") or self.draw(st.integers(0, 9)) == 0:
            kinds = "boolean" if shape == "boolean" else "number text any boolean"
            owners = [
                b.id
                for b in self.project.blocks.values()
                for slot in self.editor.language.definitions[b.type].slots.values()
                if slot.kind.pluggable and slot.kind.name in kinds
            ]
            owner = self.one(owners)
            return InInput(owner, self.slot(owner, kinds))
        return self.chain()

    def group_edit(self, edit: type):
        with_groups = [b.id for b in self.project.blocks.values() if b.groups]
        block = self.one(with_groups)
        there = self.project.blocks.get(block)
        group = self.one(there.groups if there else [])
        definition = self.editor.language.definitions[there.type] if there else None
        slots = definition.group_slots(group) if definition else ()
        count = there.groups[group] if there else 0
        arguments = (block, group, self.draw(st.integers(1, count + 1)), slots)
        return edit(*arguments, {}) if edit is AddGroup else edit(*arguments)

    def move(self) -> MoveBlocks:
        block = self.block()
        there = self.project.blocks.get(block)
        shape = self.editor.language.definitions[there.type].shape if there else ""
        return MoveBlocks(block, self.draw(st.sampled_from([1, 1, 2, 3])), self.place(shape))

    def edit(self) -> Edit:
        kinds = [CreateBlocks] * 12 + [MoveBlocks] * 6 + [SetField] * 3 + [AddGroup] * 2
        kinds += [DeleteBlocks, RemoveGroup, SetFlag, SetComment, MoveStack, RenameProject]
        kinds += [AddVariable, RemoveVariable, RenameVariable]
        kind = self.draw(st.sampled_from(kinds))
        if kind is CreateBlocks:
            block_type = self.one(self.editor.language.definitions)
            block = self.editor.language.definitions[block_type].new_block(self.project.new_id("b"))
            definition = self.editor.language.definitions[block_type]
            return CreateBlocks(
                (block.id,), (block,), self.place(definition.shape, definition.page)
            )
        if kind is MoveBlocks:
            return self.move()
        if kind is DeleteBlocks:
            return DeleteBlocks(self.block(), self.draw(st.sampled_from([1, 1, 2])))
        if kind is SetField:
            block = self.block()
            value = self.draw(TEXTS | st.integers(-5, 5) | st.floats(-5, 5) | st.none())
            return SetField(block, self.slot(block), value)
        if kind in (AddGroup, RemoveGroup):
            return self.group_edit(kind)
        if kind is SetFlag:
            flag = self.draw(st.sampled_from(["disabled", "collapsed"]))
            return SetFlag(self.block(), flag, self.draw(st.booleans()))
        if kind is SetComment:
            return SetComment(self.block(), self.draw(TEXTS))
        if kind is MoveStack:
            return MoveStack(self.one(self.project.stacks), self.draw(PLACES), self.draw(PLACES))
        if kind is RenameProject:
            return RenameProject(self.draw(TEXTS))
        if kind is AddVariable:
            return AddVariable(
                self.project.new_id("v"), self.draw(NAMES), self.index(len(self.project.variables))
            )
        variable = self.one(v.id for v in self.project.variables)
        if kind is RemoveVariable:
            return RemoveVariable(variable)
        return RenameVariable(variable, self.draw(NAMES))

"""Random edits of any kind, sensible and senseless, for property tests."""

from __future__ import annotations

from hypothesis import strategies as st

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import Edit
from nep_studio.blocks.edits.content import (
    AddGroup,
    AddNote,
    AddProcedure,
    ChangeNote,
    ChangeProcedure,
    RemoveGroup,
    RemoveNote,
    RemoveProcedure,
    SetComment,
    SetCommentSize,
    SetField,
    SetFlag,
)
from nep_studio.blocks.edits.placing import CreateBlocks, DeleteBlocks, MoveBlocks
from nep_studio.blocks.edits.project import (
    AddPage,
    AddVariable,
    MovePage,
    MoveStack,
    RemovePage,
    RemoveVariable,
    RenamePage,
    RenameProject,
    RenameVariable,
    SetScope,
)
from nep_studio.blocks.places import InBody, InInput, InStack, NewStack
from nep_studio.blocks.procedures import PARAMETER_KINDS
from nep_studio.blocks.program import PAGES, Note, Parameter, Procedure

TEXTS = st.sampled_from(["", "x", "y\nimport os", "größe", "NAO", "Pepper", "v1", "add", "karate"])
NAMES = TEXTS | st.text(max_size=6)
PLACES = st.floats(-1000, 1000) | st.integers(0, 500)


VALUES = (
    TEXTS
    | st.integers(-5, 5)
    | st.floats(-5, 5)
    | st.none()
    | st.booleans()
    | st.sampled_from(["2*pi/3", "sqrt(2)", "#ff8800", "2026-01-31", "end", "x = 1", "# only"])
)
SIZES = st.integers(0, 400) | st.floats(-1, 1e5)


class Whole:
    """Stands for the edits of pages, notes and sizes."""


class Own:
    """Stands for the edits of own blocks."""


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

    def definition(self, block):
        """The definition of a block, or None where there is no block or it is unknown."""
        return self.editor.language.definitions.get(block.type) if block else None

    def slots(self, block_type: str):
        definition = self.editor.language.definitions.get(block_type)
        return definition.slots.values() if definition else ()

    def slot(self, block: str, kinds: str = "") -> str:
        """A slot of a block, of a kind where it has one."""
        there = self.project.blocks.get(block)
        definition = self.definition(there)
        keys = list(definition.keys(there.groups)) if definition else []
        fitting = [key for key, slot in keys if slot.kind.name in kinds or not kinds]
        return self.one(fitting or ["do", "value"])

    def chain(self):
        """A place in a chain: below any block, or in an empty body."""
        owners = [
            b
            for b in self.project.blocks.values()
            if getattr(self.definition(b), "shape", "") == "c"
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
        page = self.draw(st.sampled_from([page, page, *self.project.pages]))
        position = self.index(len(self.project.pages[page]))
        stack = self.project.new_id("s")
        new = NewStack(page, stack, self.draw(PLACES), self.draw(PLACES), position)
        if shape == "hat" or not self.project.blocks or self.draw(st.integers(0, 3)) == 0:
            return new
        if shape in ("reporter", "boolean") or self.draw(st.integers(0, 9)) == 0:
            kinds = "boolean" if shape == "boolean" else "number text any boolean list colour"
            owners = [
                b.id
                for b in self.project.blocks.values()
                for slot in self.slots(b.type)
                if slot.pluggable and slot.kind.name in kinds
            ]
            owner = self.one(owners)
            return InInput(owner, self.slot(owner, kinds))
        return self.chain()

    def group_edit(self, edit: type):
        with_groups = [b.id for b in self.project.blocks.values() if b.groups]
        block = self.one(with_groups)
        there = self.project.blocks.get(block)
        group = self.one(there.groups if there else [])
        definition = self.definition(there)
        slots = definition.group_slots(group) if definition else ()
        count = there.groups[group] if there else 0
        arguments = (block, group, self.draw(st.integers(1, count + 1)), slots)
        return edit(*arguments, {}) if edit is AddGroup else edit(*arguments)

    def move(self) -> MoveBlocks:
        block = self.block()
        there = self.project.blocks.get(block)
        shape = getattr(self.definition(there), "shape", "")
        return MoveBlocks(block, self.draw(st.sampled_from([1, 1, 2, 3])), self.place(shape))

    def edit(self) -> Edit:
        kinds = [CreateBlocks] * 12 + [MoveBlocks] * 6 + [SetField] * 3 + [AddGroup] * 2
        kinds += [DeleteBlocks, RemoveGroup, SetFlag, SetComment, MoveStack, RenameProject]
        kinds += [AddVariable, RemoveVariable, RenameVariable, SetScope, Whole, Whole, Own, Own]
        kind = self.draw(st.sampled_from(kinds))
        if kind is Whole:
            return self.whole_edit()
        if kind is Own:
            return self.own_edit()
        if kind is CreateBlocks:
            own = [t for t in self.editor.language.definitions if t.startswith("my.")]
            types = st.sampled_from(sorted(self.editor.language.definitions))
            block_type = self.draw(types | st.sampled_from(own))
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
            value = self.draw(VALUES)
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
        if kind is SetScope:
            return SetScope(variable, self.draw(st.sampled_from(["", "program", "kept", "new"])))
        return RenameVariable(variable, self.draw(NAMES))

    def whole_edit(self) -> Edit:
        """An edit of pages, notes or the size of a comment."""
        pages, notes = self.project.pages, self.project.notes
        kinds = [AddPage, RemovePage, RenamePage, MovePage, AddNote, RemoveNote, ChangeNote]
        kind = self.draw(st.sampled_from([*kinds, SetCommentSize]))
        if kind is AddPage:
            return AddPage(self.project.new_id("page"), self.draw(NAMES), self.index(len(pages)))
        if kind is RemovePage:
            return RemovePage(self.one(pages))
        if kind is RenamePage:
            return RenamePage(self.one(pages), self.draw(NAMES))
        if kind is MovePage:
            return MovePage(self.one(pages), self.index(len(pages)))
        if kind is AddNote:
            return AddNote(self.note(self.project.new_id("n")))
        if kind is RemoveNote:
            return RemoveNote(self.one(notes))
        if kind is ChangeNote:
            return ChangeNote(self.note(self.one(notes)))
        return SetCommentSize(self.block(), self.draw(SIZES), self.draw(SIZES))

    def note(self, note_id: str) -> Note:
        places = [self.draw(PLACES), self.draw(PLACES), self.draw(SIZES), self.draw(SIZES)]
        return Note(note_id, self.one(self.project.pages), *places, self.draw(TEXTS))

    def own_edit(self) -> Edit:
        """An edit of the list of own blocks."""
        procedures = self.project.procedures
        kind = self.draw(st.sampled_from([AddProcedure, AddProcedure, ChangeProcedure, "remove"]))
        if kind is AddProcedure:
            made = self.procedure(self.project.new_id("p"), [])
            return AddProcedure(made, self.index(len(procedures)))
        procedure = self.one(procedures)
        if kind is ChangeProcedure:
            there = procedures.get(procedure)
            parts = [p for p in there.parts if isinstance(p, Parameter)] if there else []
            return ChangeProcedure(self.procedure(procedure, parts))
        return RemoveProcedure(procedure)

    def procedure(self, procedure_id: str, parameters: list[Parameter]) -> Procedure:
        """An own block with some of these parameters, and new ones, in any order."""
        kept = self.draw(st.lists(st.sampled_from(parameters), unique=True)) if parameters else []
        kinds = self.draw(st.lists(st.sampled_from(PARAMETER_KINDS), max_size=2))
        new = [Parameter(self.project.new_id("a"), self.draw(NAMES), kind) for kind in kinds]
        words = self.draw(st.lists(NAMES, min_size=1, max_size=2))
        parts = self.draw(st.permutations([*words, *kept, *new]))
        return Procedure(procedure_id, tuple(parts), self.draw(st.booleans()))

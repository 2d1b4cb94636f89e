"""One sample of every block that the palette offers, in a small project of its own."""

from __future__ import annotations

from collections.abc import Iterable

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import AddProcedure, AddVariable, CreateBlocks
from nep_studio.blocks.operations.copying import Clip, copy
from nep_studio.blocks.places import NewStack
from nep_studio.blocks.procedures import CALL
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence
from nep_studio.blocks.values import FieldValue

READ_VARIABLE = "variable.get"


class Stock:
    """The samples, made from an editor's language, with its variables and own blocks.

    Ids of samples are those of blocks in ``project``, which whatever draws a project can draw.
    """

    def __init__(self, editor: Editor) -> None:
        self.language = editor.language
        self.project = Project("Palette")
        for number, variable in enumerate(editor.project.variables):
            AddVariable(variable.id, variable.name, number).apply(self.project)
        for number, procedure in enumerate(editor.project.procedures.values()):
            AddProcedure(procedure, number).apply(self.project)
        self._ids: dict[tuple[object, ...], str] = {}

    def sample(self, block_type: str, **fields: FieldValue) -> str:
        """The id of the sample of a type; slots for a variable hold the first one there is."""
        key = (block_type, *fields.items())
        if key not in self._ids:
            self._ids[key] = self._new(self.language.definitions[block_type], fields)
        return self._ids[key]

    def offered(self, category: str) -> Iterable[str]:
        """The samples of a category, in the order of the palette."""
        variables = self.project.variables
        if category == "my":
            for procedure in self.project.procedures:
                yield self.sample(CALL + procedure)
        if category == "variable":
            for variable in variables:
                yield self.sample(READ_VARIABLE, variable=variable.id)
        for definition in self.language.definitions.values():
            is_own = definition.id.startswith("my.") and definition.id.count(".") > 1
            is_here = definition.category.id == category and not is_own
            if is_here and definition.id != READ_VARIABLE:
                yield self.sample(definition.id)

    def clip(self, sample: str) -> Clip:
        """A sample as blocks to be put into a program."""
        return copy(self.project, self.language, [sample])

    def words(self, sample: str) -> str:
        """What a sample says."""
        return sentence(self.project, self.language, sample)

    def definition(self, sample: str) -> Definition:
        """The definition of a sample."""
        return self.language.definitions[self.project.blocks[sample].type]

    def _new(self, definition: Definition, fields: dict[str, FieldValue]) -> str:
        block = definition.new_block(self.project.new_id("b"))
        first = next((variable.id for variable in self.project.variables), "")
        for key, slot in definition.keys(block.groups):
            if slot.kind.name == "variable" and first:
                block.fields[key] = first
        block.fields.update(fields)
        stacks = self.project.pages[definition.page]
        place = NewStack(definition.page, self.project.new_id("s"), 0.0, 0.0, len(stacks))
        CreateBlocks((block.id,), (block,), place).apply(self.project)
        return block.id

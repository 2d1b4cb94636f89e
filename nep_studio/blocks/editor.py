"""Edits a project as the block language allows: refuses what does not fit, and says why."""

from __future__ import annotations

from contextlib import AbstractContextManager

from .connections import (
    why_no_body,
    why_no_field,
    why_not_below,
    why_not_chained,
    why_not_plugged,
    why_not_variable_name,
)
from .definitions import Definition
from .edits import (
    AddGroup,
    AddVariable,
    CreateBlocks,
    Edit,
    MoveBlocks,
    MoveStack,
    RemoveGroup,
    RenameProject,
    RenameVariable,
    SetComment,
    SetField,
)
from .errors import EditRefused
from .fitting import why_not_block
from .history import History
from .language import Language
from .places import InBody, InInput, InStack, NewStack, Place
from .program import FARTHEST, Block, Project
from .values import why_not_name, why_not_text, why_not_value


class Editor:
    """A project with its language and its history."""

    def __init__(self, project: Project, language: Language) -> None:
        self.project = project
        self.language = language
        self.history = History(project)

    def transaction(self, label: str) -> AbstractContextManager[object]:
        """Everything applied inside is one step of undo."""
        return self.history.transaction(label)

    def apply(self, edit: Edit, label: str = "") -> None:
        """Apply an edit, or raise EditRefused with the reason."""
        reason = self.why_not(edit)
        if reason is not None:
            raise EditRefused(reason)
        self.history.apply(edit, label)

    def create(self, block_type: str, place: Place) -> str:
        """Make a block with its default values; gives its id."""
        definition = self.language.definitions[block_type]
        block = definition.new_block(self.project.new_id("b"))
        self.apply(CreateBlocks((block.id,), (block,), place))
        return block.id

    def add_variable(self, name: str) -> str:
        """Make a variable; gives its id."""
        variable_id = self.project.new_id("v")
        self.apply(AddVariable(variable_id, name, len(self.project.variables)))
        return variable_id

    def new_stack(self, page: str, x: float, y: float) -> NewStack:
        """A place for a new stack, the last of its page."""
        position = len(self.project.pages[page])
        return NewStack(page, self.project.new_id("s"), x, y, position)

    def why_not(self, edit: Edit) -> str | None:
        """Why an edit does not fit the language, or None when it does."""
        if isinstance(edit, MoveBlocks):
            return self._why_not_move(edit)
        if isinstance(edit, CreateBlocks):
            return self._why_not_create(edit)
        if isinstance(edit, SetField):
            return self._why_not_field(edit)
        if isinstance(edit, AddGroup | RemoveGroup):
            return self._why_not_group(edit)
        if isinstance(edit, SetComment):
            return why_not_text(edit.comment)
        if isinstance(edit, MoveStack) and not _is_near(edit.x, edit.y):
            return "This is too far outside the page."
        if isinstance(edit, RenameProject):
            return why_not_name(edit.name)
        if isinstance(edit, AddVariable):
            return why_not_variable_name(self.project, edit.name)
        if isinstance(edit, RenameVariable):
            return why_not_variable_name(self.project, edit.name, but=edit.variable)
        return None

    def _why_not_move(self, edit: MoveBlocks) -> str | None:
        if edit.first not in self.project.blocks:
            return "This block is not there any more."
        chain = self.project.chain_of(self.project.parents[edit.first]) or [edit.first]
        start = chain.index(edit.first) if edit.first in chain else 0
        roots = [self.project.blocks[i] for i in chain[start : start + edit.count]]
        return self._why_not_here(roots or [self.project.blocks[edit.first]], edit.place)

    def _why_not_create(self, edit: CreateBlocks) -> str | None:
        by_id = {block.id: block for block in edit.blocks}
        inside = [child for block in edit.blocks for child in block.children()]
        if not edit.roots or not by_id.keys() >= {*inside, *edit.roots}:
            return "These blocks are not complete."
        for block in edit.blocks:
            if (reason := why_not_block(block, by_id, self.language)) is not None:
                return reason
        return self._why_not_here([by_id[root] for root in edit.roots], edit.place)

    def _why_not_here(self, roots: list[Block], place: Place) -> str | None:
        """Why these blocks cannot be put, one after the other, into a place."""
        definitions = self.language.definitions
        if isinstance(place, NewStack) and not _is_near(place.x, place.y):
            return "This is too far outside the page."
        if isinstance(place, InInput | InBody):
            owner = self.project.blocks.get(place.block)
            if owner is None:
                return "This block is not there any more."
            if isinstance(place, InInput):
                return why_not_plugged(owner, place.slot, roots[0], definitions)
            if (reason := why_no_body(owner, place.slot, definitions)) is not None:
                return reason
        return self._why_not_page(roots, place) or self._why_not_between(roots, place)

    def _why_not_between(self, roots: list[Block], place: Place) -> str | None:
        """Why these blocks cannot be between those that are above and below a place."""
        above, below = self._neighbours({block.id for block in roots}, place)
        is_top = above is None and not isinstance(place, InBody)
        reason = why_not_chained(self._definition(roots[0]), first_in_stack=is_top)
        if reason is None and above is not None:
            reason = why_not_below(self._definition(above))
        if reason is None and below is not None:
            reason = why_not_below(self._definition(roots[-1])) or why_not_chained(
                self._definition(below), first_in_stack=False
            )
        return reason

    def _why_not_page(self, roots: list[Block], place: Place) -> str | None:
        project = self.project
        if isinstance(place, NewStack):
            page = place.page
        elif isinstance(place, InStack) and place.stack in project.stacks:
            page = project.page_of(place.stack)
        elif isinstance(place, InBody) and place.block in project.blocks:
            page = project.page_of(project.stack_of(place.block).id)
        else:
            return None
        for definition in map(self._definition, roots):
            if definition is not None and definition.page != page:
                return f"This block belongs on the page {definition.page.title()}."
        return None

    def _neighbours(self, moved: set[str], place: Place) -> tuple[Block | None, Block | None]:
        """The blocks that will be directly above and below a place."""
        if isinstance(place, InStack) and place.stack in self.project.stacks:
            chain = self.project.stacks[place.stack].body
        elif isinstance(place, InBody) and place.block in self.project.blocks:
            chain = self.project.blocks[place.block].bodies.get(place.slot, [])
        else:
            return None, None
        left = [block for block in chain if block not in moved]
        above = self.project.blocks[left[place.index - 1]] if 0 < place.index <= len(left) else None
        below = self.project.blocks[left[place.index]] if 0 <= place.index < len(left) else None
        return above, below

    def _why_not_field(self, edit: SetField) -> str | None:
        block = self.project.blocks.get(edit.block)
        if block is None:
            return "This block is not there any more."
        if edit.value is None:
            return None
        reason = why_no_field(block, edit.slot, edit.value, self.language)
        if reason is not None:
            return reason
        slot = self.language.definitions[block.type].slot(edit.slot, block.groups)
        return self.language.why_not_choice(slot, edit.value) if slot is not None else None

    def _why_not_group(self, edit: AddGroup | RemoveGroup) -> str | None:
        block = self.project.blocks.get(edit.block)
        definition = self._definition(block) if block is not None else None
        if block is None or definition is None or edit.group not in definition.groups:
            return "This block has no such part."
        if edit.slots != definition.group_slots(edit.group):
            return "This part has other slots."
        count = block.groups.get(edit.group, 0) + (1 if isinstance(edit, AddGroup) else -1)
        if count > definition.groups[edit.group].maximum:
            return "This block cannot have more parts."
        if count < definition.minimum[edit.group]:
            return "This block cannot have fewer parts."
        return self._why_not_part_fields(edit) if isinstance(edit, AddGroup) else None

    def _why_not_part_fields(self, edit: AddGroup) -> str | None:
        slots = self.language.definitions[self.project.blocks[edit.block].type].slots
        for name, value in edit.fields.items():
            if name not in edit.slots or not slots[name].kind.typed:
                return f"This part has no field “{name}”."
            if (reason := why_not_value(slots[name].kind.name, value)) is not None:
                return reason
        return None

    def _definition(self, block: Block) -> Definition | None:
        return self.language.definitions.get(block.type)


def _is_near(x: float, y: float) -> bool:
    return abs(x) <= FARTHEST and abs(y) <= FARTHEST

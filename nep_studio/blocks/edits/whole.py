"""Edits of the project as a whole: its name, its variables, where its stacks lie."""

from __future__ import annotations

from typing import ClassVar

import msgspec

from ..errors import EditRefused
from ..program import Project, Variable


class MoveStack(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Move a stack on its page, in canvas units."""

    label: ClassVar[str] = "move a stack"
    stack: str
    x: float
    y: float

    def apply(self, project: Project) -> MoveStack:
        """Move the stack."""
        stack = project.stacks.get(self.stack)
        if stack is None:
            raise EditRefused("This stack is not there any more.")
        old = MoveStack(self.stack, stack.x, stack.y)
        stack.x, stack.y = float(self.x), float(self.y)
        project.touch(self.stack)
        return old


class RenameProject(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Give the project another name."""

    label: ClassVar[str] = "rename the project"
    name: str

    def apply(self, project: Project) -> RenameProject:
        """Rename the project."""
        old, project.name = project.name, self.name
        project.touch_whole()
        return RenameProject(old)


class AddVariable(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Make a variable, at a position of the list of variables."""

    label: ClassVar[str] = "make a variable"
    variable: str
    name: str
    position: int

    def apply(self, project: Project) -> RemoveVariable:
        """Make the variable."""
        if project.variable(self.variable) is not None:
            raise EditRefused("A variable with this id is already there.")
        if not 0 <= self.position <= len(project.variables):
            raise EditRefused("There is no such position in the list of variables.")
        project.variables.insert(self.position, Variable(self.variable, self.name))
        project.id_seen(self.variable)
        project.touch_whole()
        return RemoveVariable(self.variable)


class RemoveVariable(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Delete a variable; blocks that name it stay, and are told by the checks."""

    label: ClassVar[str] = "delete a variable"
    variable: str

    def apply(self, project: Project) -> AddVariable:
        """Delete the variable."""
        variable = _require_variable(project, self.variable)
        position = project.variables.index(variable)
        del project.variables[position]
        project.touch_whole()
        return AddVariable(variable.id, variable.name, position)


class RenameVariable(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Give a variable another name; blocks name it by its id and follow."""

    label: ClassVar[str] = "rename a variable"
    variable: str
    name: str

    def apply(self, project: Project) -> RenameVariable:
        """Rename the variable."""
        variable = _require_variable(project, self.variable)
        old, variable.name = variable.name, self.name
        project.touch_whole()
        return RenameVariable(self.variable, old)


def _require_variable(project: Project, variable_id: str) -> Variable:
    variable = project.variable(variable_id)
    if variable is None:
        raise EditRefused("This variable is not there any more.")
    return variable

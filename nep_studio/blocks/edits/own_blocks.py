"""Edits of the list of own blocks; editor.py sees to it that the blocks that call them follow."""

from __future__ import annotations

from typing import ClassVar

import msgspec

from ..errors import EditRefused
from ..program import Parameter, Procedure, Project


class AddProcedure(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Make an own block, at a position of the list of own blocks."""

    label: ClassVar[str] = "make an own block"
    procedure: Procedure
    position: int

    def apply(self, project: Project) -> RemoveProcedure:
        """Make the own block."""
        if self.procedure.id in project.procedures:
            raise EditRefused("An own block with this id is already there.")
        procedures = list(project.procedures.values())
        if not 0 <= self.position <= len(procedures):
            raise EditRefused("There is no such position in the list of own blocks.")
        procedures.insert(self.position, self.procedure)
        project.procedures.clear()
        project.procedures.update({procedure.id: procedure for procedure in procedures})
        see_ids(project, self.procedure)
        project.touch_procedures()
        return RemoveProcedure(self.procedure.id)


class RemoveProcedure(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Delete an own block from the list."""

    label: ClassVar[str] = "delete an own block"
    procedure: str

    def apply(self, project: Project) -> AddProcedure:
        """Delete the own block."""
        old = _require_procedure(project, self.procedure)
        position = list(project.procedures).index(self.procedure)
        del project.procedures[self.procedure]
        project.touch_procedures()
        return AddProcedure(old, position)


class ChangeProcedure(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Change the sentence of an own block, and whether it gives a value."""

    label: ClassVar[str] = "change an own block"
    procedure: Procedure

    def apply(self, project: Project) -> ChangeProcedure:
        """Change the own block."""
        old = _require_procedure(project, self.procedure.id)
        project.procedures[old.id] = self.procedure
        see_ids(project, self.procedure)
        project.touch_procedures()
        return ChangeProcedure(old)


def see_ids(project: Project, procedure: Procedure) -> None:
    """Remember the ids in an own block, so that none is given again."""
    project.id_seen(procedure.id)
    for part in procedure.parts:
        if isinstance(part, Parameter):
            project.id_seen(part.id)


def _require_procedure(project: Project, procedure_id: str) -> Procedure:
    procedure = project.procedures.get(procedure_id)
    if procedure is None:
        raise EditRefused("This own block is not there any more.")
    return procedure

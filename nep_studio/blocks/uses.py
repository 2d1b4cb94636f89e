"""Where a variable or an own block is used."""

from __future__ import annotations

from .procedures import CALL
from .program import Project

VARIABLE_SLOT = "variable"
"""The name of every slot that names a variable."""


def variable_uses(project: Project, variable_id: str) -> list[str]:
    """The blocks that name a variable, in the order of their making."""
    return [b.id for b in project.blocks.values() if b.fields.get(VARIABLE_SLOT) == variable_id]


def procedure_uses(project: Project, procedure_id: str) -> list[str]:
    """The blocks that call an own block, in the order of their making."""
    call = CALL + procedure_id
    return [block.id for block in project.blocks.values() if block.type == call]

"""The edits that change a program. Each is data, and applying it gives the edit that undoes it.

An edit checks that the program stays one (ids that exist, a free place, no block inside itself)
and raises EditRefused before anything has changed. Whether blocks *belong* together is asked by
editor.py. All edits can be written as JSON: a journal of them is a crash-safe autosave.
"""

from __future__ import annotations

from .content import AddGroup, RemoveGroup, SetComment, SetField, SetFlag
from .placing import CreateBlocks, DeleteBlocks, MoveBlocks
from .whole import AddVariable, MoveStack, RemoveVariable, RenameProject, RenameVariable

Edit = (
    CreateBlocks
    | DeleteBlocks
    | MoveBlocks
    | SetField
    | SetFlag
    | SetComment
    | AddGroup
    | RemoveGroup
    | MoveStack
    | RenameProject
    | AddVariable
    | RemoveVariable
    | RenameVariable
)

__all__ = [
    "AddGroup",
    "AddVariable",
    "CreateBlocks",
    "DeleteBlocks",
    "Edit",
    "MoveBlocks",
    "MoveStack",
    "RemoveGroup",
    "RemoveVariable",
    "RenameProject",
    "RenameVariable",
    "SetComment",
    "SetField",
    "SetFlag",
]

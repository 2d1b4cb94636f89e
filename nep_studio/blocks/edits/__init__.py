"""The edits that change a program. Each is data, and applying it gives the edit that undoes it.

An edit checks that the program stays one (ids that exist, a free place, no block inside itself)
and raises EditRefused before anything has changed. Whether blocks *belong* together is asked by
editor.py. All edits can be written as JSON: a journal of them is a crash-safe autosave.
"""

from __future__ import annotations

from .content import (
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
    SetExtra,
    SetField,
    SetFlag,
)
from .placing import CreateBlocks, DeleteBlocks, MoveBlocks
from .project import (
    AddPage,
    AddVariable,
    MovePage,
    MoveStack,
    RemovePage,
    RemoveVariable,
    RenamePage,
    RenameProject,
    RenameVariable,
)

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
    | AddNote
    | RemoveNote
    | ChangeNote
    | SetCommentSize
    | AddPage
    | RemovePage
    | RenamePage
    | MovePage
    | AddProcedure
    | RemoveProcedure
    | ChangeProcedure
    | SetExtra
)

__all__ = [
    "AddGroup",
    "AddNote",
    "AddPage",
    "AddProcedure",
    "AddVariable",
    "ChangeNote",
    "ChangeProcedure",
    "CreateBlocks",
    "DeleteBlocks",
    "Edit",
    "MoveBlocks",
    "MovePage",
    "MoveStack",
    "RemoveGroup",
    "RemoveNote",
    "RemovePage",
    "RemoveProcedure",
    "RemoveVariable",
    "RenamePage",
    "RenameProject",
    "RenameVariable",
    "SetComment",
    "SetCommentSize",
    "SetExtra",
    "SetField",
    "SetFlag",
]

"""What can go wrong with blocks, as one tree.

BlocksError
├── DefinitionError    a file that describes blocks or a robot is wrong
├── ProjectFileError   a .nep file cannot be read or written
├── PackError          a pack of blocks cannot be read, written or made
├── EditRefused        an edit that the program cannot take
└── CodeRefused        a block that cannot become Python
"""

from __future__ import annotations

from typing import Any

from faults import FaultError, Words


class BlocksError(FaultError):
    """An error of blocks, or of the files that hold or describe them."""

    title = "Something is wrong with the blocks"


class DefinitionError(BlocksError):
    """A file that describes blocks or a robot is wrong."""

    title = "A description of blocks is wrong"


class ProjectFileError(BlocksError):
    """A project file cannot be read or written."""

    title = "This project cannot be used"


class PackError(BlocksError):
    """A pack of blocks cannot be read, written or made; nothing of it was taken in."""

    title = "These blocks cannot be used"


class EditRefused(BlocksError):
    """An edit that the program cannot take; the program is unchanged."""

    title = "This does not fit"


class CodeRefused(BlocksError):
    """A block that cannot become Python; ``block`` is its id."""

    title = "A block cannot become code"

    def __init__(self, sentence: Words, /, *, block: str = "", **values: Any) -> None:
        super().__init__(sentence, **values)
        self.block = block

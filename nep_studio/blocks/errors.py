"""What can go wrong with blocks, as one tree.

BlocksError
├── DefinitionError    a file that describes blocks or a robot is wrong
├── ProjectFileError   a .nep file cannot be read or written
├── EditRefused        an edit that the program cannot take
└── CodeRefused        a block that cannot become Python
"""

from __future__ import annotations


class BlocksError(Exception):
    """An error that a person can act on: what happened, and a checklist of what to try in order."""

    title = "Something is wrong with the blocks"

    def __init__(
        self, sentence: str, *, checklist: tuple[str, ...] = (), details: str = ""
    ) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.checklist = checklist
        self.details = details


class DefinitionError(BlocksError):
    """A file that describes blocks or a robot is wrong."""

    title = "A description of blocks is wrong"


class ProjectFileError(BlocksError):
    """A project file cannot be read or written."""

    title = "This project cannot be used"


class EditRefused(BlocksError):
    """An edit that the program cannot take; the program is unchanged."""

    title = "This does not fit"


class CodeRefused(BlocksError):
    """A block that cannot become Python; ``block`` is its id."""

    title = "A block cannot become code"

    def __init__(
        self,
        sentence: str,
        *,
        block: str = "",
        checklist: tuple[str, ...] = (),
        details: str = "",
    ) -> None:
        super().__init__(sentence, checklist=checklist, details=details)
        self.block = block

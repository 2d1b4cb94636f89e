"""Packs of own blocks: one file with their definitions and with what people want to know of them.

A pack is a project file with a page of definitions, and one key more: so it is checked like any
project that a stranger made, and can be opened as one. It is data alone: Python in its blocks runs
when a project that has a copy of them does, and no person is spared the question before that.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import msgspec
from msgspec.structs import replace

from faults import Text, text_of

from . import files
from .errors import PackError, ProjectFileError
from .file_text import in_words
from .language import Language
from .procedures import DEFINE, LATEST_VERSION, PACK_ID, procedure_of, title
from .program import Origin, Procedure, Project
from .slots import why_not_line, why_not_name

KEY = "block_pack"
"""Under which key of the file a pack says what it is."""
ENDING = ".nepblocks"
LARGEST_BYTES = 4_000_000
LONGEST_LINE = 200
_CHOOSE = "Choose a file that “Share these blocks” has made; its name ends in .nepblocks."
_ASK = "Ask who made it for a whole copy."


class About(msgspec.Struct, frozen=True, omit_defaults=True):
    """What a pack says of itself; ``id`` is that of all its versions.

    ``offers`` are the own blocks that it is for; the others are those that these need.
    """

    id: str
    version: int = 1
    author: str = ""
    licence: str = ""
    offers: tuple[str, ...] = ()


@dataclass(frozen=True)
class Pack:
    """Own blocks with their definitions; its title is the name of its project."""

    about: About
    project: Project

    @property
    def title(self) -> str:
        """What people call it."""
        return self.project.name

    @property
    def offered(self) -> list[Procedure]:
        """The own blocks that it is for, each saying that it is from here."""
        known = self.project.procedures
        return [self.from_here(known[block]) for block in self.about.offers]

    def from_here(self, procedure: Procedure) -> Procedure:
        """An own block of the pack as it is in a project that has a copy of it."""
        about = self.about
        return replace(procedure, origin=Origin(about.id, procedure.id, about.version, self.title))


def to_bytes(pack: Pack) -> bytes:
    """The text of a pack in UTF-8."""
    return files.to_bytes(pack.project)


def pack_of(project: Project, about: About, language: Language) -> Pack:
    """A project with definitions as a pack, which its file then says; raises PackError."""
    reason = why_not_name(project.name) or _why_not(about, project, language)
    if reason is not None:
        raise PackError(
            "These blocks cannot be shared: {reason}",
            checklist=("Change it, then try again.",),
            reason=reason,
        )
    project.extra[KEY] = msgspec.to_builtins(about)
    return Pack(about, project)


def from_bytes(data: bytes, file_name: str, language: Language) -> Pack:
    """Read a pack; raises PackError, and nothing of it is known then."""
    if len(data) > LARGEST_BYTES:
        raise too_large(file_name)
    try:
        project = files.from_bytes(data, file_name, language)
    except ProjectFileError as error:
        raise PackError(error.sentence, checklist=(_CHOOSE, _ASK), details=error.details) from error
    if KEY not in project.extra:
        raise PackError(
            "{file_name} is no pack of blocks.",
            checklist=(_CHOOSE, "If it is a project, open it with Open."),
            file_name=file_name,
        )
    try:
        about = msgspec.convert(project.extra[KEY], About)
    except msgspec.ValidationError as error:
        raise _refused(file_name, in_words(error)) from error
    if (reason := _why_not(about, project, language)) is not None:
        raise _refused(file_name, reason)
    return Pack(about, project)


def too_large(file_name: str) -> PackError:
    """What is told of a file that is no pack by its size alone."""
    return PackError(
        "{file_name} is too large: a pack has {most} MB at most.",
        checklist=("Is it a pack of blocks, and not a project or a recording?", _CHOOSE),
        file_name=file_name,
        most=LARGEST_BYTES // 1_000_000,
    )


def _refused(name: str, reason: Text) -> PackError:
    return PackError(
        "“{name}” cannot be used as a pack: {reason}",
        checklist=(_ASK, "If the file was changed by hand, change this place back."),
        name=name,
        reason=reason,
    )


def _why_not(about: About, project: Project, language: Language) -> Text | None:
    return _why_not_about(about, project) or next(_wrong_in(project, language), None)


def _why_not_about(about: About, project: Project) -> Text | None:
    """Why a pack cannot say this of itself, or None when it can."""
    if not PACK_ID.fullmatch(about.id):
        return Text("its id is made of small letters and digits.")
    if not 1 <= about.version <= LATEST_VERSION:
        return Text("its version is a whole number: 1, 2, 3 and so on.")
    for line in (about.author, about.licence):
        if line and (reason := why_not_line(line)) is not None:
            return reason
        if len(line) > LONGEST_LINE:
            return text_of("its author and licence have {most} letters at most.", most=LONGEST_LINE)
    if not about.offers or len(set(about.offers)) < len(about.offers):
        return Text("it must name its blocks, each once.")
    if not project.procedures.keys() >= set(about.offers):
        return Text("it names blocks that are not in it.")
    return None


def _wrong_in(project: Project, language: Language) -> Iterator[Text]:
    """What does not belong into a pack: it has definitions and nothing else."""
    stacks = [stack for page in project.pages.values() for stack in page]
    defined = [procedure_of(_defining(project, stack.body[0])) for stack in stacks]
    if "" in defined:
        yield Text("there are blocks in it that are in no definition.")
    yield from _not_defined_once(project, defined)
    known = language.of(project).definitions
    for block in project.blocks.values():
        if block.type not in known and procedure_of(block.type):
            yield Text("it has a block of an own block that is not like this any more.")
        elif block.type not in known:
            yield text_of(
                "it has a block that this NEP Studio does not know: “{type}”. Update NEP Studio.",
                type=block.type,
            )


def _defining(project: Project, first: str) -> str:
    """The type of a block where it is the header of a definition, else nothing."""
    block_type = project.blocks[first].type
    return block_type if block_type.startswith(DEFINE) else ""


def _not_defined_once(project: Project, defined: Iterable[str]) -> Iterator[Text]:
    """Own blocks that a pack does not define, or twice; two that say the same."""
    defined, said = list(defined), set[str]()
    for procedure in project.procedures.values():
        own_block = title(procedure)
        if defined.count(procedure.id) != 1:
            yield text_of("“{own_block}” must be defined in it, once.", own_block=own_block)
        if own_block in said:
            yield text_of("two of its blocks are called “{own_block}”.", own_block=own_block)
        said.add(own_block)

"""Snippets: blocks kept under a name in the person's folder, to be used in any project."""

from __future__ import annotations

import errno
import logging
import re
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from faults.files import content, whole_file
from nep_studio.blocks.errors import BlocksError, EditRefused
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, from_text, to_text
from nep_studio.settings import user_folder
from nep_studio.ui.words import tr

log = logging.getLogger(__name__)

ENDING = ".nepsnippet"
LARGEST_BYTES = 4_000_000
LONGEST_NAME = 60


@dataclass(frozen=True)
class Snippet:
    """Blocks in a file; its name is that of the project inside the file."""

    path: Path
    name: str
    clip: Clip


class Snippets:
    """The snippets of a person: one file each, which is also a project file."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or user_folder() / "snippets"

    @property
    def are_any(self) -> bool:
        """Whether there is a file of one."""
        return any(self.folder.glob(f"*{ENDING}"))

    def all(self, language: Language) -> list[Snippet]:
        """Every snippet that can be read, by name; what cannot be read is left alone."""
        found = []
        for path in sorted(self.folder.glob(f"*{ENDING}")):
            try:
                found.append(read_snippet(path, language))
            except EditRefused as refusal:
                log.warning("The snippet %s cannot be read: %s", path, refusal.sentence)
        return sorted(found, key=lambda snippet: snippet.name.casefold())

    def keep(self, name: str, clip: Clip) -> Path:
        """Write a snippet under a name; raises EditRefused. Nothing that is there is written over.

        The name need not be new: files are told apart by a number.
        """
        clip.project.name = _checked(name)
        path = self._free_path(clip.project.name)
        _write(path, to_text(clip))
        return path

    def rename(self, snippet: Snippet, name: str) -> Path:
        """Give a snippet another name; raises EditRefused."""
        path = self.keep(name, snippet.clip)
        self.delete(snippet)
        return path

    def delete(self, snippet: Snippet) -> None:
        """Take a snippet's file away; raises EditRefused."""
        try:
            snippet.path.unlink(missing_ok=True)
        except OSError as error:
            raise _refused(snippet.path, error) from error

    def take_in(self, path: Path, language: Language) -> Path:
        """Copy a snippet, or any project file, from elsewhere; raises EditRefused."""
        snippet = read_snippet(path, language)
        return self.keep(snippet.name, snippet.clip)

    def _free_path(self, name: str) -> Path:
        stem = file_stem(name)
        path, number = self.folder / f"{stem}{ENDING}", 2
        while path.exists():
            path, number = self.folder / f"{stem}-{number}{ENDING}", number + 1
        return path


def read_snippet(path: Path, language: Language) -> Snippet:
    """Read a snippet's file; raises EditRefused with what is wrong."""
    try:
        clip = from_text(content(path, LARGEST_BYTES).decode(), language)
    except (OSError, UnicodeDecodeError) as error:
        if getattr(error, "errno", 0) == errno.EFBIG:
            raise EditRefused(
                tr("The file {name} is too large for a snippet.", name=path.name),
                checklist=(tr("A snippet is a few blocks: keep more as a project."),),
            ) from error
        raise _refused(path, error) from error
    except BlocksError as error:
        raise EditRefused(error.sentence, checklist=error.checklist) from error
    if not clip.stacks:
        raise EditRefused(
            tr("There are no blocks in the file {name}.", name=path.name),
            checklist=(tr("Choose another file."),),
        )
    return Snippet(path, clip.project.name, clip)


def write_out(snippet: Snippet, path: Path) -> None:
    """Write a snippet into a file that somebody else can take in; raises EditRefused."""
    _write(path, to_text(snippet.clip))


def file_stem(name: str) -> str:
    """A name as the name of a file on any system."""
    letters = unicodedata.normalize("NFC", name)
    stem = re.sub(r"[^\w\-]+", "-", letters).strip("-.")[:LONGEST_NAME]
    return stem or "snippet"


def _checked(name: str) -> str:
    name = " ".join(name.split())
    if not name:
        raise EditRefused(
            tr("A snippet needs a name."), checklist=(tr("Write a short name, such as greeting."),)
        )
    if len(name) > LONGEST_NAME:
        raise EditRefused(
            tr("The name can have at most {count} letters.", count=LONGEST_NAME),
            checklist=(tr("Write a short name, such as greeting."),),
        )
    return name


def _write(path: Path, text: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(path) as file:
            file.write(text.encode())
    except OSError as error:
        raise _refused(path, error) from error


def _refused(path: Path, error: Exception) -> EditRefused:
    reason = tr((getattr(error, "strerror", None) or str(error)).lower())
    return EditRefused(
        tr("The file {name} cannot be used: {reason}.", name=path.name, reason=reason),
        checklist=(tr("Choose another file."), tr("Is there room on the disk?")),
    )

"""The library of a person: packs of own blocks in their folder, one file each."""

from __future__ import annotations

import contextlib
import errno
import logging
import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from faults import reason_of
from faults.files import as_file_name, content, make_privately, whole_file
from nep_studio.blocks.errors import PackError
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.packing import packed
from nep_studio.blocks.packs import (
    ENDING,
    LARGEST_BYTES,
    About,
    Pack,
    from_bytes,
    to_bytes,
    too_large,
)
from nep_studio.blocks.procedures import words
from nep_studio.blocks.program import Project
from nep_studio.settings import user_folder

log = logging.getLogger(__name__)

MOST_PACKS = 500
_MAY_WRITE = ("Is there room on the disk?", "May you write into this folder?")


@dataclass
class _Read:
    """What was read of a file, as long as that is the same; None is no pack."""

    stamp: tuple[int, int]
    pack: Pack | None


@dataclass
class Library:
    """The packs of a person, by their ids; of each the newest version that came in."""

    folder: Path = field(default_factory=lambda: user_folder() / "library")
    _read: dict[Path, _Read] = field(default_factory=dict)

    @property
    def are_any(self) -> bool:
        """Whether there is a file of a pack."""
        return any(self._files())

    def packs(self, language: Language) -> list[Pack]:
        """Every pack that can be read, by title; what cannot be read is left alone."""
        return sorted(
            self._by_file(language).values(),
            key=lambda pack: (pack.title.casefold(), pack.about.id),
        )

    def pack(self, pack_id: str, language: Language) -> Pack | None:
        """The pack of an id, or None."""
        return next((p for p in self._by_file(language).values() if p.about.id == pack_id), None)

    def keep(self, pack: Pack, language: Language) -> None:
        """Put a pack into the library, in the place of an older version of it.

        Raises PackError: for a newer one that is there, or another one of the same version.
        """
        files = self._by_file(language)
        path = next((p for p, one in files.items() if one.about.id == pack.about.id), None)
        if path is not None:
            _check_newer(files[path], pack)
        elif len(files) >= MOST_PACKS:
            raise PackError(
                "Your library is full: {most} packs at most.",
                checklist=("Take a pack out of it: the menu of its blocks has that.",),
                most=MOST_PACKS,
            )
        _write(path or self._free_path(pack.title), pack)

    def keep_block(self, project: Project, language: Language, own: str, pack_id: str) -> Pack:
        """Keep an own block with all that it needs, as a pack of its own; raises PackError.

        One that was kept before becomes a new version; else the pack has this id.
        """
        procedure = project.procedures[own]
        origin = procedure.origin
        before = self.pack(origin.pack, language) if origin is not None else None
        is_alone = before is not None and before.about.offers == (origin and origin.block,)
        if before is not None and is_alone:
            about, name = before.about, before.title
            about = About(about.id, about.version + 1, about.author, about.licence)
        else:
            about, name = About(pack_id), words(procedure)
        pack = packed(project, language, [own], about, name)
        self.keep(pack, language)
        return pack

    def take_in(self, path: Path, language: Language) -> Pack:
        """Copy a pack from elsewhere into the library; raises PackError."""
        pack = read_pack(path, language)
        self.keep(pack, language)
        return pack

    def remove(self, pack: Pack, language: Language) -> None:
        """Take a pack out of the library; raises PackError."""
        for path, one in self._by_file(language).items():
            if one.about.id == pack.about.id:
                try:
                    path.unlink(missing_ok=True)
                except OSError as error:
                    raise _unwritten(path, error) from error

    def _by_file(self, language: Language) -> dict[Path, Pack]:
        found = list(self._files())
        for gone in self._read.keys() - set(found):
            del self._read[gone]
        packs = ((path, self._pack_in(path, language)) for path in found)
        return _newest({path: pack for path, pack in packs if pack is not None})

    def _files(self) -> Iterable[Path]:
        with contextlib.suppress(OSError):  # there is no folder yet
            return sorted(self.folder.glob(f"*{ENDING}"))[:MOST_PACKS]
        return ()

    def _pack_in(self, path: Path, language: Language) -> Pack | None:
        try:
            found = os.stat(path)
        except OSError:
            return None
        stamp = found.st_mtime_ns, found.st_size
        known = self._read.get(path)
        if known is None or known.stamp != stamp:
            known = self._read[path] = _Read(stamp, _pack_or_none(path, language))
        return known.pack

    def _free_path(self, title: str) -> Path:
        stem = as_file_name(title)[:60] or "blocks"
        path, number = self.folder / f"{stem}{ENDING}", 2
        while path.exists():
            path, number = self.folder / f"{stem}-{number}{ENDING}", number + 1
        return path


def read_pack(path: Path, language: Language) -> Pack:
    """Read the file of a pack; raises PackError with what is wrong."""
    try:
        data = content(path, LARGEST_BYTES)
    except OSError as error:
        if error.errno == errno.EFBIG:
            raise too_large(path.name) from error
        raise PackError(
            "{name} cannot be opened: {reason}.",
            checklist=("Is the file still where it was?", "Choose another file."),
            details=str(path),
            name=path.name,
            reason=reason_of(error),
        ) from error
    return from_bytes(data, path.name, language)


def write_pack(pack: Pack, path: Path) -> None:
    """Write a pack into a file for others; raises PackError."""
    _write(path, pack)


def _newest(packs: dict[Path, Pack]) -> dict[Path, Pack]:
    """Of several files of one pack, as somebody copied them there, the newest version."""
    newest: dict[str, Path] = {}
    for path, pack in packs.items():
        known = newest.setdefault(pack.about.id, path)
        if packs[known].about.version < pack.about.version:
            newest[pack.about.id] = path
    return {path: packs[path] for path in newest.values()}


def _pack_or_none(path: Path, language: Language) -> Pack | None:
    try:
        return read_pack(path, language)
    except PackError as error:
        log.warning("The pack %s cannot be read: %s", path, error.sentence)
        return None


def _check_newer(known: Pack, pack: Pack) -> None:
    """Raise PackError unless a pack may take the place of the one that is known."""
    there, version = known.about.version, pack.about.version
    if version < there:
        raise PackError(
            "Your library has version {there} of “{title}” already: this is version {version}.",
            checklist=("Keep the newer one, or take it out of your library first.",),
            there=there,
            version=version,
            title=pack.title,
        )
    if version == there and to_bytes(known) != to_bytes(pack):
        raise PackError(
            "Your library has another “{title}” with the same version, {version}.",
            checklist=(
                "Ask who made it to share it again, as a new version.",
                "Or take the one that is there out of your library first.",
            ),
            title=pack.title,
            version=version,
        )


def _write(path: Path, pack: Pack) -> None:
    try:
        make_privately(path.parent)
        with whole_file(path) as file:
            file.write(to_bytes(pack))
    except OSError as error:
        raise _unwritten(path, error) from error


def _unwritten(path: Path, error: OSError) -> PackError:
    return PackError(
        "{name} cannot be written: {reason}.",
        checklist=_MAY_WRITE,
        details=str(path),
        name=path.name,
        reason=reason_of(error),
    )

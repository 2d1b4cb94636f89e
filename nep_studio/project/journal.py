"""A journal of edits beside a snapshot of the project, from which lost work is recovered.

    <folder>/<time-pid>/lock            held by the window that writes here, for as long as it lives
    <folder>/<time-pid>/about.json      name and path of the project, and whether it is saved
    <folder>/<time-pid>/3.nep           the project at the beginning of ...
    <folder>/<time-pid>/3.edits         ... the edits since then: one JSON array a step, one a line

Each step is given to the operating system at once, so that the program may die at any time; a
``flush`` every two seconds puts it on the disk, so that the computer may.
"""

from __future__ import annotations

import logging
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import msgspec

from faults.files import content, whole_file
from nep_core.places import opened_privately, private_folder
from nep_core.wire.frames import CANNOT_DECODE
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import ANY_EDIT, Edit
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Project
from nep_studio.support.safe_mode import FileLock

log = logging.getLogger(__name__)

STEPS_PER_SNAPSHOT = 500
BYTES_PER_SNAPSHOT = 40_000_000
"""What was learned of gestures is a megabyte or more, each time."""
_ENCODER = msgspec.json.Encoder()
_DECODER = msgspec.json.Decoder(list[ANY_EDIT])


class About(msgspec.Struct):
    """What a journal is of; ``unsaved`` says that its snapshots are not in the project's file."""

    name: str
    path: str
    unsaved: bool


@dataclass(frozen=True, slots=True)
class Recoverable:
    """Work that was not saved: the name and file of the project, when it was last changed."""

    name: str
    path: Path | None
    time: float
    project: Project
    folder: Path

    def discard(self) -> None:
        """Throw the journal away, once the work is saved or not wanted."""
        shutil.rmtree(self.folder, ignore_errors=True)


class Journal:
    """Writes down every edit of one open project.

    A failing disk does not stop the person's work: it is logged, ``error`` says so, and ``flush``
    tries again until nothing is missing any more.
    """

    def __init__(
        self, folder: Path, editor: Editor, path: Path | None = None, *, unsaved: bool = False
    ) -> None:
        self._editor = editor
        self._about = About(editor.project.name, str(path or ""), unsaved)
        self._number = 0
        self._steps = self._bytes = 0
        self._file = -1
        self._is_flushed = True
        self._is_behind = False
        """Whether something is missing on the disk, so that only a new beginning helps."""
        self.error = ""
        self.folder = folder / f"{time.time_ns()}-{os.getpid()}"
        private_folder(folder)
        self.folder.mkdir(mode=0o700)
        self._lock = FileLock(self.folder / "lock")
        self._lock.take()
        self._snapshot()
        editor.history.record(self._write)

    def flush(self) -> None:
        """Put on the disk what has been written; to be called at least every two seconds."""
        if self._is_behind:
            self._snapshot()
        if self._is_flushed or self._file < 0:
            return
        try:
            os.fsync(self._file)
            self._is_flushed = True
        except OSError as error:
            self._fail(error)

    def saved(self, path: Path) -> None:
        """Note that the project has been saved as it is now: nothing is left to recover."""
        self._about = About(self._editor.project.name, str(path), False)
        self._snapshot()

    def close(self, *, keep: bool = False) -> None:
        """Write no more; the journal goes, unless it is to be kept for the next start."""
        self._editor.history.unrecord(self._write)
        if self._file >= 0:
            self.flush()
            os.close(self._file)
            self._file = -1
        self._lock.release()
        if not keep:
            shutil.rmtree(self.folder, ignore_errors=True)

    def _write(self, edits: tuple[Edit, ...]) -> None:
        is_long = self._steps >= STEPS_PER_SNAPSHOT or self._bytes >= BYTES_PER_SNAPSHOT
        if is_long or self._is_behind:
            self._about.unsaved = True
            self._snapshot()
            return
        try:
            line = left = _ENCODER.encode(edits) + b"\n"
            while left:
                left = left[os.write(self._file, left) :]
            self._steps, self._bytes = self._steps + 1, self._bytes + len(line)
        except OSError as error:
            self._fail(error)
            self._is_behind = self._about.unsaved = True
        self._is_flushed = False

    def _snapshot(self) -> None:
        """Begin a new file of edits from the project as it is; only then the old ones go."""
        number = self._number + 1
        try:
            with whole_file(self.folder / f"{number}.nep", is_private=True) as whole:
                whole.write(to_bytes(self._editor.project))
            edits = self.folder / f"{number}.edits"
            flags = os.O_WRONLY | os.O_CREAT | os.O_APPEND | getattr(os, "O_BINARY", 0)
            file = opened_privately(str(edits), flags)
            with whole_file(self.folder / "about.json", is_private=True) as whole:
                whole.write(msgspec.json.encode(self._about))
        except OSError as error:
            self._fail(error)
            self._is_behind = True
            return
        self._is_behind, self.error = False, ""
        if self._file >= 0:
            os.close(self._file)
        for old in (f"{self._number}.nep", f"{self._number}.edits"):
            with suppress(OSError):
                (self.folder / old).unlink(missing_ok=True)
        self._number, self._file, self._is_flushed = number, file, False
        self._steps = self._bytes = 0

    def _fail(self, error: OSError) -> None:
        if not self.error:
            log.warning("The journal in %s cannot be written: %s", self.folder, error)
        self.error = str(error)


def recover(folder: Path, language: Language) -> list[Recoverable]:
    """The unsaved work of windows that are no more, the newest first.

    Journals of running windows and those without unsaved work are left out, the latter are
    removed; what cannot be read is left where it is, and logged.
    """
    found = []
    for journal in sorted(folder.glob("*-*")) if folder.is_dir() else ():
        lock = FileLock(journal / "lock")
        if not lock.take():
            continue
        try:
            work = _read(journal, language)
        except (OSError, BlocksError, *CANNOT_DECODE) as error:
            log.warning("The journal in %s cannot be read: %s", journal, error)
            work = None
        finally:
            lock.release()
        if work is not None:
            found.append(work)
    return sorted(found, key=lambda work: work.time, reverse=True)


def _read(journal: Path, language: Language) -> Recoverable | None:
    about = msgspec.json.decode(content(journal / "about.json"), type=About)
    snapshot = max(journal.glob("*.nep"), key=lambda path: int(path.stem))
    edits = snapshot.with_suffix(".edits")
    project = from_bytes(content(snapshot), snapshot.name, language)
    steps = _replay(project, edits) if edits.exists() else 0
    if not steps and not about.unsaved:
        shutil.rmtree(journal, ignore_errors=True)
        return None
    changed = edits.stat().st_mtime if steps else snapshot.stat().st_mtime
    path = Path(about.path) if about.path else None
    return Recoverable(project.name, path, changed, project, journal)


def _replay(project: Project, edits: Path) -> int:
    """Apply the steps of a file, up to the first that is not whole; gives how many were."""
    steps = 0
    for step in _steps(edits):
        undo: list[Edit] = []
        try:
            for edit in step:
                undo.append(edit.apply(project))
        except (BlocksError, LookupError) as error:
            log.warning("Step %d of %s does not fit: %s", steps + 1, edits, error)
            for edit in reversed(undo):
                edit.apply(project)
            break
        steps += 1
    return steps


def _steps(edits: Path) -> Iterator[list[Edit]]:
    for line in content(edits).splitlines():
        try:
            yield _DECODER.decode(line)
        except CANNOT_DECODE:
            return  # the program died while it wrote this line

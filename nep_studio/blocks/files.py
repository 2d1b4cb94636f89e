"""Open and save .nep files; saving never loses the file that was there."""

from __future__ import annotations

import os
import shutil
from contextlib import suppress
from pathlib import Path

from .errors import ProjectFileError
from .language import Language
from .program import Project
from .reading import from_bytes
from .writing import to_bytes

LARGEST_BYTES = 60_000_000

_CHOOSE = ("Is the file still where it was?", "Choose a project that NEP Studio has saved.")


def load(path: Path, language: Language) -> Project:
    """Read a project; raises ProjectFileError, which names the file, the place, the remedy."""
    try:
        if path.is_dir() or (path.exists() and not path.is_file()):
            raise ProjectFileError(f"{path.name} is not a file.", checklist=_CHOOSE)
        with path.open("rb") as file:
            data = file.read(LARGEST_BYTES + 1)
    except OSError as error:
        raise ProjectFileError(
            f"{path.name} cannot be opened: {_reason(error)}.", checklist=_CHOOSE, details=str(path)
        ) from error
    if len(data) > LARGEST_BYTES:
        raise ProjectFileError(
            f"{path.name} is too large: more than {LARGEST_BYTES // 1_000_000} MB.",
            checklist=_CHOOSE,
        )
    return from_bytes(data, path.name, language)


def save(project: Project, path: Path) -> None:
    """Write a project beside the old file, then put it in its place in one step.

    Raises ProjectFileError; the old file is then as it was.
    """
    target = path.resolve()
    new = target.with_name(f".{target.name}.{os.getpid()}.new")
    try:
        data = to_bytes(project)
        with new.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            shutil.copymode(target, new)
        os.replace(new, target)
    except (OSError, UnicodeEncodeError) as error:
        with suppress(OSError):
            new.unlink(missing_ok=True)
        reason = _reason(error) if isinstance(error, OSError) else "a text in it cannot be written"
        raise ProjectFileError(
            f"{path.name} could not be saved: {reason}. The file that was there is unchanged.",
            checklist=(
                "Is there room on the disk?",
                "May you write into this folder? Save the project in another one.",
            ),
            details=str(error),
        ) from error


def _reason(error: OSError) -> str:
    return (error.strerror or "the system gives no reason").lower()

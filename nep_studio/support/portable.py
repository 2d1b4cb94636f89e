"""Portable mode: all that belongs to the person is in a folder beside the program, as on a stick.

The folder beside the program switches it on; ``--portable`` makes the folder. Where that cannot be
written (a stick with its switch on, a program in a folder of the system) a folder of this run takes
its place: nothing is kept then, and nothing is left on the computer either.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

from nep_core.places import PORTABLE_VARIABLE, ROBOT_FILES_VARIABLE, portable_folder

NAME = "NEP Studio data"
"""The folder beside the program."""

OPTION = "--portable"
SETTINGS_VARIABLE = "NEP_STUDIO_FOLDER"
ORIGIN = "not kept.txt"
"""In a folder of one run: which folder cannot be written."""

COPIED = ("settings", "keys")


def begin(*, is_asked: bool = False, beside: Path | None = None) -> None:
    """Use the folder beside the program if there is one, or if it ``is_asked`` for."""
    if (told := portable_folder()) is not None:  # as whoever started this process said
        _use(told)
        return
    folder = (beside or program_folder()) / NAME
    if is_asked or folder.is_dir():
        _use(folder if _can_write(folder) else _folder_of_this_run(folder))


def program_folder() -> Path:
    """The folder in which the person sees the program.

    On macOS the one with the .app, on Linux the one with the AppImage, from source the checkout.
    """
    if not getattr(sys, "frozen", False):
        return Path(__file__).resolve().parents[2]
    if image := os.environ.get("APPIMAGE"):
        return Path(image).parent
    program = Path(sys.executable).resolve()
    bundles = (folder for folder in program.parents if folder.suffix == ".app")
    return next(bundles, program).parent


def not_kept() -> Path | None:
    """The folder that should keep what this run keeps, and cannot; None when all is well."""
    folder = portable_folder()
    if folder is None:
        return None
    try:
        return Path((folder / ORIGIN).read_text(encoding="utf-8"))
    except OSError:
        return None


def kept_name(path: Path) -> str:
    """A path as settings keep it: one on the stick without its drive, which may be another next."""
    root = _travelling()
    if root is not None and path.is_relative_to(root):
        return f"./{path.relative_to(root).as_posix()}"
    return str(path)


def path_of(name: str) -> Path:
    """The path that ``kept_name`` was given."""
    root = _travelling()
    return root / name if root is not None and name.startswith("./") else Path(name)


def _travelling() -> Path | None:
    """The folder that travels: the program's with all that is in it."""
    folder = not_kept() or portable_folder()
    return folder.parent if folder is not None else None


def _use(folder: Path) -> None:
    """Let this process, and all that it starts, keep everything there."""
    folder = folder.absolute()
    os.environ[PORTABLE_VARIABLE] = str(folder)
    os.environ.setdefault(SETTINGS_VARIABLE, str(folder / "settings"))
    os.environ.setdefault(ROBOT_FILES_VARIABLE, str(folder / "robots"))
    with suppress(OSError):
        (folder / "projects").mkdir(exist_ok=True)


def _can_write(folder: Path) -> bool:
    import tempfile

    try:
        folder.mkdir(exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def _folder_of_this_run(origin: Path) -> Path:
    """A folder with a copy of the settings, which goes when the program ends."""
    import atexit
    import shutil
    import tempfile

    folder = Path(tempfile.mkdtemp(prefix="nep-studio-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    for name in COPIED:
        with suppress(OSError, shutil.Error):
            left_out = shutil.ignore_patterns("journals", "*.log*")
            shutil.copytree(origin / name, folder / name, ignore=left_out)
    (folder / ORIGIN).write_text(str(origin), encoding="utf-8")
    return folder

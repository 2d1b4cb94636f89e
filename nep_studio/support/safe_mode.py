"""Safe mode: without the person's settings, snippets and own nodes, and without the graphics card.

A start leaves a note that goes when the window stood for a while, or was closed. A note that
nobody holds tells the next start that the last one failed: the lock on it goes with its process.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from nep_core.places import NODES_VARIABLE, opened_privately, private_folder

if TYPE_CHECKING:
    from nep_studio.settings import Settings


OPTION = "--safe-mode"
VARIABLE = "NEP_SAFE_MODE"
LEFT_OUT = (
    NODES_VARIABLE,
    "QT_STYLE_OVERRIDE",
    "QT_QPA_PLATFORMTHEME",
    "QT_PLUGIN_PATH",
    "QT_OPENGL",
)
"""Variables that bring in what others made."""

NOTE = "starting"
CRASHES = "crashes.log"
MOST_CRASH_BYTES = 200_000


def begin() -> None:
    """Let this process, and all that it starts, run in safe mode."""
    os.environ[VARIABLE] = "1"
    for name in LEFT_OUT:
        os.environ.pop(name, None)


def is_on() -> bool:
    """Whether this is safe mode."""
    return bool(os.environ.get(VARIABLE))


def passing_settings() -> Settings:
    """Settings as at a first start, in a folder that goes when the program ends."""
    import atexit
    import shutil
    import tempfile

    from nep_studio.settings import Settings

    folder = Path(tempfile.mkdtemp(prefix="nep-studio-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    settings = Settings(folder)
    settings.tour_done = True
    return settings


def set_settings_aside(folder: Path) -> bool:
    """Let the next usual start be as the first one; the old settings stay beside."""
    try:
        (folder / "settings.ini").replace(folder / "settings.old.ini")
        return True
    except OSError:
        return False


class StartNote:
    """Says that the program is starting, until ``succeeded``; see ``last_failed``."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / NOTE
        self._lock = FileLock(self._path)
        was_there = self._path.exists()
        with suppress(OSError):
            private_folder(folder)
        self._is_held = self._lock.take()
        self.last_failed = was_there and self._is_held
        """Whether a start ended without a window; one that still goes on holds its note."""

    def succeeded(self) -> None:
        """Take the note away: the window is there, or a person has closed it."""
        if not self._is_held:
            return
        self._is_held = False
        with suppress(OSError):
            if sys.platform == "win32":  # there, an open file cannot be deleted
                self._lock.release()
            self._path.unlink()
        self._lock.release()


def keep_crashes(folder: Path) -> None:
    """Let Python write down where it was when the system ends the program."""
    import faulthandler

    path = folder / CRASHES
    with suppress(OSError):
        private_folder(folder)
        if path.exists() and path.stat().st_size > MOST_CRASH_BYTES:
            with suppress(OSError):  # another window may have it open
                path.unlink()
        file = open(path, "a", opener=opened_privately)  # noqa: SIM115  as long as the program
        faulthandler.enable(file)


# A lock on a file that goes with the process that holds it, however that ends.

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl


class FileLock:
    """Held by one process at a time; the file holds the id of that process, for people."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = -1

    def take(self) -> bool:
        """Take the lock; False when another process has it, or the file cannot be made."""
        try:
            file = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o600)
        except OSError:
            return False
        try:
            if sys.platform == "win32":
                msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
            else:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(file)
            return False
        os.ftruncate(file, 0)
        os.write(file, f" {os.getpid()}\n".encode())  # Windows locks the first byte
        self._file = file
        return True

    def release(self) -> None:
        """Give the lock back."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

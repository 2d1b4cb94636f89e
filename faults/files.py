"""Files that are written whole, and read only where they are files.

Whoever reads finds the old one or the new one, never a half; and never waits for a pipe, whatever
it was that somebody brought.

It stands in this room because it is the one that every other may import, and saving is where a
fault would lose somebody's work.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import sys
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, BinaryIO

IN_USE_S = 1.0
"""Windows gives no new content to a file that another program has open: so long it is tried."""
AGAIN_S = 0.02

NO_FILE, TOO_LARGE = "it is not a file", "it is too large"
"""Why something cannot be read, where the system would."""


@contextlib.contextmanager
def whole_file(path: Path, *, is_private: bool = False) -> Iterator[BinaryIO]:
    """Write a file beside ``path``, which takes its place when it is whole; raises OSError.

    Whoever reads finds the old one or the new one, also after a crash or a power cut; one that
    ``is_private`` is this user's alone at every moment, and another is for those whom the old one
    was for.
    """
    new = path.with_name(f".{path.name[:40]}.{os.urandom(4).hex()}")
    mode = 0o600 if is_private else 0o666
    try:
        with open(new, "xb", opener=lambda name, flags: os.open(name, flags, mode)) as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        if not is_private:
            with contextlib.suppress(OSError):  # there is no old one, or modes mean nothing there
                new.chmod(stat.S_IMODE(path.stat().st_mode))
        put_in_place(new, path)
    finally:
        new.unlink(missing_ok=True)


def write_whole(path: Path, content: str | bytes, *, is_private: bool = False) -> None:
    """Write a text, as UTF-8, or bytes as a file that takes the place of ``path`` when it is whole.

    Raises OSError; what was there is then as it was.
    """
    with whole_file(path, is_private=is_private) as file:
        file.write(content.encode() if isinstance(content, str) else content)


def is_elsewhere(named: str) -> bool:
    """Whether a path is on another computer, which even a look would tell of us.

    Windows greets that computer with the person's name and a hash of their password.
    """
    return named.strip()[:2] in ("\\\\", "//", "\\/", "/\\")


def make_privately(folder: Path) -> None:
    """Make a folder for this user only, unless it is there, as it is then; raises OSError.

    Those above it that are not there either are for this user only, too: who can write there could
    put another one in its place.
    """
    for one in (*reversed(folder.parents), folder):
        if not one.exists():
            one.mkdir(exist_ok=True, mode=0o700)
    folder.mkdir(exist_ok=True)  # FileExistsError, where there is a file


def put_in_place(new: Path, path: Path) -> None:
    """Let the whole file ``new`` take the place of ``path``, to stay; raises OSError."""
    until_s = time.monotonic() + IN_USE_S
    while True:
        try:
            os.replace(new, path)
            break
        except PermissionError:
            if sys.platform != "win32" or time.monotonic() >= until_s:
                raise
            time.sleep(AGAIN_S)
    sync_folder(path.parent)


def sync_folder(folder: Path) -> None:
    """Bring to the disk which files a folder has: else a power cut may take a new name back."""
    if sys.platform == "win32":  # it keeps names by itself, and opens no folder
        return
    with contextlib.suppress(OSError):  # some file systems, as of networks, cannot
        number = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(number)
        finally:
            os.close(number)


def opened(path: Path) -> BinaryIO:
    """Open a file to read it; raises OSError for what is none.

    A pipe would keep who opens it for ever, and a device may give bytes without end.
    """
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    number = os.open(path, flags)
    mode = os.fstat(number).st_mode
    if stat.S_ISREG(mode):
        return os.fdopen(number, "rb")
    os.close(number)
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    raise OSError(errno.EINVAL, NO_FILE, str(path))


def content(path: Path, most: int = sys.maxsize) -> bytes:
    """The bytes of a file; raises OSError for what is none, or has more than ``most``."""
    with opened(path) as file:
        if os.fstat(file.fileno()).st_size > most:
            raise OSError(errno.EFBIG, TOO_LARGE, str(path))
        return file.read()


LARGEST_TOML = 1_000_000
_DEEP_KEY = re.compile(r"""(?<![\w"'-])(?:[\w"'-]++[ \t]*+\.[ \t]*+){60}""")


def read_toml(path: Path) -> dict[str, Any]:
    """The values in a TOML file; OSError, ValueError or RecursionError when there are none.

    Python's reader takes seconds for a name of a thousand parts, and for ever for more.
    """
    with opened(path) as file:
        return toml_of(file.read(LARGEST_TOML + 1).decode())


def toml_of(text: str) -> dict[str, Any]:
    """The values in such a text; ValueError or RecursionError when there are none."""
    text = text.replace("\r\n", "\n")
    if len(text) > LARGEST_TOML:
        raise ValueError(TOO_LARGE)
    if _DEEP_KEY.search(text):
        raise ValueError("a name in it has too many parts")
    return tomllib.loads(text)


def as_file_name(title: str) -> str:
    """A title without the letters that some system allows in no file name."""
    return "".join(" " if letter in '\\/:*?"<>|' else letter for letter in title).strip()

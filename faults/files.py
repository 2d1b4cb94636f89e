"""Files that are written whole: whoever reads finds the old one or the new one, never a half.

And files that somebody brought, of which nobody knows what they are.

It stands in this room because it is the one that every other may import, and saving is where a
fault would lose somebody's work.
"""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import stat
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

IN_USE_S = 1.0
"""Windows gives no new content to a file that another program has open: so long it is tried."""
AGAIN_S = 0.02


@contextlib.contextmanager
def whole_file(path: Path, *, is_private: bool = False) -> Iterator[BinaryIO]:
    """Write a file beside ``path``, which takes its place when it is whole; raises OSError.

    Whoever reads finds the old one or the new one, also after a crash or a power cut; one that
    ``is_private`` is this user's alone at every moment, and another is for those whom the old one
    was for.
    """
    new = path.with_name(f".{path.name[:40]}.{secrets.token_hex(4)}")
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


def read_file(path: Path, most_bytes: int) -> bytes:
    """The bytes of a file that somebody brought; raises OSError for one that has more, or none.

    What is called like a picture may be a link to a device that never ends, or a pipe into which
    nobody writes: who reads that waits for ever.
    """
    with open(path, "rb", opener=_opened_at_once) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(errno.EINVAL, "it is not a file", str(path))
        data = file.read(most_bytes + 1)
    if len(data) > most_bytes:
        raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), str(path))
    return data


def _opened_at_once(name: str, flags: int) -> int:
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))


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

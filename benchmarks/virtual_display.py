"""A display of our own without a screen: Xvfb on a free number, ended with what it was for."""

from __future__ import annotations

import os
import secrets
import select
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PROGRAMS = ("Xvfb", "xauth")
START_S = 15.0
SCREEN = "1600x1200x24"


class NoDisplay(Exception):
    """There can be no display of our own; the text says why and what to do."""


def missing_programs() -> list[str]:
    """The programs for a display of our own that this machine lacks."""
    return [name for name in PROGRAMS if shutil.which(name) is None]


@contextmanager
def virtual_display() -> Iterator[dict[str, str]]:
    """Start a display that only we may use; give the environment for what is to be shown on it.

    Raises NoDisplay.
    """
    if missing := missing_programs():
        raise NoDisplay(
            f"{' and '.join(missing)} is not installed. Type: apt-get install xvfb xauth"
        )
    with tempfile.TemporaryDirectory(prefix="nep-display-") as folder:
        key = Path(folder) / "key"
        key.touch()
        read, write = os.pipe()
        options = ["-displayfd", str(write), "-screen", "0", SCREEN, "-nolisten", "tcp"]
        server = subprocess.Popen(
            ["Xvfb", *options, "-auth", str(key)], pass_fds=(write,), stderr=subprocess.DEVNULL
        )
        os.close(write)
        try:
            display = f":{_number(read)}"
            _allow_only_us(key, display)
            away = ("WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
            environment = {k: v for k, v in os.environ.items() if k not in away}
            extra = {"DISPLAY": display, "XAUTHORITY": str(key), "QT_QPA_PLATFORM": "xcb"}
            yield environment | extra
        finally:
            os.close(read)
            server.terminate()
            try:
                server.wait(5)
            except subprocess.TimeoutExpired:
                server.kill()
                server.wait()


def _number(pipe: int) -> int:
    """The number of the display, which Xvfb chooses and tells when it is ready."""
    is_there, _, _ = select.select([pipe], [], [], START_S)
    told = os.read(pipe, 32) if is_there else b""
    if not told.strip().isdigit():
        raise NoDisplay("Xvfb did not start.")
    return int(told)


def _allow_only_us(key: Path, display: str) -> None:
    """Make the key without which the server lets nobody in."""
    cookie = secrets.token_hex(16)
    command = ["xauth", "-q", "-f", str(key), "add", display, ".", cookie]
    made = subprocess.run(command, capture_output=True, text=True)
    if made.returncode != 0:
        raise NoDisplay(f"xauth could not make a key: {made.stderr.strip()}")

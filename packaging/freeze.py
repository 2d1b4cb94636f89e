"""Freezes the program into ``dist/nep-studio`` (macOS: ``dist/NEP Studio.app``)."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import parts

DIST = parts.ROOT / "dist"
STORED = {"PYINSTALLER_ZLIB_COMPRESSION_LEVEL": "0"}
"""Modules are stored as they are: they load sooner, and installers compress them better."""
WORK = parts.ROOT / "build" / "frozen"


def freeze(dist: Path = DIST) -> Path:
    """Run PyInstaller, strip what it leaves; the folder of the program."""
    nothing_elsewhere = {"PYINSTALLER_CONFIG_DIR": str(WORK), "QT_QPA_PLATFORM": "offscreen"}
    environment = {**os.environ, **nothing_elsewhere, **STORED}
    command = [sys.executable, "-m", "PyInstaller", "--noconfirm", "--log-level", "WARN"]
    folders = ["--distpath", str(dist), "--workpath", str(WORK)]
    subprocess.run([*command, *folders, "build.spec"], cwd=parts.ROOT, env=environment, check=True)
    folder = dist / parts.NAME
    if sys.platform == "linux":
        strip_debug_data(folder / "_internal")
        nep = folder / "nep"
        nep.unlink(missing_ok=True)
        nep.symlink_to(parts.NAME)
    return folder


def strip_debug_data(folder: Path) -> None:
    """Take away what only debuggers read."""
    strip = shutil.which("strip")
    found = [path for name in parts.WITH_DEBUG_DATA for path in folder.glob(name)]
    if strip and found:
        subprocess.run([strip, "--strip-debug", *map(str, found)], check=True)


if __name__ == "__main__":
    print(freeze())

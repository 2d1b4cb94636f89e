"""Packs the frozen program as it is: ``python packaging/archive.py`` makes a .tar.xz of Linux."""

from __future__ import annotations

import argparse
import platform
import tarfile
from pathlib import Path
from typing import Literal

import linux_files
import parts
from freeze import DIST

from nep_studio import __version__

Preset = Literal[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]


def build(program: Path, goal: Path, preset: Preset = 9) -> Path:
    """Pack the program; the path of the archive. Its files belong to nobody special."""
    name = f"{parts.NAME}-{__version__}-Linux-{platform.machine()}"
    path = goal / f"{name}.tar.xz"
    with tarfile.open(path, "w:xz", preset=preset) as archive:
        archive.add(program, arcname=name, filter=_of_root)
    return path


def _of_root(file: tarfile.TarInfo) -> tarfile.TarInfo:
    file.uid = file.gid = 0
    file.uname = file.gname = "root"
    if file.isfile() or file.isdir():
        file.mode = linux_files.allowed(file.name, file.mode, is_folder=file.isdir())
    return file


def main() -> None:
    """Make it, and print its path and size."""
    parser = argparse.ArgumentParser(description="Make the .tar.xz.")
    parser.add_argument("program", type=Path, nargs="?", default=DIST / parts.NAME)
    path = build(parser.parse_args().program, DIST)
    print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()

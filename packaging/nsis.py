"""Makes the installer for Windows: ``python packaging/nsis.py [FOLDER]``; needs makensis."""

from __future__ import annotations

import argparse
import subprocess
from pathlib import Path

import icons
import parts
from freeze import DIST

from nep_studio import __version__

SCRIPT = Path(__file__).resolve().parent / "windows" / "nep-studio.nsi"


def build(program: Path, goal: Path) -> Path:
    """Pack the program; the path of the installer."""
    drawn = parts.ROOT / "build" / "icons"
    icons.write_icons(drawn)
    output = goal / f"NEP-Studio-{__version__}-Windows.exe"
    defined = {
        "VERSION": __version__,
        "PROGRAM": program.resolve(),
        "ICON": drawn / f"{parts.NAME}.ico",
        "OUTPUT": output.resolve(),
    }
    words = [f"-D{name}={value}" for name, value in defined.items()]
    subprocess.run(["makensis", "-V2", "-WX", "-INPUTCHARSET", "UTF8", *words, SCRIPT], check=True)
    return output


def main() -> None:
    """Make it, and print its path and size."""
    parser = argparse.ArgumentParser(description="Make the installer for Windows.")
    parser.add_argument("program", type=Path, nargs="?", default=DIST / parts.NAME)
    path = build(parser.parse_args().program, DIST)
    print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()

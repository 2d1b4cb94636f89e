"""Makes an AppImage of the frozen program, where ``appimagetool`` is on the PATH."""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import linux_files
import parts
from freeze import DIST

from nep_studio import __version__

TOOL = "appimagetool"
NO_TOOL = """\
There is no appimagetool on the PATH, so that no AppImage was made. It is a program of the AppImage
project; packaging/README.md says where to get it."""
RUN = """\
#!/bin/sh
# What the AppImage starts. Called as "nep", by a link of this name, it is the command nep.
case "${ARGV0##*/}" in nep) exec "$APPDIR/usr/bin/nep" "$@" ;; esac
exec "$APPDIR/usr/bin/nep-studio" "$@"
"""


def lay_out(program: Path, root: Path) -> None:
    """The tree that becomes the AppImage."""
    linux_files.lay_out(program, root)
    share = root / "usr" / "share"
    shutil.copy(share / "applications" / f"{parts.NAME}.desktop", root)
    shutil.copy(share / "icons" / "hicolor" / "256x256" / "apps" / f"{parts.NAME}.png", root)
    (root / ".DirIcon").symlink_to(f"{parts.NAME}.png")
    run = root / "AppRun"
    run.write_text(RUN, encoding="utf-8")
    run.chmod(0o755)


def main() -> int:
    """Make it; 1 when the tool is missing or fails."""
    parser = argparse.ArgumentParser(description="Make the AppImage.")
    parser.add_argument("program", type=Path, nargs="?", default=DIST / parts.NAME)
    program = parser.parse_args().program
    if shutil.which(TOOL) is None:
        print(NO_TOOL, file=sys.stderr)
        return 1
    path = DIST / f"NEP-Studio-{__version__}-{platform.machine()}.AppImage"
    with tempfile.TemporaryDirectory(prefix="nep-appimage-") as made:
        root = Path(made) / "NEP Studio.AppDir"
        lay_out(program, root)
        environment = {**os.environ, "ARCH": platform.machine(), "VERSION": __version__}
        code = subprocess.run([TOOL, "--no-appstream", root, path], env=environment).returncode
    if code == 0:
        print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")
    return code


if __name__ == "__main__":
    sys.exit(main())

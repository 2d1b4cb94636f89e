"""Makes all that is published for this system: freezes the program, tries it, packs it."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

import parts

HERE = Path(__file__).resolve().parent
REPORT = parts.ROOT / "dist" / "smoke.json"
PICTURE = parts.ROOT / "dist" / "smoke.png"


def steps(system: str, *, is_quick: bool, has_appimagetool: bool) -> list[list[str]]:
    """The commands, in their order, for a ``sys.platform``."""
    python = sys.executable
    try_it = ["smoke.py", "--report", str(REPORT), "--picture", str(PICTURE)]
    scripts = [["freeze.py"], try_it]
    if system == "linux":
        scripts += [["deb.py", *(["--quick"] if is_quick else [])]]
        scripts += [] if is_quick else [["archive.py"]]
        scripts += [["appimage.py"]] if has_appimagetool else []
    elif system == "win32":
        scripts += [["nsis.py"]]
    commands = [[python, str(HERE / script), *words] for script, *words in scripts]
    return commands + ([["sh", str(HERE / "macos" / "dmg.sh")]] if system == "darwin" else [])


def main() -> int:
    """Do one step after the other; the exit code of the first that fails."""
    parser = argparse.ArgumentParser(prog="dev.py package", description="Make the installers.")
    parser.add_argument("--quick", action="store_true", help="larger files, in less time")
    asked = parser.parse_args()
    has_appimagetool = shutil.which("appimagetool") is not None
    for command in steps(sys.platform, is_quick=asked.quick, has_appimagetool=has_appimagetool):
        print(" ".join(command), file=sys.stderr, flush=True)
        if code := subprocess.run(command, cwd=parts.ROOT).returncode:
            return code
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Installs the .deb in a bare Debian without Python, uses it as a person would, and removes it.

``sudo python packaging/check_deb.py FILE.deb --base BASE.tar --results FOLDER``: BASE.tar is a bare
Debian, made once with ``mmdebstrap --variant=minbase bookworm BASE.tar`` (packaging/README.md).
It needs root and a Linux; everything happens in namespaces of its own.
"""

from __future__ import annotations

import argparse
import json
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from PySide6.QtGui import QImage

HERE = Path(__file__).resolve().parent
SCRIPT = HERE / "linux" / "try_in_debian.sh"
ALONE = ["unshare", "--mount", "--pid", "--fork", "--kill-child"]
INSIDE = (
    'mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" && mount -t tmpfs tmpfs "$1/run"'
    ' && exec chroot "$1" /bin/sh /try/try.sh /try/nep-studio.deb'
)
WANTED = {
    "python": "none",
    "python_after": "none",
    "karate": "5",
    "left": "",
    "left_on_desktop": "",
    "type": "application/x-nep-studio-project",
    "program": "nep-studio.desktop",
    "all_done": "yes",
}
"""What must have been found out; the rest is for people to read."""


def check(deb: Path, base: Path, results: Path) -> dict[str, str]:
    """Try it; what was found out."""
    results.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="nep-debian-") as made:
        root = Path(made)
        subprocess.run(["tar", "--extract", "--file", base, "--directory", root], check=True)
        here = root / "try"
        here.mkdir(mode=0o755)
        shutil.copy(deb, here / "nep-studio.deb")
        shutil.copy(SCRIPT, here / "try.sh")
        shutil.copy("/etc/resolv.conf", root / "etc" / "resolv.conf")
        command = [*ALONE, "sh", "-c", INSIDE, "sh", str(root)]
        done = subprocess.run(command, text=True, capture_output=True)
        print(done.stdout, done.stderr, sep="\n", file=sys.stderr)
        for shot in here.glob("*.xwd"):
            picture(shot.read_bytes()).save(str(results / f"{shot.stem}.png"))
    lines = [line.split(" ", 2) for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    return {line[1]: line[2] if len(line) > 2 else "" for line in lines}


def picture(xwd: bytes) -> QImage:
    """What an X server keeps of its screen, as a picture."""
    head = struct.unpack(">25I", xwd[:100])
    size, width, height, row_bytes, colours = head[0], head[4], head[5], head[12], head[19]
    points = xwd[size + 12 * colours :]
    return QImage(points, width, height, row_bytes, QImage.Format.Format_RGB32).copy()


def main() -> int:
    """Try it and tell; 1 when something is not as it should be."""
    parser = argparse.ArgumentParser(description="Try the .deb in a bare Debian.")
    parser.add_argument("deb", type=Path)
    parser.add_argument("--base", type=Path, required=True, help="a bare Debian, as a .tar")
    parser.add_argument("--results", type=Path, default=Path("build/deb"), help="for pictures")
    asked = parser.parse_args()
    found = check(asked.deb, asked.base, asked.results)
    wrong = {name: found.get(name) for name, value in WANTED.items() if found.get(name) != value}
    report = {"ok": not wrong, "wrong": wrong, "found": found}
    (asked.results / "report.json").write_text(json.dumps(report, indent=1), encoding="utf-8")
    print(json.dumps(report, indent=1))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

"""Makes the .deb of the frozen program: ``python packaging/deb.py [--quick]``."""

from __future__ import annotations

import argparse
import hashlib
import platform
import re
import subprocess
import tempfile
from pathlib import Path

import linux_files
import parts
from freeze import DIST

from nep_studio import __version__

ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}
NEEDS = ("libegl1", "libgl1", "libxcb1", "libstdc++6", "libgcc-s1", "fontconfig-config")
"""What no program should bring: the drivers of the screen and what they share with us."""
WISHES = (
    *("desktop-file-utils", "hicolor-icon-theme", "shared-mime-info", "xdg-utils"),
    "libcups2 | libcups2t64",
)
"""What every desktop has: it makes the menu entry, the double click and printing work."""
HOW = {"small": ["-Zxz", "-z9"], "quick": ["-Zzstd"], "plain": ["-Znone"]}
"""How a package is compressed: as small as can be for a release, quickly while developing."""
GLIBC = re.compile(rb"GLIBC_2\.(\d+)\0")
MAINTAINER = "The NEP Studio authors <authors@nep-studio.invalid>"
"""Debian asks for an address; mail to one that ends in .invalid reaches nobody (RFC 2606)."""

CONTROL = """\
Package: {name}
Version: {version}
Architecture: {architecture}
Maintainer: {maintainer}
Installed-Size: {size_kb}
Depends: libc6 (>= 2.{glibc}), {needs}
Recommends: {wishes}
Suggests: espeak-ng | speech-dispatcher
Section: education
Priority: optional
Description: Give a social robot its behaviour with blocks
 NEP Studio is for people who do not program: they put together what a social
 robot does from blocks that read as sentences, press Run, and see it happen. It
 works with no robot and no internet: a robot on the screen and recorded
 gestures stand in for them.
"""


def build(program: Path, goal: Path, compression: str) -> Path:
    """Pack the program; the path of the .deb."""
    with tempfile.TemporaryDirectory(prefix="nep-deb-") as made:
        root = Path(made) / "root"
        linux_files.lay_out(program, root)
        (root / "DEBIAN").mkdir()
        (root / "DEBIAN" / "control").write_text(control(root), encoding="utf-8")
        (root / "DEBIAN" / "md5sums").write_text(checksums(root), encoding="utf-8")
        linux_files.allow_reading(root / "DEBIAN")
        path = goal / f"{parts.NAME}_{__version__}_{architecture()}.deb"
        pack = ["dpkg-deb", "--root-owner-group", *HOW[compression], "--build"]
        subprocess.run([*pack, str(root), str(path)], check=True, stdout=subprocess.DEVNULL)
    return path


def architecture() -> str:
    """What Debian calls this machine."""
    return ARCHITECTURES[platform.machine()]


def control(root: Path) -> str:
    """What Debian is told of the package."""
    size = sum(path.stat().st_size for path in files(root)) // 1024
    return CONTROL.format(
        name=parts.NAME,
        version=__version__,
        architecture=architecture(),
        maintainer=MAINTAINER,
        size_kb=size,
        glibc=newest_glibc(root),
        needs=", ".join(NEEDS),
        wishes=", ".join(WISHES),
    )


def newest_glibc(root: Path) -> int:
    """The N of the newest 2.N of the C library that anything in the tree was made for."""
    libraries = [path for path in files(root) if ".so" in path.name or path.name == parts.NAME]
    return max(int(found) for library in libraries for found in GLIBC.findall(library.read_bytes()))


def checksums(root: Path) -> str:
    """The sums by which Debian finds damage."""
    return "".join(
        f"{hashlib.md5(path.read_bytes()).hexdigest()}  {path.relative_to(root)}\n"
        for path in files(root)
        if path.relative_to(root).parts[0] != "DEBIAN"
    )


def files(root: Path) -> list[Path]:
    """All files of a tree, without links."""
    return sorted(path for path in root.rglob("*") if path.is_file() and not path.is_symlink())


def main() -> None:
    """Make it, and print its path and size."""
    parser = argparse.ArgumentParser(description="Make the .deb.")
    parser.add_argument("program", type=Path, nargs="?", default=DIST / parts.NAME)
    parser.add_argument("--quick", action="store_true", help="pack quickly, but larger (zstd)")
    asked = parser.parse_args()
    path = build(asked.program, DIST, "quick" if asked.quick else "small")
    print(f"{path} ({path.stat().st_size / 1e6:.1f} MB)")


if __name__ == "__main__":
    main()

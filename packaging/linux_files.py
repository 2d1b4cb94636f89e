"""Where the files of the frozen program go on a Linux system: for the .deb and the AppImage."""

from __future__ import annotations

import gzip
import re
import shutil
from pathlib import Path

import icons
import parts

LINUX = Path(__file__).resolve().parent / "linux"
LIBRARY = re.compile(r"\.so(\.|$)")
MIME_TYPE = "application/x-nep-studio-project"
PLACE = f"usr/lib/{parts.NAME}"
"""Where the program itself is."""
SHARED = {
    "nep-studio.desktop": "applications",
    "nep-studio.xml": "mime/packages",
    f"{parts.ID}.metainfo.xml": "metainfo",
}
"""What desktops read, and the folder of /usr/share in which they look for it."""


def lay_out(program: Path, root: Path) -> None:
    """Put the program into a new tree, with all that desktops read."""
    shutil.copytree(program, root / PLACE, symlinks=True)
    names = root / "usr" / "bin"
    names.mkdir(parents=True)
    for name in (parts.NAME, "nep"):
        (names / name).symlink_to(f"../lib/{parts.NAME}/{parts.NAME}")
    share = root / "usr" / "share"
    for file, folder in SHARED.items():
        (share / folder).mkdir(parents=True)
        shutil.copy(LINUX / file, share / folder)
    lay_out_icons(share / "icons" / "hicolor")
    lay_out_papers(share / "doc" / parts.NAME)
    allow_reading(root)


def lay_out_icons(folder: Path) -> None:
    """The program's icon, and the same one for its projects, in all sizes."""
    kinds = {"apps": parts.NAME, "mimetypes": MIME_TYPE.replace("/", "-")}
    for kind, name in kinds.items():
        for size in icons.SIZES:
            goal = folder / f"{size}x{size}" / kind / f"{name}.png"
            goal.parent.mkdir(parents=True, exist_ok=True)
            goal.write_bytes(icons.png(size))
        goal = folder / "scalable" / kind / f"{name}.svg"
        goal.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(icons.SVG, goal)


def lay_out_papers(folder: Path) -> None:
    """The licence, where Debian wants it, and what changed, under a name without rules."""
    folder.mkdir(parents=True)
    licence = (parts.ROOT / "LICENSE").read_text(encoding="utf-8")
    others = f"The licences of all parts are in /{PLACE}/_internal/licences.\n"
    (folder / "copyright").write_text(f"{licence}\n{others}", encoding="utf-8")
    changes = (parts.ROOT / "CHANGELOG.md").read_bytes()
    (folder / "CHANGELOG.md.gz").write_bytes(gzip.compress(changes, mtime=0))


def allow_reading(root: Path) -> None:
    """Everybody may read everything, and run what is to be run; only the owner may write."""
    for path in [root, *root.rglob("*")]:
        if not path.is_symlink():
            path.chmod(allowed(path.name, path.stat().st_mode, is_folder=path.is_dir()))


def allowed(name: str, mode: int, *, is_folder: bool) -> int:
    """Return the mode that a file gets, however careful the umask was when it was made."""
    is_library = LIBRARY.search(name) is not None
    return 0o755 if is_folder or (mode & 0o100 and not is_library) else 0o644

"""Collects the licences of every part that is in the frozen program, from what is installed."""

from __future__ import annotations

import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path

import parts

OURS = Path(__file__).resolve().parent / "licences"
"""Texts, in a folder for each part, of those that come without the text of their licence."""
LICENCE_NAMES = ("licen", "copying", "notice", "authors")
DEBIAN_TEXTS = Path("/usr/share/common-licenses")

ABOUT = """\
What NEP Studio is made of
==========================

NEP Studio itself: the MIT licence, see LICENSE.txt.
Each part that others have made is listed here; its licence is in the folder of its name.

{parts}

Qt and PySide6 (Qt for Python)
------------------------------
Used under the GNU Lesser General Public License, version 3 (qt/LGPL-3.0.txt, which extends
qt/GPL-3.0.txt). Their libraries lie unchanged in the folder PySide6 of this program: you may
replace them by others of the same version that you have changed. Their sources are offered by The
Qt Company at https://download.qt.io/official_releases/QtForPython/ and
https://download.qt.io/official_releases/qt/.

zeroconf
--------
Used under the GNU Lesser General Public License, version 2.1 or later (folder zeroconf). Its
sources are at https://pypi.org/project/zeroconf/. With the sources of NEP Studio, which hold the
recipe of this program, you may make it again with a zeroconf that you have changed.
"""


def write_licences(folder: Path, modules: Iterable[str], libraries: Iterable[str]) -> None:
    """Write into a new folder the licences of these top modules and of the system's libraries."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copy(parts.ROOT / "LICENSE", folder / "LICENSE.txt")
    told = [_python(folder), _qt(folder), *_resources(folder)]
    told += [_distribution(folder, name) for name in distributions(modules)]
    told += _system_packages(folder, libraries)
    lines = "\n".join(f"* {line}" for line in told)
    (folder / "README.txt").write_text(ABOUT.format(parts=lines), encoding="utf-8")


def distributions(modules: Iterable[str]) -> list[str]:
    """The names of the installed packages that these top modules come from."""
    homes = metadata.packages_distributions()
    return sorted({name for module in modules for name in homes.get(module, ())} - {parts.NAME})


def licence_files(name: str) -> list[Path]:
    """The files of an installed package that tell its licence."""
    return [
        Path(str(file.locate()))
        for file in metadata.files(name) or ()
        if ".dist-info" in file.parts[0]
        and any(word in file.as_posix().lower() for word in LICENCE_NAMES)
    ]


def licence_name(name: str) -> str:
    """What an installed package calls its licence."""
    about = metadata.metadata(name)
    said = "".join(about[key] for key in ("License-Expression", "License") if key in about).strip()
    kinds = [kind.split(" :: ")[-1] for kind in about.get_all("Classifier") or () if "Lic" in kind]
    is_name = said and "\n" not in said  # some write the whole text there
    return said if is_name else ", ".join(kinds) or "see its page"


def _distribution(folder: Path, name: str) -> str:
    goal = folder / name.lower()
    goal.mkdir(exist_ok=True)
    if (OURS / name.lower()).is_dir():
        shutil.copytree(OURS / name.lower(), goal, dirs_exist_ok=True)
    line = f"{name} {metadata.version(name)}: {licence_name(name)}"
    for file in licence_files(name):
        shutil.copy(file, goal / f"{file.stem}{file.suffix or '.txt'}")
    if not any(goal.iterdir()):
        (goal / "LICENCE.txt").write_text(f"{line}\n", encoding="utf-8")
    return line


def _python(folder: Path) -> str:
    for text in (Path(sysconfig.get_path("stdlib")), Path(sys.base_prefix)):
        if (text / "LICENSE.txt").is_file():
            (folder / "python").mkdir(exist_ok=True)
            shutil.copy(text / "LICENSE.txt", folder / "python")
            break
    return f"Python {sys.version.split()[0]}: Python Software Foundation License"


def _qt(folder: Path) -> str:
    shutil.copytree(OURS / "qt", folder / "qt")
    return f"Qt and PySide6 {metadata.version('PySide6-Essentials')}: LGPL-3.0"


def _resources(folder: Path) -> list[str]:
    """Fonts and icons, which lie in resources with their licences."""
    found = sorted((parts.ROOT / "resources").glob("*/LICENSE-*.txt"))
    for text in found:
        goal = folder / text.parent.name
        goal.mkdir(exist_ok=True)
        shutil.copy(text, goal)
    return [f"{text.stem.removeprefix('LICENSE-')} ({text.parent.name})" for text in found]


def _system_packages(folder: Path, libraries: Iterable[str]) -> list[str]:
    """The libraries of a Debian or Ubuntu on which the program is frozen."""
    if shutil.which("dpkg") is None:
        return []
    told = []
    for package in _packages_of(libraries):
        goal = folder / "system" / package
        goal.mkdir(parents=True)
        shutil.copy(f"/usr/share/doc/{package}/copyright", goal / "copyright.txt")
        told.append(f"{package} of this Linux: see system/{package}")
    if told:
        shutil.copytree(DEBIAN_TEXTS, folder / "system" / "common-licenses", symlinks=False)
    return told


def _packages_of(libraries: Iterable[str]) -> list[str]:
    """The Debian packages of these libraries, but for those that do not tell their licence."""
    paths = set(libraries)
    paths |= {str(Path(path).resolve()) for path in paths}
    paths |= {path.replace("/usr/lib", "/lib", 1) for path in paths}
    found = subprocess.run(["dpkg", "-S", *sorted(paths)], capture_output=True, text=True)
    names = {line.partition(":")[0] for line in found.stdout.splitlines()}
    return sorted(name for name in names if Path(f"/usr/share/doc/{name}/copyright").is_file())

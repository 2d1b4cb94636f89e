"""Where files are kept, beside the installed packages or where a variable says."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
from pathlib import Path
from typing import Literal

import platformdirs

from faults.files import make_privately
from nep_core.errors import KeyFileError

NODES_VARIABLE = "NEP_NODES"
"""More folders with nodes, before the shipped one, separated as in PATH."""
ROBOT_FILES_VARIABLE = "NEP_ROBOT_FILES"
"""Where the files of robots on the screen are, instead of in the folder of this user's data."""
RESOURCES_VARIABLE = "NEP_RESOURCES"
"""The folder of resources, instead of the one that comes with us."""
PORTABLE_VARIABLE = "NEP_PORTABLE"
"""The folder that holds everything of this user, as on a stick, instead of the user's own ones."""


def portable_folder() -> Path | None:
    """The folder that holds everything, if there is to be one."""
    told = os.environ.get(PORTABLE_VARIABLE)
    return Path(told) if told else None


def node_folders() -> tuple[Path, ...]:
    """The folders in which manifests are looked for."""
    more = [Path(part) for part in os.environ.get(NODES_VARIABLE, "").split(os.pathsep) if part]
    frozen = getattr(sys, "_MEIPASS", None)
    root = Path(frozen) if frozen else Path(__file__).resolve().parent.parent
    return (*more, root / "nodes")


def resource_folders() -> list[Path]:
    """The folders in which resources are looked for: of this checkout, wheel or frozen program."""
    if told := os.environ.get(RESOURCES_VARIABLE):
        return [Path(told)]
    if frozen := getattr(sys, "_MEIPASS", None):
        return [Path(frozen) / "resources"]
    # The wheel goes first: beside an installed package, "resources" could be anybody's.
    root = Path(__file__).resolve().parent.parent
    return [root / "nep_studio" / "resources", root / "resources"]


def log_folder() -> Path:
    """Where the nodes' log files are kept."""
    return own_folder("log", "logs")


def cache_folder() -> Path:
    """Where files are kept that can be made again."""
    return own_folder("cache", "cache")


def own_folder(kind: Literal["log", "cache", "data", "config"], portable: str = "") -> Path:
    """This user's folder for files of a kind; ``portable``: its name beside a portable program."""
    if folder := portable_folder():
        return folder / portable
    try:
        return Path(getattr(platformdirs, f"user_{kind}_dir")("nep-studio", appauthor=False))
    except RuntimeError:  # a user without a home
        return Path(tempfile.gettempdir()) / "nep-studio"


def key_file() -> Path:
    """Where this user's key file of an opened network is, when nobody says another."""
    if folder := portable_folder():
        return folder / "keys" / "network.keys"
    try:
        data = Path(platformdirs.user_data_dir("nep-studio", appauthor=False))
    except RuntimeError as error:  # a user without a home; other users could read the rest
        raise KeyFileError(
            "There is no folder of your own for the key file.",
            checklist=("Say where it should be: --keys FILE.",),
        ) from error
    return data / "network.keys"


def robot_folder(robot: str) -> Path:
    """Where a robot on the screen keeps its files; ``robot``: its name, as one of a folder."""
    if told := os.environ.get(ROBOT_FILES_VARIABLE):
        return Path(told) / robot
    return own_folder("data") / "robots" / robot


def private_folder(folder: Path) -> Path:
    """Make a folder, unless it is there, that only this user can look into; raises OSError.

    On Windows the folders of a user are theirs alone as they are, and modes say nothing.
    """
    make_privately(folder)
    if os.name == "posix" and folder.stat().st_mode & 0o077:
        with contextlib.suppress(PermissionError):  # it is somebody else's: then it stays so
            folder.chmod(0o700)
    return folder


def opened_privately(name: str, flags: int) -> int:
    """An ``opener`` for files that others have no business to read."""
    return os.open(name, flags, 0o600)

"""A program to try, frozen or from source, in an environment without Python."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import parts

Figures = dict[str, Any]
MOST_S = 120.0
KEPT = ("SYSTEMROOT", "WINDIR", "COMSPEC", "TEMP", "TMP", "USERPROFILE", "NUMBER_OF_PROCESSORS")
"""What no program of Windows can do without."""


class Differs(Exception):
    """The frozen program does not do what it should."""


def expect(is_so: bool, sentence: str) -> None:
    """Stop when something is not as it should be."""
    if not is_so:
        raise Differs(sentence)


def clean_environment(folder: Path) -> dict[str, str]:
    """Hardly any variables: no Python is found, and nothing is kept outside of a folder."""
    home = folder / "home"
    home.mkdir()
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    ours = {"HOME": str(home), "LANG": "C.UTF-8", "QT_QPA_PLATFORM": "offscreen"}
    ours["PATH"] = os.path.join(kept["SYSTEMROOT"], "System32") if kept else "/nowhere"
    places = {"APPDATA": str(home), "LOCALAPPDATA": str(home)} if kept else {}
    return {**kept, **ours, **places, "NEP_STUDIO_FOLDER": str(home / "studio")}


@dataclass(frozen=True)
class Program:
    """A program with its first words."""

    words: tuple[str, ...]
    is_frozen: bool

    @property
    def folder(self) -> Path:
        """Where its own files are: resources, nodes, docs."""
        if not self.is_frozen:
            return parts.ROOT
        beside = Path(self.words[0]).parent
        contents = beside.parent / "Frameworks"  # of a program of macOS
        return contents if contents.is_dir() else beside / "_internal"

    def environment(self) -> dict[str, str]:
        """The environment of this process; from source it is told where our modules are."""
        if self.is_frozen:
            return dict(os.environ)
        return {**os.environ, "PYTHONPATH": str(parts.ROOT), "PYTHONUTF8": "1"}

    def start(self, *words: str | Path, **more: Any) -> subprocess.Popen[str]:
        """Start a job; what it writes can be read."""
        return subprocess.Popen(
            [*self.words, *map(str, words)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=self.environment() | more.pop("variables", {}),
            text=True,
            encoding="utf-8",
            **more,
        )

    def run(self, *words: str | Path, code: int = 0, **more: Any) -> str:
        """Do a job to its end; its output. Raises Differs when it ends with another exit code."""
        return finished(self.start(*words, **more), code)


def finished(process: subprocess.Popen[str], code: int = 0) -> str:
    """Wait for the end of a job; its output."""
    try:
        output, errors = process.communicate(timeout=MOST_S)
    except subprocess.TimeoutExpired:
        process.kill()
        output, errors = process.communicate()
        raise Differs(f"{process.args!r} did not end: {output}\n{errors}") from None
    told = f"{process.args!r}: {process.returncode}\n{output}\n{errors}"
    expect(process.returncode == code, told)
    return output


def is_windows() -> bool:
    """Whether this is Windows."""
    return sys.platform == "win32"

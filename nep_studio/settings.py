"""What a person has chosen and what the window remembers, kept in the user's folder."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

from PySide6.QtCore import QByteArray, QLocale, QSettings, QStandardPaths

FOLDER_VARIABLE = "NEP_STUDIO_FOLDER"
"""Another place for settings, journals and logs than the user's folder."""

SYSTEM = "system"
"""The choice that follows the computer: for the theme and for the language."""

MOST_RECENT = 10
SMALLEST_TEXT, LARGEST_TEXT = 0.8, 2.5


def user_folder() -> Path:
    """Where this program keeps what belongs to the person and not to a project."""
    named = os.environ.get(FOLDER_VARIABLE)
    if named:
        return Path(named)
    place = QStandardPaths.StandardLocation.GenericConfigLocation
    found = QStandardPaths.writableLocation(place)
    return Path(found or tempfile.gettempdir()) / "nep-studio"


def journal_folder() -> Path:
    """Where unsaved work is kept until it is saved."""
    return user_folder() / "journals"


def log_file() -> Path:
    """Where the program notes what went wrong."""
    return user_folder() / "nep-studio.log"


def system_language(known: Iterable[str]) -> str:
    """The first language of the computer that is known here, else English."""
    offered = set(known)
    for name in QLocale.system().uiLanguages():
        code = name.replace("_", "-")
        for wanted in (code, code.partition("-")[0]):
            if wanted in offered:
                return wanted
    return "en"


class Settings:
    """Values with names in one file; one that makes no sense counts as not set."""

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or user_folder()
        file = self.folder / "settings.ini"
        self._values = QSettings(str(file), QSettings.Format.IniFormat)

    @property
    def theme(self) -> str:
        """The name of a theme, or "system"."""
        return self._text("look/theme", SYSTEM)

    @theme.setter
    def theme(self, name: str) -> None:
        self._values.setValue("look/theme", name)

    @property
    def language(self) -> str:
        """The code of a language, or "system"."""
        return self._text("look/language", SYSTEM)

    @language.setter
    def language(self, code: str) -> None:
        self._values.setValue("look/language", code)

    @property
    def text_scale(self) -> float:
        """How much larger than the computer's the text is."""
        try:
            scale = float(self._text("look/text_scale", "1"))
        except ValueError:
            return 1.0
        return min(max(scale, SMALLEST_TEXT), LARGEST_TEXT) if math.isfinite(scale) else 1.0

    @text_scale.setter
    def text_scale(self, scale: float) -> None:
        self._values.setValue("look/text_scale", f"{scale:g}")

    @property
    def recent_files(self) -> list[Path]:
        """The projects that were opened or saved last, the newest first."""
        stored = self._values.value("files/recent", [])
        names = [stored] if isinstance(stored, str) else stored
        if not isinstance(names, list):
            return []
        return [Path(name) for name in names if isinstance(name, str) and name][:MOST_RECENT]

    def add_recent(self, path: Path) -> None:
        """Put a project first in the list."""
        self._set_recent([path, *(one for one in self.recent_files if one != path)])

    def forget_recent(self, path: Path) -> None:
        """Take a project out of the list."""
        self._set_recent(one for one in self.recent_files if one != path)

    def _set_recent(self, paths: Iterable[Path]) -> None:
        self._values.setValue("files/recent", [str(path) for path in paths][:MOST_RECENT])

    @property
    def recent_blocks(self) -> list[str]:
        """The types of blocks that were used last, the newest first."""
        stored = self._values.value("palette/recent", [])
        names = [stored] if isinstance(stored, str) else stored
        return [n for n in names if isinstance(n, str) and n] if isinstance(names, list) else []

    @recent_blocks.setter
    def recent_blocks(self, types: Iterable[str]) -> None:
        self._values.setValue("palette/recent", list(types))

    @property
    def last_folder(self) -> Path:
        """Where a project was opened or saved last."""
        documents = QStandardPaths.StandardLocation.DocumentsLocation
        default = QStandardPaths.writableLocation(documents)
        recent = next(iter(self.recent_files), None)
        return recent.parent if recent is not None else Path(default)

    def state(self, name: str) -> QByteArray:
        """What a part of the window remembers of its shape; empty when nothing."""
        value = self._values.value(f"window/{name}")
        return value if isinstance(value, QByteArray) else QByteArray()

    def set_state(self, name: str, state: QByteArray) -> None:
        """Remember the shape of a part of the window."""
        self._values.setValue(f"window/{name}", state)

    def is_shown(self, panel: str, *, default: bool) -> bool:
        """Whether a person left a panel open."""
        return self._text(f"panels/{panel}", "yes" if default else "no") == "yes"

    def is_chosen(self, panel: str) -> bool:
        """Whether a person has ever shown or hidden a panel."""
        return bool(self._text(f"panels/{panel}", ""))

    def set_shown(self, panel: str, is_shown: bool) -> None:
        """Remember whether a panel is open."""
        self._values.setValue(f"panels/{panel}", "yes" if is_shown else "no")

    def forget_window(self) -> None:
        """Let the window be as it was at the first start."""
        for group in ("window", "panels"):
            self._values.remove(group)

    def write(self) -> None:
        """Write to the disk now."""
        self._values.sync()

    def _text(self, name: str, default: str) -> str:
        value = self._values.value(name, default)
        return value if isinstance(value, str) else default

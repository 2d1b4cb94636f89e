"""What a person has chosen and what the window remembers, kept in the user's folder."""

from __future__ import annotations

import contextlib
import math
import os
import re
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Literal, TypeVar, cast

from PySide6.QtCore import QByteArray, QLocale, QSettings, QStandardPaths

from faults.files import content, whole_file
from nep_core.places import log_folder, portable_folder, private_folder

from .support.portable import kept_name, not_kept, path_of

FOLDER_VARIABLE = "NEP_STUDIO_FOLDER"
"""Another place for settings, journals and logs than the user's folder."""

MINIMAP = "Minimap"
SYSTEM = "system"
"""The choice that follows the computer: for the theme and for the language."""

T = TypeVar("T")
FolderName = Literal["projects", "recordings", "logs"]

MOST_RECENT = 10
MOST_RESTARTS = 1000
YES, NO = "yes", "no"
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


def usual_folder(what: FolderName) -> Path:
    """Where projects, recordings or logs are kept when nobody says anything else."""
    if what == "logs":
        return log_folder()
    documents = QStandardPaths.StandardLocation.DocumentsLocation
    folder = Path(QStandardPaths.writableLocation(documents) or tempfile.gettempdir())
    if (here := portable_folder()) and not_kept() is None:  # else they would go with the program
        folder = here / "projects"
    return folder if what == "projects" else folder / "NEP recordings"


def system_language(known: Iterable[str]) -> str:
    """The first language of the computer that is known here, else English."""
    offered = set(known)
    for name in QLocale.system().uiLanguages():
        code = name.replace("_", "-")
        for wanted in (code, code.partition("-")[0]):
            if wanted in offered:
                return wanted
    return "en"


@dataclass(frozen=True)
class ShowOptions:
    """How show mode goes: ``restarts`` is how often in a row a program that failed is run again.

    ``runs_at_once``: without anybody pressing Run; ``again``: also when it has ended well;
    ``has_cues``: with the buttons of the cue panel, for an operator.
    """

    runs_at_once: bool = False
    again: bool = False
    has_cues: bool = False
    restarts: int = 5


class SettingsFile:
    """The file in a folder in which values are kept by name."""

    def __init__(self, folder: Path) -> None:
        file = folder / "settings.ini"
        with contextlib.suppress(OSError):  # Qt keeps the mode of a file that is there
            private_folder(folder)
            if file.exists() and not file.is_file():  # a pipe would be waited for, without end
                file.replace(folder / "settings.ini.old")
            os.close(os.open(file, os.O_WRONLY | os.O_CREAT, 0o600))
            _leave_out_streams(file)
        self.values = QSettings(str(file), QSettings.Format.IniFormat)

    def value(self, name: str, usual: object) -> object:
        """What the file has under a name; ``usual`` where it has nothing that Python knows."""
        try:
            return self.values.value(name, usual)
        except (RuntimeError, ValueError, OverflowError):  # one of the hundred types of Qt
            return usual


# WORKAROUND: QSettings reads "@Variant(...)" as a stream of any of Qt's types, and believes what
# that says of its size: a few damaged bytes, and the program ends for want of memory
# (qsettings.cpp, QSettingsPrivate::stringToVariant). Nothing of ours is kept so: "@@" is a text.

LARGEST_BYTES = 10_000_000
_STREAM = re.compile(rb"(?<!@)@(?:Variant|DateTime)\(")
_LETTER = re.compile(rb"\\x([0-9a-fA-F]+)|\\([0-7]+)")
_UNHEARD = re.compile(rb"[\s\"\\]")
"""What may stand between the letters, and QSettings passes over."""


def _leave_out_streams(file: Path) -> None:
    """Take the lines out of a file that QSettings would read as a stream; raises OSError."""
    data = content(file, LARGEST_BYTES)
    if not _has_stream(data):
        return
    left = b"\n".join(line for line in re.split(rb"[\r\n]+", data) if not _has_stream(line))
    with whole_file(file, is_private=True) as writing:
        writing.write(b"" if _has_stream(left) else left)  # one that goes over lines


def _has_stream(text: bytes) -> bool:
    return bool(_STREAM.search(_UNHEARD.sub(b"", _LETTER.sub(_letter, text))))


def _letter(found: re.Match[bytes]) -> bytes:
    """An escaped letter as QSettings reads it: by its last 16 bits; b"?" for what is no ASCII."""
    number = int(found[1][-4:], 16) if found[1] else int(found[2][-6:], 8) & 0xFFFF
    return bytes((number,)) if number < 128 else b"?"


class Kept(Generic[T]):
    """A text, a switch or a list of texts that a file keeps under a name; else as usual."""

    def __init__(self, name: str, usual: T) -> None:
        self._name, self._usual = name, usual

    def __get__(self, file: SettingsFile, _kind: object = None) -> T:
        value = file.value(self._name, self._usual)
        match self._usual:
            case bool():
                value = value == YES if value in (YES, NO) else self._usual
            case str() if not isinstance(value, str):
                value = self._usual
            case list():
                texts = value if isinstance(value, list) else [value]
                value = [text for text in texts if isinstance(text, str) and text]
        return cast(T, value)

    def __set__(self, file: SettingsFile, value: T) -> None:
        kept = (YES if value else NO) if isinstance(value, bool) else value
        file.values.setValue(self._name, kept)


class Settings(SettingsFile):
    """Values with names in one file; one that makes no sense counts as not set."""

    theme = Kept("look/theme", SYSTEM)
    """The name of a theme, or "system"."""
    language = Kept("look/language", SYSTEM)
    """The code of a language, or "system"."""
    palette_level = Kept("palette/level", "first")
    """How many blocks the palette shows: "first", "more" or "all"."""
    recent_blocks = Kept[list[str]]("palette/recent", [])
    """The types of blocks that were used last, the newest first."""
    recent_commands = Kept[list[str]]("commands/recent", [])
    """What was done with the command palette last, by the ids of the commands."""
    _recent = Kept[list[str]]("files/recent", [])
    tour_done = Kept("help/tour", False)
    """Whether a person has taken the tour, or wants none: then it is not offered."""
    follows_running = Kept("canvas/follows_running", True)
    """Whether the canvas follows the block that runs."""
    has_sound = Kept("robots/sound", True)
    """Whether robots on the screen are heard."""
    lets_original_join = Kept("network/original", False)
    """Whether programs of the original NEP may join the studio's network."""
    author = Kept("library/author", "")
    """Who is named as the author of the blocks that the person shares."""
    licence = Kept("library/licence", "")
    """What others may do with them."""
    kept_open_at = Kept("network/open_at", "")
    """The address at which the network is opened at each start; "" when it is not."""

    _show_at_once = Kept("show/at_once", False)
    _show_again = Kept("show/again", False)
    _show_cues = Kept("show/cues", False)

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder or user_folder()
        super().__init__(self.folder)

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
        self.values.setValue("look/text_scale", f"{scale:g}")

    @property
    def recent_files(self) -> list[Path]:
        """The projects that were opened or saved last, the newest first."""
        return [path_of(name) for name in self._recent][:MOST_RECENT]

    def add_recent(self, path: Path) -> None:
        """Put a project first in the list."""
        paths = [path, *(one for one in self.recent_files if one != path)][:MOST_RECENT]
        self._recent = [kept_name(one) for one in paths]

    def remove_recent(self, path: Path) -> None:
        """Take a project out of the list."""
        self._recent = [kept_name(one) for one in self.recent_files if one != path]

    @property
    def last_folder(self) -> Path:
        """Where a project was opened or saved last."""
        recent = next(iter(self.recent_files), None)
        return recent.parent if recent is not None else self.folder_for("projects")

    def folder_for(self, what: FolderName) -> Path:
        """Where projects, recordings or logs are kept: where the person said, else as usual."""
        return self.chosen_folder(what) or usual_folder(what)

    def chosen_folder(self, what: FolderName) -> Path | None:
        """Where the person said that it is kept; None when they did not."""
        chosen = self._text(f"folders/{what}", "")
        return path_of(chosen) if chosen else None

    def set_folder(self, what: FolderName, folder: Path | None) -> None:
        """Keep projects, recordings or logs there; None: where they usually are."""
        self.values.setValue(f"folders/{what}", kept_name(folder) if folder else "")

    @property
    def show_options(self) -> ShowOptions:
        """How show mode goes."""
        return ShowOptions(
            self._show_at_once,
            self._show_again,
            self._show_cues,
            self._number("show/restarts", ShowOptions.restarts, 0, MOST_RESTARTS),
        )

    @show_options.setter
    def show_options(self, options: ShowOptions) -> None:
        self._show_at_once, self._show_again = options.runs_at_once, options.again
        self._show_cues = options.has_cues
        self.values.setValue("show/restarts", str(options.restarts))

    @property
    def has_pin(self) -> bool:
        """Whether show mode is only left with a PIN."""
        return bool(self._text("show/pin", ""))

    def set_pin(self, pin: str) -> None:
        """Leave show mode with this PIN only; an empty one: without."""
        self.values.setValue("show/pin", _disguised(pin) if pin else "")

    def is_pin(self, pin: str) -> bool:
        """Whether this is the PIN."""
        return self._text("show/pin", "") == _disguised(pin)

    def state(self, name: str) -> QByteArray:
        """What a part of the window remembers of its shape; empty when nothing."""
        value = self.value(f"window/{name}", None)
        return value if isinstance(value, QByteArray) else QByteArray()

    def set_state(self, name: str, state: QByteArray) -> None:
        """Remember the shape of a part of the window."""
        self.values.setValue(f"window/{name}", state)

    def is_shown(self, panel: str, *, default: bool) -> bool:
        """Whether a person left a panel open."""
        return self._text(f"panels/{panel}", "yes" if default else "no") == "yes"

    @property
    def is_minimap_shown(self) -> bool:
        """Whether the person left the minimap open."""
        return self.is_shown(MINIMAP, default=False)

    def is_chosen(self, panel: str) -> bool:
        """Whether a person has ever shown or hidden a panel."""
        return self.values.contains(f"panels/{panel}")

    def set_shown(self, panel: str, is_shown: bool) -> None:
        """Remember whether a panel is open."""
        self.values.setValue(f"panels/{panel}", "yes" if is_shown else "no")

    def forget_window(self) -> None:
        """Let the window be as it was at the first start."""
        for group in ("window", "panels"):
            self.values.remove(group)

    def write(self) -> None:
        """Write to the disk now."""
        self.values.sync()

    def _text(self, name: str, default: str) -> str:
        value = self.value(name, default)
        return value if isinstance(value, str) else default

    def _number(self, name: str, default: int, least: int, most: int) -> int:
        try:
            return min(max(int(self._text(name, str(default))), least), most)
        except ValueError:
            return default


def _disguised(pin: str) -> str:
    """A PIN that nobody reads by chance in the file; who may change the file may leave anyway."""
    import hashlib  # it loads all of OpenSSL, which a start needs for nothing

    return hashlib.sha256(f"nep-studio {pin}".encode()).hexdigest()

"""The files that let a computer start a show by itself, and start it again when it ends.

Nothing here writes unless it is asked to. A show that a person ended (exit code 0) stays ended; one
that was killed, or that failed, is started again by the system, everywhere in the same way.
"""

from __future__ import annotations

import os
import plistlib
import shutil
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from faults.files import whole_file

NAME = "nep-studio-show"
LABEL = "org.nep-studio.show"
AGAIN_S = 5
"""How long the system waits before it starts a show again."""

_DISPLAY = "DISPLAY WAYLAND_DISPLAY XAUTHORITY"


@dataclass(frozen=True)
class StartupFile:
    """A file that the system reads: where it is, what is in it, and what it is for, in a word."""

    path: Path
    text: str
    role: str

    @property
    def is_there(self) -> bool:
        """Whether there is such a file, of whatever content."""
        return self.path.is_file()

    @property
    def is_as_written(self) -> bool:
        """Whether the file is there as it would be written now."""
        try:
            return self.path.read_bytes() == self.text.encode()
        except OSError:
            return False


@dataclass(frozen=True)
class Place:
    """The computer for which files are made: its system, its user's folders."""

    system: str
    home: Path
    settings: Path
    has_systemd: bool = False

    @classmethod
    def here(cls, environment: Mapping[str, str] = os.environ) -> Place:
        """This computer."""
        home = Path.home()
        if sys.platform == "win32":
            settings = Path(environment.get("APPDATA") or home / "AppData" / "Roaming")
        else:
            settings = Path(environment.get("XDG_CONFIG_HOME") or home / ".config")
        has_systemd = bool(shutil.which("systemctl")) and Path("/run/systemd/system").is_dir()
        return cls(sys.platform, home, settings, has_systemd)


def startup_files(place: Place, command: Sequence[str]) -> list[StartupFile]:
    """The files that let this command start with the computer; an empty list: not known how."""
    if place.system == "win32":
        folder = place.settings / "Microsoft" / "Windows" / "Start Menu" / "Programs" / "Startup"
        return [StartupFile(folder / f"{NAME}.cmd", _batch(command), "start_and_again")]
    if place.system == "darwin":
        path = place.home / "Library" / "LaunchAgents" / f"{LABEL}.plist"
        agent = {
            "Label": LABEL,
            "ProgramArguments": list(command),
            "RunAtLoad": True,
            "KeepAlive": {"SuccessfulExit": False},
            "ThrottleInterval": AGAIN_S,
            "ProcessType": "Interactive",
        }
        return [
            StartupFile(path, plistlib.dumps(agent, sort_keys=False).decode(), "start_and_again")
        ]
    autostart = place.settings / "autostart" / f"{NAME}.desktop"
    if not place.has_systemd:
        return [StartupFile(autostart, _desktop(command), "start")]
    unit = place.settings / "systemd" / "user" / f"{NAME}.service"
    return [
        StartupFile(unit, _unit(command), "again"),
        StartupFile(autostart, _desktop(_start_of_unit()), "start"),
    ]


def write(files: Sequence[StartupFile]) -> None:
    """Write the files, each as a whole; raises OSError."""
    for file in files:
        file.path.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(file.path) as new:
            new.write(file.text.encode())


def remove(files: Sequence[StartupFile]) -> None:
    """Take the files away; raises OSError."""
    for file in files:
        file.path.unlink(missing_ok=True)


def as_it_is(place: Place) -> Callable[[], None]:
    """What puts the files back to what they are now, or takes them away; raises OSError."""
    paths = [file.path for file in startup_files(place, [])]
    before = [path.read_bytes() if path.is_file() else None for path in paths]

    def put_back() -> None:
        for path, content in zip(paths, before, strict=True):
            if content is None:
                path.unlink(missing_ok=True)
            elif not path.is_file() or path.read_bytes() != content:
                with whole_file(path) as new:
                    new.write(content)

    return put_back


def _start_of_unit() -> list[str]:
    """A unit knows of no screen until the desktop tells it."""
    service = f"{NAME}.service"
    told = f"systemctl --user import-environment {_DISPLAY}"
    start = f"systemctl --user daemon-reload; systemctl --user restart {service}"
    return ["/bin/sh", "-c", f"{told}; {start}"]


def _desktop(command: Sequence[str]) -> str:
    return f"""\
[Desktop Entry]
Type=Application
Version=1.0
Name=NEP Studio show
Comment=Plays a project of NEP Studio in show mode
Exec={" ".join(map(_desktop_word, command))}
Icon=nep-studio
Terminal=false
X-GNOME-Autostart-enabled=true
"""


def _desktop_word(word: str) -> str:
    """A word of an Exec key: quoted, and then escaped as every text of such a file is."""
    quoted = "".join(f"\\{letter}" if letter in '"`$\\' else letter for letter in word)
    return f'"{quoted}"'.replace("\\", "\\\\").replace("%", "%%").replace("\n", "\\n")


def _unit(command: Sequence[str]) -> str:
    return f"""\
[Unit]
Description=NEP Studio show
StartLimitIntervalSec=0

[Service]
ExecStart={" ".join(map(_unit_word, command))}
Restart=always
RestartSec={AGAIN_S}
# Somebody has ended it on purpose
RestartPreventExitStatus=0
KillMode=mixed
TimeoutStopSec=10
"""


def _unit_word(word: str) -> str:
    escaped = word.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped.replace("%", "%%").replace("$", "$$")}"'


def _batch(command: Sequence[str]) -> str:
    line = " ".join(f'"{word.replace("%", "%%")}"' for word in command)
    return "\r\n".join(
        [
            "@echo off",
            "chcp 65001 >nul",
            "rem NEP Studio show: started again until somebody ends it on purpose",
            ":again",
            line,
            "if %errorlevel% equ 0 exit /b 0",
            f"timeout /t {AGAIN_S} /nobreak >nul",
            "goto again",
            "",
        ]
    )

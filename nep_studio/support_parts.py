"""Collects what is in a report for support: nothing here needs Qt, which may be what is broken."""

from __future__ import annotations

import json
import locale
import os
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import msgspec

from nep_core.cli import checks_of_system
from nep_core.cli.doctor import examined
from nep_core.cli.finding import Finding
from nep_core.places import cache_folder, key_file, log_folder, portable_folder
from nep_core.process import program_command
from nep_core.security.addresses import own_addresses
from nep_studio import __version__, portable, safe_mode
from nep_studio.anonymous import Anonymous
from nep_studio.support_logs import LAST_BYTES, LONGEST_LINE, crash_part, log_part
from nep_studio.support_report import Part, Report

SCREEN_S = 30.0
SHOWN_SETTINGS = ("look", "show", "help", "robots", "panels", "folders", "network", "updates")
"""Groups of the settings whose values tell nothing of anybody; of others only the names."""
SECRET_SETTINGS = ("pin",)
MOST_SETTINGS = 400
OF_ANOTHER = "clock of "
DISPLAYS = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
QT_VARIABLE = re.compile(r"(QT|QSG|XDG_SESSION|WAYLAND|DISPLAY|LANG|LC_|LIBGL|__GL|MESA)")
ESCAPED = re.compile(r"\\x([0-9a-f]{1,4})")
"""How older files of settings write letters that are not English."""
SECRET_VARIABLES = ("NEP_ROBOT_PASSWORD", "NEP_NAOQI_LOGIN")


def report(master: str | None = None) -> Report:
    """The report of this computer, made anonymous."""
    groups = examined(master)
    parts = [
        Part("NEP Studio", tuple(_program())),
        Part("Computer", tuple(groups["computer"])),
        Part("Screen, graphics and sound", tuple(_screen())),
        Part("Network", (*map(_without_host, groups["network"]), *_addresses())),
        Part("Folders", (*groups["folders"], *_folders())),
        Part("Nodes", tuple(groups["nodes"])),
        Part("Settings", lines=tuple(setting_lines(_user_folder() / "settings.ini"))),
        crash_part(_user_folder()),
        *(log_part(path) for path in _log_files()),
    ]
    return Report.of(parts, Anonymous.here(_secrets()))


def _program() -> Iterator[Finding]:
    kind = "installed program" if getattr(sys, "frozen", False) else "from source"
    yield Finding("version", "ok", f"{__version__}, {kind}")
    yield Finding("program", "ok", sys.executable)
    folder, missed = portable_folder(), portable.not_kept()
    if missed is not None:
        told = f"{missed} cannot be written: what is done now is not kept"
        yield Finding("portable", "look", told, ("Is the stick write-protected, or full?",))
    else:
        yield Finding("portable", "ok", f"yes, {folder}" if folder else "no")
    yield Finding("safe mode", "note" if safe_mode.is_on() else "ok", _yes(safe_mode.is_on()))
    yield Finding("words", "ok", f"{locale.getlocale()[0]}, files in {sys.getfilesystemencoding()}")
    yield Finding("time zone", "ok", time.strftime("%Z %z"))
    for name, value in sorted(os.environ.items()):
        if QT_VARIABLE.match(name):
            yield Finding(name, "ok", value)


def _yes(is_so: bool) -> str:
    return "yes" if is_so else "no"


def _screen() -> Iterator[Finding]:
    """What a child process finds out: a driver may end it, and then it is known which."""
    environment = dict(os.environ)
    has_display = not sys.platform.startswith("linux") or any(map(environment.get, DISPLAYS))
    if not has_display:
        yield Finding("display", "note", "none here, so that no window can be shown")
        environment["QT_QPA_PLATFORM"] = "offscreen"
    try:
        done = subprocess.run(
            program_command("doctor-screen"),
            env=environment,
            capture_output=True,
            timeout=SCREEN_S,
            stdin=subprocess.DEVNULL,
        )
        output, errors, end = done.stdout, done.stderr, _ending(done.returncode)
    except subprocess.TimeoutExpired as error:
        output, errors = error.stdout or b"", error.stderr or b""
        end = f"no answer within {SCREEN_S:.0f} seconds"
    except OSError as error:
        output, errors, end = b"", b"", str(error)
    yield from _findings(output)
    if end:
        last = " ".join(errors.decode(errors="replace").split())[-600:]
        steps = (
            "Update the driver of the graphics card.",
            "Start in safe mode: nep-studio --safe-mode",
            "On Linux: install libgl1 libegl1 libxkbcommon-x11-0 libxcb-cursor0"
            " libxcb-icccm4 libxcb-keysyms1 libxcb-shape0.",
        )
        yield Finding("Qt", "look", f"the window cannot be made: {end}. {last}".strip(), steps)


def _ending(code: int) -> str:
    if code == 0:
        return ""
    return f"ended by signal {-code}" if code < 0 else f"ended with code {code}"


def _findings(output: bytes) -> Iterator[Finding]:
    for line in output.splitlines():
        with suppress(msgspec.MsgspecError):
            yield msgspec.json.decode(line, type=Finding)


def _without_host(found: Finding) -> Finding:
    """A finding that does not name another computer."""
    is_named = found.about.startswith(OF_ANOTHER)
    return replace(found, about=f"{OF_ANOTHER}another computer") if is_named else found


def _addresses() -> Iterator[Finding]:
    with suppress(Exception):  # psutil's own errors too
        told = ", ".join(own_addresses()) or "none but this computer's own"
        yield Finding("addresses", "ok", told)


def _folders() -> Iterator[Finding]:
    yield checks_of_system.folder("settings", _user_folder())
    with suppress(Exception):  # a user without a home has none
        yield checks_of_system.folder("keys", key_file().parent)
    for name, folder in _documents():
        yield checks_of_system.folder(name, folder)


def _documents() -> list[tuple[str, Path]]:
    try:
        from nep_studio.settings import usual_folder
    except ImportError:
        return []
    return [("projects", usual_folder("projects"))]


def _user_folder() -> Path:
    try:
        from nep_studio.settings import user_folder
    except ImportError:  # Qt is not there, or cannot be loaded: the screen's part says so
        return Path(os.environ.get(portable.SETTINGS_VARIABLE) or cache_folder())
    return user_folder()


def setting_lines(file: Path) -> Iterator[str]:
    """The settings as they are written, without secrets and the names of projects."""
    try:
        with file.open("rb") as opened:
            text = opened.read(LAST_BYTES).decode("utf-8", "replace")
    except OSError as error:
        yield f"({(error.strerror or 'cannot be read').lower()})"
        return
    group = ""
    text = ESCAPED.sub(lambda found: chr(int(found[1], 16)), text)
    for line in (long[:LONGEST_LINE] for long in text.splitlines()[:MOST_SETTINGS]):
        name, mark, value = line.partition("=")
        if line.startswith("["):
            group = line.strip("[]")
            yield line
        elif mark and group in SHOWN_SETTINGS and name.lower() not in SECRET_SETTINGS:
            yield line
        elif mark:
            yield f"{name}=({len(value)} letters, not shown)"


def _log_files() -> list[Path]:
    """The program's own log, and the nodes' that were written last."""
    nodes = []
    for folder in {log_folder(), _chosen_logs()}:
        with suppress(OSError):
            nodes += [(path.stat().st_mtime, path) for path in folder.glob("*.log")]
    newest = [path for _, path in sorted(nodes, reverse=True)[:5]]
    return [_user_folder() / "nep-studio.log", *newest]


def _chosen_logs() -> Path:
    try:
        from nep_studio.settings import Settings
    except ImportError:
        return log_folder()
    return Settings().folder_for("logs")


def _secrets() -> Iterator[str]:
    """What must not be in a report wherever it stands: passwords of robots, keys."""
    for name in SECRET_VARIABLES:
        value = os.environ.get(name, "")
        yield from (value, value.partition(":")[2])
    with suppress(OSError, ValueError, AttributeError):
        logins = json.loads((_user_folder() / "robots.json").read_bytes())
        yield from (str(login["password"]) for login in logins.values() if "password" in login)
    files = [Path(os.environ["NEP_KEYS"])] if os.environ.get("NEP_KEYS") else []
    with suppress(Exception):
        files.append(key_file())
    for file in files:
        with suppress(OSError):
            yield from re.findall(r'"([^"\n]{20,})"', file.read_text("utf-8", "replace"))

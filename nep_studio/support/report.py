"""A report that a person can send to those who help: what is in it, as text, JSON and a file.

Everything that leaves this module has been made anonymous.
"""

from __future__ import annotations

import argparse
import json
import locale
import os
import re
import subprocess
import sys
import time
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from faults.files import whole_file
from nep_core.cli import doctor
from nep_core.cli.doctor import Finding, examined, finding_lines
from nep_core.networks.security.addresses import own_addresses
from nep_core.places import cache_folder, key_file, log_folder, portable_folder
from nep_core.processes.process import program_command
from nep_core.wire.frames import CANNOT_DECODE
from nep_studio import __version__

from . import portable, safe_mode
from .anonymous import Anonymous
from .safe_mode import CRASHES

FILE = "NEP Studio report.zip"
FORMAT = "nep-studio-report"
VERSION = 1
START = (
    "Report of NEP Studio for support",
    "",
    "Names of people, computers, folders and projects have been taken out,",
    "and so have passwords, keys and addresses of the internet.",
    "Read it before you send it: what programs and nodes wrote into logs is in it too.",
)


@dataclass(frozen=True)
class Part:
    """A part of the report: findings, and lines as some program wrote them."""

    title: str
    findings: tuple[Finding, ...] = ()
    lines: tuple[str, ...] = ()


@dataclass(frozen=True)
class Report:
    """All parts, and when they were made (as ISO 8601)."""

    parts: tuple[Part, ...]
    made: str

    @classmethod
    def of(cls, parts: Sequence[Part], anonymous: Anonymous) -> Report:
        """The report of parts, without what tells who the person is."""
        made = time.strftime("%Y-%m-%dT%H:%M:%S%z")
        return cls(tuple(_without_names(part, anonymous) for part in parts), made)

    @property
    def is_sound(self) -> bool:
        """Whether there is nothing to look at."""
        return not any(one.state == "look" for part in self.parts for one in part.findings)

    def text(self) -> str:
        """The report for people."""
        looks = [
            f"  {part.title}: {one.about}"
            for part in self.parts
            for one in part.findings
            if one.state == "look"
        ]
        looks = looks or ["  Nothing of what was checked is wrong."]
        lines = [*START, self.made, "", "Look at", "=======", *looks]
        for part in self.parts:
            lines += ["", part.title, "=" * len(part.title), *finding_lines(part.findings)]
            lines += [f"  {line}" for line in part.lines]
        return "\n".join([*lines, ""])

    def json(self) -> str:
        """The same for machines."""
        told = {"format": FORMAT, "version": VERSION, "made": self.made, "parts": self.parts}
        return msgspec.json.encode(told).decode()

    def save(self, path: Path) -> None:
        """Write a zip file with both, as a whole; raises OSError."""
        with whole_file(path) as whole, zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as file:
            file.writestr("report.txt", self.text())
            file.writestr("report.json", self.json())


def report_of(text: bytes | str) -> Report:
    """The report that ``json`` gave; raises msgspec.MsgspecError (a ValueError)."""

    class Kept(msgspec.Struct):
        made: str
        parts: tuple[Part, ...]

    told = msgspec.json.decode(text, type=Kept)
    return Report(told.parts, told.made)


def _without_names(part: Part, anonymous: Anonymous) -> Part:
    hide = anonymous.text
    return Part(
        hide(part.title),
        tuple(
            Finding(hide(one.about), one.state, hide(one.sentence), tuple(map(hide, one.steps)))
            for one in part.findings
        ),
        tuple(hide("\n".join(part.lines)).splitlines()),  # together: a key may take many lines
    )


# The ends of logs, and the last crash, for a report.

LAST_LINES = 60
LAST_BYTES = 40_000
LONGEST_LINE = 400
CRASH_LINES = 60
BEGINS = re.compile(r"^(Fatal Python error|Windows fatal exception)")
TRACE = re.compile(r"^\d{4}-\d\d-\d\d .* (ERROR|CRITICAL) ")
RECORD = re.compile(r"^\d{4}-\d\d-\d\d ")


def log_part(path: Path) -> Part:
    """The last lines of a log."""
    lines = last_lines(path)
    told = () if lines else (Finding("log", "note", "nothing is written there"),)
    return Part(f"Log {path.name}", told, tuple(lines[-LAST_LINES:]))


def crash_part(folder: Path) -> Part:
    """When the program last ended by a crash, and where; and its last error."""
    path = folder / CRASHES
    crash = _last(last_lines(path), BEGINS)
    findings = [Finding("crash", "ok", "none is known")]
    if crash:
        findings = [Finding("crash", "note", f"the last one: {_time(path)}")]
    log = folder / "nep-studio.log"
    error = _last(last_lines(log), TRACE, RECORD)
    if error:
        findings.append(Finding("error", "note", "the last one is below"))
    lines = [*crash, *([""] if crash and error else []), *error]
    return Part("Last crash", tuple(findings), tuple(lines))


def last_lines(path: Path) -> list[str]:
    """The end of a file, without the line of which only a part was read."""
    try:
        with path.open("rb") as file:
            size = file.seek(0, 2)
            file.seek(max(0, size - LAST_BYTES))
            lines = file.read().decode("utf-8", "replace").splitlines()
    except OSError:
        return []
    whole = lines[1:] if size > LAST_BYTES else lines
    return [line[:LONGEST_LINE] for line in whole]


def _last(
    lines: list[str], begin: re.Pattern[str], end: re.Pattern[str] | None = None
) -> list[str]:
    """The lines from the last beginning on, up to an end behind it."""
    starts = [number for number, line in enumerate(lines) if begin.match(line)]
    if not starts:
        return []
    told = lines[starts[-1] :]
    if end is not None:
        after = (number for number, line in enumerate(told) if number and end.match(line))
        told = told[: next(after, len(told))]
    return told[:CRASH_LINES]


def _time(path: Path) -> str:
    return time.strftime("%Y-%m-%d %H:%M", time.localtime(path.stat().st_mtime))


# Collects what is in a report for support: nothing here needs Qt, which may be what is broken.

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
    is_safe = safe_mode.is_on()
    yield Finding("safe mode", "note" if is_safe else "ok", "yes" if is_safe else "no")
    yield Finding("words", "ok", f"{locale.getlocale()[0]}, files in {sys.getfilesystemencoding()}")
    yield Finding("time zone", "ok", time.strftime("%Z %z"))
    for name, value in sorted(os.environ.items()):
        if QT_VARIABLE.match(name):
            yield Finding(name, "ok", value)


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
    for line in output.splitlines():
        with suppress(*CANNOT_DECODE):
            yield msgspec.json.decode(line, type=Finding)
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


def _without_host(found: Finding) -> Finding:
    """A finding that does not name another computer."""
    is_named = found.about.startswith(OF_ANOTHER)
    return replace(found, about=f"{OF_ANOTHER}another computer") if is_named else found


def _addresses() -> Iterator[Finding]:
    with suppress(Exception):  # psutil's own errors too
        told = ", ".join(own_addresses()) or "none but this computer's own"
        yield Finding("addresses", "ok", told)


def _folders() -> Iterator[Finding]:
    yield doctor.folder("settings", _user_folder())
    with suppress(Exception):  # a user without a home has none
        yield doctor.folder("keys", key_file().parent)
    with suppress(ImportError):  # as below
        from nep_studio.settings import usual_folder

        yield doctor.folder("projects", usual_folder("projects"))


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


# ``nep-studio doctor``: what to look at when something is wrong, as a report to send.


def main(arguments: list[str]) -> int:
    """Print or save the report; 1 when there is something to look at."""
    options = parser().parse_args(arguments)
    made = report(options.master)
    if options.save is not None:
        path: Path = options.save  # a folder, or a file whose ending may be left out
        if path.is_dir():
            path /= FILE
        elif not path.suffix:
            path = path.with_suffix(".zip")
        made.save(path)
        print(f"The report is in {path}. Read report.txt in it before you send it.")
    else:
        print(made.json() if options.json else made.text(), flush=True)
    return 0 if made.is_sound else 1


def parser() -> argparse.ArgumentParser:
    """The words of the command."""
    made = argparse.ArgumentParser(
        prog="nep-studio doctor",
        description="Check this computer for NEP Studio, and make a report that you can send to"
        " whoever helps you. Names, passwords and keys are taken out; nothing is sent.",
        epilog="Exit code: 0 when all is well, 1 when there is something to look at.",
    )
    made.add_argument("--json", action="store_true", help="for machines: one line of JSON")
    made.add_argument("--save", type=Path, metavar="FILE.zip", help="write it into a file")
    made.add_argument("--master", metavar="ENDPOINT", help="where the master is")
    return made

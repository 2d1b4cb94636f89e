"""The doctor's checks of this computer: versions, firewall, clock, permissions, disk, manifests."""

from __future__ import annotations

import ctypes
import os
import platform
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from importlib import metadata
from pathlib import Path

import psutil
import zmq

from nep_core.cli.finding import Finding
from nep_core.cli.showing import amount
from nep_core.errors import ManifestError
from nep_core.manifest import NodeCatalog, read_manifest
from nep_core.places import cache_folder, log_folder, node_folders

PYTHONS = ((3, 11), (3, 14))
"""From, and below."""
NEEDED = ("msgspec", "psutil", "platformdirs", "mcap", "zeroconf", "spake2")
OPTIONAL = {
    "eclipse-zenoh": "only for networks of several sites",
    "qi": "only to compare with the official NAOqi client",
}
FREE_BYTES = 500_000_000
OLDEST_TIME_S = 1_735_689_600
"""The year 2025 began then: a computer that says it is earlier has lost its clock."""
NOT_SYNCHRONIZED = 5
"""What Linux's adjtimex gives then (TIME_ERROR)."""
TIMEX_BYTES = 512
COMMAND_S = 2.0


def versions() -> list[Finding]:
    """Python and the libraries."""
    python = platform.python_version()
    told = f"{python} on {platform.platform()}"
    is_usable = PYTHONS[0] <= sys.version_info[:2] < PYTHONS[1]
    steps = () if is_usable else ("Install Python 3.11, 3.12 or 3.13.",)
    return [
        Finding("Python", "ok" if is_usable else "look", told, steps),
        _zeromq(),
        *(_library(name) for name in NEEDED),
        *(_library(name, why) for name, why in OPTIONAL.items()),
    ]


def computer() -> list[Finding]:
    """The system by its name, memory and processors."""
    memory = psutil.virtual_memory()
    processors = f"{os.cpu_count() or 1}, {platform.machine()}"
    return [
        Finding("system", "ok", _system_name()),
        Finding("processors", "ok", processors),
        Finding("memory", "ok", f"{amount(memory.total)}, {amount(memory.available)} free"),
    ]


def _system_name() -> str:
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except (OSError, KeyError):
        return " ".join((platform.system(), platform.release(), platform.mac_ver()[0])).strip()


def _zeromq() -> Finding:
    told = f"{zmq.zmq_version()} (pyzmq {zmq.__version__})"
    if zmq.has("curve"):
        return Finding("ZeroMQ", "ok", f"{told}, with CURVE")
    return Finding(
        "ZeroMQ",
        "look",
        f"{told}, without CURVE: the network cannot be opened safely",
        ("Install pyzmq from a wheel: pip install --force-reinstall --only-binary :all: pyzmq",),
    )


def _library(name: str, only_for: str = "") -> Finding:
    try:
        return Finding(name, "ok", metadata.version(name))
    except metadata.PackageNotFoundError:
        if only_for:
            return Finding(name, "note", f"not installed; {only_for}")
        return Finding(name, "look", "not installed", (f"Install it: pip install {name}",))


def firewalls(
    ufw: Path = Path("/etc/ufw/ufw.conf"), programs: frozenset[str] | None = None
) -> list[Finding]:
    """Which firewall is on, as far as one may know; ``programs`` are the names that run."""
    about = "firewall"
    harmless = "it matters only when the network is opened: then allow the ports of NEP"
    if sys.platform == "win32":
        return [_asked(about, ["netsh", "advfirewall", "show", "currentprofile", "state"])]
    if sys.platform == "darwin":
        tool = "/usr/libexec/ApplicationFirewall/socketfilterfw"
        return [_asked(about, [tool, "--getglobalstate"])]
    running = _running() if programs is None else programs
    findings = []
    if ufw.exists():
        try:
            is_on = "enabled=yes" in ufw.read_text(encoding="utf-8", errors="replace").lower()
            findings.append(
                Finding(about, "note", f"ufw is {f'on; {harmless}' if is_on else 'off'}")
            )
        except OSError:
            findings.append(Finding(about, "unknown", "whether ufw is on could not be found out"))
    if "firewalld" in running:
        findings.append(Finding(about, "note", f"firewalld is on; {harmless}"))
    if any(shutil.which(tool, path=_PLACES) for tool in ("nft", "iptables")):
        told = "rules of nft or iptables could not be found out without administrator rights"
        findings.append(Finding(about, "unknown", told))
    return findings or [Finding(about, "ok", "none was found")]


_PLACES = os.pathsep.join((os.environ.get("PATH", ""), "/usr/sbin", "/sbin"))


def _running() -> frozenset[str]:
    return frozenset(process.info["name"] or "" for process in psutil.process_iter(["name"]))


def _asked(about: str, command: list[str]) -> Finding:
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=COMMAND_S,
            check=True,
            errors="replace",
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except (OSError, subprocess.SubprocessError):
        return Finding(about, "unknown", "could not be found out")
    return Finding(about, "note", " ".join(done.stdout.split()) or "could not be found out")


def clock(now_s: float | None = None) -> Finding:
    """Whether the clock is plausible, and kept right by other computers."""
    told_s = time.time() if now_s is None else now_s
    told = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(told_s))
    if told_s < OLDEST_TIME_S:
        return Finding(
            "clock",
            "look",
            f"it says {told}, which is long ago",
            ("Set the clock, or connect to the internet and switch automatic time on.",),
        )
    synchronized = _is_synchronized()
    if synchronized is None:
        return Finding("clock", "unknown", f"{told}; whether it is kept right was not found out")
    if synchronized:
        return Finding("clock", "ok", f"{told}, kept right by a time server")
    return Finding("clock", "note", f"{told}, not kept right; that matters between computers only")


def _is_synchronized() -> bool | None:
    if not sys.platform.startswith("linux"):
        return None
    try:
        library = ctypes.CDLL(None)
        state = library.adjtimex(ctypes.create_string_buffer(TIMEX_BYTES))  # zeros: only read it
    except (OSError, AttributeError):
        return None
    return None if state < 0 else bool(state != NOT_SYNCHRONIZED)


def folders() -> list[Finding]:
    """Whether what NEP keeps can be written."""
    return [
        folder("logs", log_folder()),
        folder("cache", cache_folder()),
        folder("home", Path.home()),
    ]


def folder(about: str, path: Path) -> Finding:
    """Whether files can be made in a folder, or the folder itself."""
    place = path
    while not os.path.exists(place) and place != place.parent:  # Path asks what it may not see
        place = place.parent
    try:
        if not place.is_dir():
            raise NotADirectoryError(20, "not a folder")
        with tempfile.TemporaryFile(dir=place):
            pass
    except OSError as error:
        return Finding(
            about,
            "look",
            f"{path} cannot be written: {(error.strerror or 'unknown reason').lower()}",
            (f"Let your user write into {place}.", "Is the disk full or read-only?"),
        )
    return Finding(about, "ok", str(path))


def key_file(path: str | None = None) -> Finding:
    """Whether the key file of an opened network is there, and only for its owner."""
    told = os.environ.get("NEP_KEYS", "") if path is None else path
    if not told:
        return Finding("key file", "ok", "none: the network is closed to other computers")
    file = Path(told)
    try:
        status = file.stat()
        with file.open("rb") as opened:
            opened.read(1)
    except OSError as error:
        reason = (error.strerror or "unknown reason").lower()
        steps = ("Make one: nep open", "Or close the network: remove the variable NEP_KEYS.")
        return Finding("key file", "look", f"{file} cannot be read: {reason}", steps)
    if os.name == "posix" and status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
        told = f"others may read or change {file}"
        return Finding("key file", "look", told, (f"Keep it to yourself: chmod 600 {file}",))
    return Finding("key file", "ok", str(file))


def disk_space(least: int = FREE_BYTES) -> list[Finding]:
    """Whether logs and recordings have room."""
    found = []
    for about, path in (("disk of logs", log_folder()), ("disk here", Path(os.curdir))):
        while not os.path.exists(path) and path != path.parent:
            path = path.parent
        free = shutil.disk_usage(path).free
        steps = () if free >= least else ("Delete what is not needed, such as old recordings.",)
        found.append(Finding(about, "look" if steps else "ok", f"{amount(free)} free", steps))
    return found


def manifests() -> Finding:
    """Whether all nodes can be started by their manifests."""
    paths = NodeCatalog(node_folders()).paths()
    problems, steps = [], []
    for path in paths:
        try:
            read_manifest(path)
        except ManifestError as error:
            problems.append(error.sentence)
            steps.append(error.checklist[0])
    if problems:
        return Finding("nodes", "look", " ".join(problems), tuple(steps))
    return Finding("nodes", "ok", f"{len(paths)} can be started")

"""``nep doctor``: what this computer has for NEP, what to look at, and what to do."""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import os
import platform
import shutil
import socket
import stat
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from importlib import metadata
from pathlib import Path
from typing import Literal

import msgspec
import psutil
import zmq

from faults import FaultError
from nep_core.errors import ManifestError, NepError
from nep_core.networks import transports
from nep_core.networks.endpoints import (
    BROKER_VARIABLE,
    MASTER_VARIABLE,
    fixed_endpoint,
    master_endpoint,
)
from nep_core.networks.master_messages import ask_master
from nep_core.places import (
    NODES_VARIABLE,
    PORTABLE_VARIABLE,
    ROBOT_FILES_VARIABLE,
    cache_folder,
    log_folder,
    node_folders,
)
from nep_core.processes.manifest import NodeCatalog, read_manifest
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Subscriber

from .console import add_json, amount, many, near, say, say_json

State = Literal["ok", "look", "unknown", "note"]
"""``look``: something is wrong. ``unknown``: it could not be found out. ``note``: good to know."""


class Finding(msgspec.Struct, frozen=True, rename={"sentence": "told"}):
    """A thing, how it is, in an English sentence, and the steps to do when it is wrong."""

    about: str
    state: State
    sentence: str
    steps: tuple[str, ...] = ()

    @classmethod
    def of(cls, about: str, error: FaultError) -> Finding:
        """Return what an error tells of a thing, as words: reports are for programs too."""
        return look(about, str(error), *map(str, error.checklist))


def look(about: str, sentence: str, *steps: str) -> Finding:
    """What is wrong with a thing, and the steps to do."""
    return Finding(about, "look", sentence, steps)


MARKS = {"ok": "ok       ", "look": "LOOK     ", "unknown": "unknown  ", "note": "-        "}


def add_arguments(_name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    parser.add_argument("--robot", metavar="ADDRESS", help="does a NAO answer there?")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print the report; 1 when there is something to look at."""
    groups = examined(options.master, options.robot).values()
    findings = [found for group in groups for found in group]
    looks = sum(found.state == "look" for found in findings)
    if options.json:
        say_json(findings)
    else:
        order = f"Look at {looks} of these, the first one first."
        say("\n".join([*finding_lines(findings), "", order if looks else "Nothing is wrong."]))
    return 1 if looks else 0


def examined(master: str | None = None, robot: str | None = None) -> dict[str, list[Finding]]:
    """What was found out by what it is about: computer, network, folders, nodes."""
    return {
        "computer": [
            *_found("versions", versions),
            *_found("computer", computer),
            *_found("clock", clock),
        ],
        "network": [
            *_found("variables", variables),
            *_found("master", lambda: service(master)),
            *_found("ports", original_ports),
            *_found("ports", naoqi_port),
            *(_found("robot", lambda: check_robot(robot)) if robot else []),
            *_found("clocks", lambda: clocks(master)),
            *_found("firewall", firewalls),
        ],
        "folders": [
            *_found("folders", folders),
            *_found("key file", key_file),
            *_found("disk", disk_space),
        ],
        "nodes": _found("nodes", manifests),
    }


def _found(about: str, check: Callable[[], Finding | list[Finding]]) -> list[Finding]:
    """What a check finds out; one that fails on this computer does not hide the others."""
    try:
        found = check()
    except (OSError, RuntimeError, ValueError, psutil.Error, NepError) as error:
        return [Finding(about, "unknown", f"could not be found out: {error}")]
    return found if isinstance(found, list) else [found]


def finding_lines(findings: Sequence[Finding]) -> list[str]:
    """The report for people: a line for each, steps below what needs a look."""
    width = max((len(found.about) for found in findings), default=0)
    lines = []
    for found in findings:
        lines.append(f"{MARKS[found.state]}{found.about.ljust(width)}  {found.sentence}")
        lines += [f"           [ ] {step}" for step in found.steps]
    return lines


# The doctor's checks of the network: ports, the master, a robot, other computers' clocks.

ORIGINAL_PORTS = (7000, 50000, 7777)
NAOQI_PORT = 9559
ANSWER_S = 0.5
CONNECT_S = 1.0
HEARTBEATS_S = 1.2
MOST_DIFFERENCE_S = 0.5
VARIABLES = {
    MASTER_VARIABLE: "where the master is",
    BROKER_VARIABLE: "where the broker is",
    NODES_VARIABLE: "more folders with nodes",
    ROBOT_FILES_VARIABLE: "where robots on the screen keep files",
    "NEP_KEYS": "the key file of an opened network",
    "NEP_HOST": "the address of this computer in an opened network",
    "NEP_ORIGINAL": "whether programs of the original NEP may join (0 or 1)",
    "NEP_NETWORK": f"which network: {', '.join(transports.TRANSPORTS)}",
    "NEP_ZENOH": "where the routers of a zenoh network are",
    "NEP_ZENOH_KEYS": "the certificates of a zenoh network",
    "NEP_ROBOT_USER": "the user's name at the real robot",
    "NEP_ROBOT_PASSWORD": "the password at the real robot",
    "NEP_NAOQI_LOGIN": "the name and password at the real robot",
    "NEP_RESOURCES": "where blocks, robots and examples are",
    "NEP_STUDIO_FOLDER": "where NEP Studio keeps its settings",
    PORTABLE_VARIABLE: "the folder that holds everything, as on a stick",
    "NEP_SAFE_MODE": "whether NEP Studio leaves settings and own nodes out",
}
SECRET = ("NEP_ROBOT_USER", "NEP_ROBOT_PASSWORD", "NEP_NAOQI_LOGIN")
INSIDE = ("NEP_TREE", "NEP_LIFELINE")
"""What NEP sets itself."""


def variables() -> list[Finding]:
    """The variables that change what NEP does, and those that look as if they should."""
    found = [
        _variable(name, value)
        for name, value in sorted(os.environ.items())
        if name.startswith("NEP_") and not name.startswith(INSIDE)
    ]
    return found or [Finding("variables", "ok", "no NEP_ variable is set")]


def _variable(name: str, value: str) -> Finding:
    if name not in VARIABLES:
        meant = near(name, VARIABLES)
        step = f"Did you mean {meant[0]}?" if meant else "Remove it."
        return look(name, "NEP knows no such variable", step)
    told = f"{'it is set' if name in SECRET else value} ({VARIABLES[name]})"
    try:
        if name in (MASTER_VARIABLE, BROKER_VARIABLE):
            fixed_endpoint(value)
    except NepError as error:
        return Finding.of(name, error)
    if name == NODES_VARIABLE:
        missing = [part for part in value.split(os.pathsep) if part and not Path(part).is_dir()]
        if missing:
            sentence = f"there is no folder {', '.join(missing)}"
            return look(name, sentence, "Correct the variable, or make the folder.")
    if name == "NEP_NETWORK" and value not in transports.TRANSPORTS:
        return look(name, f"there is no network {value}", f"Use {transports.TRANSPORTS}.")
    return Finding(name, "ok", told)


def service(endpoint: str | None = None) -> Finding:
    """Whether the service of this computer's network answers: a master, a broker, a router."""
    try:
        kind = transports.transport()
        if kind == "p2p":
            return master(endpoint)
        count = len(transports.registrations())
    except NepError as error:
        return Finding.of("network", error)
    return Finding("network", "ok", f"{many(count, 'program')} over {kind}")


def master(endpoint: str | None = None) -> Finding:
    """Whether a master answers, nothing is there, or another program has its port."""
    try:
        place = fixed_endpoint(endpoint) if endpoint else master_endpoint()
    except NepError as error:
        return Finding.of("master", error)
    listing = ask_master(place, ANSWER_S)
    if listing is not None:
        count = len(listing.registrations)
        return Finding("master", "ok", f"{many(count, 'program')} at {place}")
    host, _, port = place.removeprefix("tcp://").rpartition(":")
    if not _answers(host.strip("[]"), int(port)):
        return Finding("master", "note", f"none answers at {place}; start one with: nep master")
    return look(
        "master",
        f"{place} is used by {_who_listens(int(port))}, which is no NEP master",
        "End that program, or let the master serve elsewhere:",
        "set NEP_MASTER to another port, such as tcp://127.0.0.1:7200, for all programs.",
    )


def original_ports(ports: tuple[int, ...] = ORIGINAL_PORTS) -> list[Finding]:
    """Whether programs of the original NEP could join: their fixed ports."""
    return [_port(port, "the original NEP's programs") for port in ports]


def naoqi_port(port: int = NAOQI_PORT) -> Finding:
    """Whether a robot on the screen could be served as a NAO."""
    return _port(port, "robots on the screen that are served as a NAO")


def _port(port: int, for_whom: str) -> Finding:
    about = f"port {port}"
    if not _answers("127.0.0.1", port):
        return Finding(about, "ok", f"free, for {for_whom}")
    if _is_of_our_master(port):
        return Finding(about, "ok", f"the NEP master has it, for {for_whom}")
    return Finding(about, "note", f"in use by {_who_listens(port)}; it is for {for_whom}")


def check_robot(address: str, port: int = NAOQI_PORT) -> Finding:
    """Whether a NAO answers at an address."""
    if _answers(address, port):
        return Finding("robot", "ok", f"something answers at {address}, port {port}")
    return look(
        "robot",
        f"nothing answers at {address}, port {port}",
        "Is the robot switched on? Its chest button should glow.",
        "Is this computer in the same network?",
        "Press its chest button once: it says its address.",
    )


def clocks(endpoint: str | None = None) -> list[Finding]:
    """How far the clocks of other computers are from ours, by their nodes' heartbeats."""
    with contextlib.suppress(NepError):
        here = socket.gethostname()
        if any(
            told.host != here and NODE_STATE in told.publishes
            for told in transports.registrations(endpoint)
        ):
            return [difference(host, ages) for host, ages in _ages(endpoint, here).items()]
    return []


def difference(host: str, ages_s: list[float]) -> Finding:
    """What the ages of a computer's messages on arrival tell of its clock."""
    late_s = statistics.median(ages_s)
    told = f"{abs(late_s):.2f} s {'behind' if late_s > 0 else 'ahead of'} this computer's"
    if abs(late_s) <= MOST_DIFFERENCE_S:
        return Finding(f"clock of {host}", "ok", told)
    return look(f"clock of {host}", told, "Let both computers set their clocks by a time server.")


def _ages(master: str | None, here: str) -> dict[str, list[float]]:
    ages: dict[str, list[float]] = {}
    end_s = time.monotonic() + HEARTBEATS_S
    with transports.network_for(f"nep-doctor-{os.getpid()}", master=master) as network:
        states = Subscriber(NODE_STATE, NodeState, network=network)
        while (left_s := end_s - time.monotonic()) > 0:
            state = states.receive(left_s)
            if state is not None and state.event == "alive" and state.host not in ("", here):
                ages.setdefault(state.host, []).append(time.time() - state.time)
    return ages


def _answers(host: str, port: int) -> bool:
    try:
        with socket.create_connection((host, port), CONNECT_S):
            return True
    except OSError:
        return False


def _who_listens(port: int) -> str:
    """The program that has a port; that of other users cannot be seen."""
    pid = _listener(port)
    with contextlib.suppress(psutil.Error, OSError):
        if pid is not None:
            return f"{psutil.Process(pid).name()} (process {pid})"
    return "another program"


def _is_of_our_master(port: int) -> bool:
    with contextlib.suppress(NepError):
        listing = ask_master(master_endpoint(), ANSWER_S)
        return listing is not None and listing.pid == _listener(port)
    return False


def _listener(port: int) -> int | None:
    with contextlib.suppress(psutil.Error, OSError):
        for one in psutil.net_connections("tcp"):
            if one.status == psutil.CONN_LISTEN and one.laddr.port == port and one.pid:
                return int(one.pid)
    return None


# The doctor's checks of this computer: versions, firewall, clock, permissions, disk, manifests.

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
    told = f"{platform.python_version()} on {platform.platform()}"
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
    return look(
        "ZeroMQ",
        f"{told}, without CURVE: the network cannot be opened safely",
        "Install pyzmq from a wheel: pip install --force-reinstall --only-binary :all: pyzmq",
    )


def _library(name: str, only_for: str = "") -> Finding:
    try:
        return Finding(name, "ok", metadata.version(name))
    except metadata.PackageNotFoundError:
        if only_for:
            return Finding(name, "note", f"not installed; {only_for}")
        return look(name, "not installed", f"Install it: pip install {name}")


def firewalls(
    ufw: Path = Path("/etc/ufw/ufw.conf"), programs: frozenset[str] | None = None
) -> list[Finding]:
    """Which firewall is on, as far as one may know; ``programs`` are the names that run."""
    about = "firewall"
    harmless = "it matters only when the network is opened: then allow the ports of NEP"
    if sys.platform == "win32":
        # By its whole path: Windows would take one of the folder that we are started in first
        tool = rf"{os.environ.get('SYSTEMROOT', 'C:/Windows')}\System32\netsh.exe"
        return [_asked(about, [tool, "advfirewall", "show", "currentprofile", "state"])]
    if sys.platform == "darwin":
        tool = "/usr/libexec/ApplicationFirewall/socketfilterfw"
        return [_asked(about, [tool, "--getglobalstate"])]
    running = programs
    if running is None:
        running = frozenset(one.info["name"] or "" for one in psutil.process_iter(["name"]))
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
        step = "Set the clock, or connect to the internet and switch automatic time on."
        return look("clock", f"it says {told}, which is long ago", step)
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
        reason = (error.strerror or "unknown reason").lower()
        steps = f"Let your user write into {place}.", "Is the disk full or read-only?"
        return look(about, f"{path} cannot be written: {reason}", *steps)
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
        steps = "Make one: nep open", "Or close the network: remove the variable NEP_KEYS."
        return look("key file", f"{file} cannot be read: {reason}", *steps)
    if os.name == "posix" and status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
        step = f"Keep it to yourself: chmod 600 {file}"
        return look("key file", f"others may read or change {file}", step)
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
            problems.append(str(error))
            steps.append(str(error.checklist[0]))
    if problems:
        return look("nodes", " ".join(problems), *steps)
    return Finding("nodes", "ok", f"{len(paths)} can be started")

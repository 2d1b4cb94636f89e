"""The doctor's checks of the network: ports, the master, a robot, other computers' clocks."""

from __future__ import annotations

import contextlib
import os
import socket
import statistics
import time
from pathlib import Path

import psutil

from nep_core import transports
from nep_core.cli.finding import Finding
from nep_core.cli.joining import near
from nep_core.cli.showing import many
from nep_core.endpoints import BROKER_VARIABLE, MASTER_VARIABLE, fixed_endpoint, master_endpoint
from nep_core.errors import NepError
from nep_core.master_probe import ask_master
from nep_core.messages import NODE_STATE, NodeState
from nep_core.places import NODES_VARIABLE, PORTABLE_VARIABLE, ROBOT_FILES_VARIABLE
from nep_core.pubsub import Subscriber

ORIGINAL_PORTS = (7000, 50000, 7777)
NAOQI_PORT = 9559
ANSWER_S = 0.5
CONNECT_S = 1.0
HEARTBEATS_S = 1.2
MOST_DIFFERENCE_S = 0.5
NETWORKS = ("p2p", "broker", "zenoh")
VARIABLES = {
    MASTER_VARIABLE: "where the master is",
    BROKER_VARIABLE: "where the broker is",
    NODES_VARIABLE: "more folders with nodes",
    ROBOT_FILES_VARIABLE: "where robots on the screen keep files",
    "NEP_KEYS": "the key file of an opened network",
    "NEP_HOST": "the address of this computer in an opened network",
    "NEP_ORIGINAL": "whether programs of the original NEP may join (0 or 1)",
    "NEP_NETWORK": f"which network: {', '.join(NETWORKS)}",
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
        steps = (f"Did you mean {meant[0]}?",) if meant else ("Remove it.",)
        return Finding(name, "look", "NEP knows no such variable", steps)
    told = f"{'it is set' if name in SECRET else value} ({VARIABLES[name]})"
    try:
        if name in (MASTER_VARIABLE, BROKER_VARIABLE):
            fixed_endpoint(value)
    except NepError as error:
        return Finding(name, "look", error.sentence, error.checklist)
    if name == NODES_VARIABLE:
        missing = [part for part in value.split(os.pathsep) if part and not Path(part).is_dir()]
        if missing:
            steps = ("Correct the variable, or make the folder.",)
            return Finding(name, "look", f"there is no folder {', '.join(missing)}", steps)
    if name == "NEP_NETWORK" and value not in NETWORKS:
        return Finding(name, "look", f"there is no network {value}", (f"Use {NETWORKS}.",))
    return Finding(name, "ok", told)


def service(endpoint: str | None = None) -> Finding:
    """Whether the service of this computer's network answers: a master, a broker, a router."""
    try:
        kind = transports.transport()
        if kind == "p2p":
            return master(endpoint)
        count = len(transports.registrations())
    except NepError as error:
        return Finding("network", "look", error.sentence, error.checklist)
    return Finding("network", "ok", f"{many(count, 'program')} over {kind}")


def master(endpoint: str | None = None) -> Finding:
    """Whether a master answers, nothing is there, or another program has its port."""
    try:
        place = fixed_endpoint(endpoint) if endpoint else master_endpoint()
    except NepError as error:
        return Finding("master", "look", error.sentence, error.checklist)
    listing = ask_master(place, ANSWER_S)
    if listing is not None:
        count = len(listing.registrations)
        return Finding("master", "ok", f"{many(count, 'program')} at {place}")
    host, _, port = place.removeprefix("tcp://").rpartition(":")
    if not _answers(host.strip("[]"), int(port)):
        return Finding("master", "note", f"none answers at {place}; start one with: nep master")
    return Finding(
        "master",
        "look",
        f"{place} is used by {_who_listens(int(port))}, which is no NEP master",
        (
            "End that program, or let the master serve elsewhere:",
            "set NEP_MASTER to another port, such as tcp://127.0.0.1:7200, for all programs.",
        ),
    )


def original_ports(ports: tuple[int, ...] = ORIGINAL_PORTS) -> list[Finding]:
    """Whether programs of the original NEP could join: their fixed ports."""
    return [_port(f"port {port}", port, "the original NEP's programs") for port in ports]


def naoqi_port(port: int = NAOQI_PORT) -> Finding:
    """Whether a robot on the screen could be served as a NAO."""
    return _port(f"port {port}", port, "robots on the screen that are served as a NAO")


def _port(about: str, port: int, for_whom: str) -> Finding:
    if not _answers("127.0.0.1", port):
        return Finding(about, "ok", f"free, for {for_whom}")
    if _is_of_our_master(port):
        return Finding(about, "ok", f"the NEP master has it, for {for_whom}")
    return Finding(about, "note", f"in use by {_who_listens(port)}; it is for {for_whom}")


def robot(address: str, port: int = NAOQI_PORT) -> Finding:
    """Whether a NAO answers at an address."""
    if _answers(address, port):
        return Finding("robot", "ok", f"something answers at {address}, port {port}")
    return Finding(
        "robot",
        "look",
        f"nothing answers at {address}, port {port}",
        (
            "Is the robot switched on? Its chest button should glow.",
            "Is this computer in the same network?",
            "Press its chest button once: it says its address.",
        ),
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
    steps = ("Let both computers set their clocks by a time server.",)
    return Finding(f"clock of {host}", "look", told, steps)


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

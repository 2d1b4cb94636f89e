"""The studio's own network: its master, its place in there, and the nodes that it starts."""

from __future__ import annotations

import contextlib
import os
import re
import socket
import threading
import time
import uuid
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Literal
from urllib.parse import urlsplit

import msgspec

from faults import Words, reason_of, text_of
from nep_core.cli.console import OWN
from nep_core.errors import KeyFileError, NameTaken, NodeStartError, PairingError
from nep_core.networks.endpoints import master_endpoint
from nep_core.networks.master_messages import ask_master
from nep_core.networks.network import Network
from nep_core.networks.security import KEYS_VARIABLE
from nep_core.networks.security.addresses import HOST_VARIABLE
from nep_core.networks.security.keys import Keys
from nep_core.networks.security.opening import DOOR_PORT
from nep_core.networks.security.pairing import pair
from nep_core.networks.transports import network_for, transport
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.places import log_folder
from nep_core.processes.launcher import LaunchedNode, Launcher
from nep_core.processes.process import ON_WINDOWS, Outcome, program_command
from nep_core.wire import messages as m
from nep_core.wire.pubsub import Publisher, Subscriber

from .gate import Gate
from .plan import MASTER, STUDIO, PlannedNode

# The master of a session: one that is there for all programs, or one that it starts for itself.

READY_S = 10.0
TRIES = 5
MASTER_LOOK_S = 0.5
"""How long a master may take that is there for all programs."""


def start_master(launcher: Launcher, wanted: str | None = None, options: Iterable[str] = ()) -> str:
    """Start a master at ``wanted``, or where there is room, with these options; its endpoint.

    Another program may take the port at the same moment, so several are tried. Raises
    NodeStartError.
    """
    endpoint, lines = "", list[str]()
    for _ in range(1 if wanted else TRIES):
        endpoint = wanted or free_endpoint(master_endpoint())
        command = program_command(MASTER, "--endpoint", endpoint, OWN, *options)
        launched = launcher.start_command(MASTER, command)
        if is_up(launched, endpoint):
            return endpoint
        launcher.stop(MASTER)
        lines = launched.process.last_lines if launched.process else []
    raise NodeStartError(
        "The NEP master did not start at {endpoint}.",
        checklist=("Is another program using that port?", "Try again."),
        details="\n".join(lines),
        endpoint=endpoint,
    )


def shared_master(studio: str) -> str:
    """The endpoint of a master that somebody runs for all programs of this computer, else "".

    Nor is one joined that has a session already (a program named ``studio``): two sessions at once
    do not disturb each other.
    """
    endpoint = master_endpoint()
    if free_endpoint(endpoint) == endpoint:
        return ""
    listing = ask_master(endpoint, timeout_s=MASTER_LOOK_S)
    if listing is None or any(told.node == studio for told in listing.registrations):
        return ""
    return endpoint if listing.shared else ""


def is_up(launched: LaunchedNode, endpoint: str) -> bool:
    """Whether the master that answers is ours: another session may have been quicker."""
    deadline = time.monotonic() + READY_S
    while time.monotonic() < deadline and not launched.ended.is_set():
        listing = ask_master(endpoint, timeout_s=0.1)
        if listing is not None and launched.owns(listing.pid):
            return True
    return False


def free_endpoint(wanted: str) -> str:
    """``wanted`` if it is free, else a free port: of its address, or of this computer."""
    host, _, port = wanted.removeprefix("tcp://").rpartition(":")
    with socket.socket() as probe:
        if not ON_WINDOWS:  # there it would let two programs have one port
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        for place in ((host, int(port)), (host, 0)):
            with contextlib.suppress(OSError):  # in use, or no address of this computer
                probe.bind(place)
                break
        else:
            probe.bind(("127.0.0.1", 0))
        address, free_port = probe.getsockname()
    return f"tcp://{address}:{free_port}"


# What a session itself says on the network.


class Voice:
    """Speaks until it falls silent, which it must before the network is closed."""

    def __init__(self, network: Network) -> None:
        self._lock = threading.Lock()
        self._is_silent = False
        self._requests = Publisher(m.ACTION_REQUEST, network=network)
        self._control = Publisher(m.PROGRAM_CONTROL, network=network)

    def stop_robots(self) -> None:
        """Stop all that the robots do; waits for nothing."""
        self.say(m.ActionRequest(id=uuid.uuid4().hex, robots=[], action="stop", priority=100))

    def fall_silent(self) -> None:
        """Say nothing any more: a session may still end when the network is closed."""
        with self._lock:
            self._is_silent = True

    def say(self, message: m.ActionRequest | m.ProgramControl) -> None:
        """Ask the robots, or the program, for something."""
        is_request = isinstance(message, m.ActionRequest)
        with self._lock:
            if not self._is_silent:
                (self._requests if is_request else self._control).send(message)


LOOK_S = 0.02

HEARD = (m.NODE_STATE, m.HUMAN_BEHAVIOR, m.ACTION_REQUEST, m.ACTION_RESULT, m.PROGRAM_STATE)

Listener = Callable[[str, msgspec.Struct], None]
"""Called with each message of the network and its topic, from several threads."""

EndListener = Callable[[LaunchedNode, Outcome, bool], None]
"""Called when a process ended: which, how, and whether it is started again."""

MasterEvent = Literal["restarting", "back", "gone"]
"""What becomes of a master that ended unexpectedly; those who know each other go on meanwhile."""


class LocalNetwork:
    """A master, this program's place in its network, and the nodes it started; any thread.

    ``open`` raises NepError when the master cannot start; ``close`` stops all nodes, then the
    master. Closed, it can be opened again, unless that was for good. What it starts has passed its
    ``gate``.
    """

    def __init__(
        self, *, logs: Path | None = None, master: str | None = None, gate: Gate | None = None
    ) -> None:
        self.logs = logs or log_folder()
        self.gate = gate or Gate()
        self.network: Network | None = None
        self.voice: Voice | None = None
        self.planned: dict[str, PlannedNode] = {}
        """The nodes that it was asked to start, by name."""
        self.name = STUDIO
        """What this program is called in its network."""
        self.wanted_master = master
        """Where its own master is started; None: where there is room, unless one is shared."""
        self.shared_master = ""
        """The master that somebody runs for all programs of this computer, if it is that."""
        self.joined_master = ""
        """The master of another computer, which it joins instead of starting one."""
        self.master_options: Callable[[], Iterable[str]] = tuple
        """What its own master is told when it is started, as on the command line."""
        self.on_open: Callable[[], None] = lambda: None
        """Called each time that nodes can be started, in the thread that opened it."""
        self.on_master: Callable[[MasterEvent, Words], None] = lambda event, sentence: None
        """Called when the master ended unexpectedly, from several threads, with how it ended."""
        self.has_master = False
        """Whether its master runs, or is about to be started again by itself."""
        self._listeners: tuple[Listener, ...] = ()
        self._end_listeners: tuple[EndListener, ...] = ()
        self._stack = contextlib.ExitStack()
        self._opening = threading.RLock()
        self._is_over = False
        self._make_launchers()

    def _make_launchers(self) -> None:
        self.launcher = Launcher(logs=self.logs, on_end=self._on_end)
        self._master_launcher = Launcher(logs=self.logs, on_end=self._on_end)

    @property
    def is_open(self) -> bool:
        """Whether nodes can be started."""
        return self.network is not None

    def listen(self, listener: Listener, on_end: EndListener | None = None) -> None:
        """Call ``listener`` with each message, ``on_end`` with each end of a process."""
        with self._opening:
            self._listeners += (listener,)
            self._end_listeners += (on_end,) if on_end is not None else ()

    def unlisten(self, listener: Listener, on_end: EndListener | None = None) -> None:
        """Call them no more."""
        with self._opening:
            self._listeners = tuple(one for one in self._listeners if one != listener)
            self._end_listeners = tuple(one for one in self._end_listeners if one != on_end)

    def open(self) -> None:
        """Start the master and join it, unless that is done; one that is gone is replaced."""
        with self._opening:
            if self._is_over:
                raise _closed()
            if self.network is not None:
                # Start one where the last one was, if that is gone: all who were there come to it
                if self.shared_master and ask_master(self.shared_master) is None:
                    self.shared_master, self.has_master = "", False
                if not self.has_master:
                    start_master(self._master_launcher, self.launcher.master, self.master_options())
                    self.has_master = True
                    self.on_master("back", "")
                return
            self._make_launchers()  # those before are closed, or write to another folder
            try:
                self._open()
            except BaseException:
                self.close()
                raise

    def _open(self) -> None:
        self._stack.callback(self._master_launcher.close)
        if transport() == "p2p":  # a broker or a router serves more than one session
            if not self.joined_master:
                self.shared_master = "" if self.wanted_master else shared_master(self.name)
            self.launcher.master = self.joined_master or self.shared_master
            if not self.launcher.master:
                self.launcher.master = start_master(
                    self._master_launcher, self.wanted_master, self.master_options()
                )
        network = self._join()
        self._stack.callback(network.close)
        self.voice = Voice(network)
        self._stack.callback(self.voice.fall_silent)
        self._stack.callback(self._master_launcher.leave)
        self._stack.callback(self.launcher.close)
        for launcher in (self.launcher, self._master_launcher):
            launcher.hear(network)
        for topic in HEARD:
            on_message = partial(self._on_message, topic)
            Subscriber(topic, m.BY_TOPIC[topic], network=network, callback=on_message)
        self.network = network
        self.has_master = True
        self.on_open()

    def _join(self) -> Network:
        network = network_for(self.name, master=self.launcher.master)
        try:
            if isinstance(network, PeerNetwork):
                network.join()
        except NameTaken:
            network.close()
            if not self.shared_master:
                raise
            self.shared_master = ""  # another session was quicker: this one keeps apart from it
            self.launcher.master = start_master(
                self._master_launcher, self.wanted_master, self.master_options()
            )
            return self._join()
        except BaseException:
            network.close()
            raise
        return network

    def close(self, *, for_good: bool = False) -> None:
        """Stop all nodes, leave the network, stop the master.

        ``for_good``: also who waits already for its turn to open it comes too late.
        """
        self._is_over = self._is_over or for_good
        with self._opening:
            self.network = None
            self._stack.close()
            self.planned.clear()

    def reopen(self, prepare: Callable[[], None], nodes: Iterable[PlannedNode]) -> None:
        """Close, let ``prepare`` change how it is opened, open again and start these nodes.

        Does not wait until they are ready; raises NepError.
        """
        with self._opening:
            self.close()
            prepare()
            self.open()
            self.start(nodes)

    @property
    def running(self) -> list[PlannedNode]:
        """The nodes that run now, as they were started."""
        nodes = self.launcher.nodes
        return [
            planned
            for name, planned in self.planned.items()
            if name in nodes and not nodes[name].ended.is_set()
        ]

    def start(self, nodes: Iterable[PlannedNode]) -> list[LaunchedNode]:
        """Start those of the nodes that do not run yet as they are wanted; all of them, launched.

        Does not wait until they are ready; raises NepError, and NotApproved before any starts.
        """
        nodes = list(nodes)
        for one in nodes:
            self.gate.check_node(one)
        with self._opening:
            if self.network is None:
                raise _closed()
            launched = []
            for one in nodes:
                running = self.launcher.nodes.get(one.name)
                if running is not None and not running.ended.is_set():
                    if self.planned.get(one.name) == one:
                        launched.append(running)
                        continue
                    self.launcher.stop(one.name)
                # Write what a node will read, as the motions of the project
                try:
                    if one.files is not None:
                        one.files.write()
                except OSError as error:
                    raise NodeStartError(
                        "What {name} needs could not be written: {reason}.",
                        checklist=("Is there room on the disk?",),
                        details=str(error),
                        name=one.name,
                        reason=reason_of(error),
                    ) from error
                self.planned[one.name] = one
                launched.append(self.launcher.launch(one.node, one.name, one.parameters))
            return launched

    def stop(self, name: str) -> None:
        """Stop one node."""
        self.launcher.stop(name)

    def restart(self, name: str) -> LaunchedNode:
        """Stop a node that was started here, and start it again as it was."""
        planned = self.planned[name]
        self.stop(name)
        return self.start([planned])[0]

    def log_of(self, name: str) -> list[str]:
        """The last lines that a node, or the master, wrote; at most 200."""
        for launcher in (self.launcher, self._master_launcher):
            launched = launcher.nodes.get(name)
            if launched is not None and launched.process is not None:
                return launched.process.last_lines
        return []

    def tell(self, topic: str, message: msgspec.Struct) -> None:
        """Let all who listen hear what was found out here, and not said on the network."""
        self._on_message(topic, message)

    def _on_message(self, topic: str, message: msgspec.Struct) -> None:
        for listener in self._listeners:
            listener(topic, message)

    def _on_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if launched.name == MASTER:
            self._on_master_end(launched, outcome, again)
        for listener in self._end_listeners:
            listener(launched, outcome, again)

    def _on_master_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if launched.stopping or self.network is None:
            return  # it was stopped, or never answered: who starts it tells of that
        if again:
            self.on_master("restarting", text_of("{outcome}.", outcome=outcome.text))
            args = (launched, self.launcher.master)
            threading.Thread(target=self._await_master, args=args, daemon=True).start()
        else:
            self.has_master = False
            self.on_master("gone", text_of("{outcome}.", outcome=outcome.text))

    def _await_master(self, launched: LaunchedNode, endpoint: str) -> None:
        """Tell when the master that was started again answers."""
        gone_pid, until_s = launched.pid, time.monotonic() + READY_S
        while launched.pid == gone_pid and time.monotonic() < until_s and not launched.stopping:
            time.sleep(LOOK_S)
        if is_up(launched, endpoint) and not launched.stopping:
            self.on_master("back", "")


def _closed() -> NodeStartError:
    return NodeStartError("The network is closed.", checklist=("Start it again.",))


# What it takes to use keys: a key file for each other computer, and the variables that name it.


class UsedKeys:
    """Lets this program, and all that it starts, use a key file until it is given back."""

    def __init__(self) -> None:
        self._before: dict[str, str | None] = {}

    def take(self, keys: Path, host: str = "") -> None:
        """Use these keys, and be reached at ``host`` ("": as it was before)."""
        self.give_back()
        wanted = {KEYS_VARIABLE: str(keys.absolute())} | ({HOST_VARIABLE: host} if host else {})
        self._before = {name: os.environ.get(name) for name in wanted}
        os.environ.update(wanted)

    def give_back(self) -> None:
        """Be as before."""
        for name, value in self._before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
        self._before = {}


def pair_with(address: str, code: str, folder: Path) -> tuple[Path, Keys]:
    """Pair with the computer at an address, as it is typed: the key file in ``folder``.

    Raises PairingError, KeyFileError.
    """
    host, port = door_at(address)
    path = folder / f"joined {re.sub(r'[^A-Za-z0-9.]', '-', host)}.keys"
    try:
        return path, pair(host, port, code, path)
    except KeyFileError as error:
        if not path.exists():
            raise
        path.unlink()
        raise PairingError(
            "The computer at {host} has new keys since this one was paired with it.",
            checklist=("Make a new code there and type it here: the old keys are gone now.",),
            details=str(error),
            host=host,
        ) from error


def door_at(typed: str) -> tuple[str, int]:
    """The address and port of a door, as the other computer shows them; raises PairingError."""
    try:
        place = urlsplit("//" + typed.strip().removeprefix("tcp://"))
        host, port = place.hostname, place.port or DOOR_PORT
    except ValueError:
        host, port = None, 0
    if not host or any(letter.isspace() for letter in host):
        raise PairingError(
            "“{typed}” is no address.",
            checklist=("Write it as the other computer shows it, such as 192.168.1.5.",),
            typed=typed,
        )
    return host, port

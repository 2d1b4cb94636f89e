"""The studio's own network: its master, its place in there, and the nodes that it starts."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Literal

import msgspec

from nep_core import messages as m
from nep_core.errors import NameTaken, NodeStartError
from nep_core.launcher import LaunchedNode, Launcher
from nep_core.master_probe import ask_master
from nep_core.network import Network
from nep_core.outcome import Outcome
from nep_core.p2p import PeerNetwork
from nep_core.places import log_folder
from nep_core.pubsub import Subscriber
from nep_core.transports import network_for, transport
from nep_studio.own_master import MASTER, READY_S, is_up, shared_master, start_master
from nep_studio.plan import PlannedNode
from nep_studio.signals import postponed
from nep_studio.voice import Voice

STUDIO = "studio"
LOOK_S = 0.02

HEARD = (
    m.NODE_STATE,
    m.HUMAN_BEHAVIOR,
    m.ACTION_REQUEST,
    m.ACTION_RESULT,
    m.PROGRAM_STATE,
)

Listener = Callable[[str, msgspec.Struct], None]
"""Called with each message of the network and its topic, from several threads."""

EndListener = Callable[[LaunchedNode, Outcome, bool], None]
"""Called when a process ended: which, how, and whether it is started again."""

MasterEvent = Literal["restarting", "back", "gone"]
"""What becomes of a master that ended unexpectedly; those who know each other go on meanwhile."""


class LocalNetwork:
    """A master, this program's place in its network, and the nodes it started; any thread.

    ``open`` raises NepError when the master cannot start; ``close`` stops all nodes, then the
    master. Closed, it can be opened again.
    """

    def __init__(self, *, logs: Path | None = None, master: str | None = None) -> None:
        self.logs = logs or log_folder()
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
        self.on_master: Callable[[MasterEvent, str], None] = lambda event, sentence: None
        """Called when the master ended unexpectedly, from several threads, with how it ended."""
        self.has_master = False
        """Whether its master runs, or is about to be started again by itself."""
        self._listeners: tuple[Listener, ...] = ()
        self._end_listeners: tuple[EndListener, ...] = ()
        self._stack = contextlib.ExitStack()
        self._opening = threading.RLock()
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
            if self.is_open:
                self._replace_master()
                return
            self._make_launchers()
            try:
                self._open()
            except BaseException:
                self.close()
                raise

    def _open(self) -> None:
        self._stack.callback(self._master_launcher.close)
        if transport() == "p2p":  # a broker or a router serves more than one session
            self.launcher.master = self.joined_master or self._find_master()
        network = self._stack.enter_context(self._join())
        self.voice = Voice(network)
        self._stack.callback(self.voice.fall_silent)
        self._stack.callback(self._master_launcher.leave)
        self._stack.callback(self.launcher.close)
        for launcher in (self.launcher, self._master_launcher):
            launcher.hear(network)
        for topic in HEARD:
            self._hear(topic, network)
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
            self.launcher.master = self._start_master(self.wanted_master)
            return self._join()
        except BaseException:
            network.close()
            raise
        return network

    def _find_master(self) -> str:
        self.shared_master = "" if self.wanted_master else shared_master(self.name)
        return self.shared_master or self._start_master(self.wanted_master)

    def _start_master(self, wanted: str | None) -> str:
        return start_master(self._master_launcher, wanted, self.master_options())

    def close(self) -> None:
        """Stop all nodes, leave the network, stop the master."""
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

        Does not wait until they are ready; raises NepError.
        """
        with self._opening, postponed():
            if not self.is_open:
                raise NodeStartError("The network is closed.", checklist=("Start it again.",))
            return [self._start(one) for one in nodes]

    def _start(self, planned: PlannedNode) -> LaunchedNode:
        running = self.launcher.nodes.get(planned.name)
        if running is not None and not running.ended.is_set():
            if self.planned.get(planned.name) == planned:
                return running
            self.launcher.stop(planned.name)
        _write_files(planned)
        self.planned[planned.name] = planned
        return self.launcher.launch(planned.node, planned.name, planned.parameters)

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

    def _hear(self, topic: str, network: Network) -> None:
        def callback(message: msgspec.Struct) -> None:
            for listener in self._listeners:
                listener(topic, message)

        Subscriber(topic, m.BY_TOPIC[topic], network=network, callback=callback)

    def _on_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if launched.name == MASTER:
            self._on_master_end(launched, outcome, again)
        for listener in self._end_listeners:
            listener(launched, outcome, again)

    def _replace_master(self) -> None:
        """Start one where the last one was, if that is gone: all who were there come to it."""
        if self.shared_master and ask_master(self.shared_master) is None:
            self.shared_master, self.has_master = "", False
        if not self.has_master:
            self._start_master(self.launcher.master)
            self.has_master = True
            self.on_master("back", "")

    def _on_master_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if launched.stopping or not self.is_open:
            return  # it was stopped, or never answered: who starts it tells of that
        if again:
            self.on_master("restarting", f"{outcome}.")
            args = (launched, self.launcher.master)
            threading.Thread(target=self._await_master, args=args, daemon=True).start()
        else:
            self.has_master = False
            self.on_master("gone", f"{outcome}.")

    def _await_master(self, launched: LaunchedNode, endpoint: str) -> None:
        """Tell when the master that was started again answers."""
        gone_pid, until_s = launched.pid, time.monotonic() + READY_S
        while launched.pid == gone_pid and time.monotonic() < until_s and not launched.stopping:
            time.sleep(LOOK_S)
        if is_up(launched, endpoint) and not launched.stopping:
            self.on_master("back", "")


def _write_files(planned: PlannedNode) -> None:
    """Write what a node will read, as the motions of the project."""
    try:
        if planned.files is not None:
            planned.files.write()
    except OSError as error:
        raise NodeStartError(
            f"What {planned.name} needs could not be written: {error.strerror or error}.",
            checklist=("Is there room on the disk?",),
            details=str(error),
        ) from error

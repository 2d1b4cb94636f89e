"""An opened network, seen from the computer that opens it: its keys, its door, its name."""

from __future__ import annotations

import logging
import os
import socket
from collections.abc import Callable
from pathlib import Path

import msgspec
import zmq

from faults import Fault
from nep_core.errors import KeyFileError, NepError
from nep_core.networks import discovery
from nep_core.networks import master_messages as says
from nep_core.networks.endpoints import check_endpoint, fixed_endpoint
from nep_core.networks.network import Network
from nep_core.networks.registry import Registration, Registry
from nep_core.wire.messages import NODE_STATE, NodeState, described
from nep_core.wire.pubsub import Publisher

from .addresses import endpoint_at, lan_address
from .curve import Security
from .keys import KeyFile, new_keys, write_keys
from .pairing import CODE_S, Code, Door, DoorEvent

log = logging.getLogger(__name__)


MASTER_PORT = 7100
DOOR_PORT = 7101


class Opening:
    """Opens a network to other computers; any thread.

    ``keys``: the key file, made when it is not there. ``host``: the address of this computer to
    be reached at (None: the one in its network). ``on_event`` is told, from a thread of its own,
    who was paired and who tried in vain. The master is not part of it: start it at ``master``,
    with NEP_KEYS set to the key file. Raises KeyFileError, NetworkError.

    ``title`` is what other computers see, ``port`` the master's and ``door_port`` the door's;
    ``is_announced``: computers of the network find it without its address.
    """

    def __init__(
        self,
        keys: Path,
        *,
        title: str = "NEP",
        host: str | None = None,
        port: int = MASTER_PORT,
        door_port: int = DOOR_PORT,
        is_announced: bool = True,
        on_event: Callable[[DoorEvent], None] = lambda event: None,
    ) -> None:
        self.host = host or lan_address()
        self.master = fixed_endpoint(endpoint_at(self.host, port))
        check_endpoint(endpoint_at(self.host, door_port or "*"))
        self.file = owned_key_file(keys, title)
        self.door_port = door_port
        """Where the second computer knocks."""
        self._is_announced = is_announced
        self._on_event = on_event
        self._door: Door | None = None
        self._announcement: discovery.Announcement | None = None

    def start(self) -> None:
        """Open the door and announce the network; raises PortTaken."""
        self.file.change(lambda keys: msgspec.structs.replace(keys, master=self.master))
        self._door = Door(self.file, (self.host, self.door_port), self._on_event)
        self.door_port = self._door.port
        if self._is_announced:
            keys = self.file.keys
            self._announcement = discovery.announce(
                discovery.Found(
                    title=keys.title,
                    computer=keys.computer,
                    network=keys.network,
                    master=self.master,
                    door_port=self.door_port,
                )
            )

    @property
    def door_place(self) -> str:
        """The door's address and port, as they are typed."""
        return endpoint_at(self.host, self.door_port).removeprefix("tcp://")

    @property
    def code(self) -> Code | None:
        """The code that holds now."""
        return self._door.code if self._door else None

    def new_code(self, seconds: float = CODE_S) -> Code:
        """A code for one computer; after start()."""
        if self._door is None:
            raise RuntimeError("start() comes first")
        return self._door.new_code(seconds)

    def close(self) -> None:
        """Shut the door and announce no more; programs go on as they are."""
        if self._announcement is not None:
            self._announcement.close()
            self._announcement = None
        if self._door is not None:
            self._door.close()
            self._door = None


def owned_key_file(path: Path, title: str) -> KeyFile:
    """The key file of a network that this computer opened, made when there is none."""
    if not path.exists():
        write_keys(path, new_keys(title))
    file = KeyFile(path)
    if not file.keys.is_owner:
        raise KeyFileError(
            'The key file {path} is of the network "{title}", which another computer opened.',
            checklist=(
                "To take part in it, set NEP_KEYS to {path}: you need not open anything.",
                "To open a network of your own, choose another file: --keys FILE.",
            ),
            path=path,
            title=file.keys.title,
        )
    return file


class Admission:
    """Lets the master of an opened network tell all programs which computers are let in.

    It belongs to the master's thread; ``send`` gives an encoded answer to an address.
    """

    def __init__(
        self, security: Security, registry: Registry, send: Callable[[bytes, bytes], bool]
    ) -> None:
        self._file = security.file
        self._registry = registry
        self._send = send
        self._announced = self._file.keys.allowed

    def hears(self, frame: zmq.Frame) -> bool:
        """Whether a request is listened to: a connection may be older than its refusal."""
        return frame.get("User-Id") in self._file.keys.allowed

    def admits(self, told: Registration, address: bytes) -> bool:
        """Whether a program may register; if so it is told who else may."""
        self.look()
        if told.key not in self._announced:
            return False
        self._send(address, self._news())
        return True

    def look(self) -> list[Registration]:
        """Tell all programs when the key file has changed; those whose computer was forgotten."""
        allowed = self._file.keys.allowed
        if allowed == self._announced:
            return []
        self._announced = allowed
        entries = self._registry.entries.values()
        for entry in entries:
            self._send(entry.address, self._news())
        return [e.registration for e in entries if e.registration.key not in allowed]

    def _news(self) -> bytes:
        return says.encode(says.Computers(keys=sorted(self._announced)))


class ServiceVoice:
    """Tells the news of a service, which is no node, on ``/node_state`` as ``name``.

    It joins its network when there is something to say.
    """

    def __init__(self, name: str, join: Callable[[], Network]) -> None:
        self._name = name
        self._join = join
        self._network: Network | None = None
        self._states: Publisher | None = None

    def warn(self, fault: Fault) -> None:
        """Tell of something that a person should look at."""
        log.warning("%s", fault)
        try:
            if self._states is None:
                self._network = self._network or self._join()
                self._states = Publisher(NODE_STATE, network=self._network)
            self._states.send(
                NodeState(
                    node=self._name,
                    type="cognitive",  # the four types are of nodes, which this is not
                    event="warning",
                    pid=os.getpid(),
                    host=socket.gethostname(),
                    **described(fault),
                )
            )
        except NepError as error:
            log.warning("%s could not tell its warning: %s", self._name, error)

    def close(self) -> None:
        """Leave the network, before the service ends."""
        if self._network is not None:
            self._network.close()

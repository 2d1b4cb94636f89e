"""An opened network, seen from the computer that opens it: its keys, its door, its name."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

import msgspec

from nep_core import discovery
from nep_core.endpoints import check_endpoint, fixed_endpoint
from nep_core.errors import KeyFileError
from nep_core.security.addresses import endpoint_at, lan_address
from nep_core.security.door import CODE_S, Code, Door, DoorEvent
from nep_core.security.keys import Computer, KeyFile, new_keys

log = logging.getLogger(__name__)

MASTER_PORT = 7100
DOOR_PORT = 7101


class Opening:
    """Opens a network to other computers; any thread.

    ``keys``: the key file, made when it is not there. ``host``: the address of this computer to
    be reached at (None: the one in its network). ``on_event`` is told, from a thread of its own,
    who was paired and who tried in vain. The master is not part of it: start it at ``master``,
    with NEP_KEYS set to the key file. Raises KeyFileError, NetworkError.
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
        self._door_port = door_port
        self._is_announced = is_announced
        self._on_event = on_event
        self._door: Door | None = None
        self._announcement: discovery.Announcement | None = None

    def start(self) -> None:
        """Open the door and announce the network; raises PortTaken."""
        self.file.change(lambda keys: msgspec.structs.replace(keys, master=self.master))
        self._door = Door(self.file, (self.host, self._door_port), self._on_event)
        self._door_port = self._door.port
        if self._is_announced:
            keys = self.file.keys
            self._announcement = discovery.announce(
                discovery.Found(
                    title=keys.title,
                    computer=keys.computer,
                    network=keys.network,
                    master=self.master,
                    door_port=self._door_port,
                )
            )

    @property
    def door_port(self) -> int:
        """Where the second computer knocks."""
        return self._door_port

    @property
    def door_place(self) -> str:
        """The door's address and port, as they are typed."""
        return endpoint_at(self.host, self._door_port).removeprefix("tcp://")

    @property
    def code(self) -> Code | None:
        """The code that holds now."""
        return self._door.code if self._door else None

    def new_code(self, seconds: float = CODE_S) -> Code:
        """A code for one computer; after start()."""
        if self._door is None:
            raise RuntimeError("start() comes first")
        return self._door.new_code(seconds)

    @property
    def peers(self) -> tuple[Computer, ...]:
        """The computers that were let in."""
        return self.file.keys.computers

    def forget(self, peer: str) -> bool:
        """Let a computer in no more; whether it was known.

        Connections that exist stay until the programs at one of their ends are started again.
        """
        return self.file.forget(peer)

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
        return KeyFile.make(path, new_keys(title))
    file = KeyFile(path)
    if not file.keys.is_owner:
        raise KeyFileError(
            f'The key file {path} is of the network "{file.keys.title}", which another computer '
            "opened.",
            checklist=(
                f"To take part in it, set NEP_KEYS to {path}: you need not open anything.",
                "To open a network of your own, choose another file: --keys FILE.",
            ),
        )
    return file

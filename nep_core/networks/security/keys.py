"""The key file: this computer's keys for one opened network, and which computers were let in."""

from __future__ import annotations

import os
import socket
import stat
import threading
import time
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Literal

import msgspec
import zmq

from faults import Text, reason_of
from faults.files import make_privately, opened, whole_file
from nep_core.errors import KeyFileError
from nep_core.wire.frames import CANNOT_DECODE

MOST_BYTES = 1_000_000
LONGEST_NAME = 60
ON_WINDOWS = os.name == "nt"

Key = Annotated[str, msgspec.Meta(pattern=r"\A[!-~]{40}\Z")]
"""A CURVE key as 40 printable characters (Z85)."""
Name = Annotated[str, msgspec.Meta(min_length=1, max_length=LONGEST_NAME)]


class Computer(msgspec.Struct, frozen=True, kw_only=True):
    """A computer that was let in: its name, public key, address at that time, and when."""

    name: Name
    key: Key
    address: str = ""
    since: float = 0.0


class Keys(msgspec.Struct, frozen=True, kw_only=True):
    """What a key file holds.

    ``network`` tells networks apart, ``title`` is for people; ``computer``, ``public`` and
    ``secret`` are this computer's; ``master`` is where the master is and ``master_key`` the
    public key of the computer that opened the network.
    """

    nep_keys: Literal[1] = 1
    network: str
    title: Name
    computer: Name
    public: Key
    secret: Key
    master: str = ""
    master_key: Key
    computers: tuple[Computer, ...] = ()

    @property
    def is_owner(self) -> bool:
        """Whether this computer opened the network, and so decides who is let in."""
        return self.public == self.master_key

    @property
    def allowed(self) -> set[str]:
        """The public keys that may talk with this computer, as far as the file knows."""
        return {self.public, self.master_key, *(computer.key for computer in self.computers)}


def new_keys(title: str) -> Keys:
    """Keys for a network that this computer is about to open."""
    public, secret = (key.decode() for key in zmq.curve_keypair())
    return Keys(
        network=uuid.uuid4().hex,
        title=plain_name(title) or "NEP",
        computer=own_name(),
        public=public,
        secret=secret,
        master_key=public,
    )


def own_name() -> str:
    """What this computer is called."""
    return plain_name(socket.gethostname()) or "a computer"


def plain_name(text: str) -> str:
    """A name that can be shown: printable, in one line, not too long."""
    return "".join(c for c in text if c.isprintable()).strip()[:LONGEST_NAME].strip()


class KeyFile:
    """A key file on disk; read again whenever it has changed. Raises KeyFileError."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = threading.RLock()
        self._stamp, self._keys = self._read()

    @property
    def keys(self) -> Keys:
        """What the file says now; what it said last while it cannot be used."""
        with self._lock:
            try:
                if self._stamp != _stamp_of(os.stat(self.path)):
                    self._stamp, self._keys = self._read()
            except (OSError, KeyFileError):
                pass  # it is being repaired, or gone: who was let in stays so
            return self._keys

    def change(self, edit: Callable[[Keys], Keys]) -> Keys:
        """Read, change and write the file; programs that run see it at once."""
        with self._lock:
            _, keys = self._read()
            changed = edit(keys)
            if changed != keys:
                write_keys(self.path, changed)
            return self.keys

    def let_in(self, name: str, key: str, address: str) -> Computer:
        """Note a computer under a name of its own; one that comes again keeps its place."""
        known: list[Computer] = []

        def add(keys: Keys) -> Keys:
            others = [one for one in keys.computers if one.key != key]
            taken = {keys.computer, *(one.name for one in others)}
            new = Computer(
                name=_free_name(name, taken), key=key, address=address, since=time.time()
            )
            known.append(new)
            return msgspec.structs.replace(keys, computers=(*others, new))

        self.change(add)
        return known[0]

    def forget(self, name: str) -> bool:
        """Let a computer in no more; whether it was known.

        Connections that exist stay until the programs at one of their ends are started again.
        """
        before = self.keys.computers

        def drop(keys: Keys) -> Keys:
            left = tuple(one for one in keys.computers if one.name != name)
            return msgspec.structs.replace(keys, computers=left)

        return self.change(drop).computers != before

    def _read(self) -> tuple[tuple[int, ...], Keys]:
        try:
            with opened(self.path) as file:
                status = os.fstat(file.fileno())
                _require_private(self.path, status)
                return _stamp_of(status), _decode(self.path, file.read(MOST_BYTES + 1))
        except OSError as error:
            raise KeyFileError(
                "The key file {path} cannot be read: {reason}.",
                checklist=(
                    "Is NEP_KEYS the path of the key file?",
                    "To open a network of your own: nep open.",
                    "To join the network of another computer: nep pair.",
                ),
                path=self.path,
                reason=reason_of(error),
            ) from error


def write_keys(path: Path, keys: Keys) -> None:
    """Write a key file in one step, readable by its owner only; raises KeyFileError."""
    try:
        make_privately(path.parent)
        with whole_file(path, is_private=True) as file:
            file.write(msgspec.json.format(msgspec.json.encode(keys), indent=2) + b"\n")
    except OSError as error:
        raise KeyFileError(
            "The key file {path} cannot be written: {reason}.",
            checklist=("May you write in that folder?", "Is there room on the disk?"),
            path=path,
            reason=reason_of(error),
        ) from error


def _decode(path: Path, data: bytes) -> Keys:
    try:
        if len(data) > MOST_BYTES:
            raise ValueError("it is too large")
        keys = msgspec.json.decode(data, type=Keys)
        if zmq.curve_public(keys.secret.encode()).decode() != keys.public:
            raise ValueError("its secret key does not belong to its public key")
    except (*CANNOT_DECODE, zmq.ZMQError) as error:
        raise KeyFileError(
            "{path} is no key file, or it is damaged.",
            checklist=(
                "Is NEP_KEYS the path of the key file?",
                "Delete the file, and pair this computer again (nep pair) or, on the computer "
                "that opened the network, open it again (nep open).",
            ),
            details=str(error),
            path=path,
        ) from error
    return keys


def _require_private(path: Path, status: os.stat_result) -> None:
    """Refuse a file that others could have read: whoever has it can join as this computer."""
    if ON_WINDOWS:
        # Refuse a file outside the user's own folder, the one that Windows keeps from others
        home = Path.home()
        if not path.resolve().is_relative_to(home.resolve()):
            raise _not_private(path, "It is not in your own folder.", f'move "{path}" "{home}"')
        return
    if status.st_uid not in (os.geteuid(), 0) and os.geteuid() != 0:
        raise _not_private(path, "It belongs to another user.", f"chown $USER {path}")
    if status.st_mode & (stat.S_IRWXG | stat.S_IRWXO):
        raise _not_private(path, "Other users of this computer can open it.", f"chmod 600 {path}")


def _not_private(path: Path, why: str, command: str) -> KeyFileError:
    return KeyFileError(
        "The key file {path} is not private. {why}",
        checklist=(
            "Make it private: {command}",
            "Did somebody else have time to copy it? Then delete it, and open the network or "
            "pair this computer anew.",
        ),
        path=path,
        why=Text(why),
        command=command,
    )


def _stamp_of(status: os.stat_result) -> tuple[int, ...]:
    # The rights belong to it: a file that becomes open to others is looked at again.
    return status.st_mtime_ns, status.st_size, status.st_ino, status.st_mode


def _free_name(wanted: str, taken: set[str]) -> str:
    name, number = wanted, 1
    while name in taken:
        number += 1
        name = f"{wanted[: LONGEST_NAME - 6]} {number}"
    return name

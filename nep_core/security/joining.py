"""The second computer: pair with the one that opened a network, and write the key file."""

from __future__ import annotations

import socket
import time
from pathlib import Path
from typing import TypeVar

import msgspec
import zmq

from nep_core.endpoints import fixed_endpoint
from nep_core.errors import KeyFileError, NetworkError, PairingError
from nep_core.security import pairing
from nep_core.security.keys import Computer, KeyFile, Keys, own_name, write_keys
from nep_core.security.lines import Lines

T = TypeVar("T")

TALK_S = 10.0


def pair(host: str, port: int, code: str, path: Path) -> Keys:
    """Pair this computer at a door and write its key file; raises PairingError, KeyFileError.

    A key file that is already there must be one of the same network: its keys are kept.
    """
    before = KeyFile(path).keys if path.exists() else None
    if before is not None and before.is_owner:
        raise _other_network(path, before)
    public, secret = _own_pair(before)
    told = _talk(host, port, code, pairing.Guest(name=own_name(), key=public))
    if before is not None and before.network != told.network:
        raise _other_network(path, before)
    owner = Computer(name=told.computer, key=told.key, address=host, since=time.time())
    keys = Keys(
        network=told.network,
        title=told.title,
        computer=own_name(),
        public=public,
        secret=secret,
        master=told.master,
        master_key=told.key,
        computers=(owner,),
    )
    write_keys(path, keys)
    return keys


def _own_pair(before: Keys | None) -> tuple[str, str]:
    if before is not None:
        return before.public, before.secret
    public, secret = zmq.curve_keypair()
    return public.decode(), secret.decode()


def _talk(host: str, port: int, code: str, guest: pairing.Guest) -> pairing.Host:
    talk = pairing.GuestTalk(code, guest)
    hello = talk.hello()  # it takes a while, and the door does not wait for it
    try:
        connection = socket.create_connection((host, port), timeout=TALK_S)
    except (OSError, UnicodeError, OverflowError) as error:
        raise PairingError(
            f"No computer answers at {host}, port {port}: {_reason(error)}.",
            checklist=(
                "Is the network open on the other computer? It says so: nep open.",
                "Are both computers in the same network?",
                f"Does a firewall of the other computer keep port {port} shut?",
                "Is the address right? The other computer shows it.",
            ),
        ) from error
    with connection:
        lines = Lines(connection, TALK_S)
        lines.say(hello)
        offer = _expect(pairing.Offer, lines.hear())
        lines.say(talk.prove(offer))
        try:
            told = talk.read(_expect(pairing.Welcome, lines.hear()))
            fixed_endpoint(told.master)
        except (msgspec.MsgspecError, NetworkError) as error:
            if isinstance(error, PairingError):
                raise
            raise _strange() from error
    return told


def _reason(error: Exception) -> str:
    if isinstance(error, OSError):
        return (error.strerror or str(error)).lower()
    return "there can be no such place"


def _expect(kind: type[T], message: object) -> T:
    if isinstance(message, pairing.No):
        raise PairingError(
            _plain(message.sentence), checklist=tuple(map(_plain, message.checklist))
        )
    if not isinstance(message, kind):
        raise _strange()
    return message


def _plain(text: str) -> str:
    """What a stranger says, without letters that command a terminal."""
    return "".join(c for c in text if c.isprintable())


def _strange() -> PairingError:
    return PairingError(
        "The other computer answered something that cannot be read.",
        checklist=(
            "Is that the address of a computer that opened a NEP network?",
            "Update NEP Studio on both computers.",
        ),
    )


def _other_network(path: Path, keys: Keys) -> KeyFileError:
    return KeyFileError(
        f'The key file {path} belongs to another network, "{keys.title}".',
        checklist=(
            "Choose another file for the new network: --keys FILE.",
            "Or delete that file, if you do not need it any more.",
        ),
    )

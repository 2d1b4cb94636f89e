"""What it takes to use keys: a key file for each other computer, and the variables that name it."""

from __future__ import annotations

import os
import re
from pathlib import Path
from urllib.parse import urlsplit

from nep_core.errors import KeyFileError, PairingError
from nep_core.security import KEYS_VARIABLE
from nep_core.security.addresses import HOST_VARIABLE
from nep_core.security.joining import pair
from nep_core.security.keys import Keys
from nep_core.security.opening import DOOR_PORT


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
            f"The computer at {host} has new keys since this one was paired with it.",
            checklist=("Make a new code there and type it here: the old keys are gone now.",),
            details=error.sentence,
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
            f"“{typed}” is no address.",
            checklist=("Write it as the other computer shows it, such as 192.168.1.5.",),
        )
    return host, port

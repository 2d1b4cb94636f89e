"""An opened network of this computer: a key file, a master with keys, more key files."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import msgspec
import pytest
import zmq

from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.master import Master
from nep_core.networks.security import KEYS_VARIABLE
from nep_core.networks.security.addresses import HOST_VARIABLE
from nep_core.networks.security.keys import KeyFile, Keys, new_keys, write_keys
from nep_core.networks.zmq_networks import PeerNetwork


def written(path: Path, keys: Keys) -> KeyFile:
    write_keys(path, keys)
    return KeyFile(path)


def wait_until(condition: Callable[[], object], seconds: float = 5.0) -> bool:
    until_s = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > until_s:
            return False
        time.sleep(0.01)
    return True


def keys_of_a_guest(owner: Keys, name: str) -> Keys:
    """What pairing would write on a second computer."""
    public, secret = (key.decode() for key in zmq.curve_keypair())
    return msgspec.structs.replace(owner, computer=name, public=public, secret=secret, computers=())


@dataclass
class Opened:
    """The network of one master; ``use`` makes the programs that start now a computer's."""

    file: KeyFile
    master: Master
    patch: pytest.MonkeyPatch
    closing: ExitStack = field(default_factory=ExitStack)

    def use(self, keys: Path | None) -> None:
        if keys is None:
            self.patch.delenv(KEYS_VARIABLE, raising=False)
        else:
            self.patch.setenv(KEYS_VARIABLE, str(keys))

    def guest(self, name: str, *, let_in: bool = True) -> Path:
        """Another computer's key file."""
        path = self.file.path.with_name(f"{name}.keys")
        guest = written(path, keys_of_a_guest(self.file.keys, name))
        if let_in:
            self.file.let_in(name, guest.keys.public, "127.0.0.1")
        return path

    def join(self, node: str, keys: Path | None) -> PeerNetwork:
        self.use(keys)
        return self.closing.enter_context(PeerNetwork(node, master=self.master.endpoint))


@pytest.fixture
def key_file(tmp_path: Path) -> KeyFile:
    return written(tmp_path / "owner.keys", new_keys("karate"))


@pytest.fixture
def opened(key_file: KeyFile, monkeypatch: pytest.MonkeyPatch) -> Iterator[Opened]:
    monkeypatch.setenv(HOST_VARIABLE, "127.0.0.1")
    monkeypatch.setenv(KEYS_VARIABLE, str(key_file.path))
    master = Master("tcp://127.0.0.1:*")
    monkeypatch.setenv(MASTER_VARIABLE, master.endpoint)
    network = Opened(key_file, master, monkeypatch)
    yield network
    network.closing.close()
    master.close()

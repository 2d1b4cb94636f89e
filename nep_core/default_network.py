"""The network that publishers and subscribers join when they are told no other."""

from __future__ import annotations

import atexit
import threading

from nep_core.network import Network
from nep_core.transports import network_for

_lock = threading.Lock()
_network: Network | None = None


def default_network() -> Network:
    """This program's network: the one that was set, else one of NEP_NETWORK's kind."""
    global _network
    with _lock:
        if _network is None or _network.closed:
            if _network is not None:
                atexit.unregister(_network.close)
            _network = network_for()
            atexit.register(_network.close)
        return _network


def set_default_network(network: Network | None) -> None:
    """Let publishers and subscribers join ``network`` (None: make a new one at next use)."""
    global _network
    with _lock:
        _network = network

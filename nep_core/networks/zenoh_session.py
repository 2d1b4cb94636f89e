"""Opening zenoh sessions: programs are clients of a router, and routers join sites.

Nothing is looked for by multicast or gossip: only the endpoints that are named are used.
``NEP_ZENOH`` names the router (several with commas: the first that answers); ``NEP_ZENOH_KEYS``
the folder of the certificates that ``tls/`` and ``quic/`` endpoints need.
"""

from __future__ import annotations

import atexit
import json
import os
import re
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote, unquote

import msgspec

from faults import Fault, fault_of
from nep_core.errors import NetworkError, PortTaken, RouterNotFound

from .registry import Registration
from .security.addresses import is_loopback

if TYPE_CHECKING:
    import zenoh


ROUTER_VARIABLE = "NEP_ZENOH"
KEYS_VARIABLE = "NEP_ZENOH_KEYS"
DEFAULT_ROUTER = "tcp/127.0.0.1:7447"
ENCRYPTED = ("tls", "quic")
CONNECT_MS = 2000
"""How long a program looks for its router."""

SETTINGS: dict[str, Any] = {
    "scouting/multicast/enabled": False,
    "scouting/gossip/enabled": False,
    "scouting/delay": 0,
    "connect/retry": {"period_init_ms": 50, "period_max_ms": 500, "period_increase_factor": 2},
    "transport/shared_memory/enabled": False,
    # As many batches of 64 KB as zenoh takes: with its usual 2, floods lose messages.
    "transport/link/tx/queue/size/data": 16,
}
DROP_US = "transport/link/tx/queue/congestion_control/drop/wait_before_drop"
PROGRAM_WAITS_US = 100_000
"""A program's longest wait for its router, which is never slow itself."""
ROUTER_WAITS_US = 20_000
"""A router's longest wait for a program; while that one stays frozen it does not wait again."""

_PID = re.compile(r"\d{1,9}", re.ASCII)
_ENDPOINT = re.compile(r"(?P<how>tcp|tls|quic)/(?P<host>\[[0-9a-f:]+\]|[\w.\-]+):\d{1,5}", re.I)


def router_endpoints() -> list[str]:
    """Where routers are: the variable NEP_ZENOH, else port 7447 of this computer. NetworkError."""
    text = os.environ.get(ROUTER_VARIABLE) or DEFAULT_ROUTER
    return [check_zenoh_endpoint(part.strip()) for part in text.split(",")]


def check_zenoh_endpoint(endpoint: str) -> str:
    """Give back ``endpoint``, or raise NetworkError that shows what one looks like."""
    if _ENDPOINT.fullmatch(endpoint) is None:
        raise NetworkError(
            "{endpoint} is not a zenoh endpoint.",
            checklist=('Write it as "tcp/127.0.0.1:7447" or "tls/site.example:7447".',),
            endpoint=repr(endpoint),
        )
    return endpoint


def open_client(routers: list[str]) -> zenoh.Session:
    """A program's session with the first of ``routers`` that answers; raises RouterNotFound."""
    settings = {"connect/timeout_ms": CONNECT_MS, DROP_US: PROGRAM_WAITS_US}
    failure = RouterNotFound(
        "No zenoh router answers at {routers}.",
        checklist=(
            "Start one in another terminal: nep broker --zenoh",
            "Is it at another place? Set {router_variable} to its endpoint.",
        ),
        routers=" or ".join(routers),
        router_variable=ROUTER_VARIABLE,
    )
    return _open("client", routers, [], settings, failure)


def check_private(endpoint: str) -> None:
    """Raise NetworkError when anybody on a network could reach and read ``endpoint``."""
    match = _ENDPOINT.fullmatch(check_zenoh_endpoint(endpoint))
    assert match is not None
    if match["how"].lower() not in ENCRYPTED and not is_loopback(match["host"].strip("[]")):
        raise NetworkError(
            "At {endpoint} everybody on the network could listen and send.",
            checklist=(
                "Use tls/ instead of tcp/, with certificates in {keys_variable}.",
                "Only on a network of your own, such as a VPN: add --private",
            ),
            endpoint=endpoint,
            keys_variable=KEYS_VARIABLE,
        )


def _open(
    mode: str, connect: list[str], listen: list[str], more: dict[str, Any], failure: NetworkError
) -> zenoh.Session:
    """A session; raises ``failure`` when zenoh does not open it."""
    if find_spec("zenoh") is None:
        raise NetworkError(
            "The zenoh library is not installed.",
            checklist=(
                'Install it: pip install "nep-studio[zenoh]"',
                "Or use another network: NEP_NETWORK=p2p",
            ),
        )
    import zenoh

    settings = {**SETTINGS, "mode": mode, "connect/endpoints": connect, "listen/endpoints": listen}
    if any(endpoint.lower().startswith(ENCRYPTED) for endpoint in (*connect, *listen)):
        settings["transport/link/tls"] = _certificates()
    config = zenoh.Config()
    for key, value in (settings | more).items():
        config.insert_json5(key, json.dumps(value))
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        failure.fault = msgspec.structs.replace(failure.fault, details=str(error))
        raise failure from error


def _certificates() -> dict[str, Any]:
    """Both sides show a certificate and look at the other's (mTLS)."""
    folder = Path(os.environ.get(KEYS_VARIABLE) or "zenoh-keys")
    files = [folder / name for name in ("ca.pem", "certificate.pem", "key.pem")]
    missing = [str(file) for file in files if not file.is_file()]
    if missing:
        raise NetworkError(
            "An encrypted connection needs certificates: {missing} cannot be found.",
            checklist=(
                "Set {keys_variable} to the folder of ca.pem, certificate.pem and key.pem.",
                "docs/transports.md says how to make them.",
            ),
            missing=", ".join(missing),
            keys_variable=KEYS_VARIABLE,
        )
    authority, certificate, key = (str(file) for file in files)
    return {
        "root_ca_certificate": authority,
        "enable_mtls": True,
        "listen_certificate": certificate,
        "listen_private_key": key,
        "connect_certificate": certificate,
        "connect_private_key": key,
    }


# The key expressions of a zenoh network: where frames go, and the tokens that say who is there.
#
# Each part of a key is percent-encoded, since topics and names may hold what zenoh gives a meaning
# to: ``/``, ``*``, ``$``, ``?``, ``#``. Tokens are zenoh's liveliness tokens: they end with their
# program, whatever ends it.

ALL_TOKENS = "nep/alive/**"


def frames_key(topic: str, subscriber: str = "*") -> str:
    """Where the frames of ``topic`` go: to every subscriber, or to one."""
    return f"nep/frames/{_part(topic)}/{subscriber}"


def stop_key(instance: str) -> str:
    """Where a program hears that it is asked to stop."""
    return f"nep/stop/{instance}"


def node_token(node: str, instance: str, pid: int, host: str) -> str:
    """The token of a program that has the name ``node``.

    ``instance`` is its run, ``pid`` its process, ``host`` its computer.
    """
    return f"nep/alive/node/{_part(node)}/{instance}/{pid}/{_part(host or '?')}"


def node_tokens(node: str) -> str:
    """The tokens of all programs that have the name ``node``, or try to get it."""
    return f"nep/alive/node/{_part(node)}/**"


def says_token(topic: str, instance: str = "*") -> str:
    """The token of a program that publishes ``topic``."""
    return f"nep/alive/says/{_part(topic)}/{instance}"


def hears_token(topic: str, instance: str = "*", subscriber: str = "*") -> str:
    """The token of a subscriber of ``topic``."""
    return f"nep/alive/hears/{_part(topic)}/{instance}/{subscriber}"


def last_part(token: str) -> str:
    """The id with which a token ends: a publisher's instance, a subscriber's own."""
    return token.rpartition("/")[2]


def registrations_of(tokens: Iterable[str], endpoint: str) -> list[Registration]:
    """Who is there, by all their tokens; ``endpoint`` is where they are reached."""
    said = sorted([unquote(part) for part in token.split("/")[2:]] for token in tokens)
    told: dict[str, Registration] = {}
    for parts in said:
        match parts:
            case ["node", node, instance, pid, host] if _PID.fullmatch(pid):
                told[instance] = Registration(
                    instance=instance, node=node, pid=int(pid), host=host, endpoint=endpoint
                )
    for parts in said:
        match parts:
            case ["says", topic, instance] if instance in told:
                told[instance].publishes.append(topic)
            case ["hears", topic, instance, subscriber] if instance in told:
                told[instance].subscribes[subscriber] = topic
    return list(told.values())


def _part(text: str) -> str:
    return quote(text, safe="")


class ZenohRouter:
    """Passes messages on, in this process: between its programs, and to routers that it knows of.

    ``listen``: its endpoints (default: NEP_ZENOH); ``connect``: routers of other sites, which it
    looks for as long as it lives. Endpoints that anybody could read must be allowed by
    ``is_private``. Raises PortTaken, NetworkError.
    """

    def __init__(
        self, listen: Iterable[str] = (), connect: Iterable[str] = (), *, is_private: bool = False
    ) -> None:
        places = [check_zenoh_endpoint(one) for one in listen] or router_endpoints()
        if not is_private:
            for place in places:
                check_private(place)
        failure = PortTaken(
            "{listen} cannot be used.",
            checklist=(
                "Is a router running there already? Use that one, or stop it.",
                "Choose another port: --listen tcp/127.0.0.1:7448",
                "Is that an address of this computer?",
            ),
            listen=" or ".join(places),
        )
        others = [check_zenoh_endpoint(one) for one in connect]
        self._session = _open("router", others, places, {DROP_US: ROUTER_WAITS_US}, failure)
        self._told_sites = 0
        self.endpoint = " and ".join(places)
        atexit.register(self.close)  # zenoh's threads must end before the interpreter does

    def sites(self) -> int:
        """How many other routers it is connected with now."""
        return len(self._session.info.routers_zid())

    def take_warning(self) -> Fault | None:
        """How many other sites are connected, if that has changed since the last time."""
        before, self._told_sites = self._told_sites, self.sites()
        if self._told_sites == before:
            return None
        return fault_of("Connected with other sites: {count}.", count=self._told_sites)

    def close(self) -> None:
        """Stop passing messages on."""
        self._session.close()
        atexit.unregister(self.close)

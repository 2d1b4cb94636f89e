"""Opening zenoh sessions: programs are clients of a router, and routers join sites.

Nothing is looked for by multicast or gossip: only the endpoints that are named are used.
``NEP_ZENOH`` names the router (several with commas: the first that answers); ``NEP_ZENOH_KEYS``
the folder of the certificates that ``tls/`` and ``quic/`` endpoints need.
"""

from __future__ import annotations

import ipaddress
import json
import os
import re
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nep_core.errors import NetworkError, PortTaken, RouterNotFound

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
    "connect/retry": {
        "period_init_ms": 50,
        "period_max_ms": 500,
        "period_increase_factor": 2,
    },
    "transport/shared_memory/enabled": False,
    # As many batches of 64 KB as zenoh takes: with its usual 2, floods lose messages.
    "transport/link/tx/queue/size/data": 16,
}
DROP_US = "transport/link/tx/queue/congestion_control/drop/wait_before_drop"
PROGRAM_WAITS_US = 100_000
"""A program's longest wait for its router, which is never slow itself."""
ROUTER_WAITS_US = 20_000
"""A router's longest wait for a program; while that one stays frozen it does not wait again."""

_ENDPOINT = re.compile(r"(?P<how>tcp|tls|quic)/(?P<host>\[[0-9a-f:]+\]|[\w.\-]+):\d{1,5}", re.I)


def router_endpoints() -> list[str]:
    """Where routers are: the variable NEP_ZENOH, else port 7447 of this computer. NetworkError."""
    text = os.environ.get(ROUTER_VARIABLE) or DEFAULT_ROUTER
    return [check_zenoh_endpoint(part.strip()) for part in text.split(",")]


def check_zenoh_endpoint(endpoint: str) -> str:
    """Give back ``endpoint``, or raise NetworkError that shows what one looks like."""
    if _ENDPOINT.fullmatch(endpoint) is None:
        raise NetworkError(
            f"{endpoint!r} is not a zenoh endpoint.",
            checklist=('Write it as "tcp/127.0.0.1:7447" or "tls/site.example:7447".',),
        )
    return endpoint


def open_client(routers: Iterable[str]) -> zenoh.Session:
    """A program's session with the first of ``routers`` that answers; raises RouterNotFound."""
    routers = list(routers)
    settings = {"connect/timeout_ms": CONNECT_MS, DROP_US: PROGRAM_WAITS_US}
    failure = RouterNotFound(
        f"No zenoh router answers at {' or '.join(routers)}.",
        checklist=(
            "Start one in another terminal: nep broker --zenoh",
            f"Is it at another place? Set {ROUTER_VARIABLE} to its endpoint.",
        ),
    )
    return _open("client", routers, [], settings, failure)


def open_router(listen: Iterable[str], connect: Iterable[str]) -> zenoh.Session:
    """A router's session, which goes on looking for the other routers; raises PortTaken."""
    listen = list(listen)
    failure = PortTaken(
        f"{' or '.join(listen)} cannot be used.",
        checklist=(
            "Is a router running there already? Use that one, or stop it.",
            "Choose another port: --listen tcp/127.0.0.1:7448",
            "Is that an address of this computer?",
        ),
    )
    return _open("router", list(connect), listen, {DROP_US: ROUTER_WAITS_US}, failure)


def check_private(endpoint: str) -> None:
    """Raise NetworkError when anybody on a network could reach and read ``endpoint``."""
    match = _ENDPOINT.fullmatch(check_zenoh_endpoint(endpoint))
    assert match is not None
    if match["how"].lower() not in ENCRYPTED and not _is_this_computer(match["host"]):
        raise NetworkError(
            f"At {endpoint} everybody on the network could listen and send.",
            checklist=(
                f"Use tls/ instead of tcp/, with certificates in {KEYS_VARIABLE}.",
                "Only on a network of your own, such as a VPN: add --private",
            ),
        )


def _is_this_computer(host: str) -> bool:
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def _open(
    mode: str,
    connect: list[str],
    listen: list[str],
    settings: dict[str, Any],
    failure: NetworkError,
) -> zenoh.Session:
    """A session; raises ``failure`` when zenoh does not open it."""
    _require_zenoh()
    import zenoh

    settings = SETTINGS | settings
    settings |= {"mode": mode, "connect/endpoints": connect, "listen/endpoints": listen}
    if any(endpoint.lower().startswith(ENCRYPTED) for endpoint in (*connect, *listen)):
        settings["transport/link/tls"] = _certificates()
    config = zenoh.Config()
    for key, value in settings.items():
        config.insert_json5(key, json.dumps(value))
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        failure.details = str(error)
        raise failure from error


def _certificates() -> dict[str, Any]:
    """Both sides show a certificate and look at the other's (mTLS)."""
    folder = Path(os.environ.get(KEYS_VARIABLE) or "zenoh-keys")
    files = [folder / name for name in ("ca.pem", "certificate.pem", "key.pem")]
    missing = [str(file) for file in files if not file.is_file()]
    if missing:
        raise NetworkError(
            f"An encrypted connection needs certificates: {', '.join(missing)} cannot be found.",
            checklist=(
                f"Set {KEYS_VARIABLE} to the folder of ca.pem, certificate.pem and key.pem.",
                "docs/transports.md says how to make them.",
            ),
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


def _require_zenoh() -> None:
    """Raise NetworkError when the library is not installed."""
    if find_spec("zenoh") is None:
        raise NetworkError(
            "The zenoh library is not installed.",
            checklist=(
                'Install it: pip install "nep-studio[zenoh]"',
                "Or use another network: NEP_NETWORK=p2p",
            ),
        )

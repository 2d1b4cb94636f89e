"""Who may talk to the phone page, and what its answers tell the browser about safety."""

from __future__ import annotations

import ipaddress
from collections.abc import Mapping

SERVER = "NEP Studio"
HTTPS_PORT = 443  # is left out of links
COMMON_HEADERS = {
    "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "accelerometer=(self), gyroscope=(self), screen-wake-lock=(self), "
    "camera=(), microphone=(), geolocation=()",
    "Referrer-Policy": "no-referrer",  # the link has the token in it
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
_NOTHING_ELSE = "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"


def headers(host: str, nonce: str = "") -> dict[str, str]:
    """The headers of every answer; ``nonce`` allows the one style of the page of refusal.

    WebSockets are named with the host, as older browsers do not count them as 'self'.
    """
    style = f"'nonce-{nonce}'" if nonce else "'self'"
    policy = (
        f"default-src 'none'; script-src 'self'; style-src {style}; img-src 'self' data:; "
        f"connect-src 'self' wss://{host}; {_NOTHING_ELSE}"
    )
    return {**COMMON_HEADERS, "Content-Security-Policy": policy}


def is_our_host(host: str, own: tuple[str, int]) -> bool:
    """Whether the page was asked for by the address (and port) that the connection came to.

    A name of somebody else's that leads to our address is refused (DNS rebinding).
    """
    address, port = own
    names = {address, "localhost"} if _is_loopback(address) else {address}
    return host in {f"{name}:{port}" for name in names} or (port == HTTPS_PORT and host in names)


def is_our_origin(given: Mapping[str, str], host: str) -> bool:
    """Whether a request was made by our own page, by its headers."""
    return given.get("Origin") == f"https://{host}"


def _is_loopback(address: str) -> bool:
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False

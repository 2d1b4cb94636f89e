"""How a client says who it is, and what both sides say they can do."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

AUTHENTICATE = 8
"""The number of the call, to service 0 and object 0."""
STATE, USER, TOKEN, NEW_TOKEN = "__qi_auth_state", "auth_user", "auth_token", "auth_newToken"
FAILED, GOES_ON, DONE = 1, 2, 3
CAPABILITIES = {
    "ClientServerSocket": True,
    "MessageFlags": True,
    "MetaObjectCache": False,
    "RemoteCancelableCalls": True,
}


@dataclass(frozen=True)
class Login:
    """User and password of a robot."""

    user: str
    password: str = field(repr=False)


@dataclass(frozen=True)
class TlsFiles:
    """The certificate of a server and its private key, both as PEM files."""

    certificate: Path
    key: Path

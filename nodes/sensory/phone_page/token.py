"""The secret part of the link that the QR code shows."""

from __future__ import annotations

import hmac
import secrets

TOKEN_BYTES = 9
"""12 letters in the link: nobody guesses it, and the QR code stays coarse enough to scan."""


def new_token() -> str:
    """A token that nobody can guess, of letters that a link may have."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def is_token(given: str, wanted: str) -> bool:
    """Whether it is the token; takes the same time for every wrong one."""
    return bool(wanted) and hmac.compare_digest(given.encode(), wanted.encode())

"""User and password of robots that ask for them: in a file of this person's, never in a project.

The file is beside the settings of the studio, and only its owner may read it. Two environment
variables go before it, for programs that start nodes by themselves.
"""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

import msgspec
import platformdirs

FOLDER_VARIABLE = "NEP_STUDIO_FOLDER"
USER_VARIABLE, PASSWORD_VARIABLE = "NEP_ROBOT_USER", "NEP_ROBOT_PASSWORD"
FILE = "robots.json"
USUAL_USER = "nao"


class SavedLogin(msgspec.Struct, frozen=True):
    """How to log in at a robot; ``fingerprint`` is that of its certificate, "" for any."""

    user: str
    password: str
    fingerprint: str = ""


def logins_file() -> Path:
    """Where user and password of robots are kept."""
    if named := os.environ.get(FOLDER_VARIABLE):
        return Path(named) / FILE
    try:
        return Path(platformdirs.user_config_dir("nep-studio", appauthor=False)) / FILE
    except RuntimeError:  # a user without a home
        return Path(tempfile.gettempdir()) / "nep-studio" / FILE


def saved_login(place: str) -> SavedLogin | None:
    """Return how to log in at an address (as a person writes it), None when it needs nothing."""
    if password := os.environ.get(PASSWORD_VARIABLE):
        return SavedLogin(os.environ.get(USER_VARIABLE) or USUAL_USER, password)
    return _read().get(_key(place))


def save_login(place: str, login: SavedLogin | None) -> None:
    """Keep user and password of an address; None forgets them. Raises OSError."""
    logins, place = _read(), _key(place)
    if logins.get(place) == login:
        return
    logins.pop(place, None)
    if login is not None:
        logins[place] = login
    _write(logins)


def _key(place: str) -> str:
    """The same robot may be written with the usual port, or without."""
    return place.strip().casefold().removesuffix(":9559")


def _read() -> dict[str, SavedLogin]:
    try:
        return msgspec.json.decode(logins_file().read_bytes(), type=dict[str, SavedLogin])
    except (OSError, msgspec.DecodeError):  # none yet, or one that is no use: asked for again
        return {}


def _write(logins: dict[str, SavedLogin]) -> None:
    path = logins_file()
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_suffix(".new")
    with contextlib.suppress(FileNotFoundError):
        new.unlink()
    # made for its owner only from the first moment on, and never half written
    handle = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(handle, "wb") as file:
        file.write(msgspec.json.format(msgspec.json.encode(logins), indent=2))
    new.replace(path)

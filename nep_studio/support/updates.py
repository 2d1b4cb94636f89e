"""Asks, if a person wants that, which version is the newest: once a day, at one address.

Nothing is sent but the version of this program; the answer is JSON, {"version": "1.2.0",
"page": "https://..."}, or the bare version. Nobody is asked unless ``is_wanted``.
"""

from __future__ import annotations

import json
import logging
import re
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from nep_studio import __version__
from nep_studio.settings import Kept, Settings, SettingsFile

if TYPE_CHECKING:
    import ssl
    import urllib.request

log = logging.getLogger(__name__)

ADDRESS = ""
"""Where the newest version is told; who releases the program fills it in. "": nowhere yet."""

TIMEOUT_S = 4.0
LARGEST_BYTES = 10_000
DAY_S = 24 * 3600
SCHEMES = ("http", "https")
CERTIFICATES = (
    "/etc/ssl/certs/ca-certificates.crt",
    "/etc/pki/tls/certs/ca-bundle.crt",
    "/etc/ssl/ca-bundle.pem",
    "/etc/ssl/cert.pem",
)
"""Whom the systems trust; a frozen program knows only where that was when it was made."""
_VERSION = re.compile(r"v?(\d{1,6}(?:\.\d{1,6}){0,3})")


@dataclass(frozen=True)
class Newest:
    """The newest version, and the page where it is; "" when none is told."""

    version: str
    page: str = ""

    @property
    def is_newer(self) -> bool:
        """Whether it is newer than this program."""
        return numbers(self.version) > numbers(__version__)


class UpdateChoice(SettingsFile):
    """What a person chose about updates, and when it was asked last."""

    is_wanted = Kept("updates/check", False)
    """Whether the person wants to be told."""
    announced = Kept("updates/announced", "")
    """The version of which the person has been told."""

    def __init__(self, settings: Settings) -> None:
        super().__init__(settings.folder)

    @property
    def address(self) -> str:
        """Where it is asked; "" when no usable address is known."""
        told = self._text("address") or ADDRESS
        return told if is_usable(told) else ""

    @address.setter
    def address(self, address: str) -> None:
        chosen = address.strip()
        self.values.setValue("updates/address", "" if chosen == ADDRESS else chosen)

    def is_due(self, now_s: float) -> bool:
        """Whether it is wanted, and was not asked within a day; a clock that went back counts."""
        try:
            since_s = now_s - float(self._text("asked") or 0)
        except ValueError:
            since_s = DAY_S
        return self.is_wanted and bool(self.address) and not 0 <= since_s < DAY_S

    def note_asked(self, now_s: float | None = None) -> None:
        """Note that it is asked now, whatever comes of it."""
        self.values.setValue("updates/asked", f"{time.time() if now_s is None else now_s:.0f}")
        self.values.sync()

    def _text(self, name: str) -> str:
        value = self.values.value(f"updates/{name}", "")
        return value if isinstance(value, str) else ""


def is_usable(address: str) -> bool:
    """Whether something can be asked there."""
    try:
        parts = urlsplit(address)
        return parts.scheme in SCHEMES and bool(parts.hostname)
    except ValueError:
        return False


def numbers(version: str) -> tuple[int, ...]:
    """A version as numbers to compare, (1, 2) for "1.2.0"; () when it is none."""
    found = _VERSION.match(version.strip())
    told = [int(part) for part in found[1].split(".")] if found else []
    while told and told[-1] == 0:
        told.pop()
    return tuple(told)


def ask(address: str) -> Newest | None:
    """Ask for the newest version; None when that is not told. Takes a while: for a thread."""
    import http.client  # with TLS and all: only who wants it loads it
    import urllib.request

    if not is_usable(address):
        return None
    request = urllib.request.Request(address, headers={"User-Agent": f"NEP-Studio/{__version__}"})
    try:
        with _opener(urlsplit(address).scheme).open(request, timeout=TIMEOUT_S) as answer:
            return newest_in(answer.read(LARGEST_BYTES + 1))
    except (OSError, ValueError, http.client.HTTPException) as error:
        log.info("The newest version is not known: %s", error)
        return None


def _opener(scheme: str) -> urllib.request.OpenerDirector:
    """Asks; where a page sends it on to, it asks only as safely."""
    import urllib.request

    class Redirects(urllib.request.HTTPRedirectHandler):
        def redirect_request(self, *told: Any) -> urllib.request.Request | None:
            if urlsplit(told[-1]).scheme not in (scheme, "https"):
                raise ValueError("it is sent on to a page that is less safe")
            return super().redirect_request(*told)

    trusting = urllib.request.HTTPSHandler(context=_trust())
    return urllib.request.build_opener(Redirects, trusting)


def _trust() -> ssl.SSLContext:
    import ssl

    context, usual = ssl.create_default_context(), ssl.get_default_verify_paths()
    if not (usual.cafile or usual.capath or context.get_ca_certs()):
        file = next((one for one in CERTIFICATES if Path(one).is_file()), None)
        if file is not None:
            context.load_verify_locations(file)
    return context


def newest_in(answer: bytes) -> Newest | None:
    """What an answer tells; None when it makes no sense."""
    if len(answer) > LARGEST_BYTES:
        return None
    text = answer.decode("utf-8", "replace").strip()
    try:
        told = json.loads(text) if text.startswith("{") else {"version": text}
    except (ValueError, RecursionError):
        return None
    found = _VERSION.fullmatch(str(told.get("version", "")).strip())
    page = str(told.get("page", ""))
    return Newest(found[1], page if is_usable(page) else "") if found else None

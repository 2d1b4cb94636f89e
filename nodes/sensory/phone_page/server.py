"""Serves the phone page by HTTPS from a thread of its own, while it is asked for."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import ipaddress
import socket
import ssl
import threading
from collections.abc import AsyncIterator, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING

from faults import Text, reason_of, text_of
from faults.files import whole_file
from nep_core.errors import NodeStartError
from nep_core.places import own_folder, private_folder
from nodes.sensory.connectors.connector import Settings
from nodes.sensory.connectors.servers import LOOPBACK, Background, lan_addresses, open_tcp

from .site import PageFiles, Receiving, Site, new_token, page_files

if TYPE_CHECKING:
    from aiohttp import web
    from cryptography import x509


# The certificate of the phone page: made on this computer, for this computer, kept for a year.

FILE = "phone_page.pem"
VALID_DAYS = 397  # browsers refuse certificates that are good for longer than 398 days
RENEWED_BEFORE = timedelta(days=14)
_CLOCKS_DIFFER = timedelta(days=1)
_MOST_NAMES = 16


@dataclass(frozen=True)
class Certificate:
    """The file of a key and its certificate, which is good for ``names``."""

    path: Path
    names: tuple[str, ...]

    def context(self) -> ssl.SSLContext:
        """What a server needs to speak TLS 1.2 or newer with it."""
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        context.load_cert_chain(self.path)
        return context

    @property
    def spki_sha256(self) -> str:
        """The fingerprint of its public key in base64, as browsers write it."""
        import base64
        import hashlib

        from cryptography import x509
        from cryptography.hazmat.primitives import serialization

        public = x509.load_pem_x509_certificate(self.path.read_bytes()).public_key()
        der = public.public_bytes(
            serialization.Encoding.DER, serialization.PublicFormat.SubjectPublicKeyInfo
        )
        return base64.b64encode(hashlib.sha256(der).digest()).decode()


def certificate_folder() -> Path:
    """Where the key is kept: among this user's settings."""
    return own_folder("config", "keys")


def own_certificate(addresses: Sequence[str], folder: Path | None = None) -> Certificate:
    """The kept certificate, or a new one when that is not good for all addresses or gets too old.

    Earlier addresses stay in a new one, so that going back to a network does not make the phone
    ask again. Raises OSError when it cannot be kept.
    """
    folder = folder or certificate_folder()
    wanted = ("localhost", "127.0.0.1", *addresses)
    path = folder / FILE
    kept = _kept_names(path)
    if kept and set(wanted) <= set(kept):
        return Certificate(path, kept)
    private_folder(folder)
    names = tuple(dict.fromkeys((*wanted, *kept)))[:_MOST_NAMES]
    _make(path, names)
    return Certificate(path, names)


def _kept_names(path: Path) -> tuple[str, ...]:
    """The names that the kept certificate is good for, none when it cannot be used any more."""
    from cryptography import x509

    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(path)
        found = x509.load_pem_x509_certificate(path.read_bytes())
        names = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, x509.ExtensionNotFound):
        return ()
    now = datetime.now(UTC)
    if not found.not_valid_before_utc <= now < found.not_valid_after_utc - RENEWED_BEFORE:
        return ()
    return tuple(str(name.value) for name in names)


def _make(path: Path, names: Sequence[str]) -> None:
    from cryptography import x509
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID

    key = ec.generate_private_key(ec.SECP256R1())
    subject = x509.Name(
        [x509.NameAttribute(x509.NameOID.COMMON_NAME, "NEP Studio on this computer")]
    )
    now = datetime.now(UTC)
    number = x509.random_serial_number()
    builder = x509.CertificateBuilder(subject, subject, key.public_key(), number)
    builder = builder.not_valid_before(now - _CLOCKS_DIFFER)
    builder = builder.not_valid_after(now - _CLOCKS_DIFFER + timedelta(days=VALID_DAYS))
    alternatives = x509.SubjectAlternativeName([_general_name(name) for name in names])
    usage = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH])
    builder = builder.add_extension(alternatives, critical=False)
    builder = builder.add_extension(usage, critical=False)
    builder = builder.add_extension(x509.BasicConstraints(False, None), critical=True)
    pem = serialization.Encoding.PEM
    private = key.private_bytes(
        pem, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    with whole_file(path, is_private=True) as file:
        file.write(private + builder.sign(key, hashes.SHA256()).public_bytes(pem))


def _general_name(name: str) -> x509.GeneralName:
    from cryptography import x509

    try:
        return x509.IPAddress(ipaddress.ip_address(name))
    except ValueError:
        return x509.DNSName(name)


MOST_CONNECTIONS = 32
START_S = 5.0
CLOSE_S = 0.1  # for saying goodbye; then a connection is given up
HANDSHAKE_S = 5.0
AGAIN_S = 0.1
LINGER_S = 1.0  # for the rest of what is refused
IDLE_CONNECTION_S = 15.0


def page_urls(port: int, token: str, addresses: Iterable[str] | None = None) -> list[str]:
    """The links that open the page, the most likely one first.

    ``addresses`` are this computer's; those of its networks when None.
    """
    found = lan_addresses() if addresses is None else addresses
    return [f"https://{address}:{port}/{token}/" for address in found]


class PhonePage(Background):
    """The connector that serves a page on one port, for who has the token in the link.

    A token is made when the settings have none; ``folder`` is where the certificate is kept, this
    user's settings when it is None. Port 0 is any free one.
    """

    def __init__(self, settings: Settings, folder: Path | None = None) -> None:
        super().__init__()
        self.token = settings.token or new_token()
        self.certificate: Certificate | None = None
        self._settings, self._folder = settings, folder
        self._door: socket.socket | None = None
        self._is_ready = threading.Event()
        self._receiving = Receiving(self.put)

    @property
    def where(self) -> Text:
        """What the node is ready for; the link is told only where nobody else knows its token."""
        is_known = bool(self._settings.token)
        page = text_of("its page on port {port}", port=self.port)
        return text_of(
            "waits for a phone that opens {told} ({where})",
            told=page if is_known else self.urls[0],
            where=self._settings.where,
        )

    @property
    def missing(self) -> str:
        """What to check when no phone has come."""
        if self._settings.listen_on == "this computer":
            return (
                "No phone has come yet. Only this computer is let in: for a phone, set "
                "“listen on” to network."
            )
        return (
            "No phone has come yet. Is it in the same Wi-Fi as this computer, was the warning of "
            "the browser accepted, and does this computer's firewall let it in?"
        )

    @property
    def port(self) -> int:
        """The port that is served."""
        return self._settings.port

    @property
    def urls(self) -> list[str]:
        """The links to the page; on this computer only, that is one that works here."""
        return page_urls(self.port, self.token, self._addresses() or [LOOPBACK])

    @property
    def hand(self) -> str:
        """Where the followed phone is, as chosen on it: left, right, hand; empty: not known."""
        return self._receiving.hand

    def open(self) -> None:
        """Serve. Raises PortTaken, NodeStartError."""
        self._files, self.certificate = self._prepared()
        self._door = open_tcp(self._settings)
        self._settings = dataclasses.replace(self._settings, port=self._door.getsockname()[1])
        self.start()
        self._is_ready.wait(START_S)

    def _addresses(self) -> list[str]:
        return [] if self._settings.own_address == LOOPBACK else lan_addresses()

    def _prepared(self) -> tuple[PageFiles, Certificate]:
        try:
            return page_files(), own_certificate(self._addresses(), self._folder)
        except OSError as error:
            raise NodeStartError(
                "The page for the phone cannot be made: {reason}.",
                checklist=(
                    "Is there room on the disk, and may you write to your settings folder?",
                    "Install NEP Studio again.",
                ),
                details=str(error),
                reason=reason_of(error),
            ) from error

    async def _serve(self) -> None:
        assert self._door is not None
        try:
            async with self._serving(self._door) as connections:
                self._is_ready.set()
                await connections.let_in()
        finally:
            self._is_ready.set()
            self._door.close()

    @contextlib.asynccontextmanager
    async def _serving(self, door: socket.socket) -> AsyncIterator[_Connections]:
        from aiohttp import web

        assert self.certificate is not None
        runner = web.AppRunner(
            Site(self.token, self._files, self._receiving).app(),
            handle_signals=False,
            access_log=None,  # the links have the token in them
            keepalive_timeout=IDLE_CONNECTION_S,
            lingering_time=LINGER_S,
            shutdown_timeout=CLOSE_S,
        )
        await runner.setup()
        connections = _Connections(runner, door, self.certificate.context())
        try:
            yield connections
        finally:
            await connections.close()


class _Connections:
    """All connections to the page: not too many, and all closed in the end.

    They are let in one by one, as a server of asyncio would greet any number of callers at once,
    each with a buffer of its own.
    """

    def __init__(self, runner: web.AppRunner, door: socket.socket, safety: ssl.SSLContext) -> None:
        self._runner, self._door, self._safety = runner, door, safety
        self._coming: set[asyncio.Task[None]] = set()
        self._open: list[web.RequestHandler] = []

    async def let_in(self) -> None:
        """Let callers in, for ever; one that is too many is turned away at once."""
        loop = asyncio.get_running_loop()
        while True:
            try:
                caller, _address = await loop.sock_accept(self._door)
            except OSError:  # it has left already, or too many files are open
                await asyncio.sleep(AGAIN_S)
                continue
            if self._is_full:
                caller.close()
                continue
            greeting = loop.create_task(self._greet(caller))
            self._coming.add(greeting)
            greeting.add_done_callback(self._coming.discard)

    async def close(self) -> None:
        """End what is going on; those who do not say goodbye are not waited for."""
        for greeting in self._coming:
            greeting.cancel()
        await asyncio.gather(*self._coming, return_exceptions=True)
        transports = [one.transport for one in self._open]
        await self._runner.cleanup()
        for transport in filter(None, transports):
            transport.abort()
        if self._open:
            await asyncio.sleep(2 * CLOSE_S)

    @property
    def _is_full(self) -> bool:
        assert self._runner.server is not None
        there = len(self._runner.server.connections)
        return there >= MOST_CONNECTIONS or len(self._coming) >= MOST_CONNECTIONS

    async def _greet(self, caller: socket.socket) -> None:
        """Agree on TLS with a caller; who does not is left."""
        assert self._runner.server is not None
        handler = self._runner.server()
        try:
            await asyncio.get_running_loop().connect_accepted_socket(
                lambda: handler,
                caller,
                ssl=self._safety,
                ssl_handshake_timeout=HANDSHAKE_S,
                ssl_shutdown_timeout=CLOSE_S,
            )
        except OSError:
            caller.close()
            return
        self._open = [one for one in self._open if one.transport is not None] + [handler]

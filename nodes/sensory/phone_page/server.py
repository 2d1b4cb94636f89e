"""Serves the phone page by HTTPS from a thread of its own, while it is asked for."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import socket
import ssl
import threading
from collections.abc import AsyncIterator, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from nep_core.errors import NodeStartError
from nodes.sensory.addresses import lan_addresses
from nodes.sensory.phone_page.certificate import Certificate, own_certificate
from nodes.sensory.phone_page.page_files import PageFiles, page_files
from nodes.sensory.phone_page.receiving import Receiving
from nodes.sensory.phone_page.site import Site
from nodes.sensory.phone_page.token import new_token
from nodes.sensory.ways.background import Background
from nodes.sensory.ways.doors import open_tcp
from nodes.sensory.ways.way import Arrived, Settings

if TYPE_CHECKING:
    from aiohttp import web

LOOPBACK = "127.0.0.1"
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


class PhonePage:
    """The page on one port of this computer, for who has the token in the link.

    A token is made when the settings have none; ``folder`` is where the certificate is kept, this
    user's settings when it is None. Port 0 is any free one.
    """

    def __init__(self, settings: Settings, folder: Path | None = None) -> None:
        self.token = settings.token or new_token()
        self.certificate: Certificate | None = None
        self._settings, self._folder = settings, folder
        self._background: Background | None = None
        self._receiving: Receiving | None = None

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
        return "" if self._receiving is None else self._receiving.hand

    def start(self) -> str:
        """Serve; the first link. Raises PortTaken, NodeStartError."""
        files, self.certificate = self._prepared()
        door = open_tcp(self._settings)
        self._settings = dataclasses.replace(self._settings, port=door.getsockname()[1])
        ready = threading.Event()
        background = Background(lambda: self._serve(door, files, ready))
        self._receiving = Receiving(background.put)
        self._background = background
        background.start()
        ready.wait(START_S)
        return self.urls[0]

    def take(self, until_s: float = 0.0) -> list[Arrived]:
        """What has arrived up to then (``time.monotonic()``)."""
        return self._background.take(until_s) if self._background else []

    def stop(self) -> None:
        """Serve no more; also when it was never started."""
        if self._background is not None:
            self._background.stop()
        self._background = None

    def _addresses(self) -> list[str]:
        return [] if self._settings.own_address == LOOPBACK else lan_addresses()

    def _prepared(self) -> tuple[PageFiles, Certificate]:
        try:
            return page_files(), own_certificate(self._addresses(), self._folder)
        except OSError as error:
            raise NodeStartError(
                f"The page for the phone cannot be made: {error.strerror or error}.",
                checklist=(
                    "Is there room on the disk, and may you write to your settings folder?",
                    "Install NEP Studio again.",
                ),
                details=str(error),
            ) from error

    async def _serve(self, door: socket.socket, files: PageFiles, ready: threading.Event) -> None:
        try:
            async with self._serving(door, files) as connections:
                ready.set()
                await connections.let_in()
        finally:
            ready.set()
            door.close()

    @contextlib.asynccontextmanager
    async def _serving(self, door: socket.socket, files: PageFiles) -> AsyncIterator[_Connections]:
        from aiohttp import web

        assert self._receiving is not None and self.certificate is not None
        runner = web.AppRunner(
            Site(self.token, files, self._receiving).app(),
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

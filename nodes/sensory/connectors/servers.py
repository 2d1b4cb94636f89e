"""How senders come in: ports and addresses of this computer, and servers with threads."""

from __future__ import annotations

import asyncio
import ipaddress
import re
import socket
import threading
import time
from collections import deque
from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar

import psutil

from faults import Text, reason_of, text_of
from nep_core.errors import ParameterError, PortTaken

from .connector import Arrived, Settings

if TYPE_CHECKING:
    from aiohttp import web


# The addresses under which other devices of the network reach this computer.

_ANYWHERE = ("192.0.2.1", 9)  # nobody's (RFC 5737): nothing is sent, the system only chooses a way
_VIRTUAL = ("docker", "br-", "veth", "virbr", "vmnet", "vboxnet", "lxc", "tailscale", "utun", "wg")


def lan_addresses() -> list[str]:
    """The IPv4 addresses of this computer in its networks, the most likely one first.

    That is the one of the default route; then come home networks, then the rest. Addresses that
    only this computer has, and those of networks without a router, are left out.
    """
    statistics = psutil.net_if_stats()
    found = [
        (address.address, name)
        for name, addresses in psutil.net_if_addrs().items()
        if name not in statistics or statistics[name].isup
        for address in addresses
        if address.family == socket.AF_INET and _is_reachable(address.address)
    ]
    main = _main_address()
    return [address for address, _ in sorted(found, key=lambda it: (it[0] != main, *_rank(*it)))]


def _rank(address: str, interface: str) -> tuple[bool, bool]:
    is_virtual = interface.lower().startswith(_VIRTUAL)
    return is_virtual, not ipaddress.ip_address(address).is_private


def _is_reachable(address: str) -> bool:
    parsed = ipaddress.ip_address(address)
    return not (parsed.is_loopback or parsed.is_link_local or parsed.is_unspecified)


def _main_address() -> str:
    """Our address on the default route, empty where there is none."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_ANYWHERE)
            return str(probe.getsockname()[0])
        except OSError:
            return ""


LOOPBACK = "127.0.0.1"
_WAITING = 64  # callers that are not taken yet


def open_udp(settings: Settings) -> socket.socket:
    """A door for packets; raises PortTaken."""
    return _bound(socket.socket(socket.AF_INET, socket.SOCK_DGRAM), settings, "UDP")


def open_tcp(settings: Settings) -> socket.socket:
    """A door that connections come in by, not waiting; raises PortTaken."""
    door = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if hasattr(socket, "SO_EXCLUSIVEADDRUSE"):  # Windows lets two programs share a port otherwise
        door.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
    else:  # else the port would stay taken for a minute after the node ended
        door.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    _bound(door, settings, "TCP")
    door.listen(_WAITING)
    door.setblocking(False)
    return door


def own_addresses(settings: Settings) -> list[str]:
    """Where senders find this computer, the most likely address first."""
    if settings.listen_on == "this computer":
        return [LOOPBACK]
    return lan_addresses()[:3] or [LOOPBACK]


def missing_words(settings: Settings, app: str) -> Text:
    """What to check when nothing came to a door of this computer."""
    where = f"{' / '.join(own_addresses(settings))}, port {settings.port}"
    if settings.listen_on == "this computer":
        return text_of(
            "Nothing has arrived for 10 seconds. Only this computer is let in, at {where}: for a "
            "watch or phone, set “listen on” to network.",
            where=where,
        )
    return text_of(
        "Nothing has arrived for 10 seconds. Does {app} send to {where}, is it in the same "
        "network, and does this computer's firewall let it in?",
        app=app,
        where=where,
    )


def _bound(door: socket.socket, settings: Settings, kind: str) -> socket.socket:
    try:
        door.bind((settings.own_address, settings.port))
    except OSError as error:
        door.close()
        raise PortTaken(
            "{kind} port {port} cannot be opened: {reason}.",
            checklist=(
                "Does another program, or a second node like this one, use it? Stop that one.",
                "Choose another port than {port} here, and the same one in the watch.",
            ),
            kind=kind,
            port=settings.port,
            reason=reason_of(error),
        ) from error
    return door


# The address of a phone that a person typed or copied.

_ADDRESS = re.compile(r"(?:[a-z]+://)?([a-z0-9.-]+|\[[0-9a-f:.%]+\])(?::(\d{1,5}))?(?:/.*)?", re.I)


def phone_address(text: str, port: int, app: str) -> tuple[str, int]:
    """Host and port of "192.168.1.20", "192.168.1.20:8080" or "http://192.168.1.20:8080/".

    ``port`` is taken where the text has none. Raises ParameterError for anything else.
    """
    found = _ADDRESS.fullmatch(text.strip())
    if found is None or (found[2] and not 1 <= int(found[2]) <= 65_535):
        raise ParameterError(
            text_of("“{text}” is not the address of a phone.", text=text)
            if text.strip()
            else text_of("The address that {app} shows on the phone is missing.", app=app),
            checklist=(
                "Switch on the remote access or the server in {app}: it shows the address.",
                "Write it into “address”, such as 192.168.1.20:8080.",
                "Is the phone in the same wireless network as this computer?",
            ),
            app=app,
        )
    return found[1], int(found[2] or port)


# An asyncio program in a thread of its own, which hands what arrives over to the node.

_MOST_WAITING = 256  # arrivals that the node has not taken yet; the oldest go first
_ENOUGH = 64  # arrivals that are taken at once, without waiting for the end of a batch
_STOP_S = 0.9


class Background:
    """Runs ``_serve`` from ``start`` to ``close``; what it puts in comes out in batches.

    A connector with a thread of its own is one.
    """

    def __init__(self) -> None:
        self._arrived: deque[Arrived] = deque(maxlen=_MOST_WAITING)
        self._has_enough = threading.Event()
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[None] | None = None
        self._lost = 0
        self._is_stopped = False
        self._fault: BaseException | None = None

    async def _serve(self) -> None:
        """What is done in the thread, until it is cancelled."""
        raise NotImplementedError

    def start(self) -> None:
        """Start the thread; an error of ``_serve`` is raised by the next ``readings``."""
        self._is_stopped = False
        self._thread = threading.Thread(target=self._run, name="way", daemon=True)
        self._thread.start()

    def put(self, arrived: Arrived) -> None:
        """Hand over, from ``_serve``; the oldest is left out when nobody takes them."""
        if len(self._arrived) == _MOST_WAITING:
            self._lost += len(self._arrived[0].readings)
        self._arrived.append(arrived)
        if len(self._arrived) >= _ENOUGH:
            self._has_enough.set()

    def readings(self, until_s: float = 0.0) -> list[Arrived]:
        """What was put in up to then (``time.monotonic()``)."""
        self._has_enough.wait(max(0.0, until_s - time.monotonic()))
        if self._fault is not None:
            raise self._fault
        self._has_enough.clear()
        found: list[Arrived] = []
        while self._arrived:
            found.append(self._arrived.popleft())
        if self._lost and found:
            found[0] = replace(found[0], dropped=found[0].dropped + self._lost)
            self._lost = 0
        return found

    def close(self) -> None:
        """Cancel ``_serve``, if it runs, and wait for it, but not long."""
        if self._thread is None:
            return
        self._is_stopped = True  # a thread that has no task yet sees it before it serves
        loop, task = self._loop, self._task
        if loop is not None and task is not None and not loop.is_closed():
            loop.call_soon_threadsafe(task.cancel)
        self._thread.join(_STOP_S)
        self._thread = None

    def _run(self) -> None:
        try:
            asyncio.run(self._main())
        except asyncio.CancelledError:
            pass
        except BaseException as error:  # it must reach the node, whatever it is
            self._fault = error
            self._has_enough.set()

    async def _main(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._task = asyncio.current_task()
        if not self._is_stopped:
            await self._serve()


class OutboundConnector(Background):
    """Asks the ``app`` of a phone, and again when it was away."""

    app: ClassVar[str]

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        self._host, self._port = settings.address, settings.port

    def open(self) -> None:
        """Begin to ask; raises ParameterError for an address that is none."""
        settings = self._settings
        self._host, self._port = phone_address(settings.address, settings.port, self.app)
        self.start()

    @property
    def _place(self) -> dict[str, object]:
        """The values of the places that sentences about the phone have."""
        return {"host": self._host, "port": self._port}

    def _say(self, template: str, **values: object) -> None:
        """Tell of a trouble."""
        trouble = text_of(template, **self._place, **values)
        self.put(Arrived(self._host, arrived_s=time.monotonic(), trouble=trouble))


# A small HTTP server that nobody can fill: few connections, small bodies, short waits.

MOST_BODY_BYTES = 2_000_000
_MOST_CONNECTIONS = 24
_BODY_S = 10.0
_SHUT_S = 0.3


async def serve(
    door: socket.socket, answer: Callable[[web.Request], Awaitable[web.StreamResponse]]
) -> None:
    """Answer all requests that come in by the door, until cancelled."""
    from aiohttp import web

    app = web.Application(client_max_size=MOST_BODY_BYTES)
    app.router.add_route("*", "/{path:.*}", answer)
    runner = web.AppRunner(app, access_log=None, keepalive_timeout=30.0, shutdown_timeout=_SHUT_S)
    await runner.setup()
    loop = asyncio.get_running_loop()

    def connection() -> Any:
        """Those who only hold a connection make room for new ones, the oldest first."""
        assert runner.server is not None
        for old in runner.server.connections[: 1 - _MOST_CONNECTIONS]:
            old.force_close()
        return runner.server()

    server = await loop.create_server(connection, sock=door)
    try:
        await server.serve_forever()
    finally:
        server.close()
        await runner.cleanup()


async def body_of(request: web.Request) -> bytes | None:
    """The body, None when it is too large or too slow, or is not what its head says."""
    from aiohttp import web

    try:
        return await asyncio.wait_for(request.read(), _BODY_S)
    except (TimeoutError, ConnectionError, web.HTTPRequestEntityTooLarge, web.RequestPayloadError):
        return None

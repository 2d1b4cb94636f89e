"""An asyncio program in a thread of its own, which hands what arrives over to the node."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections import deque
from collections.abc import Awaitable, Callable, Coroutine
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from .connector import Arrived

if TYPE_CHECKING:
    from aiohttp import web


_MOST_WAITING = 256  # arrivals that the node has not taken yet; the oldest go first
_ENOUGH = 64  # arrivals that are taken at once, without waiting for the end of a batch
_STOP_S = 0.9


class Background:
    """Runs ``serve`` until it is stopped; what it puts in is taken out in batches."""

    def __init__(self, serve: Callable[[], Coroutine[Any, Any, None]]) -> None:
        self._serve = serve
        self._arrived: deque[Arrived] = deque(maxlen=_MOST_WAITING)
        self._has_enough = threading.Event()
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[None] | None = None
        self._lost = 0
        self._is_stopped = False
        self._fault: BaseException | None = None

    def start(self) -> None:
        """Start the thread; an error of ``serve`` is raised by the next ``take``."""
        self._is_stopped = False
        self._thread = threading.Thread(target=self._run, name="way", daemon=True)
        self._thread.start()

    def put(self, arrived: Arrived) -> None:
        """Hand over, from ``serve``; the oldest is left out when nobody takes them."""
        if len(self._arrived) == _MOST_WAITING:
            self._lost += len(self._arrived[0].readings)
        self._arrived.append(arrived)
        if len(self._arrived) >= _ENOUGH:
            self._has_enough.set()

    def take(self, until_s: float) -> list[Arrived]:
        """What was put in up to then."""
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

    def stop(self) -> None:
        """Cancel ``serve`` and wait for it, but not long."""
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
    """The body, None when it is too large or too slow."""
    from aiohttp import web

    try:
        return await asyncio.wait_for(request.read(), _BODY_S)
    except (TimeoutError, web.HTTPRequestEntityTooLarge):
        return None

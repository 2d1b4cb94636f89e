"""A small HTTP server that nobody can fill: few connections, small bodies, short waits."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Awaitable, Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from aiohttp import web

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

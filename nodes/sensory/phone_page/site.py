"""What the phone page's server answers, and which of the phones that have it open is followed.

Answers are the page, its files, and the two ways to send batches.
"""

from __future__ import annotations

import asyncio
import hmac
import html
import ipaddress
import itertools
import json
import logging
import math
import secrets
import time
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import msgspec

from faults import text_of
from nodes.resources import resource_folder
from nodes.sensory.connectors.connector import Arrived
from nodes.sensory.reading import Reading, Vector

if TYPE_CHECKING:
    from aiohttp import web

    _Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


# What the page sends: some samples, and how the phone is held.

MOST_BYTES = 65_536
MOST_SAMPLES = 512
_LARGEST = 1e4  # m/s² or rad/s; no phone in a hand means more

Hand = Literal["left", "hand", "right"]
Word = Annotated[str, msgspec.Meta(max_length=32)]
Times = Annotated[list[float], msgspec.Meta(max_length=MOST_SAMPLES)]
Vectors = Annotated[list[Vector], msgspec.Meta(max_length=MOST_SAMPLES)]


class PageMessage(msgspec.Struct, kw_only=True):
    """One message of the page as it is on the wire; no samples: the page is there, but rests."""

    id: Word
    t: Times
    acc: Vectors
    gyr: Vectors | None = None
    gravity: bool = True
    hand: Hand = "hand"
    device: Word = ""
    lost: Annotated[int, msgspec.Meta(ge=0, le=2**31)] = 0


def read_message(text: bytes | str) -> PageMessage:
    """The message, checked; raises ValueError with a reason when it is not one of our page."""
    try:
        message = _DECODER.decode(text)
    except RecursionError as error:
        raise ValueError("it is nested too deep") from error
    rows = [message.acc] if message.gyr is None else [message.acc, message.gyr]
    if any(len(vectors) != len(message.t) for vectors in rows):
        raise ValueError("times and values differ in number")
    values = itertools.chain(message.t, *itertools.chain.from_iterable(rows))
    if not all(map(math.isfinite, values)):
        raise ValueError("a value is not finite")
    flat = itertools.chain.from_iterable(itertools.chain.from_iterable(rows))
    if any(abs(value) > _LARGEST for value in flat):
        raise ValueError("a value is larger than any sensor's")
    return message


def readings_of(message: PageMessage) -> tuple[Reading, ...]:
    """The samples of a message, by the phone's own clock in seconds."""
    gyr: list[Vector] | list[None] = message.gyr or [None] * len(message.t)
    return tuple(
        Reading(acc, turn, stamp=t, stamp_unit_s=1.0, gravity_included=message.gravity)
        for t, acc, turn in zip(message.t, message.acc, gyr, strict=True)
    )


_DECODER = msgspec.json.Decoder(PageMessage)


# Which of several phones is followed, and how much each may send.

SILENT_S = 3.0
_MOST_SENDERS = 128


class Turn:
    """One phone is followed, until it leaves or is silent for some seconds; then the next."""

    def __init__(self) -> None:
        self._phone = ""
        self.heard_s = 0.0
        """When the phone that is followed sent something last."""

    def is_free_for(self, phone: str, now_s: float) -> bool:
        """Whether this phone is followed, or would be if it sent something now."""
        return self._phone in ("", phone) or now_s - self.heard_s >= SILENT_S

    def take(self, phone: str, now_s: float) -> bool:
        """Follow this phone, which sends samples, if it is free to; whether it is followed."""
        if not self.is_free_for(phone, now_s):
            return False
        self._phone, self.heard_s = phone, now_s
        return True

    def leave(self, phone: str, heard_s: float = math.inf) -> None:
        """The phone has closed a connection, by which it was followed last at ``heard_s``.

        Who was heard by another one since then has only changed its network.
        """
        if phone == self._phone and self.heard_s <= heard_s:
            self._phone = ""


class Allowance:
    """How much of something each sender may use: ``rate`` a second, and ``burst`` at once."""

    def __init__(self, rate: float, burst: float) -> None:
        self._rate, self._burst = rate, burst
        self._left: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def grants(self, sender: str, now_s: float, amount: float = 1.0) -> bool:
        """Whether the sender may use so much now; what is refused is not counted."""
        left, before_s = self._left.pop(sender, (self._burst, now_s))
        left = min(self._burst, left + (now_s - before_s) * self._rate)
        is_granted = amount <= left
        self._left[sender] = (left - amount if is_granted else left, now_s)
        while len(self._left) > _MOST_SENDERS:
            self._left.popitem(last=False)
        return is_granted


MESSAGES_S, MESSAGES_AT_ONCE = 60.0, 120.0
SAMPLES_S, SAMPLES_AT_ONCE = 500.0, 1500.0  # twice what the fastest phone sends
TOLD_EVERY_S = 5.0

FOLLOWED, BUSY = "followed", "busy"
"""What a phone is told: that its samples are used, or that another phone is followed."""


class Receiving:
    """``give`` gets each batch of the phone that is followed, and what the user should know."""

    def __init__(
        self, give: Callable[[Arrived], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._give, self._clock = give, clock
        self._turn = Turn()
        self._messages = Allowance(MESSAGES_S, MESSAGES_AT_ONCE)
        self._samples = Allowance(SAMPLES_S, SAMPLES_AT_ONCE)
        self._sentences = Allowance(1 / TOLD_EVERY_S, 1.0)
        self._followed = ""
        self.hand = ""
        """Where the followed phone is, as chosen on the page: left, right or hand."""

    def may_send(self, address: str) -> bool:
        """Whether a message of this address is still one of a page, and not of a flood."""
        return self._messages.grants(address, self._clock())

    def take(self, message: PageMessage, address: str) -> str:
        """Give a message on if it is its phone's turn; what the phone is told."""
        now_s = self._clock()
        if not message.t:
            return FOLLOWED if self._turn.is_free_for(message.id, now_s) else BUSY
        if not self._turn.take(message.id, now_s):
            if self._sentences.grants("", now_s):
                told = text_of(
                    "A second phone ({name}) has the page open; {followed} is followed.",
                    name=_name(message, address),
                    followed=self._followed,
                )
                self._give(Arrived(self._followed, arrived_s=now_s, trouble=told))
            return BUSY
        self._followed = _name(message, address)
        is_granted = self._samples.grants(address, now_s, len(message.t))
        self.hand = message.hand
        arrived = Arrived(
            sender=self._followed,
            readings=readings_of(message) if is_granted else (),
            arrived_s=now_s,
            dropped=message.lost + (0 if is_granted else len(message.t)),
        )
        self._give(arrived)
        return FOLLOWED

    @property
    def followed_s(self) -> float:
        """When something came last from the phone that is followed."""
        return self._turn.heard_s

    def leave(self, phone: str, followed_s: float) -> None:
        """A connection of a phone, its id, was closed; by it the phone was followed last then."""
        self._turn.leave(phone, followed_s)


def _name(message: PageMessage, address: str) -> str:
    return f"{message.device} {address}" if message.device.isalnum() else address


log = logging.getLogger(__name__)


# Who may talk to the phone page, and what its answers tell the browser about safety.

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


HANDSHAKE = ("Upgrade", "Connection", "Sec-WebSocket-Version", "Sec-WebSocket-Key")


def is_plain_handshake(given: Mapping[str, str]) -> bool:
    """Whether what a WebSocket begins with is ASCII.

    WORKAROUND: else aiohttp fails at it, or at telling what is wrong with it, and answers 500
    (aiohttp/web_ws.py, WebSocketResponse._handshake).
    """
    return all(given.get(name, "").isascii() for name in HANDSHAKE)


def _is_loopback(address: str) -> bool:
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


# The files of the phone page, and the page that refuses a wrong link.

TYPES = {
    ".css": "text/css",
    ".html": "text/html",
    ".js": "text/javascript",
    ".json": "application/json",
    ".svg": "image/svg+xml",
}
"""The media types of its files."""
NAMES = (
    *("index.html", "style.css", "page.js", "motion.js", "line.js", "graph.js"),
    *("words.json", "icon.svg"),
)
ENGLISH = "en"


@dataclass(frozen=True)
class PageFiles:
    """What is served: the text of each file by its name, and the texts by language."""

    texts: dict[str, str]
    words: dict[str, dict[str, str]]
    refusal: str

    def refused(self, accepted: str, nonce: str) -> str:
        """The page for a wrong link, in the first language of ``Accept-Language`` that we have."""
        language = self.language(accepted)
        told = {name: html.escape(text) for name, text in self.words[language].items()}
        return self.refusal.format(
            language=language, nonce=nonce, style=self.texts["style.css"], **told
        )

    def language(self, accepted: str) -> str:
        """The best language for an ``Accept-Language`` header, which lists them by preference."""
        wanted = [part.strip().split(";")[0][:2].lower() for part in accepted.split(",")]
        return next((name for name in wanted if name in self.words), ENGLISH)


def page_files(folder: Path | None = None) -> PageFiles:
    """Read the page. Raises OSError when a file is not there."""
    folder = folder or resource_folder() / "phone_page"
    texts = {name: (folder / name).read_text(encoding="utf-8") for name in NAMES}
    refusal = (folder / "refused.html").read_text(encoding="utf-8")
    return PageFiles(texts, json.loads(texts["words.json"]), refusal)


# The secret part of the link that the QR code shows.

TOKEN_BYTES = 9
"""12 letters in the link: nobody guesses it, and the QR code stays coarse enough to scan."""


def new_token() -> str:
    """A token that nobody can guess, of letters that a link may have."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def is_token(given: str, wanted: str) -> bool:
    """Whether it is the token; takes the same time for every wrong one."""
    return bool(wanted) and hmac.compare_digest(given.encode(), wanted.encode())


IDLE_S = 10.0  # a page says each second that it is there
ANSWER_S = 1.0
READ_S = 5.0  # for one batch
REQUESTS_S, REQUESTS_AT_ONCE = 60.0, 200.0
UNREADABLE, TOO_MUCH = 1007, 1008  # reasons for closing a WebSocket (RFC 6455)


class Site:
    """Serves the page to those who have the token; ``receiving`` gets what the page sends."""

    def __init__(self, token: str, files: PageFiles, receiving: Receiving) -> None:
        self._token, self._files, self._receiving = token, files, receiving
        self._requests = Allowance(REQUESTS_S, REQUESTS_AT_ONCE)

    def app(self) -> web.Application:
        """The application for aiohttp."""
        from aiohttp import web

        @web.middleware
        async def guard(request: web.Request, handler: _Handler) -> web.StreamResponse:
            return await self._guard(request, handler)

        app = web.Application(client_max_size=MOST_BYTES, middlewares=[guard])
        app.router.add_get("/{token}", self._home)
        app.router.add_get("/{token}/alive", self._alive)
        app.router.add_get("/{token}/motion", self._motion)
        app.router.add_post("/{token}/batch", self._batch)
        app.router.add_get("/{token}/{name:[a-z.]*}", self._file)
        app.on_response_prepare.append(_protect)
        return app

    async def _guard(self, request: web.Request, handler: _Handler) -> web.StreamResponse:
        """Lets only those through who ask for our address with the token, and not too often."""
        from aiohttp import web

        own = request.transport.get_extra_info("sockname") if request.transport else None
        if own is None or not is_our_host(request.host, own[:2]):
            return _text(403, "Open the link that NEP Studio shows.")
        if not self._requests.grants(request.remote or "", time.monotonic()):
            return _text(429, "Too many requests. Wait a moment.")
        if not is_token(request.path.strip("/").partition("/")[0], self._token):
            return self._refuse(request)
        try:
            return await handler(request)
        except web.HTTPException as error:
            return _text(error.status, error.reason)

    def _refuse(self, request: web.Request) -> web.Response:
        from aiohttp import web

        nonce = secrets.token_urlsafe(16)
        page = self._files.refused(request.headers.get("Accept-Language", ""), nonce)
        own = headers(request.host, nonce)
        return web.Response(status=403, text=page, content_type="text/html", headers=own)

    async def _home(self, request: web.Request) -> web.Response:
        """The page's other files are beside it: its address must end with a slash."""
        from aiohttp import web

        return web.Response(status=308, headers={"Location": f"/{self._token}/"})

    async def _alive(self, request: web.Request) -> web.Response:
        return _text(200, "")

    async def _file(self, request: web.Request) -> web.Response:
        name = request.match_info["name"] or "index.html"
        if name not in self._files.texts:
            return _text(404, "There is no such page.")
        return _text(200, self._files.texts[name], TYPES[Path(name).suffix])

    async def _batch(self, request: web.Request) -> web.Response:
        """One batch by POST, for phones that refuse WebSockets to a certificate of our own."""
        from aiohttp import web

        address = request.remote or ""
        if not is_our_origin(request.headers, request.host):
            return _text(403, "Only the page itself may send.")
        if not self._receiving.may_send(address):
            return _text(429, "Too many messages.")
        try:
            async with asyncio.timeout(READ_S):
                message = read_message(await request.read())
        except (TimeoutError, ConnectionError, web.RequestPayloadError):
            return _text(408, "The batch did not arrive.")
        except ValueError as error:
            return _text(400, f"This is no batch of the page: {error}")
        return _text(200, _answer(self._receiving.take(message, address)), "application/json")

    async def _motion(self, request: web.Request) -> web.StreamResponse:
        """Batches by WebSocket, until the phone leaves, is silent too long, or sends rubbish."""
        from aiohttp import web

        if not is_our_origin(request.headers, request.host):
            return _text(403, "Only the page itself may send.")
        socket = web.WebSocketResponse(
            max_msg_size=MOST_BYTES, compress=False, receive_timeout=IDLE_S, timeout=1.0
        )
        if not is_plain_handshake(request.headers) or not socket.can_prepare(request):
            return _text(400, "The page itself uses this.")
        try:
            await socket.prepare(request)
        except ConnectionError:
            return _text(408, "The phone has left.")
        talk = _Talk(self._receiving, socket, request.remote or "")
        try:
            await talk.go_on()
        finally:
            self._receiving.leave(talk.phone, talk.followed_s)
        return socket


class _Talk:
    """What one page says on its WebSocket, and what it is told."""

    def __init__(self, receiving: Receiving, socket: web.WebSocketResponse, address: str) -> None:
        self._receiving, self._socket, self._address = receiving, socket, address
        self.phone = ""
        self.followed_s = 0.0
        self._answered, self._answered_s = "", 0.0

    async def go_on(self) -> None:
        """Hear and answer until the end of the talk."""
        from aiohttp import WSMsgType

        try:
            async for message in self._socket:
                if not self._receiving.may_send(self._address):
                    await self._socket.close(code=TOO_MUCH)
                elif message.type is WSMsgType.TEXT:
                    await self._hear(message.data)
                else:
                    await self._socket.close(code=UNREADABLE)
        except (TimeoutError, ConnectionError):
            await self._socket.close()

    async def _hear(self, text: str) -> None:
        try:
            message = read_message(text)
        except ValueError as error:
            log.info("A batch of %s cannot be read: %s", self._address, error)
            await self._socket.close(code=UNREADABLE)
            return
        self.phone = message.id
        state, now_s = self._receiving.take(message, self._address), time.monotonic()
        if state == FOLLOWED and message.t:
            self.followed_s = self._receiving.followed_s
        if state != self._answered or now_s - self._answered_s >= ANSWER_S:
            self._answered, self._answered_s = state, now_s
            await self._socket.send_str(_answer(state))


async def _protect(request: web.Request, response: web.StreamResponse) -> None:
    """Give every answer the headers of safety, unless it has its own."""
    for name, value in headers(request.host).items():
        response.headers.setdefault(name, value)
    response.headers["Server"] = SERVER


def _answer(state: str) -> str:
    return json.dumps({"state": state})


def _text(status: int, text: str, kind: str = "text/plain") -> web.Response:
    from aiohttp import web

    return web.Response(status=status, text=text, content_type=kind)

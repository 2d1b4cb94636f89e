"""Listens for NAOqi programs and lets them use services."""

from __future__ import annotations

import contextlib
import hmac
import itertools
import logging
import socket
import ssl
import threading
from collections.abc import Mapping
from typing import Any

from faults import Words, text_of
from robots.errors import PortTaken
from robots.naoqi.wire.codec import Reader, encode, read_value, reader_of
from robots.naoqi.wire.errors import BadFrame, NaoqiError
from robots.naoqi.wire.frames import (
    AUTHENTICATE,
    CAPABILITIES,
    DONE,
    STATE,
    TOKEN,
    USER,
    Frame,
    Kind,
    Login,
    TlsFiles,
)
from robots.naoqi.wire.line import Line, wait_for
from robots.naoqi.wire.peer import MAIN, Answering, Peer
from robots.naoqi.wire.service import BLOCKING

from .directory import Entry, ServiceDirectory, Visitor

log = logging.getLogger(__name__)


# Lets clients in: answers their first words, and nothing else before they are known.


class Doorkeeper:
    """Stands before one connection. ``knows_authenticate`` False plays a robot of 2013."""

    def __init__(self, peer: Peer, login: Login | None, *, knows_authenticate: bool) -> None:
        self._peer = peer
        self._login = login
        self._knows_authenticate = knows_authenticate
        self._is_greeted = False

    def lets_pass(self, frame: Frame) -> bool:
        """Whether a frame is for the services; what is for the door is answered here."""
        is_call = frame.kind == Kind.CALL and frame.service == 0 and frame.object == 0
        if is_call and frame.action == AUTHENTICATE and self._knows_authenticate:
            self._authenticate(frame)
            return False
        if self._login is not None:
            self._refuse(frame, "Expected authentication.")
            return False
        if frame.kind == Kind.CAPABILITY:
            self._peer.take_capabilities(frame)
            self._greet()
            return False
        if not is_call:
            self._greet()
            self._peer.gate = None
        return True

    def _authenticate(self, frame: Frame) -> None:
        try:
            said = read_value(reader_of("{sm}"), Reader(frame.payload))
        except BadFrame as problem:
            self._refuse(
                frame, text_of("Authentication failed: {sentence}", sentence=problem.sentence)
            )
            return
        if not self._is_right(said):
            self._refuse(frame, "Authentication failed: user or token is wrong.")
            return
        self._peer.capabilities = said
        self._peer.gate = None
        answer = encode("{sm}", CAPABILITIES | {STATE: DONE})
        self._peer.answer(frame.answer(Kind.REPLY, answer))

    def _is_right(self, said: dict[str, Any]) -> bool:
        if self._login is None:
            return True
        given = (said.get(USER), said.get(TOKEN))
        wanted = (self._login.user, self._login.password)
        return all(
            isinstance(one, str) and hmac.compare_digest(one.encode(), right.encode())
            for one, right in zip(given, wanted, strict=True)
        )

    def _refuse(self, frame: Frame, text: Words) -> None:
        self._peer.answer(frame.answer(Kind.ERROR, encode("m", text)))
        self._peer.close()

    def _greet(self) -> None:
        if not self._is_greeted:
            self._is_greeted = True
            payload = encode("{sm}", CAPABILITIES)
            self._peer.answer(Frame(Kind.CAPABILITY, 0, 0, 0, 0, payload))


HANDSHAKE_S = 5.0
LISTEN_S = 0.5
MOST_CLIENTS = 128
_numbers = itertools.count(1)


class Server:
    """A robot for NAOqi programs; one thread for each that is connected.

    ``port`` 0 takes any that is free. ``knows_authenticate`` False plays a robot of 2013.
    """

    def __init__(
        self,
        services: Mapping[str, object],
        *,
        host: str = "127.0.0.1",
        port: int = 9559,
        login: Login | None = None,
        tls_files: TlsFiles | None = None,
        knows_authenticate: bool = True,
    ) -> None:
        self._host = host
        self._wanted_port = port
        self._login = login
        self._tls_files = tls_files
        self._knows_authenticate = knows_authenticate
        self._listener: socket.socket | None = None
        self._lock = threading.Lock()
        self._peers: set[Peer] = set()
        self._visitors: dict[int, Visitor] = {}
        self._directory = ServiceDirectory(self._endpoints)
        self._directory.offer("ServiceDirectory", self._directory)
        self._directory.when_ready = self._meet
        for name, service in services.items():
            self._directory.offer(name, service)

    @property
    def port(self) -> int:
        """The port that this listens at; 0 when it does not."""
        return self._listener.getsockname()[1] if self._listener is not None else 0

    @property
    def clients(self) -> int:
        """How many programs are connected."""
        return len(self._peers)

    def start(self) -> int:
        """Listen; return the port. Raises PortTaken, OSError (certificate files)."""
        context = None
        if self._tls_files is not None:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(self._tls_files.certificate, self._tls_files.key)
        self._listener = self._listen()
        threading.Thread(
            target=self._accept, args=(self._listener, context), name="naoqi-accept", daemon=True
        ).start()
        return self.port

    def stop(self) -> None:
        """End all connections and listen no more."""
        listener, self._listener = self._listener, None
        if listener is not None:
            with contextlib.suppress(OSError):
                listener.shutdown(socket.SHUT_RDWR)
            listener.close()
        with self._lock:
            peers = list(self._peers)
        for peer in peers:
            peer.close()

    def register(self, name: str, service: object) -> int:
        """Add a service; its number. Raises CallFailed when the name is taken."""
        return self._directory.offer(name, service)

    def unregister(self, name: str) -> None:
        """Take a service away."""
        self._directory.remove(name)

    def tell(self, name: str, method: str, *values: Any) -> bool:
        """Call a method of a service without waiting, also of one that a client offers.

        False when there is no such service. This is how ALMemory calls modules back.
        """
        entry = self._directory.named(name)
        if entry is None:
            return False
        if entry.bound is not None:
            bound = entry.bound
            BLOCKING.add(lambda: bound.call(method, values))
            return True
        visitor = self._visitors.get(entry.number)
        if visitor is None:
            return False
        visitor.tell(method, values)
        return True

    def _listen(self) -> socket.socket:
        family = socket.AF_INET6 if ":" in self._host else socket.AF_INET
        listener = socket.socket(family, socket.SOCK_STREAM)
        if hasattr(socket, "SO_EXCLUSIVEADDRUSE"):
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
        else:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind((self._host, self._wanted_port))
            listener.listen(64)
        except OSError as problem:
            listener.close()
            raise PortTaken(
                "Port {wanted_port} of this computer is used by another program.",
                checklist=(
                    "Is another simulated NAO running? Close it, or Choregraphe's virtual robot.",
                    "Choose another port.",
                ),
                details=str(problem),
                wanted_port=self._wanted_port,
            ) from problem
        return listener

    def _accept(self, listener: socket.socket, context: ssl.SSLContext | None) -> None:
        while self._listener is listener:
            try:
                if not wait_for(listener, writing=False, timeout_s=LISTEN_S):
                    continue  # closing does not wake this thread on every system
                connected, _ = listener.accept()
            except (OSError, ValueError):
                return
            if len(self._peers) >= MOST_CLIENTS:
                connected.close()
                continue
            number = next(_numbers)
            threading.Thread(
                target=self._serve,
                args=(connected, context, number),
                name=f"naoqi-server-{number}",
                daemon=True,
            ).start()

    def _serve(self, connected: socket.socket, context: ssl.SSLContext | None, number: int) -> None:
        """One connection, from its first word to its last."""
        if context is not None:
            connected.settimeout(HANDSHAKE_S)
            try:
                connected = context.wrap_socket(connected, server_side=True)
            except (OSError, ValueError) as problem:
                log.info("a client did not encrypt: %s", problem)
                connected.close()
                return
        peer = Peer(Line(connected), name=f"naoqi-server-{number}", is_server=True)
        peer.find = self._bound
        keeper = Doorkeeper(peer, self._login, knows_authenticate=self._knows_authenticate)
        peer.gate = keeper.lets_pass
        with self._lock:
            self._peers.add(peer)
        if self._listener is None:
            peer.close()
        peer.run()
        with self._lock:
            self._peers.discard(peer)
        self._part(peer)

    def _bound(self, number: int, thing: int) -> Answering | None:
        entry = self._directory.entry(number)
        if entry is None or (entry.bound is not None and thing != MAIN):
            return None
        return entry.bound or self._visitors.get(number)

    def _meet(self, entry: Entry) -> None:
        """A client offers a service: learn what it can do."""
        if entry.peer is not None:
            with contextlib.suppress(NaoqiError):
                self._visitors[entry.number] = Visitor(entry.peer, entry.number)

    def _part(self, peer: Peer) -> None:
        """A client is gone."""
        self._directory.forget(peer)
        for number, visitor in list(self._visitors.items()):
            if visitor.peer is peer:
                del self._visitors[number]
            else:
                visitor.leave(peer)
        for entry in self._directory.here():
            entry.leave(peer)

    def _endpoints(self, peer: Peer | None) -> list[str]:
        """Return the addresses under which a client reaches this server: the way it came."""
        scheme = "tcps" if self._tls_files is not None else "tcp"
        host, port = (self._host, self.port) if peer is None else peer.line.local_address
        return [f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"]

"""Listens for NAOqi programs and lets them use services; the first service is the directory.

The directory tells which services there are, where they are, who offers them.
"""

from __future__ import annotations

import contextlib
import functools
import hmac
import itertools
import logging
import os
import socket
import ssl
import threading
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from faults import Text, Words, text_of
from robots.errors import PortTaken
from robots.naoqi.wire.codec import Reader, encode, read_value, reader_of
from robots.naoqi.wire.errors import BadFrame, CallFailed, ConnectionLost, NaoqiError
from robots.naoqi.wire.line import (
    AUTHENTICATE,
    CAPABILITIES,
    DONE,
    REASON,
    STATE,
    TOKEN,
    USER,
    Frame,
    Kind,
    Line,
    Login,
    TlsFiles,
    wait_for,
)
from robots.naoqi.wire.metaobject import META_OBJECT, MetaObject
from robots.naoqi.wire.peer import MAIN, Answering, Peer
from robots.naoqi.wire.promise import Pending
from robots.naoqi.wire.remote import RemoteObject
from robots.naoqi.wire.service import (
    BLOCKING,
    META,
    REGISTER,
    REGISTER_AS,
    UNREGISTER,
    Bound,
    caller,
    method,
    signal,
)

log = logging.getLogger(__name__)


INFORMATION = (
    "(sIsI[s]ss)<ServiceInfo,name,serviceId,machineId,processId,endpoints,sessionId,objectUid>"
)
MACHINE = str(uuid.UUID(int=uuid.getnode()))


@dataclass(frozen=True)
class Entry:
    """One service: as it is told, and either here or offered by a client."""

    name: str
    number: int
    machine: str = MACHINE
    process: int = 0
    endpoints: tuple[str, ...] = ()
    session: str = "0"
    bound: Bound | None = None
    peer: Peer | None = None
    is_ready: bool = True


class ServiceDirectory:
    """The directory of a robot's services."""

    added = signal("serviceAdded::(Is)", uid=106)
    removed = signal("serviceRemoved::(Is)", uid=107)

    def __init__(self, endpoints: Callable[[Peer | None], list[str]]) -> None:
        self._endpoints = endpoints
        self._numbers = itertools.count(1)
        self._lock = threading.RLock()
        self._entries: dict[int, Entry] = {}
        self.when_ready: Callable[[Entry], None] = lambda entry: None

    def offer(self, name: str, thing: object) -> int:
        """Add a service of this program. Raises CallFailed when the name is taken."""
        with self._lock:
            self._check_free(name)
            number = next(self._numbers)
            bound = Bound(thing, number)
            self._entries[number] = Entry(name, number, process=os.getpid(), bound=bound)
        self.added.emit(number, name)
        return number

    def entry(self, number: int) -> Entry | None:
        """Return a service by its number."""
        return self._entries.get(number)

    def named(self, name: str) -> Entry | None:
        """Return a service that is ready, by its name."""
        entries = list(self._entries.values())
        return next((it for it in entries if it.name == name and it.is_ready), None)

    def here(self) -> list[Bound]:
        """Return the services of this program."""
        return [entry.bound for entry in list(self._entries.values()) if entry.bound is not None]

    def forget(self, peer: Peer) -> None:
        """A client is gone, and its services with it."""
        for number, entry in list(self._entries.items()):
            if entry.peer is peer:
                self._remove(number)

    @method(f"service::{INFORMATION}(s)", uid=100)
    def service(self, name: str) -> Any:
        """Return where a service is. Raises CallFailed."""
        entry = self.named(name)
        if entry is None:
            raise CallFailed("Cannot find service '{name}' in index", name=name)
        return self._told(entry)

    @method(f"services::[{INFORMATION}]()", uid=101)
    def services(self) -> list[Any]:
        """Return all services that are ready."""
        return [self._told(entry) for entry in list(self._entries.values()) if entry.is_ready]

    @method(f"registerService::I({INFORMATION})", uid=102)
    def register(self, told: Any) -> int:
        """Begin to offer a service of a client; its number."""
        name, _, machine, process, endpoints, session, _ = told
        with self._lock:
            self._check_free(name)
            number = next(self._numbers)
            self._entries[number] = Entry(
                name,
                number,
                machine,
                process,
                tuple(endpoints),
                session,
                peer=caller(),
                is_ready=False,
            )
        return number

    @method("unregisterService::v(I)", uid=103)
    def unregister(self, number: int) -> None:
        """A client takes its service back."""
        entry = self._entries.get(number)
        if entry is None or entry.peer is None or entry.peer is not caller():
            raise CallFailed("Unregister Service: Can't find service #{number}", number=number)
        self._remove(number)

    @method("serviceReady::v(I)", uid=104)
    def ready(self, number: int) -> None:
        """A client can be asked now."""
        with self._lock:
            entry = self._entries.get(number)
            if entry is None or entry.is_ready:
                raise CallFailed("Can't find pending service #{number}", number=number)
            entry = self._entries[number] = replace(entry, is_ready=True)
        self.when_ready(entry)
        self.added.emit(number, entry.name)

    @method(f"updateServiceInfo::v({INFORMATION})", uid=105)
    def update(self, told: Any) -> None:
        """A client has moved."""
        _, number, machine, process, endpoints, session, _ = told
        entry = self._entries.get(number)
        if entry is None or entry.peer is not caller():
            raise CallFailed("updateServiceInfo: Can't find service #{number}", number=number)
        self._entries[number] = replace(
            entry, machine=machine, process=process, endpoints=tuple(endpoints), session=session
        )

    @method("machineId::s()", uid=108)
    def machine_id(self) -> str:
        """Return what tells this computer from others."""
        return MACHINE

    def remove(self, name: str) -> None:
        """Take a service of this program away."""
        entry = self.named(name)
        if entry is not None:
            self._remove(entry.number)

    def _remove(self, number: int) -> None:
        entry = self._entries.pop(number, None)
        if entry is not None and entry.is_ready:
            self.removed.emit(number, entry.name)

    def _told(self, entry: Entry) -> tuple[Any, ...]:
        is_here = entry.bound is not None or not entry.endpoints
        endpoints = self._endpoints(caller()) if is_here else list(entry.endpoints)
        return (
            entry.name,
            entry.number,
            entry.machine,
            entry.process,
            endpoints,
            entry.session,
            "",
        )

    def _check_free(self, name: str) -> None:
        entries = list(self._entries.values())
        taken = next((it for it in entries if it.name == name), None)
        if taken is not None:
            raise CallFailed(
                'Service "{name}" (#{number}) is already registered. Rejecting conflicting '
                "registration attempt.",
                name=name,
                number=taken.number,
            )


# A service that a client offers over its connection: this server calls it, others through it.


class Visitor:
    """One service of a client. Its own description is asked for early, without waiting."""

    def __init__(self, peer: Peer, number: int) -> None:
        self.peer = peer
        self.number = number
        self._asked = self._ask_for_meta()
        self._links: dict[tuple[Peer, int], int] = {}

    def _ask_for_meta(self) -> Pending:
        payload = encode("(I)", (MAIN,))
        return self.peer.begin(self.number, MAIN, META, payload, reader_of(META_OBJECT))

    def tell(self, method: str, values: tuple[Any, ...], attempts: int = 3) -> None:
        """Call a method without waiting for its end.

        A program of libqi says that its service is ready a moment before it answers for it ("The
        call request could not be handled."), so what could not be described is asked for again.
        """

        def post(asked: Pending) -> None:
            try:
                meta = MetaObject.from_wire(asked.result(0.0))
                RemoteObject(self.peer, meta, self.number).post(method, *values)
            except NaoqiError as problem:
                if isinstance(problem, CallFailed) and attempts > 1:
                    self.tell(method, values, attempts - 1)
                else:
                    log.warning("%s could not be called: %s", method, problem.sentence)

        with contextlib.suppress(ConnectionLost):  # who has gone need not be called
            if self._asked.failure is not None:
                self._asked = self._ask_for_meta()
            self._asked.when_done(post)

    def take(self, frame: Frame, peer: Peer) -> None:
        """Pass a call of another client on, and the answer back, both as they are."""
        is_listening = frame.action in (REGISTER, REGISTER_AS, UNREGISTER)
        if is_listening and frame.kind == Kind.CALL and frame.object == MAIN:
            self._take_listening(frame, peer)
            return
        if frame.kind == Kind.POST:
            self.peer.post(frame.service, frame.object, frame.action, frame.payload)
            return
        try:
            pending = self.peer.begin(
                frame.service, frame.object, frame.action, frame.payload, _all_bytes, frame.flags
            )
        except ConnectionLost as problem:
            peer.answer_error(frame, problem.sentence)
            return
        peer.answer_later(
            frame, pending, lambda value: peer.answer(frame.answer(Kind.REPLY, value))
        )

    def leave(self, peer: Peer) -> None:
        """A client that listened is gone."""
        for key in [key for key in list(self._links) if key[0] is peer]:
            self._end(key)

    def _take_listening(self, frame: Frame, peer: Peer) -> None:
        """Listen once for all who want to hear a signal of this service, or no more."""
        try:
            _, uid, link = read_value(reader_of("(IIL)"), Reader(frame.payload))
            if frame.action == UNREGISTER:
                self._end((peer, link))
                peer.answer(frame.answer(Kind.REPLY))
                return
            is_first = uid not in list(self._links.values())
            self._links[peer, link] = uid
            if is_first:
                self.peer.hearing[self.number, MAIN, uid] = _Passing(self._links, uid)
                self._ask(REGISTER, uid)
            peer.answer(frame.answer(Kind.REPLY, encode("L", link)))
        except NaoqiError as problem:
            peer.answer_error(frame, problem.sentence)

    def _end(self, key: tuple[Peer, int]) -> None:
        uid = self._links.pop(key, None)
        if uid is not None and uid not in list(self._links.values()):
            self.peer.hearing.pop((self.number, MAIN, uid), None)
            with contextlib.suppress(ConnectionLost):
                self._ask(UNREGISTER, uid)

    def _ask(self, action: int, uid: int) -> None:
        payload = encode("(IIL)", (MAIN, uid, uid))
        self.peer.begin(self.number, MAIN, action, payload, _all_bytes)


class _Passing:
    """Passes the events of one signal on to the clients that listen."""

    def __init__(self, links: dict[tuple[Peer, int], int], uid: int) -> None:
        self._links = links
        self._uid = uid

    def take(self, frame: Frame) -> None:
        for peer, link in list(self._links):
            if self._links.get((peer, link)) == self._uid:
                peer.answer(frame)


def _all_bytes(reader: Reader) -> bytes:
    return reader.data


# Listens for NAOqi programs and lets them use services.

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


def _turn_back(peer: Peer, why: Text, frame: Frame) -> bool:
    """Answer a call by why it is not done, and end the connection; let nothing pass.

    To let somebody in is one call, to ask for something is the next: of the error of the first the
    official client tells “disconnected”, of that of the second its words.
    """
    if frame.kind == Kind.CALL and (frame.service, frame.action) == (0, AUTHENTICATE):
        said = CAPABILITIES | {STATE: DONE, REASON: str(why)}
        peer.answer(frame.answer(Kind.REPLY, encode("{sm}", said)))
    elif frame.kind == Kind.CALL:
        peer.answer_error(frame, why)
        goodbye = threading.Timer(GOODBYE_S, peer.close)  # who sees the end first tells that alone
        goodbye.daemon = True
        goodbye.start()
    return False


def _line(connected: socket.socket, context: ssl.SSLContext | None) -> Line | None:
    """Return the line of a connection, encrypted if it is to be; None if it could not be."""
    if context is None:
        return Line(connected)
    connected.settimeout(HANDSHAKE_S)
    try:
        return Line(context.wrap_socket(connected, server_side=True))
    except (OSError, ValueError) as problem:
        log.info("a client did not encrypt: %s", problem)
        connected.close()
        return None


HANDSHAKE_S = 5.0
GOODBYE_S = 1.0
LISTEN_S = 0.5
MOST_CLIENTS = 128
MOST_TURNED_AWAY = 16
"""So many more are told at the same time that there is no room; others are only closed."""
NO_ROOM = (
    "There is no room for another program: {most} are connected to this robot. Close programs that "
    "are not needed, then try again."
)
_numbers = itertools.count(1)


class Server:
    """A robot for NAOqi programs; one thread for each that is connected.

    ``port`` 0 takes any that is free. ``knows_authenticate`` False plays a robot of 2013.

    ``services`` are what it offers, by name; ``host`` is the address that it binds; ``login``
    is who may enter (None: everybody); ``tls_files`` encrypt it.
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
        self._turning_away = threading.BoundedSemaphore(MOST_TURNED_AWAY)
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
            is_full = len(self._peers) >= MOST_CLIENTS
            if is_full and not self._turning_away.acquire(blocking=False):
                connected.close()
                continue
            number = next(_numbers)
            threading.Thread(
                target=self._turn_away if is_full else self._serve,
                args=(connected, context, number),
                name=f"naoqi-server-{number}",
                daemon=True,
            ).start()

    def _serve(self, connected: socket.socket, context: ssl.SSLContext | None, number: int) -> None:
        """One connection, from its first word to its last."""
        line = _line(connected, context)
        if line is None:
            return
        peer = Peer(line, name=f"naoqi-server-{number}", is_server=True)
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
        # A client is gone
        self._directory.forget(peer)
        for number, visitor in list(self._visitors.items()):
            if visitor.peer is peer:
                del self._visitors[number]
            else:
                visitor.leave(peer)
        for entry in self._directory.here():
            entry.leave(peer)

    def _turn_away(
        self, connected: socket.socket, context: ssl.SSLContext | None, number: int
    ) -> None:
        """Tell a client that is one too many why it cannot stay, when it says its first words."""
        try:
            line = _line(connected, context)
            if line is None:
                return
            peer = Peer(line, name=f"naoqi-server-{number}", is_server=True)
            peer.gate = functools.partial(_turn_back, peer, text_of(NO_ROOM, most=MOST_CLIENTS))
            silent = threading.Timer(HANDSHAKE_S, peer.close)
            silent.daemon = True
            silent.start()
            peer.run()
            silent.cancel()
        finally:
            self._turning_away.release()

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

    def _endpoints(self, peer: Peer | None) -> list[str]:
        """Return the addresses under which a client reaches this server: the way it came."""
        scheme = "tcps" if self._tls_files is not None else "tcp"
        host, port = (self._host, self.port) if peer is None else peer.line.local_address
        return [f"{scheme}://[{host}]:{port}" if ":" in host else f"{scheme}://{host}:{port}"]

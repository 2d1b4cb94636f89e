"""One connection to a NAOqi robot, which can be made again when it was lost."""

from __future__ import annotations

import itertools
import ssl
import threading
import time
from collections.abc import Callable

from robots.naoqi.wire.errors import (
    BadFrame,
    CallFailed,
    ConnectionLost,
    NaoqiError,
    NeedsTls,
    NoAnswer,
    NoSuchService,
    NoTls,
    NotNaoqi,
    StrangeCertificate,
)
from robots.naoqi.wire.frames import Login
from robots.naoqi.wire.line import Line
from robots.naoqi.wire.peer import MAIN, Peer
from robots.naoqi.wire.remote import PATIENCE_S, RemoteObject
from robots.naoqi.wire.service import Bound

from .reaching import (
    DIRECTORY,
    WRONG_PORT,
    Place,
    best_place,
    encrypt,
    enter,
    fingerprint_of,
    object_of,
    own_information,
    place_of,
    reach,
    speaks_tls,
)

TLS_PORT = 9503
_numbers = itertools.count(1)


class Session:
    """One connection to a robot; safe to use from any thread.

    ``tls`` None means: as the robot has it, encrypted first when there is a ``login``. ``trusted``
    is the fingerprint that an encrypted robot must have, None for any; ``fingerprint`` tells it
    after connecting. ``on_lost`` is called once for each connection that is lost, from a thread,
    with a sentence; not after ``close``. Services, objects and signals belong to one connection:
    ask for them again after connecting again.
    """

    def __init__(
        self,
        address: tuple[str, int],
        *,
        login: Login | None = None,
        tls: bool | None = None,
        timeout_s: float = PATIENCE_S,
        trusted: str | None = None,
    ) -> None:
        self.address = address
        self.on_lost: Callable[[str], None] | None = None
        self.fingerprint = ""
        self._login = login
        self._tls = tls
        self._timeout_s = timeout_s
        self._trusted = trusted
        self._lock = threading.RLock()
        self._peer: Peer | None = None
        self._directory: RemoteObject | None = None
        self._here: Place | None = None
        self._services: dict[str, RemoteObject] = {}
        self._others: dict[tuple[str, int], Peer] = {}
        self._own: dict[int, Bound] = {}

    @property
    def is_connected(self) -> bool:
        """Whether the connection is there, as far as anybody knows."""
        return self._peer is not None and not self._peer.is_closed

    def connect(self) -> None:
        """Connect, also again after the connection was lost. Raises NaoqiError."""
        with self._lock:
            if self.is_connected:
                return
            self.close()
            until_s = time.monotonic() + self._timeout_s
            self._peer = self._open_somehow(until_s)
            self._look_around(self._peer, until_s)
            self._peer.when_closed.append(self._note_lost(self._peer))
            if self._peer.is_closed:
                raise ConnectionLost("NAO has closed the connection.", checklist=WRONG_PORT)

    def service(self, name: str) -> RemoteObject:
        """Return a service of the robot. Raises NoSuchService, NaoqiError."""
        with self._lock:
            self._asked()
            known = self._services.get(name)
            if known is None or known.is_lost:
                known = self._services[name] = self._find(name)
            return known

    def services(self) -> list[str]:
        """Return the names of all services that are there now. Raises NaoqiError."""
        return [information[0] for information in self._asked().call("services")]

    def register(self, name: str, service: object) -> int:
        """Offer a service of this program to the robot; its number. Raises NaoqiError."""
        directory = self._asked()
        number: int = directory.call("registerService", own_information(name))
        self._own[number] = Bound(service, number)
        directory.call("serviceReady", number)
        return number

    def unregister(self, number: int) -> None:
        """Take back a service of this program. Raises NaoqiError."""
        self._asked().call("unregisterService", number)
        self._own.pop(number, None)

    def on_service(
        self, added: Callable[[int, str], None] | None, removed: Callable[[int, str], None] | None
    ) -> None:
        """Tell when services come and go, with number and name. Raises NaoqiError."""
        for signal, heard in (("serviceAdded", added), ("serviceRemoved", removed)):
            if heard is not None:
                self._asked().connect(signal, heard)

    def close(self) -> None:
        """End the connection; ``connect`` makes it again."""
        with self._lock:
            peers = [self._peer, *self._others.values()]
            self._peer = self._directory = self._here = None
            self._services.clear()
            self._others.clear()
            self._own.clear()
        for peer in peers:
            if peer is not None:
                peer.close()

    def _asked(self) -> RemoteObject:
        """Return the directory of services. Raises ConnectionLost."""
        directory = self._directory
        if directory is None or not self.is_connected:
            raise ConnectionLost(
                "There is no connection to {place_of}.", place_of=place_of(self.address)
            )
        return directory

    def _find(self, name: str) -> RemoteObject:
        until_s = time.monotonic() + self._timeout_s
        try:
            information = self._asked().call("service", name, timeout_s=self._timeout_s)
        except CallFailed as problem:
            raise NoSuchService(
                "NAO has no service {name}.", details=str(problem), name=name
            ) from problem
        place = Place.of(information)
        return object_of(self._peer_at(place, until_s), place.number, until_s)

    def _peer_at(self, place: Place, until_s: float) -> Peer:
        """Return the connection to where a service is; most are where their directory is."""
        here, peer = self._here, self._peer
        if peer is None or here is None:
            raise ConnectionLost(
                "There is no connection to {place_of}.", place_of=place_of(self.address)
            )
        address = best_place(place, here, self.address)
        if address is None:
            return peer
        other = self._others.get(address[:2])
        if other is None or other.is_closed:
            other = self._open(address[:2], address[2], until_s)
            self._others[address[:2]] = other
        return other

    def _open_somehow(self, until_s: float) -> Peer:
        """Return an entered connection, encrypted or not, as the robot has it.

        A password goes encrypted wherever the robot can do that. Raises NaoqiError.
        """
        first = self._login is not None or bool(self._trusted) or self.address[1] == TLS_PORT
        tls = first if self._tls is None else self._tls
        has_other = self._tls is None and not self._trusted
        first_until_s = until_s - self._timeout_s / 2 if has_other and tls else until_s
        try:
            return self._open(self.address, tls, first_until_s)
        except (NeedsTls, NoTls, NoAnswer) as problem:
            if not has_other or (isinstance(problem, NoAnswer) and not tls):
                raise
        return self._open(self.address, not tls, until_s)

    def _open(self, address: tuple[str, int], tls: bool, until_s: float) -> Peer:
        """Return an entered connection. Raises NaoqiError."""
        one = reach(address, until_s)
        if tls:
            one = encrypt(one, address, until_s)
            self._check(one, address)
        peer = Peer(Line(one), name=f"naoqi-client-{next(_numbers)}")
        peer.find = self._bound
        peer.start()
        try:
            enter(peer, self._login, until_s)
        except (BadFrame, ConnectionLost) as problem:
            peer.close()
            raise self._strange(address, tls, until_s, problem) from problem
        except NaoqiError:
            peer.close()
            raise
        return peer

    def _bound(self, number: int, thing: int) -> Bound | None:
        return self._own.get(number) if thing == MAIN else None

    def _check(self, one: ssl.SSLSocket, address: tuple[str, int]) -> None:
        self.fingerprint = fingerprint_of(one)
        if self._trusted and self._trusted.upper() != self.fingerprint:
            one.close()
            raise StrangeCertificate(
                "What answers at {place_of} is not the robot that was trusted before.",
                checklist=("Was this NAO set up anew? Then trust it again.",),
                details=self.fingerprint,
                place_of=place_of(address),
            )

    def _strange(
        self, address: tuple[str, int], tls: bool, until_s: float, problem: NaoqiError
    ) -> NaoqiError:
        """Say what it is that does not answer as NAOqi does."""
        place = place_of(address)
        if not tls and speaks_tls(address, until_s):
            return NeedsTls(
                "NAO at {place} speaks only the encrypted protocol.",
                checklist=("Give the user and the password of this NAO.",),
                details=str(problem),
                place=place,
            )
        return NotNaoqi(
            "What answers at {place} is not a NAO.",
            checklist=WRONG_PORT,
            details=str(problem),
            place=place,
        )

    def _look_around(self, peer: Peer, until_s: float) -> None:
        try:
            self._directory = object_of(peer, DIRECTORY, until_s)
            left_s = max(0.01, until_s - time.monotonic())
            information = self._directory.call("service", "ServiceDirectory", timeout_s=left_s)
            self._here = Place.of(information)
            self._directory.connect("serviceRemoved", self._forget)
        except CallFailed:
            self._here = Place(DIRECTORY, "", ())
        except NaoqiError:
            peer.close()
            raise

    def _forget(self, _number: int, name: str) -> None:
        """A service is gone; if it comes again it has another number."""
        self._services.pop(name, None)

    def _note_lost(self, peer: Peer) -> Callable[[str], None]:
        def note(why: str) -> None:
            if self._peer is not peer:
                return  # closed by this program
            on_lost = self.on_lost
            if on_lost is not None:
                threading.Thread(target=on_lost, args=(why,), daemon=True).start()

        return note

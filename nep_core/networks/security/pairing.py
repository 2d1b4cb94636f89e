"""How two computers get to know each other's keys by a short code: the messages, no sockets.

SPAKE2 makes a common secret of the code. Who listens, or sits between, learns nothing by which
codes could be tried later: each try takes a talk of its own, and three wrong ones end a code.
With the secret both prove to each other what they tell: their keys and where the master is.
"""

from __future__ import annotations

import contextlib
import logging
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec
import zmq

from faults import DEEPEST, Fault, Text, fault_of, heard_fault, reason_of, text_of
from nep_core.errors import KeyFileError, NetworkError, PairingError, PortTaken
from nep_core.networks.endpoints import fixed_endpoint
from nep_core.wire.frames import CANNOT_DECODE

from .keys import Computer, Key, KeyFile, Keys, Name, own_name, plain_name, write_keys

log = logging.getLogger(__name__)


VERSION = 1
MOST_BYTES = 4096
"""A longer message is refused."""
_SPAKE_BYTES = 33
_GUEST, _DOOR = b"nep pairing: guest", b"nep pairing: door"


class Hello(msgspec.Struct, tag="pair", tag_field="do", kw_only=True):
    """The guest begins; ``spake`` is hexadecimal."""

    version: int
    spake: str


class Offer(msgspec.Struct, tag="offer", tag_field="do", kw_only=True):
    """The door's half of SPAKE2."""

    spake: str


class Proof(msgspec.Struct, tag="proof", tag_field="do", kw_only=True):
    """The guest knows the code: a Guest as JSON text, and its HMAC-SHA256."""

    told: str
    mac: str


class Welcome(msgspec.Struct, tag="welcome", tag_field="do", kw_only=True):
    """The door knows the code too: a Host as JSON text, and the HMAC-SHA256 of both texts."""

    told: str
    mac: str


class No(msgspec.Struct, tag="no", tag_field="do", kw_only=True):
    """The door refuses: why, for the person at the guest, in English and as data (a Fault)."""

    sentence: str
    checklist: list[str] = []
    fault: dict[str, Any] | None = None  # doors before this key tell in English only


Message = Hello | Offer | Proof | Welcome | No

encode = msgspec.json.Encoder().encode
decode = msgspec.json.Decoder(Message).decode


class Guest(msgspec.Struct, kw_only=True):
    """What the guest tells of itself."""

    name: Name
    key: Key


class Host(msgspec.Struct, kw_only=True):
    """What the computer that opened the network tells."""

    network: str
    title: Name
    computer: Name
    key: Key
    master: str


T = TypeVar("T")


class GuestTalk:
    """The guest's side of one talk."""

    def __init__(self, code: str, guest: Guest) -> None:
        from spake2 import SPAKE2_A

        self._spake = SPAKE2_A(_password(code), idA=_GUEST, idB=_DOOR)
        self._guest = encode(guest).decode()
        self._secret = b""

    def hello(self) -> Hello:
        """The first message."""
        return Hello(version=VERSION, spake=self._spake.start().hex())

    def prove(self, offer: Offer) -> Proof:
        """Answer the door's offer; raises PairingError."""
        self._secret = _finish(self._spake, offer.spake, b"B")
        return Proof(told=self._guest, mac=_mac(self._secret, _GUEST, self._guest))

    def read(self, welcome: Welcome) -> Host:
        """What the door told, if it knows the code as well; raises PairingError."""
        _check(welcome.mac, _mac(self._secret, _DOOR, self._guest, welcome.told))
        return _told(welcome.told, Host)


class DoorTalk:
    """The door's side of one talk."""

    def __init__(self, code: str) -> None:
        from spake2 import SPAKE2_B

        self._spake = SPAKE2_B(_password(code), idA=_GUEST, idB=_DOOR)
        self._secret = b""

    def offer(self, hello: Hello) -> Offer:
        """Answer the guest's hello; raises PairingError."""
        started = self._spake.start()
        self._secret = _finish(self._spake, hello.spake, b"A")
        return Offer(spake=started.hex())

    def read(self, proof: Proof) -> Guest:
        """Who the guest is, if it knows the code; raises PairingError."""
        _check(proof.mac, _mac(self._secret, _GUEST, proof.told))
        return _told(proof.told, Guest)

    def welcome(self, proof: Proof, host: Host) -> Welcome:
        """The last message."""
        told = encode(host).decode()
        return Welcome(told=told, mac=_mac(self._secret, _DOOR, proof.told, told))


def wrong_code() -> PairingError:
    """The error when the two codes differ."""
    return PairingError(
        "That is not the code.",
        checklist=(
            "Read the code again on the computer that opened the network: six digits.",
            "After three wrong tries it holds no more: let that computer show a new one.",
        ),
    )


def _password(code: str) -> bytes:
    """A code as people write it: "482 913" and "482913" are the same."""
    return "".join(filter(str.isalnum, code)).encode()


def _finish(spake: Any, told: str, side: bytes) -> bytes:
    try:
        theirs = bytes.fromhex(told)
        if len(theirs) != _SPAKE_BYTES or theirs[:1] != side:
            raise ValueError("not a message of SPAKE2")
        return bytes(spake.finish(theirs))
    except Exception as error:  # the library tells by many kinds that a message is wrong
        raise PairingError(
            "The other side sent something that cannot be read.",
            checklist=("Is that the address of a computer that opened a NEP network?",),
            details=str(error),
        ) from error


def _told(text: str, kind: type[T]) -> T:
    """What the other side says of itself; raises PairingError."""
    try:
        return msgspec.json.decode(text, type=kind)
    except CANNOT_DECODE as error:
        raise _strange() from error


def _mac(secret: bytes, role: bytes, *texts: str) -> str:
    import hashlib  # with all of OpenSSL, which few programs need
    import hmac

    key = hmac.digest(secret, role, hashlib.sha256)
    return hmac.new(key, "\n".join(texts).encode(), hashlib.sha256).hexdigest()


def _check(told: str, right: str) -> None:
    import hmac

    if not hmac.compare_digest(told.encode(), right.encode()):
        raise wrong_code()


class Lines:
    """A talk over TCP, one JSON message a line, that ends after ``seconds``, however slow."""

    def __init__(self, connection: socket.socket, seconds: float) -> None:
        self._connection = connection
        self.go_on(seconds)
        self._arrived = b""

    def go_on(self, seconds: float) -> None:
        """Let the talk end after so long from now."""
        self._end_s = time.monotonic() + seconds

    def say(self, message: Message) -> None:
        """Send; raises PairingError."""
        self._wait_at_most_the_rest()
        try:
            self._connection.sendall(encode(message) + b"\n")
        except OSError as error:
            raise _broken() from error

    def hear(self) -> Message:
        """The next message; raises PairingError."""
        while b"\n" not in self._arrived:
            self._wait_at_most_the_rest()
            try:
                part = self._connection.recv(MOST_BYTES)
            except OSError as error:
                raise _broken() from error
            self._arrived += part
            if not part or len(self._arrived) > MOST_BYTES:
                raise _broken()
        line, _, self._arrived = self._arrived.partition(b"\n")
        try:
            return decode(line)  # type: ignore[no-any-return]
        except CANNOT_DECODE as error:
            raise _broken() from error

    def _wait_at_most_the_rest(self) -> None:
        left_s = self._end_s - time.monotonic()
        if left_s <= 0:
            raise _broken()
        self._connection.settimeout(left_s)


def _broken() -> PairingError:
    return PairingError(
        "The talk with the other computer ended too early.",
        checklist=("Is that the address of the computer that opened the network?", "Try again."),
    )


# The door at which a second computer is paired: one talk at a time, by a one-time code.

CODE_S = 120.0
TRIES = 3
HELLO_S = 1.0
"""Who has not said hello by then is sent away: a guest says it as soon as it is connected."""
TALK_S = 5.0
"""The longest talk; meanwhile others wait."""

EventKind = Literal["paired", "wrong_code", "code_used_up"]


@dataclass(frozen=True)
class DoorEvent:
    """What happened at the door, as a sentence too; ``computer`` is "" until it is known."""

    kind: EventKind
    sentence: Text
    computer: str = ""
    address: str = ""


@dataclass(frozen=True)
class Code:
    """A one-time code: what people read, until when it holds (time.monotonic()), tries left."""

    text: str
    until_s: float
    tries_left: int = TRIES

    @property
    def holds(self) -> bool:
        """Whether a computer may still be paired with it."""
        return self.tries_left > 0 and self.left_s > 0

    @property
    def left_s(self) -> float:
        """How long it may still be typed, whatever the computer's clock is set to meanwhile."""
        return self.until_s - time.monotonic()


NO_CODE = fault_of(
    "There is no code now: it was used, or is too old.",
    code="no_code",
    checklist=("Let the other computer show a new code, and type that one within two minutes.",),
)


class Door:
    """Listens in a thread of its own; raises PortTaken."""

    def __init__(
        self,
        file: KeyFile,
        address: tuple[str, int],
        on_event: Callable[[DoorEvent], None] = lambda event: None,
    ) -> None:
        self._file = file
        self._on_event = on_event
        self._lock = threading.Lock()
        self._code: Code | None = None
        family = socket.AF_INET6 if ":" in address[0] else socket.AF_INET
        try:
            self._listener = socket.create_server(address, family=family, backlog=8)
        except OSError as error:
            raise PortTaken(
                "Port {address} of {address_2}, where computers are paired, cannot be used: "
                "{reason}.",
                checklist=(
                    "Is the network already open? Stop the other one.",
                    "Choose another port for pairing.",
                ),
                address=address[1],
                address_2=address[0],
                reason=reason_of(error),
            ) from error
        self.port = int(self._listener.getsockname()[1])
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="nep-door", daemon=True)
        self._thread.start()

    @property
    def code(self) -> Code | None:
        """The code that holds now; None when a new one is needed."""
        with self._lock:
            return self._code if self._code is not None and self._code.holds else None

    def new_code(self, seconds: float = CODE_S) -> Code:
        """Make a code for one computer; the one before holds no more."""
        import secrets

        digits = f"{secrets.randbelow(1_000_000):06d}"
        code = Code(f"{digits[:3]} {digits[3:]}", time.monotonic() + seconds)
        with self._lock:
            self._code = code
        return code

    def close(self) -> None:
        """Close the door; a talk that goes on is ended within TALK_S."""
        self._closed = True
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)  # ends accept() on Linux
        self._listener.close()
        self._thread.join(TALK_S)

    def _run(self) -> None:
        while not self._closed:
            try:
                connection, address = self._listener.accept()
            except OSError:
                if self._closed:
                    return
                time.sleep(0.1)  # out of file numbers, perhaps: not for ever
                continue
            with connection:
                try:
                    self._talk(Lines(connection, HELLO_S), str(address[0]))
                except PairingError as error:
                    log.info("a talk with %s failed: %s", address[0], error)
                except Exception:  # a fault of ours must not shut the door
                    log.exception("the door stays open after an error")

    def _talk(self, lines: Lines, address: str) -> None:
        hello = lines.hear()
        if not isinstance(hello, Hello) or hello.version != VERSION:
            words, step = "These two programs are of different ages.", "Update both computers."
            lines.say(_no(fault_of(words, code="pairing_ages", checklist=(step,))))
            return
        lines.go_on(TALK_S)
        code = self._take_try()
        if code is None:
            lines.say(_no(NO_CODE))
            return
        try:
            talk = DoorTalk(code.text)
            lines.say(talk.offer(hello))
            proof = lines.hear()
            if not isinstance(proof, Proof):
                raise wrong_code()
            guest = talk.read(proof)
        except PairingError:
            self._refuse(lines, address)
            return
        try:
            self._let_in(guest, address)
        except KeyFileError as error:
            log.error("The computer at %s was not paired: %s", address, error.sentence)
            steps = (error.sentence, *error.checklist)
            words = "The other computer cannot keep your key."
            lines.say(_no(fault_of(words, code="key_not_kept", checklist=steps)))
            return
        lines.say(talk.welcome(proof, self._host()))

    def _take_try(self) -> Code | None:
        """The code, with one try less: who breaks off after our answer has had a try as well."""
        with self._lock:
            if self._code is None or not self._code.holds:
                return None
            self._code = replace(self._code, tries_left=self._code.tries_left - 1)
            return self._code

    def _let_in(self, guest: Guest, address: str) -> None:
        name = plain_name(guest.name) or "a computer"
        name = self._file.let_in(name, guest.key, address).name
        with self._lock:
            self._code = None
        words = "{name} at {address} was paired. Its programs may join now."
        sentence = text_of(words, name=name, address=address)
        self._on_event(DoorEvent("paired", sentence, name, address))

    def _refuse(self, lines: Lines, address: str) -> None:
        with contextlib.suppress(PairingError):
            lines.say(_no(wrong_code().fault))
        if self.code is not None:
            sentence = text_of("A computer at {address} gave a wrong code.", address=address)
            self._on_event(DoorEvent("wrong_code", sentence, "", address))
            return
        with self._lock:
            self._code = None
        words = (
            "The code was tried {tries} times in vain, the last time by {address}. It holds no "
            "more; make a new one."
        )
        sentence = text_of(words, tries=TRIES, address=address)
        self._on_event(DoorEvent("code_used_up", sentence, "", address))

    def _host(self) -> Host:
        keys = self._file.keys
        return Host(
            network=keys.network,
            title=keys.title,
            computer=keys.computer,
            key=keys.public,
            master=keys.master,
        )


def _no(fault: Fault) -> No:
    return No(
        sentence=str(fault),
        checklist=list(map(str, fault.checklist)),
        fault=msgspec.to_builtins(fault),
    )


JOINING_TALK_S = 10.0


def pair(host: str, port: int, code: str, path: Path) -> Keys:
    """Pair this computer at a door and write its key file; raises PairingError, KeyFileError.

    A key file that is already there must be one of the same network: its keys are kept.

    ``host`` and ``port`` are the door's, ``code`` is what its computer shows, ``path`` where
    the key file goes.
    """
    before = KeyFile(path).keys if path.exists() else None
    if before is not None and before.is_owner:
        raise _other_network(path, before)
    if before is not None:
        public, secret = before.public, before.secret
    else:
        public, secret = (key.decode() for key in zmq.curve_keypair())
    told = _talk(host, port, code, Guest(name=own_name(), key=public))
    if before is not None and before.network != told.network:
        raise _other_network(path, before)
    owner = Computer(name=told.computer, key=told.key, address=host, since=time.time())
    keys = Keys(
        network=told.network,
        title=told.title,
        computer=own_name(),
        public=public,
        secret=secret,
        master=told.master,
        master_key=told.key,
        computers=(owner,),
    )
    write_keys(path, keys)
    return keys


def _talk(host: str, port: int, code: str, guest: Guest) -> Host:
    talk = GuestTalk(code, guest)
    hello = talk.hello()  # it takes a while, and the door does not wait for it
    try:
        connection = socket.create_connection((host, port), timeout=JOINING_TALK_S)
    except (OSError, UnicodeError, OverflowError) as error:
        is_known = isinstance(error, OSError)
        raise PairingError(
            "No computer answers at {host}, port {port}: {reason}.",
            checklist=(
                "Is the network open on the other computer? It says so: nep open.",
                "Are both computers in the same network?",
                "Does a firewall of the other computer keep port {port} shut?",
                "Is the address right? The other computer shows it.",
            ),
            host=host,
            port=port,
            reason=reason_of(error) if is_known else Text("there can be no such place"),
        ) from error
    with connection:
        lines = Lines(connection, JOINING_TALK_S)
        lines.say(hello)
        offer = _expect(Offer, lines.hear())
        lines.say(talk.prove(offer))
        try:
            told = talk.read(_expect(Welcome, lines.hear()))
            fixed_endpoint(told.master)
        except PairingError:
            raise
        except NetworkError as error:
            raise _strange() from error
    return told


def _expect(kind: type[T], message: object) -> T:
    if isinstance(message, No):
        said = message.fault or {"sentence": message.sentence, "checklist": message.checklist}
        fault = heard_fault(_plain(said))
        raise PairingError.of(fault) if fault else _strange()
    if not isinstance(message, kind):
        raise _strange()
    return message


def _plain(told: Any, deepest: int = 2 * DEEPEST) -> Any:
    """What a stranger says, without letters that command a terminal."""
    match told:
        case str():
            return "".join(c for c in told if c.isprintable())
        case dict() if deepest:
            return {_plain(name): _plain(one, deepest - 1) for name, one in told.items()}
        case list() if deepest:
            return [_plain(one, deepest - 1) for one in told]
        case dict() | list():
            return "…"
    return told


def _strange() -> PairingError:
    return PairingError(
        "The other computer answered something that cannot be read.",
        checklist=(
            "Is that the address of a computer that opened a NEP network?",
            "Update NEP Studio on both computers.",
        ),
    )


def _other_network(path: Path, keys: Keys) -> KeyFileError:
    return KeyFileError(
        'The key file {path} belongs to another network, "{title}".',
        checklist=(
            "Choose another file for the new network: --keys FILE.",
            "Or delete that file, if you do not need it any more.",
        ),
        path=path,
        title=keys.title,
    )

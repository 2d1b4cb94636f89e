"""The door at which a second computer is paired: one talk at a time, by a one-time code."""

from __future__ import annotations

import contextlib
import logging
import os
import secrets
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import msgspec

from nep_core.errors import KeyFileError, PairingError, PortTaken
from nep_core.security import pairing
from nep_core.security.keys import KeyFile, plain_name
from nep_core.security.lines import Lines

log = logging.getLogger(__name__)

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
    sentence: str
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

    @property
    def until(self) -> float:
        """The same as a time of day (time.time())."""
        return time.time() + self.left_s


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
                f"Port {address[1]} of {address[0]}, where computers are paired, cannot be used: "
                f"{os.strerror(error.errno or 0).lower()}.",
                checklist=(
                    "Is the network already open? Stop the other one.",
                    "Choose another port for pairing.",
                ),
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
        if not isinstance(hello, pairing.Hello) or hello.version != pairing.VERSION:
            lines.say(_no("These two programs are of different ages.", "Update both computers."))
            return
        lines.go_on(TALK_S)
        code = self._take_try()
        if code is None:
            lines.say(
                _no(
                    "There is no code now: it was used, or is too old.",
                    "Let the other computer show a new code, and type that one within two minutes.",
                )
            )
            return
        try:
            talk = pairing.DoorTalk(code.text)
            lines.say(talk.offer(hello))
            proof = lines.hear()
            if not isinstance(proof, pairing.Proof):
                raise pairing.wrong_code()
            guest = talk.read(proof)
        except (PairingError, msgspec.MsgspecError):
            self._refuse(lines, address)
            return
        try:
            self._let_in(guest, address)
        except KeyFileError as error:
            log.error("The computer at %s was not paired: %s", address, error.sentence)
            lines.say(_no("The other computer cannot keep your key.", error.sentence))
            return
        lines.say(talk.welcome(proof, self._host()))

    def _take_try(self) -> Code | None:
        """The code, with one try less: who breaks off after our answer has had a try as well."""
        with self._lock:
            if self._code is None or not self._code.holds:
                return None
            self._code = replace(self._code, tries_left=self._code.tries_left - 1)
            return self._code

    def _let_in(self, guest: pairing.Guest, address: str) -> None:
        name = plain_name(guest.name) or "a computer"
        computer = self._file.let_in(name, guest.key, address)
        with self._lock:
            self._code = None
        self._on_event(
            DoorEvent(
                "paired",
                f"{computer.name} at {address} was paired. Its programs may join now.",
                computer.name,
                address,
            )
        )

    def _refuse(self, lines: Lines, address: str) -> None:
        with contextlib.suppress(PairingError):
            error = pairing.wrong_code()
            lines.say(pairing.No(sentence=error.sentence, checklist=list(error.checklist)))
        if self.code is not None:
            self._on_event(
                DoorEvent("wrong_code", f"A computer at {address} gave a wrong code.", "", address)
            )
            return
        with self._lock:
            self._code = None
        sentence = (
            f"The code was tried {TRIES} times in vain, the last time by {address}. "
            "It holds no more; make a new one."
        )
        self._on_event(DoorEvent("code_used_up", sentence, "", address))

    def _host(self) -> pairing.Host:
        keys = self._file.keys
        return pairing.Host(
            network=keys.network,
            title=keys.title,
            computer=keys.computer,
            key=keys.public,
            master=keys.master,
        )


def _no(sentence: str, step: str) -> pairing.No:
    return pairing.No(sentence=sentence, checklist=[step])

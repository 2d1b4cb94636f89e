"""What programs and the master say to each other: one JSON object a frame, told apart by "do"."""

from __future__ import annotations

import contextlib
import logging
from typing import Any, TypeVar

import msgspec
import zmq

from nep_core.errors import BrokerNotFound, MasterNotFound
from nep_core.wire.frames import CANNOT_DECODE

from . import security
from .endpoints import fixed_endpoint
from .registry import Publishing, Registration

log = logging.getLogger(__name__)


class Register(msgspec.Struct, tag="register", tag_field="do", kw_only=True):
    """Here I am, with all my topics; ``version`` counts my changes.

    ``epoch`` is that of the master that knew me before, empty for a newcomer.
    """

    version: int
    registration: Registration
    epoch: str = ""


class Change(msgspec.Struct, tag="change", tag_field="do", kw_only=True):
    """What is different from version ``base`` of my registration, so that many topics are cheap.

    A master that does not have that version answers Heard with ``known`` false.
    """

    instance: str
    version: int
    base: int
    publishes: list[str] = []
    publishes_no_more: list[str] = []
    subscribes: dict[str, str] = {}
    subscribes_no_more: list[str] = []

    def of(self, told: Registration) -> Registration:
        """The registration after this change."""
        lost, left = set(self.publishes_no_more), set(self.subscribes_no_more)
        kept = [topic for topic in told.publishes if topic not in lost]
        heard = {i: topic for i, topic in told.subscribes.items() if i not in left}
        return msgspec.structs.replace(
            told,
            publishes=list(dict.fromkeys((*kept, *self.publishes))),
            subscribes=heard | self.subscribes,
        )


class Alive(msgspec.Struct, tag="alive", tag_field="do", kw_only=True):
    """My heartbeat, every half second."""

    instance: str


class Bye(msgspec.Struct, tag="bye", tag_field="do", kw_only=True):
    """I leave."""

    instance: str


class List(msgspec.Struct, tag="list", tag_field="do"):
    """Who is there?"""


class Find(msgspec.Struct, tag="find", tag_field="do", kw_only=True):
    """Who publishes this topic, and who hears it?"""

    topic: str


class Watch(msgspec.Struct, tag="watch", tag_field="do", kw_only=True):
    """Tell me of every change for the next seconds; I know the listing with this number already."""

    epoch: str = ""
    number: int = 0


class Stop(msgspec.Struct, tag="stop", tag_field="do", kw_only=True):
    """Ask the program of this node to stop."""

    node: str


Request = Register | Change | Alive | Bye | List | Find | Watch | Stop


class Registered(msgspec.Struct, tag="registered", tag_field="do", kw_only=True):
    """The answer to Register and Change: who is already there for the topics that were told."""

    epoch: str
    version: int
    publishers: dict[str, list[Publishing]]
    subscribers: dict[str, list[str]]


class Refused(msgspec.Struct, tag="refused", tag_field="do", kw_only=True):
    """The answer to a Register that cannot be: the name is taken.

    ``sentence`` and ``checklist`` are in English, ``fault`` is the same as data; it may be missing.
    """

    version: int
    sentence: str
    checklist: list[str]
    fault: Any = None


class Heard(msgspec.Struct, tag="heard", tag_field="do", kw_only=True):
    """The answer to Alive; ``known`` is False when I should register again."""

    epoch: str
    known: bool


class Publishers(msgspec.Struct, tag="publishers", tag_field="do", kw_only=True):
    """The publishers of a topic that I subscribe to have changed: this is the whole list."""

    topic: str
    publishers: list[Publishing]


class Listing(msgspec.Struct, tag="listing", tag_field="do", kw_only=True):
    """The answer to List: the master's process, and everything that is registered.

    ``shared``: it is there for all programs of its computer, not for one session.
    """

    epoch: str
    pid: int
    registrations: list[Registration]
    number: int = 0
    shared: bool = False


class Found(msgspec.Struct, tag="found", tag_field="do", kw_only=True):
    """The answer to Find: the publishers of a topic, and the ids of its subscribers."""

    topic: str
    publishers: list[Publishing]
    subscribers: list[str]


class Changed(msgspec.Struct, tag="changed", tag_field="do", kw_only=True):
    """Pushed to who watches: registrations that are new or different, and instances that went.

    ``number`` counts; who misses one watches again and gets a Listing.
    """

    epoch: str
    number: int
    came: list[Registration]
    gone: list[str]


class Passed(msgspec.Struct, tag="passed", tag_field="do", kw_only=True):
    """The answer to Stop: whether there is such a node, which has been asked now."""

    known: bool


class StopAsked(msgspec.Struct, tag="stop_asked", tag_field="do"):
    """Pushed to a program: somebody asks it to stop."""


class Mistake(msgspec.Struct, tag="error", tag_field="do", kw_only=True):
    """The answer to a request that cannot be read."""

    sentence: str


class Computers(msgspec.Struct, tag="computers", tag_field="do", kw_only=True):
    """Which computers an opened network lets in, by their public keys: this is the whole list."""

    keys: list[str]


Answer = (
    Registered
    | Refused
    | Heard
    | Publishers
    | Listing
    | Found
    | Changed
    | Passed
    | Computers
    | StopAsked
    | Mistake
)

decode_request = msgspec.json.Decoder(Request).decode
decode_answer = msgspec.json.Decoder(Answer).decode
encode = msgspec.json.Encoder().encode


def arrived(socket: zmq.Socket[bytes]) -> list[Answer]:
    """What a master has said by now; what cannot be read is passed over."""
    answers = []
    with contextlib.suppress(zmq.Again):
        while True:
            frame = socket.recv(zmq.NOBLOCK)
            try:
                answers.append(decode_answer(frame))
            except CANNOT_DECODE as error:
                log.warning("the master says what cannot be read: %s", error)
    return answers


# Asking a master from a tool that does not join the network itself.

A = TypeVar("A", bound=Answer)


class MasterProbe:
    """A connection for questions; raises NetworkError when ``endpoint`` is not one."""

    def __init__(self, endpoint: str) -> None:
        fixed_endpoint(endpoint)
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        try:
            security.connect_to_master(self._socket, endpoint)
        except BaseException:
            self.close()
            raise

    def ask(self, request: Request, kind: type[A], timeout_s: float = 2.0) -> A | None:
        """The answer; None when no NEP master gives one of this kind."""
        self._socket.send(encode(request))
        if not self._socket.poll(int(timeout_s * 1000)):
            return None
        with contextlib.suppress(*CANNOT_DECODE):  # something else answers there
            answer = decode_answer(self._socket.recv())
            return answer if isinstance(answer, kind) else None
        return None

    def close(self) -> None:
        """Ask no more."""
        self._context.destroy(linger=0)


def ask_master(endpoint: str, timeout_s: float = 2.0) -> Listing | None:
    """What the master at ``endpoint`` has registered; None when no NEP master answers.

    Raises NetworkError when ``endpoint`` is not one.
    """
    with contextlib.closing(MasterProbe(endpoint)) as probe:
        return probe.ask(List(), Listing, timeout_s)


def ask_to_stop(endpoint: str, node: str, timeout_s: float = 2.0) -> bool | None:
    """Ask a node to stop; whether there is one, None when no NEP master answers."""
    with contextlib.closing(MasterProbe(endpoint)) as probe:
        answer = probe.ask(Stop(node=node), Passed, timeout_s)
    return None if answer is None else answer.known


def no_master(endpoint: str, broker: str = "") -> MasterNotFound:
    """The error to raise when nobody answers at ``endpoint``: it may be one that wants keys.

    ``broker`` is where a broker serves, if this is its registry.
    """
    from .security.curve import not_let_in

    if (closed := not_let_in(endpoint)) is not None:
        return closed
    if broker:
        return BrokerNotFound(
            "No NEP broker answers at {endpoint}.",
            checklist=(
                "Start one in another terminal: nep broker",
                "Is it at another place? Set NEP_BROKER to its endpoint.",
            ),
            endpoint=broker,
        )
    return MasterNotFound(
        "No NEP master answers at {endpoint}.",
        checklist=(
            "Start one in another terminal: nep master",
            "Is it at another place? Set NEP_MASTER to its endpoint.",
        ),
        endpoint=endpoint,
    )

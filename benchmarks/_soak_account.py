"""Which messages of a soak should have arrived, and which of them did.

A message is owed to each subscriber that its publisher saw, after their handshake, when it was
sent. What is owed and did not arrive is *excused* only when one of the two was killed (or the
subscriber closed) within TAIL_S of the sending, and nothing later came on that way; all else is
*lost*. What a killed program had in its hands nobody can deliver; a gap in the middle is a fault.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

TAIL_S = 2.0


@dataclass(frozen=True)
class Account:
    """Deliveries: owed to living subscribers, arrived, excused, lost, and come twice or late."""

    sent: int = 0
    owed: int = 0
    received: int = 0
    excused: int = 0
    lost: int = 0
    disordered: int = 0
    losses: tuple[str, ...] = ()
    """The first of the lost, for people."""


@dataclass
class Sent:
    """What one publisher wrote down: number, time (s) and who heard it."""

    source: str = ""
    messages: list[tuple[int, float, frozenset[str]]] = field(default_factory=list)


@dataclass
class Heard:
    """What one subscriber wrote down: the numbers of each source in their order."""

    id: str = ""
    ended_s: float = math.inf
    numbers: dict[str, list[int]] = field(default_factory=dict)


def read_sent(text: str) -> Sent:
    """Read a publisher's diary; a last line that is not whole is none."""
    sent, heard = Sent(), frozenset[str]()
    for word, *rest in whole_lines(text):
        if word == "topic":
            sent.source = rest[1]
        elif word == "heard":
            heard = frozenset(rest)
        elif word == "send":
            sent.messages.append((int(rest[0]), float(rest[1]), heard))
    return sent


def read_heard(text: str) -> Heard:
    """Read a subscriber's diary."""
    heard = Heard()
    for word, *rest in whole_lines(text):
        if word == "id":
            heard.id = rest[0]
        elif word == "got":
            heard.numbers.setdefault(rest[0], []).append(int(rest[1]))
        elif word == "end":
            heard.ended_s = float(rest[0])
    return heard


def whole_lines(text: str) -> list[list[str]]:
    """The words of each line that has its end."""
    return [line.split() for line in text.split("\n")[:-1] if line]


def account(folder: Path, killed_s: Mapping[str, float]) -> Account:
    """Settle what all programs wrote down; ``killed_s``: when which run ("name.run") was killed."""
    sent = {path.stem: read_sent(path.read_text("utf-8")) for path in folder.glob("*.sent")}
    heard = {path.stem: read_heard(path.read_text("utf-8")) for path in folder.glob("*.heard")}
    for stem, one in heard.items():
        one.ended_s = min(one.ended_s, killed_s.get(run_of(stem), math.inf))
    by_id = {one.id: one for one in heard.values()}
    ways = [
        settle(publisher, id_, by_id.get(id_), killed_s.get(run_of(stem), math.inf))
        for stem, publisher in sent.items()
        for id_ in set[str]().union(*(ids for _, _, ids in publisher.messages))
    ]
    return Account(
        sent=sum(len(one.messages) for one in sent.values()),
        owed=sum(connector.owed for connector in ways),
        received=sum(connector.received for connector in ways),
        excused=sum(connector.excused for connector in ways),
        lost=sum(connector.lost for connector in ways),
        disordered=sum(connector.disordered for connector in ways),
        losses=tuple(line for connector in ways for line in connector.losses)[:20],
    )


def run_of(stem: str) -> str:
    """The program's run to which a diary belongs: NAME.RUN of NAME.RUN.INDEX."""
    return stem.rpartition(".")[0]


def settle(publisher: Sent, id_: str, subscriber: Heard | None, killed_s: float) -> Account:
    """The account of one publisher with one subscriber (None: killed before it wrote its id)."""
    owed = [(n, sent_s) for n, sent_s, ids in publisher.messages if id_ in ids]
    if subscriber is None:
        return Account(owed=len(owed), excused=len(owed))
    numbers = subscriber.numbers.get(publisher.source, [])
    arrived, last = set(numbers), max(numbers, default=0)
    end_s = min(subscriber.ended_s, killed_s)
    missing = [(n, sent_s) for n, sent_s in owed if n not in arrived]
    lost = [n for n, sent_s in missing if n < last or sent_s < end_s - TAIL_S]
    return Account(
        owed=len(owed),
        received=len(owed) - len(missing),
        excused=len(missing) - len(lost),
        lost=len(lost),
        disordered=sum(b <= a for a, b in itertools.pairwise(numbers)),
        losses=(f"{publisher.source} to {id_}: {lost[:5]} of {owed[-1][0]}",) if lost else (),
    )

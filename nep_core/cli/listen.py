"""``nep echo`` and ``nep hz``: what comes on a topic, and how often."""

from __future__ import annotations

import argparse
import itertools
import statistics
import time
from collections import deque
from collections.abc import Iterator
from dataclasses import asdict
from datetime import datetime

import msgspec

from nep_core.recordings.raw import RawMessage, RawSubscriber
from nep_core.wire.frames import CANNOT_DECODE

from .console import (
    NoField,
    about_nobody,
    add_json,
    add_times,
    amount,
    field_of,
    join,
    many,
    registrations,
    remark,
    say,
    say_json,
    value_of,
    value_text,
    visible,
)

WINDOW_S = 10.0
WINDOW_MESSAGES = 100_000
TOLD_S = 1.0


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    add = parser.add_argument
    add("topic", metavar="TOPIC", help="such as /human_behavior")
    add_times(parser, "print" if name == "echo" else "hear")
    if name == "hz":
        add_json(parser, "for machines: a line of JSON a second")
        return
    add("--field", metavar="PATH", help="only this part, such as acc.0")
    add("--sender", metavar="NODE", help="only messages of this node")
    add("--times", action="store_true", help="begin with when it was sent, and by whom")
    add("--pretty", action="store_true", help="JSON on many lines")
    add_json(parser, "for machines: also sender, number, times in ns and encoding")


def run(options: argparse.Namespace) -> int:
    """Listen until told to end; 1 when nothing came."""
    if told := about_nobody(options.topic, registrations(options)):
        remark(told)
    with join(options) as network:
        subscriber = RawSubscriber(options.topic, network=network)
        listen = _echo if options.command == "echo" else _hz
        heard = listen(subscriber, options)
    if not heard:
        remark(f"Nothing came on {options.topic}.")
    return 0 if heard else 1


def _messages(
    subscriber: RawSubscriber, options: argparse.Namespace, tick_s: float | None = None
) -> Iterator[RawMessage | None]:
    """Each message, and None at every tick, until --count or --seconds is reached."""
    now_s = time.monotonic()
    end_s = None if options.seconds is None else now_s + options.seconds
    tick_at_s = None if tick_s is None else now_s + tick_s
    count = 0
    while count < options.count or not options.count:
        now_s = time.monotonic()
        due = [at_s for at_s in (end_s, tick_at_s) if at_s is not None]
        message = subscriber.receive(max(0.0, min(due) - now_s) if due else None)
        if message is not None:
            yield message
            count += getattr(options, "sender", None) in (None, message.node)
        elif end_s is None and tick_at_s is None:
            return
        now_s = time.monotonic()
        if tick_s is not None and tick_at_s is not None and now_s >= tick_at_s:
            tick_at_s += tick_s
            yield None
        if end_s is not None and now_s >= end_s:
            return


def _echo(subscriber: RawSubscriber, options: argparse.Namespace) -> int:
    shown = lost = 0
    next_told_s = 0.0
    complained = False
    for message in _messages(subscriber, options):
        if message is None or options.sender not in (None, message.node):
            continue
        try:
            say(_line(message, options))
        except (NoField, *CANNOT_DECODE) as error:
            if not complained:
                complained = True
                remark(f"{error if isinstance(error, NoField) else f'Not readable: {error}.'}")
        shown += 1
        if subscriber.lost > lost and time.monotonic() >= next_told_s:
            next_told_s = time.monotonic() + TOLD_S
            remark(f"{many(subscriber.lost - lost, 'message')} lost.")
            lost = subscriber.lost
    return shown


def _line(message: RawMessage, options: argparse.Namespace) -> str:
    value = value_of(message)
    if options.field:
        value = field_of(value, options.field)
    if options.json:
        told = {name: one for name, one in asdict(message).items() if name != "payload"}
        return msgspec.json.encode({**told, "message": value}).decode()
    head = ""
    if options.times:
        sent = datetime.fromtimestamp(message.sent_ns / 1e9)
        head = f"{sent:%H:%M:%S.%f}"[:-3] + f" {visible(message.node)}  "
    return head + value_text(value, pretty=options.pretty)


class Pace:
    """The messages of the last 10 s: when they came and how large they were."""

    def __init__(self) -> None:
        self.arrivals: deque[tuple[float, int]] = deque(maxlen=WINDOW_MESSAGES)

    def add(self, message: RawMessage) -> None:
        """Count one in."""
        self.arrivals.append((message.arrived_ns / 1e9, len(message.payload)))
        while self.arrivals[-1][0] - self.arrivals[0][0] > WINDOW_S:
            self.arrivals.popleft()

    def measures(self, lost: int) -> dict[str, float]:
        """Rate, gaps and bytes; only the counts when there were fewer than two messages."""
        times = [time_s for time_s, _ in self.arrivals]
        counts: dict[str, float] = {"messages": len(times), "lost": lost}
        if len(times) < 2:
            return counts
        gaps = [later - earlier for earlier, later in itertools.pairwise(times)]
        span_s = max(times[-1] - times[0], 1e-9)
        sizes = [size for _, size in self.arrivals][1:]
        return {
            **counts,
            "rate_hz": round(len(gaps) / span_s, 3),
            "shortest_ms": round(min(gaps) * 1000, 3),
            "longest_ms": round(max(gaps) * 1000, 3),
            "jitter_ms": round(statistics.pstdev(gaps) * 1000, 3),
            "bytes_s": round(sum(sizes) / span_s),
        }


def _hz(subscriber: RawSubscriber, options: argparse.Namespace) -> int:
    pace, heard, told = Pace(), 0, 0
    for message in _messages(subscriber, options, TOLD_S):
        if message is not None:
            pace.add(message)
            heard += 1
        elif heard > told:
            told = heard
            _tell(pace, subscriber, options)
        elif heard:
            remark(f"Nothing new on {options.topic}.")
            pace.arrivals.clear()
    if heard > told:
        _tell(pace, subscriber, options)
    return heard


def _tell(pace: Pace, subscriber: RawSubscriber, options: argparse.Namespace) -> None:
    told = pace.measures(subscriber.lost)
    if options.json:
        say_json({"topic": options.topic, **told})
    elif "rate_hz" not in told:
        say("one message so far")
    else:
        say(
            f"{told['rate_hz']:.1f} messages a second   gaps {told['shortest_ms']:.1f} to "
            f"{told['longest_ms']:.1f} ms   jitter {told['jitter_ms']:.1f} ms   "
            f"{amount(told['bytes_s'])} a second   lost {told['lost']:.0f}"
        )

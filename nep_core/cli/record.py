"""``nep record`` and ``nep play``: keep what is sent, and send it again."""

from __future__ import annotations

import argparse
import select
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import partial

from nep_core.errors import RecordingError
from nep_core.processes.node import STOP_SIGNALS
from nep_core.recordings.file import Overview, overview
from nep_core.recordings.recorder import Player, Recorder
from nep_core.wire.io_thread import Wake
from nep_core.wire.messages import NODE_STATE

from .console import (
    about_nobody,
    add_json,
    amount,
    join,
    many,
    number,
    registrations,
    remark,
    say,
    say_json,
    seconds,
    table,
)

TOLD_S = 1.0
LOOK_S = 0.2
MOST_FILES = 20_000


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    add = parser.add_argument
    add("file", metavar="FILE", help="such as walk.mcap")
    if name == "record":
        add("topics", nargs="*", metavar="TOPIC", help="which topics (default: all)")
        add("--without", action="append", default=[], metavar="TOPIC", help="not this one")
        add("--seconds", type=seconds, metavar="S", help="end after S seconds")
        add("--force", action="store_true", help="replace the file if it is there")
        return
    add("--topics", nargs="+", metavar="TOPIC", help="only these (default: all)")
    factor = partial(number, least=0.001, most=1000.0)
    add("--speed", type=factor, default=1.0, metavar="X", help="2 is twice as fast (default 1)")
    add("--from", dest="from_s", type=seconds, default=0.0, metavar="S", help="begin at S seconds")
    add("--to", dest="to_s", type=seconds, metavar="S", help="end at S seconds of the recording")
    add("--loop", action="store_true", help="again and again, until Ctrl-C")
    add("--prefix", default="", help="before every topic, such as /old")
    add("--wait", type=seconds, default=0.0, metavar="S", help="for subscribers, at most S seconds")
    add("--node-states", action="store_true", help=f"also {NODE_STATE}")
    add("--info", action="store_true", help="only tell what is in it")
    add_json(parser, "with --info, for machines")


def run(options: argparse.Namespace) -> int:
    """Record or play; raises RecordingError."""
    if options.command == "record":
        return _record(options)
    return _show(options) if options.info else _play(options)


def _record(options: argparse.Namespace) -> int:
    # Each topic needs an open file or two; some systems allow 1,024, though more may be had
    with suppress(ImportError, OSError, ValueError):  # Windows has no such limit
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(most, MOST_FILES), most))
    told = registrations(options)
    for topic in options.topics:
        if sentence := about_nobody(topic, told):
            remark(sentence)
    stop = Wake()  # a KeyboardInterrupt could come at the worst moment
    with _on_stop_signals(stop), join(options) as network, ExitStack() as leaving:
        recorder = Recorder(options.file, network=network, replace=options.force)
        leaving.callback(recorder.close)
        if options.topics:
            recorder.add(topic for topic in options.topics if topic not in options.without)
        else:
            recorder.follow(options.master, without=options.without)
        remark(f"Recording to {options.file}. Ctrl-C ends it.")
        _wait(recorder, options.seconds, stop)
    totals = recorder.totals
    say(
        f"Recorded {many(totals.messages, 'message')} of {many(len(totals.topics), 'topic')} "
        f"to {recorder.path} ({amount(recorder.file_bytes)})."
    )
    if recorder.lost:
        remark(f"{many(recorder.lost, 'message')} lost: this computer could not keep up.")
    return 0


@contextmanager
def _on_stop_signals(stop: Callable[[], None]) -> Iterator[None]:
    """Let Ctrl-C and the like call ``stop`` and nothing else."""
    before = {number: signal.signal(number, lambda *_: stop()) for number in STOP_SIGNALS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _wait(recorder: Recorder, most_s: float | None, stop: Wake) -> None:
    """Wait until the recording is over, telling how far it is on a terminal."""
    begin_s = told_s = time.monotonic()
    is_shown = sys.stderr.isatty()
    while not recorder.is_over:
        passed_s = time.monotonic() - begin_s
        left_s = LOOK_S if most_s is None else min(LOOK_S, most_s - passed_s)
        if left_s <= 0 or select.select([stop], [], [], left_s)[0]:
            break
        if is_shown and time.monotonic() - told_s >= TOLD_S:
            told_s, totals = time.monotonic(), recorder.totals
            heard = f"{many(totals.messages, 'message')}   {amount(totals.payload_bytes)}"
            line = f"\r{told_s - begin_s:.0f} s   {heard}   {recorder.lost} lost "
            print(line, end="", file=sys.stderr, flush=True)
    if is_shown:
        print(file=sys.stderr)


def _show(options: argparse.Namespace) -> int:
    told = overview(options.file)
    if options.json:
        say_json(
            {
                "seconds": told.seconds,
                "start_ns": told.start_ns,
                "end_ns": told.end_ns,
                "is_whole": told.is_whole,
                "topics": told.topics,
            }
        )
        return 0
    rows = [
        (
            topic,
            str(total.messages),
            amount(total.payload_bytes),
            ", ".join(sorted(total.encodings)),
            ", ".join(sorted(total.nodes)),
        )
        for topic, total in sorted(told.topics.items())
    ]
    say(f"{many(told.messages, 'message')} in {told.seconds:.1f} s")
    if rows:
        say(table(("TOPIC", "MESSAGES", "SIZE", "ENCODING", "FROM"), rows))
    _remark_on(told)
    return 0


def _remark_on(told: Overview) -> None:
    if not told.is_whole:
        remark("The file ends in the middle; what is before its end can be played.")
    if told.skipped:
        remark(f"Not readable for NEP: {', '.join(sorted(told.skipped))}.")


def _play(options: argparse.Namespace) -> int:
    with Player(
        options.file,
        join=lambda name: join(options, name),
        speed=options.speed,
        from_s=options.from_s,
        to_s=options.to_s,
        topics=options.topics,
        prefix=options.prefix,
        node_states=options.node_states,
    ) as player:
        _remark_on(player.overview)
        with _on_stop_signals(player.stop):
            is_heard = player.wait_for_subscribers(options.wait) or not options.wait
            if not is_heard and not player.is_stopping:
                remark("Not every topic is heard by somebody; it is played all the same.")
            player.play(loop=options.loop)
        if not player.sent and not player.is_stopping:
            raise RecordingError(
                "There was nothing to play in {file}.",
                checklist=(
                    "See what is in it: nep play {file} --info",
                    "Are --from, --to and --topics right?",
                    "{node_state} is played only with --node-states.",
                ),
                file=options.file,
                node_state=NODE_STATE,
            )
        say(f"Played {many(player.sent, 'message')} of {many(len(player.topics), 'topic')}.")
    return 0

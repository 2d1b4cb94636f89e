"""What robot developers do to publishers and subscribers beyond sending and receiving."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator

import msgspec
import pytest
import zmq

import nep_core
from nep_core.networks.master import Master
from nep_core.networks.network import Network
from nep_core.networks.zmq_networks import DirectNetwork, PeerNetwork
from nep_core.wire import frames, outbox
from nep_core.wire.frames import join, subscription
from nep_core.wire.inbox import MOST_PUBLISHERS, Backlog
from nep_core.wire.pubsub import Publisher, Subscriber

Join = Callable[[str], PeerNetwork]

posix = pytest.mark.skipif(sys.platform == "win32", reason="sends signals, forks")

FORKED = """
import os, sys
from nep_core.errors import NetworkError
from nep_core.wire.pubsub import Publisher, Subscriber

publisher = Publisher("/x")
hears = Subscriber("/y")
child = os.fork()
if not child:
    try:
        publisher.send({"from": "the child"})
    except NetworkError as error:
        Publisher("/x").send(error.sentence)
    sys.exit(0 if hears.receive() is None else 1)
_, status = os.waitpid(child, 0)
publisher.send({"status": status})
"""


@pytest.fixture
def pair(free_port: int) -> Iterator[tuple[Network, Network]]:
    """Two networks: who binds, as a subscriber does here, and who connects."""
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with (
        DirectNetwork(endpoint, binds="subscriber") as hearer,
        DirectNetwork(endpoint, binds="subscriber") as talker,
    ):
        yield hearer, talker


def test_null_is_skipped_and_ends_no_loop(pair: tuple[Network, Network]) -> None:
    subscriber = Subscriber[object]("/x", network=pair[0])
    publisher = Publisher("/x", network=pair[1], wait_for_subscribers=1)

    for number in range(200):  # alone, and then together in frames
        publisher.send(msgspec.Raw(b"null"))  # type: ignore[arg-type]
        publisher.send({"n": number})

    assert [subscriber.receive(5) for _ in range(200)] == [{"n": n} for n in range(200)]
    assert subscriber.lost == 0


def test_json_on_many_lines_arrives_whole_in_a_flood(pair: tuple[Network, Network]) -> None:
    subscriber = Subscriber[object]("/x", network=pair[0])
    publisher = Publisher("/x", network=pair[1], wait_for_subscribers=1)

    for _ in range(200):
        publisher.send(msgspec.Raw(b'{\n "a":\n 1}\n'))  # type: ignore[arg-type]

    assert [subscriber.receive(5) for _ in range(200)] == [{"a": 1}] * 200


def test_numbers_that_no_clock_or_counter_has_make_a_frame_unreadable() -> None:
    for head in (b'["n",-1,0]', b'["n",1,99999999999999999999]', b'["n",1,0,"json","",-5]'):
        with pytest.raises(frames.BadMessage):
            frames.read_header(head)


def test_what_waits_in_a_flood_goes_out_though_the_clock_is_set_back(
    pair: tuple[Network, Network], monkeypatch: pytest.MonkeyPatch
) -> None:
    subscriber = Subscriber[object]("/x", network=pair[0])
    publisher = Publisher("/x", network=pair[1], wait_for_subscribers=1)
    now_ns = time.time_ns()
    monkeypatch.setattr(outbox, "_now_ns", lambda: now_ns)
    for number in range(outbox.FLOOD + 1):
        publisher.send([number])

    monkeypatch.setattr(outbox, "_now_ns", lambda: now_ns - 3600 * 10**9)

    assert [subscriber.receive(5) for _ in range(outbox.FLOOD + 1)][-1] == [outbox.FLOOD]


@posix
def test_a_handler_of_a_signal_may_send_though_it_interrupts_a_sending(
    pair: tuple[Network, Network], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(outbox, "HELD_S", 0.05)
    subscriber = Subscriber[object]("/x", network=pair[0])
    publisher = Publisher("/x", network=pair[1], wait_for_subscribers=1)
    way_out = publisher.network.outbox.stream("/x", None)
    own_send = way_out._send_frame

    def interrupted(frame: bytes) -> object:  # the worst moment: the lock is held
        way_out._send_frame = own_send
        signal.raise_signal(signal.SIGUSR1)
        return own_send(frame)

    before = signal.signal(signal.SIGUSR1, lambda *_: publisher.send({"stop": True}))
    try:
        way_out._send_frame = interrupted
        publisher.send({"n": 1})
    finally:
        signal.signal(signal.SIGUSR1, before)

    assert [subscriber.receive(5), subscriber.receive(5)] == [{"n": 1}, {"stop": True}]
    assert subscriber.lost == 0


@posix
def test_a_handler_of_a_signal_may_close_the_subscriber_that_waits(
    pair: tuple[Network, Network], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.wire.inbox.LONGEST_WAIT_S", 0.1)
    subscriber = Subscriber[object]("/x", network=pair[0])
    main = threading.main_thread().ident or 0
    before = signal.signal(signal.SIGUSR1, lambda *_: subscriber.close())
    alarm = threading.Timer(0.1, lambda: signal.pthread_kill(main, signal.SIGUSR1))
    alarm.start()
    try:
        assert subscriber.receive(20) is None
    finally:
        alarm.join()
        signal.signal(signal.SIGUSR1, before)


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="there is no fork here")
def test_a_forked_child_is_told_that_it_needs_publishers_of_its_own(
    master: Master, join: Join
) -> None:
    subscriber = Subscriber[object]("/x", network=join("hearer"))

    program = subprocess.run([sys.executable, "-c", FORKED], timeout=30, check=False)

    told = [subscriber.receive(5), subscriber.receive(5)]
    assert program.returncode == 0
    assert "belongs to the process that this one was forked from" in str(told[0])
    assert told[1] == {"status": 0}


def test_a_callback_that_ends_itself_is_no_subscriber_any_more(master: Master, join: Join) -> None:
    Subscriber[object]("/x", network=join("hearer"), callback=lambda _: sys.exit())
    publisher = Publisher("/x", network=join("talker"), wait_for_subscribers=1)

    publisher.send({})

    end_s = time.monotonic() + 5
    while publisher.subscribers():
        assert time.monotonic() < end_s


def test_a_program_hears_more_topics_than_zeromq_has_sockets_by_itself(free_port: int) -> None:
    with DirectNetwork(f"tcp://127.0.0.1:{free_port}") as network:
        sockets = [network.context.socket(zmq.SUB) for _ in range(1100)]  # as subscribers have

        for one in sockets:
            one.close()


@posix
def test_a_program_that_may_open_no_more_files_is_told_so(free_port: int) -> None:
    program = """
import resource, sys
from nep_core.errors import NetworkError
from nep_core.networks.zmq_networks import DirectNetwork

resource.setrlimit(resource.RLIMIT_NOFILE, (40, 40))
with DirectNetwork(sys.argv[1]) as network:
    try:
        for number in range(100):
            network.open_inbox(f"/{number}")
    except NetworkError as error:
        print(error.sentence)
"""
    command = [sys.executable, "-c", program, f"tcp://127.0.0.1:{free_port}"]

    told = subprocess.run(command, capture_output=True, timeout=30, check=False)

    assert (told.returncode, told.stderr) == (0, b"")
    assert b"cannot be heard too: too many open files" in told.stdout


def test_a_publisher_that_is_heard_is_remembered_though_another_starts_again_and_again() -> None:
    backlog, topic = Backlog("/t"), subscription("/t")
    backlog.put(join(topic, "lasting", 1, 0, "json", b"0"))
    for start in range(2 * MOST_PUBLISHERS):
        backlog.put(join(topic, "restarting", 1, 0, "json", b"0", str(start)))
        if start % 100 == 0:
            backlog.put(join(topic, "lasting", 2 + start // 100, 0, "json", b"0"))

    backlog.put(join(topic, "lasting", 100, 0, "json", b"0"))

    assert backlog.lost == 100 - 22


def test_every_public_name_is_there() -> None:
    assert all(getattr(nep_core, name) for name in nep_core.__all__)

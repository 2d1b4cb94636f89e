"""The node that hears watches and phones, in a process of its own."""

import itertools
import socket
import sys
import threading
import time

import psutil
import pytest

from tests.node_running import until
from tests.nodes.sensory.connector_hearing import free_port, turned
from tests.nodes.sensory.senders import SensorLogger

pytestmark = pytest.mark.long


@pytest.fixture
def port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Watch:
    """Sends lines at 100 a second until it is stopped."""

    def __init__(self, port, line, address="127.0.0.1"):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((address, 0))
        self.line, self.port = line, port
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._send)

    def _send(self):
        number, began_s = 0, time.monotonic()
        while not self.stopped.wait(max(0.0, began_s + number * 0.01 - time.monotonic())):
            line = self.line(number)
            self.socket.sendto(line.encode(), ("127.0.0.1", self.port))
            number += 1

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_error):
        self.stopped.set()
        self.thread.join()
        self.socket.close()


def paper_watch(number):
    ns = 10**15 + number * 10_000_000
    return f"y;{ns};0.1;0.2;0.3\na;{ns};0;0;9.81\n"


def test_the_papers_watch_is_heard_with_both_sensors_and_its_own_clock(listener, port):
    listener.start("smartwatch", port=port)
    listener.state("ready", f"UDP port {port} (from this computer only)")

    with Watch(port, paper_watch):
        listener.state("connected", "127.0.0.1 sends 100 samples a second")
        batches = listener.batches_for(1.0)

    t = [at for batch in batches for at in batch.t]
    assert [b - a for a, b in itertools.pairwise(t)] == pytest.approx([0.01] * (len(t) - 1))
    assert len(t) > 70
    assert batches[-1].acc[0] == (0, 0, 9.81)
    assert batches[-1].gyr[0] == (0.1, 0.2, 0.3)
    assert batches[-1].rate_hz == pytest.approx(100, rel=0.02)
    assert batches[-1].gravity_included
    assert not batches[-1].simulated


def test_a_sender_without_a_clock_is_timed_by_ours(listener, port):
    listener.start("smartwatch", port=port)
    listener.state("ready")

    with Watch(port, lambda number: "0,0,9.81"):
        batch = listener.batches_until(lambda batch: batch.t[0] > 1.0)[-1]

    assert batch.rate_hz == pytest.approx(100, rel=0.1)
    assert batch.gyr is None


def test_silence_is_told_and_so_is_its_end(listener, port):
    listener.start("smartwatch", port=port)
    listener.state("ready")

    with Watch(port, paper_watch):
        listener.state("connected")
    listener.state("disconnected", "has sent nothing for 3 seconds")
    with Watch(port, paper_watch):
        listener.state("connected")


def test_lines_that_cannot_be_read_are_shown_once_in_a_while(listener, port):
    listener.start("smartwatch", port=port)
    listener.state("ready")

    with Watch(port, lambda number: "temperature is 20 degrees"):
        listener.state("warning", 'cannot be read: "temperature is 20 degrees"')
        heard = listener.states_for(1.5)

    assert [state for state in heard if state.event == "warning"] == []
    assert listener.imu.pending() == []


def test_a_second_sender_is_left_aside(listener, port):
    listener.start("smartwatch", port=port)
    listener.state("ready")

    with Watch(port, paper_watch):
        listener.state("connected", "127.0.0.1")
        with Watch(port, paper_watch, address="127.0.0.2"):
            listener.state("warning", "A second watch sends from 127.0.0.2")
            batches = listener.batches_for(0.5)

    assert {batch.source for batch in batches} == {"127.0.0.1"}


def test_a_flood_of_rubbish_does_not_end_the_node(listener, port):
    node = listener.start("smartwatch", port=port)
    listener.state("ready")
    rubbish = [b"\x00\xff" * 500, b"{" * 60_000, b"1,2,nan", b"1e400,1,1", b"\n" * 1000, b""]

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for number in range(6_000):
            sender.sendto(rubbish[number % len(rubbish)], ("127.0.0.1", port))
    with Watch(port, paper_watch):
        listener.state("connected")

    assert node.poll() is None


def test_a_port_that_is_taken_is_told_with_what_to_do(listener, port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", port))
        node = listener.start("smartwatch", port=port)
        _out, words = node.communicate(timeout=10)

    assert node.returncode == 1
    assert f"UDP port {port} cannot be opened" in words
    assert "another port" in words
    assert "Traceback" not in words


def test_sensor_logger_on_the_wrist_becomes_imu_with_its_measures(listener):
    port = free_port()
    listener.start("smartwatch", through="sensor_logger", port=port, wrist="right")
    listener.state("ready", f"Sensor Logger on HTTP port {port}")

    with SensorLogger(f"http://127.0.0.1:{port}/data", watch=True) as sender:
        sender.start(turned(6.0), speed=2)
        connected = listener.state("connected", "100 samples a second: wrist motion")
        batch = listener.batches_until(lambda batch: batch.t[0] > 1.0)[-1]
        alive = until(listener.states, lambda state: "rate_hz" in state.measures)[-1]

    assert connected.measures.keys() >= {"rate_hz", "loss", "gaps", "delay_ms"}
    assert alive.measures["loss"] == 0
    assert batch.wrist == "right"
    assert batch.gyr is not None
    assert batch.gravity_included


def test_a_missing_address_ends_the_node_with_what_to_do(listener):
    node = listener.start("smartwatch", through="phyphox")
    _out, words = node.communicate(timeout=10)

    assert node.returncode == 1
    assert "The address that phyphox shows on the phone is missing." in words
    assert "Traceback" not in words


@pytest.mark.skipif(sys.platform != "linux", reason="reads the memory of a process")
def test_floods_of_all_kinds_take_no_more_memory(listener, port):
    node = listener.start("smartwatch", port=port)
    listener.state("ready")
    process = psutil.Process(node.pid)
    floods = itertools.cycle(
        [
            lambda number: f"a;{number * 100_000};0;0;9.81",  # 10,000 samples a second
            lambda number: f"x{number},1,2",
            lambda number: ",".join(["1"] * (3 + number % 50)),
            lambda number: f'{{"t": {number}, "acc{number}": [1, 2, 3]}}',
        ]
    )

    sizes = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for _ in range(8):
            line = next(floods)
            for number in range(3_000):
                sender.sendto(line(number).encode(), ("127.0.0.1", port))
            sizes.append(process.memory_info().rss)
    with Watch(port, paper_watch):
        listener.state("connected")

    assert node.poll() is None
    assert max(sizes[4:]) - min(sizes[4:]) < 3_000_000

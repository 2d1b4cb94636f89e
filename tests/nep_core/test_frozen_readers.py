"""A reader that is frozen costs its publisher bounded memory, however large the messages are."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import psutil
import pytest

from nep_core.networks.zmq_networks import DirectNetwork
from nep_core.wire.outbox import HIGH_WATER_MARK, UNIT_BYTES
from nep_core.wire.pubsub import Publisher
from tests.nep_core.test_delivery import HEARER

pytestmark = pytest.mark.long

MOST_BYTES = HIGH_WATER_MARK * UNIT_BYTES
ALLOWANCE_BYTES = 40_000_000


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no program can be frozen here")
@pytest.mark.parametrize(
    ("size", "count"), [(1_000_000, 250), (100_000, 2500), (30_000, 8000), (1_000, 20_000)]
)
def test_what_waits_for_a_frozen_reader_is_bounded_in_bytes_and_losses_are_counted(
    free_port: int, size: int, count: int
) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with DirectNetwork(endpoint) as network:
        publisher = Publisher("/flood", network=network, encoding="bytes")
        hearer = subprocess.Popen(
            [sys.executable, "-c", HEARER, "direct", endpoint], stdout=subprocess.PIPE, text=True
        )
        try:
            assert publisher.wait_for_subscribers(1, 20)
            hearer.send_signal(signal.SIGSTOP)
            before_bytes = psutil.Process().memory_info().rss
            message, most_bytes = b"x" * size, 0
            for number in range(count):
                publisher.send(message)
                if number % 50 == 0:
                    most_bytes = max(most_bytes, psutil.Process().memory_info().rss)
            hearer.send_signal(signal.SIGCONT)

            assert hearer.stdout is not None
            received = lost = 0
            deadline_s = time.monotonic() + 20
            while received + lost < count and time.monotonic() < deadline_s:
                received, lost = (int(word) for word in hearer.stdout.readline().split())
        finally:
            hearer.kill()
            hearer.communicate()

    assert most_bytes - before_bytes < MOST_BYTES + ALLOWANCE_BYTES
    assert received + lost == count
    assert lost > 0

"""Over a long and bad line no message is missed uncounted, the first included."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.relay import Line, Relay

pytestmark = pytest.mark.long

Join = Callable[[str], PeerNetwork]
BAD = Line(delay_s=0.2, loss=0.02)
TOPICS = tuple(f"/far/{number}" for number in range(6))
"""Each is heard through a connection of its own, which has its own bad luck."""
SENT = 100
EVERY_S = 0.01
PATIENCE_S = 20.0


@pytest.fixture
def far(join: Join) -> Iterator[tuple[PeerNetwork, Relay]]:
    """A program that the others find at the far end of a bad line."""
    network = join("far")
    relay = Relay(int(network._client._registration.endpoint.rpartition(":")[2]), BAD, seed=1)
    network._client.change_later(
        lambda told: setattr(told, "endpoint", f"tcp://127.0.0.1:{relay.port}")
    )
    yield network, relay
    relay.close()


class Hearing:
    """What one subscriber has heard, in its order."""

    def __init__(self, topic: str, network: PeerNetwork) -> None:
        self.heard: list[int] = []
        self.subscriber = Subscriber[list[int]](topic, network=network, callback=self._hear)

    def _hear(self, message: list[int]) -> None:
        self.heard += message

    @property
    def known(self) -> int:
        """How many are accounted for."""
        return len(self.heard) + self.subscriber.lost


def publishers_of(network: PeerNetwork) -> list[Publisher]:
    """One for each topic; they wait for their subscribers side by side."""
    with ThreadPoolExecutor(len(TOPICS)) as threads:
        return list(threads.map(partial(Publisher, network=network), TOPICS))


def all_known(hearings: list[Hearing], sent: int = SENT) -> None:
    until_s = time.monotonic() + PATIENCE_S
    while any(one.known < sent for one in hearings) and time.monotonic() < until_s:
        time.sleep(0.05)
    told = [(one.known, one.heard[:2], one.heard[-2:], one.subscriber.lost) for one in hearings]
    assert [one.known for one in hearings] == [sent] * len(hearings), told
    assert all(one.heard == sorted(set(one.heard)) for one in hearings)


def test_far_away_each_message_is_heard_or_counted(
    far: tuple[PeerNetwork, Relay], join: Join
) -> None:
    network, _relay = far
    near = join("near")
    hearings = [Hearing(topic, near) for topic in TOPICS]

    publishers = publishers_of(network)
    for number in range(SENT):
        for publisher in publishers:
            publisher.send([number])
        time.sleep(EVERY_S)

    all_known(hearings)
    for publisher in publishers:
        assert publisher.wait_for_subscribers(1, PATIENCE_S)
        publisher.send([SENT])
    all_known(hearings, SENT + 1)
    assert all(one.heard[-1] == SENT for one in hearings)


@pytest.mark.parametrize("after_s", [0.0, 0.5])
def test_what_was_on_its_way_when_the_line_broke_is_counted(
    far: tuple[PeerNetwork, Relay], join: Join, after_s: float
) -> None:
    network, relay = far
    near = join("near")
    hearings = [Hearing(topic, near) for topic in TOPICS]
    publishers = publishers_of(network)
    assert all(publisher.wait_for_subscribers(1, PATIENCE_S) for publisher in publishers)
    begun_s = time.monotonic()

    for number in range(SENT):
        for publisher in publishers:
            publisher.send([number])
        if not relay.is_cut and time.monotonic() - begun_s >= after_s:
            relay.cut()
        time.sleep(EVERY_S)
    relay.mend()

    for publisher in publishers:
        publisher.wait_for_subscribers(1, PATIENCE_S)
    all_known(hearings)

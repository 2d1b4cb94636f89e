"""Hears a watch or phone, by whichever way its sensors come in.

One sender is followed until it falls silent, and it is told how that goes.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import TypeVar

from faults import Words, text_of
from nep_core.processes.node import MEASURES_S, Node
from nep_core.wire.messages import IMU, Imu, Wrist

from .connectors import CONNECTORS
from .connectors.connector import Arrived, Settings
from .sample_stream import Sample, SampleStream

# Bounds how many samples a second go on, when a sender floods.

T = TypeVar("T")

USEFUL_HZ = 500  # what no movement of a person needs more than
_FLOOD_HZ = 1_200  # from here on samples are left out
_OVER_S = 1.0


class Thinning:
    """Keeps every n-th sample of a flood, so that about 500 a second are left."""

    def __init__(self) -> None:
        self._began_s: float | None = None
        self._count = 0
        self._place = 0
        self.every = 1
        self.arriving_hz = 0.0

    def kept(self, samples: list[T], now_s: float) -> list[T]:
        """Those of these samples that go on."""
        self._measure(len(samples), now_s)
        if self.every == 1:
            return samples
        first = -self._place % self.every
        self._place += len(samples)
        return samples[first :: self.every]

    def _measure(self, count: int, now_s: float) -> None:
        if self._began_s is None:
            self._began_s = now_s  # what comes now belongs to the time before
            return
        self._count += count
        passed_s = now_s - self._began_s
        if self._count > _FLOOD_HZ * max(_OVER_S, passed_s) and self.every == 1:
            self._settle(max(passed_s, 0.1))  # at once, before a whole second has passed
        elif passed_s >= _OVER_S:
            self._settle(passed_s)
            self._began_s, self._count = now_s, 0

    def _settle(self, passed_s: float) -> None:
        self.arriving_hz = self._count / passed_s
        is_flood = self.arriving_hz > _FLOOD_HZ
        is_as_before = self.every > 1 and 0.8 < self.arriving_hz / self.every / USEFUL_HZ < 1.2
        if not is_as_before:
            self.every = max(1, round(self.arriving_hz / USEFUL_HZ)) if is_flood else 1


# Warnings of a node that may have cause for them a thousand times a second.

_EVERY_S = 5.0
_SAME_EVERY_S = 30.0
_REMEMBERED = 16


class Complaints:
    """Warns at most every few seconds, and of the same thing seldom."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._warned_s = -_EVERY_S
        self._last: dict[str, float] = {}

    def tell(self, words: Words, now_s: float, *, of: str = "") -> None:
        """Warn, unless it was just told; ``of`` names what is the same in other words."""
        if now_s - self._warned_s < _EVERY_S:
            return
        of = of or str(words)
        if now_s - self._last.get(of, -_SAME_EVERY_S) < _SAME_EVERY_S:
            return
        self._warned_s = now_s
        self._last.pop(of, None)
        self._last[of] = now_s
        if len(self._last) > _REMEMBERED:
            del self._last[next(iter(self._last))]
        self._node.warn(words)


_SILENT_S = 3.0
_MISSING_S = 10.0
_TOLD_AGAIN_S = 5.0
_LARGE_LOSS = 0.03
_RATE_CHANGE = 0.15


class Hearing:
    """Makes messages of what arrives, and says who sends, how fast, and what is wrong."""

    def __init__(self, node: Node, missing: Words) -> None:
        self._node = node
        self._missing = missing
        self.wrist: Wrist = ""
        self._complaints = Complaints(node)
        self._began_s = time.monotonic()
        self._ever_heard = False
        self._is_connected = False
        self._last_state: tuple[float, float, str, float] = (0.0, 0.0, "", 0.0)
        self._follow("", 0.0)

    def hear(self, arrivals: Sequence[Arrived], now_s: float) -> Imu | None:
        """The samples of these arrivals as a message, None where there are none."""
        samples: list[Sample] = []
        for arrived in arrivals:
            if arrived.trouble:
                self._ever_heard = True
                self._complaints.tell(arrived.trouble, now_s)
            if self._is_followed(arrived, now_s):
                samples += self._samples(arrived, now_s)
        kept = self._thinning.kept(samples, now_s)
        self._tell(now_s, has_samples=bool(samples))
        return self._message(kept) if kept and self._is_connected else None

    def _follow(self, sender: str, now_s: float) -> None:
        self._sender, self._since_s = sender, now_s
        self._heard_s = 0.0  # a usable reading
        self._measured_s = 0.0
        self._stream, self._thinning = SampleStream(), Thinning()
        self._columns = ""
        self._is_connected = False

    def _is_followed(self, arrived: Arrived, now_s: float) -> bool:
        if arrived.sender == self._sender:
            return True
        if self._sender and now_s - self._heard_s < _SILENT_S:
            if arrived.readings:
                told = text_of(
                    "A second watch sends from {sender}; {sender_2} is followed.",
                    sender=arrived.sender,
                    sender_2=self._sender,
                )
                self._complaints.tell(told, now_s)
            return False
        if arrived.trouble and not arrived.readings:
            return False
        self._follow(arrived.sender, now_s)
        return True

    def _samples(self, arrived: Arrived, now_s: float) -> list[Sample]:
        if arrived.readings:
            self._heard_s = now_s
            self._ever_heard = True
        self._columns = arrived.columns or self._columns
        if arrived.number is not None:
            self._stream.flow.add_message(arrived.number)
        samples = self._stream.samples(arrived.readings, arrived.arrived_s)
        self._tell_troubles(arrived, now_s)
        return samples

    def _tell_troubles(self, arrived: Arrived, now_s: float) -> None:
        if jump_s := self._stream.take_jump_s():
            told = text_of(
                "The clock of {sender} jumped ahead by {seconds} s; time goes on."
                if jump_s > 0
                else "The clock of {sender} jumped back by {seconds} s; time goes on.",
                sender=self._sender,
                seconds=f"{abs(jump_s):.0f}",
            )
            self._complaints.tell(told, now_s, of="jump")
        if arrived.dropped:
            self._complaints.tell(
                text_of(
                    "{sender} sends more than can be taken in; {dropped} values were left out.",
                    sender=self._sender,
                    dropped=arrived.dropped,
                ),
                now_s,
                of="dropped",
            )

    def _tell(self, now_s: float, *, has_samples: bool) -> None:
        if has_samples and self._stream.flow.rate_hz:
            self._tell_flow(now_s)
        elif self._is_connected and now_s - self._heard_s >= _SILENT_S:
            self._is_connected = False
            self._node.state(
                "disconnected", "{sender} has sent nothing for 3 seconds", sender=self._sender
            )
            self._since_s = now_s
        self._tell_silence(now_s)

    def _tell_flow(self, now_s: float) -> None:
        is_news = not self._is_connected or self._columns != self._last_state[2]
        if not is_news and now_s - self._measured_s < MEASURES_S:
            return
        self._measured_s = now_s
        if not self._is_connected or self._has_changed(now_s):
            self._is_connected = True
            rate_hz, loss = self._stream.flow.rate_hz, self._stream.flow.loss
            self._last_state = (rate_hz, loss, self._columns, now_s)
            self._tell_connected(rate_hz, loss)
        else:
            self._node.state("alive", measures=self._stream.measures)
        if self._thinning.every > 1:
            self._complaints.tell(
                text_of(
                    "{sender} sends {arriving_hz} samples a second, more than a movement needs; "
                    "about {useful_hz} of them are kept.",
                    sender=self._sender,
                    arriving_hz=f"{self._thinning.arriving_hz:.0f}",
                    useful_hz=USEFUL_HZ,
                ),
                now_s,
                of="flood",
            )

    def _tell_connected(self, rate_hz: float, loss: float) -> None:
        sends = "{sender} sends {rate_hz} samples a second"
        if loss >= _LARGE_LOSS:
            sends = "{sender} sends {rate_hz} samples a second, {loss} % get lost"
        elif self._columns:
            sends = "{sender} sends {rate_hz} samples a second: {columns}"
        self._node.state(
            "connected",
            sends,
            measures=self._stream.measures,
            sender=self._sender,
            rate_hz=f"{rate_hz:.0f}",
            loss=f"{loss * 100:.0f}",
            columns=self._columns,
        )

    def _has_changed(self, now_s: float) -> bool:
        rate_hz, loss, columns, told_s = self._last_state
        if columns != self._columns:
            return True
        if now_s - told_s < _TOLD_AGAIN_S:
            return False
        is_other_rate = abs(self._stream.flow.rate_hz - rate_hz) > _RATE_CHANGE * max(rate_hz, 1.0)
        now_loses = self._stream.flow.loss >= _LARGE_LOSS
        return is_other_rate or now_loses != (loss >= _LARGE_LOSS)

    def _tell_silence(self, now_s: float) -> None:
        """Tell once when nothing ever came, when a sender is there but silent, or feels nothing."""
        if not self._ever_heard and not self._sender and now_s - self._began_s >= _MISSING_S:
            self._ever_heard = True
            self._complaints.tell(self._missing, now_s)
        if not self._sender or self._is_connected or now_s - self._since_s < _MISSING_S:
            return
        self._since_s = float("inf")
        if not self._heard_s or now_s - self._heard_s < _SILENT_S:
            told = text_of(
                "{sender} sends no acceleration. Switch the accelerometer on in its app."
                if self._heard_s
                else "{sender} is connected but sends nothing. Start the measuring in its app.",
                sender=self._sender,
            )
            self._complaints.tell(told, now_s)

    def _message(self, samples: list[Sample]) -> Imu:
        gyr = [sample.gyr for sample in samples if sample.gyr is not None]
        return Imu(
            source=self._sender,
            rate_hz=self._stream.flow.rate_hz / self._thinning.every,
            t=[sample.t for sample in samples],
            acc=[sample.acc for sample in samples],
            gyr=gyr if len(gyr) == len(samples) else None,
            gravity_included=self._stream.gravity_included,
            wrist=self.wrist,
        )


_BATCH_S = 0.03


def run(
    node: Node,
    *,
    through: str,
    port: int,
    address: str,
    listen_on: str,
    wrist: Wrist,
    token: str,
    columns: str,
    units: str,
) -> None:
    """Publish ``/imu`` from what one sender sends; PortTaken or ParameterError when it cannot.

    ``node`` is this node, ``through`` the connector, ``port`` its port (0: its usual one),
    ``address`` the phone's or the device's, ``listen_on`` who may send, ``wrist`` where it is
    worn, ``token`` the phone page's, ``columns`` and ``units`` what its numbers are, where that
    is not to be guessed.
    """
    kind = CONNECTORS[through]
    connector = kind.make(Settings(port or kind.port, address, listen_on, token, columns, units))
    publisher = node.publisher(IMU)
    try:
        connector.open()
        node.ready(connector.where)
        hearing = Hearing(node, connector.missing)
        while not node.stopping:
            arrivals = connector.readings(time.monotonic() + _BATCH_S)
            hearing.wrist = wrist or getattr(connector, "hand", "")  # a phone's page asks for it
            if batch := hearing.hear(arrivals, time.monotonic()):
                publisher.send(batch)
    finally:
        connector.close()

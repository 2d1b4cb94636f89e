"""What has arrived for one subscriber and waits to be read.

It is bounded: of events the oldest are dropped and counted, of states only the newest is kept.
"""

from __future__ import annotations

from collections import deque

from nep_core.errors import BadMessage
from nep_core.frames import NUL, Header, read_header, subscription
from nep_core.network import Policy
from nep_core.tally import Tally

FRAMES = 10_000
"""Frames kept for a subscriber that does not read."""
BYTES = 64_000_000
"""Bytes kept for a subscriber that does not read; the newest frame is kept whatever its size."""


class Backlog:
    """The frames of a topic in the order of arrival; one thread at a time may use it.

    ``lost``: how many messages were sent but did not arrive, or were dropped here; any thread
    may ask. Of states nothing counts as lost: an old one is of no use.
    """

    def __init__(self, topic: str, policy: Policy = "events") -> None:
        self.policy = policy
        self._head_at = len(subscription(topic))
        self._tally = Tally()
        self._frames: deque[bytes] = deque()
        self._bytes = 0
        self._newest: dict[tuple[str, str], bytes] = {}
        self.passed = b""
        """A frame of events that its reader takes at once: it is counted at leisure."""

    def __len__(self) -> int:
        return len(self._frames) or len(self._newest)

    @property
    def lost(self) -> int:
        """How many messages are lost so far."""
        return self._tally.lost if self.policy == "events" else 0

    def put(self, frame: bytes) -> None:
        """Take in a frame or a notice."""
        self.count_passed()
        header, messages = self._read(frame)
        if header is None:
            if self.policy == "events":
                self._keep(frame)  # its reader tells what is wrong with it
        elif self._tally.note(header, messages):
            if self.policy == "events":
                self._keep(frame)
            else:
                self._keep_newest(header, frame)

    def pop(self) -> bytes | None:
        """The oldest frame that is here."""
        if self._frames:
            frame = self._frames.popleft()
            self._bytes -= len(frame)
            return frame
        if self._newest:
            return self._newest.pop(next(iter(self._newest)))
        return None

    def count_passed(self) -> None:
        """Count the frame that was passed by, before the next one comes."""
        if self.passed:
            passed, self.passed = self.passed, b""
            header, messages = self._read(passed)
            if header is not None:
                self._tally.note(header, messages)

    def _keep(self, frame: bytes) -> None:
        self._frames.append(frame)
        self._bytes += len(frame)
        while len(self._frames) > 1 and (len(self._frames) > FRAMES or self._bytes > BYTES):
            dropped = self._frames.popleft()
            self._bytes -= len(dropped)
            self._tally.lost += self._read(dropped)[1]

    def _keep_newest(self, header: Header, frame: bytes) -> None:
        sender = (header.node, header.run)
        if header.sent is None or sender not in self._newest:  # a notice brings what is old
            self._newest[sender] = frame

    def _read(self, frame: bytes) -> tuple[Header | None, int]:
        """The header (None: unreadable) and how many messages there are."""
        end = frame.find(NUL, self._head_at)
        try:
            header = read_header(frame[self._head_at : end if end >= 0 else None])
        except BadMessage:
            return None, 0
        if end < 0:
            return header, 0  # a mark
        if header.encoding != "json":
            return header, 1
        payloads = frame[end:]
        return header, len(payloads) - len(
            payloads.replace(NUL, b"")
        )  # count() is ten times slower

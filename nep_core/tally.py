"""How many messages were sent to a subscriber and did not arrive, publisher by publisher."""

from __future__ import annotations

from nep_core.frames import Header

MOST_PUBLISHERS = 1_000
"""Starts of publishers that are remembered, those heard last: a topic may live for weeks."""


class Tally:
    """Counts by the numbers of messages; told of each frame in the order of arrival."""

    def __init__(self) -> None:
        self.lost = 0
        self._known: dict[tuple[str, str], list[int]] = {}
        """By node and run: the numbers of the first message received and the last one sent, and
        at which note of ours it was heard last."""
        self._notes = 0

    def note(self, header: Header, messages: int) -> bool:
        """Count a frame with so many messages; whether they are new to the subscriber."""
        known = self._known.get((header.node, header.run))
        self._notes += 1
        if known is not None:
            known[2] = self._notes
        if header.sent is not None:
            return self._note_notice(header, messages, known)
        last = header.sequence + messages - 1
        if known is None:
            self._remember(header, header.sequence, last)
        else:
            if header.sequence > known[1] + 1:
                self.lost += header.sequence - known[1] - 1
            known[1] = last  # lower than before: a sender without a run has started again
        return True

    def _note_notice(self, header: Header, messages: int, known: list[int] | None) -> bool:
        sent = header.sent or 0
        if known is None:
            self._remember(header, sent + 1, sent)
            return messages > 0
        was_lost = header.sequence > known[1]
        is_new = messages > 0 and (was_lost or header.sequence < known[0])
        self.lost += max(0, sent - known[1] - (messages if was_lost else 0))
        known[1] = max(known[1], sent)
        if is_new:
            known[0] = min(known[0], header.sequence)
        return is_new

    def _remember(self, header: Header, first: int, last: int) -> None:
        if len(self._known) >= MOST_PUBLISHERS:
            del self._known[min(self._known, key=lambda start: self._known[start][2])]
        self._known[header.node, header.run] = [first, last, self._notes]

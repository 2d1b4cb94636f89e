"""Takes the messages of all open pages, and gives on those of the phone that is followed."""

from __future__ import annotations

import time
from collections.abc import Callable

from nodes.sensory.phone_page.batch import PageMessage, readings_of
from nodes.sensory.phone_page.turn import Allowance, Turn
from nodes.sensory.ways.way import Arrived

MESSAGES_S, MESSAGES_AT_ONCE = 60.0, 120.0
SAMPLES_S, SAMPLES_AT_ONCE = 500.0, 1500.0  # twice what the fastest phone sends
TOLD_EVERY_S = 5.0

FOLLOWED, BUSY = "followed", "busy"
"""What a phone is told: that its samples are used, or that another phone is followed."""


class Receiving:
    """``give`` gets each batch of the phone that is followed, and what the user should know."""

    def __init__(
        self, give: Callable[[Arrived], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._give, self._clock = give, clock
        self._turn = Turn()
        self._messages = Allowance(MESSAGES_S, MESSAGES_AT_ONCE)
        self._samples = Allowance(SAMPLES_S, SAMPLES_AT_ONCE)
        self._sentences = Allowance(1 / TOLD_EVERY_S, 1.0)
        self._followed = ""
        self.hand = ""
        """Where the followed phone is, as chosen on the page: left, right or hand."""

    def may_send(self, address: str) -> bool:
        """Whether a message of this address is still one of a page, and not of a flood."""
        return self._messages.grants(address, self._clock())

    def take(self, message: PageMessage, address: str) -> str:
        """Give a message on if it is its phone's turn; what the phone is told."""
        now_s = self._clock()
        if not message.t:
            return FOLLOWED if self._turn.is_free_for(message.id, now_s) else BUSY
        if not self._turn.take(message.id, now_s):
            self._tell_of_second(_name(message, address), now_s)
            return BUSY
        self._followed = _name(message, address)
        is_granted = self._samples.grants(address, now_s, len(message.t))
        self.hand = message.hand
        arrived = Arrived(
            sender=self._followed,
            readings=readings_of(message) if is_granted else (),
            arrived_s=now_s,
            dropped=message.lost + (0 if is_granted else len(message.t)),
        )
        self._give(arrived)
        return FOLLOWED

    @property
    def followed_s(self) -> float:
        """When something came last from the phone that is followed."""
        return self._turn.heard_s

    def leave(self, phone: str, followed_s: float) -> None:
        """A connection of a phone, its id, was closed; by it the phone was followed last then."""
        self._turn.leave(phone, followed_s)

    def _tell_of_second(self, name: str, now_s: float) -> None:
        if self._sentences.grants("", now_s):
            told = f"A second phone ({name}) has the page open; {self._followed} is followed."
            self._give(Arrived(self._followed, arrived_s=now_s, trouble=told))


def _name(message: PageMessage, address: str) -> str:
    return f"{message.device} {address}" if message.device.isalnum() else address

"""Who was refused, and whom we could not talk to, gathered into one sentence at a time."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable

from nep_core.security.addresses import is_loopback, own_addresses

MOST_PLACES = 20
"""So many are told apart; somebody who knocks from everywhere fills no memory."""


REPEAT_S = 4.0
"""The same sentence is told again after so long: who is refused goes on knocking."""


class Refusals:
    """Filled by the thread that guards, emptied by whoever tells people."""

    def __init__(self, key_file: str) -> None:
        self._key_file = key_file
        self._lock = threading.Lock()
        self._refused: set[str] = set()
        self._unable: set[str] = set()
        self._last = ""
        self._repeat_s = 0.0

    def refuse(self, address: str) -> None:
        """Note that a program at ``address`` ("" when not known) was not let in."""
        with self._lock:
            if len(self._refused) < MOST_PLACES:
                self._refused.add(address)

    def cannot_join(self, endpoint: str) -> None:
        """Note that whoever is at ``endpoint`` does not take us, or has no keys."""
        with self._lock:
            if len(self._unable) < MOST_PLACES:
                self._unable.add(endpoint)

    def take(self) -> str:
        """What happened since the last time and what to do; "" when nothing did."""
        with self._lock:
            refused, self._refused = self._refused, set()
            unable, self._unable = self._unable, set()
        sentence = " ".join(filter(None, (self._about_refused(refused), _about_unable(unable))))
        now_s = time.monotonic()
        if not sentence or (sentence == self._last and now_s < self._repeat_s):
            return ""
        self._last, self._repeat_s = sentence, now_s + REPEAT_S
        return sentence

    def _about_refused(self, addresses: set[str]) -> str:
        if not addresses:
            return ""
        own = set(own_addresses())
        ours = {address for address in addresses if address in own or is_loopback(address)}
        others = addresses - ours
        if addresses != {""}:  # one that left too early to be seen adds nothing
            others.discard("")
        sentences = []
        if others:
            sentences.append(
                f"A program at {_places(others)} showed no key of this network and was refused. "
                "Pair that computer (nep pair), or stop the program there."
            )
        if ours:
            sentences.append(
                "A program of this computer showed no key of this network and was refused. "
                f"Set NEP_KEYS to {self._key_file} before you start it."
            )
        return " ".join(sentences)


def _about_unable(endpoints: set[str]) -> str:
    if not endpoints:
        return ""
    return (
        f"The program at {_places(endpoints)} does not have the keys of this network, or does not "
        "know ours. Start it with NEP_KEYS, or pair the two computers."
    )


def _places(places: Iterable[str]) -> str:
    known = sorted(filter(None, places)) or ["an unknown address"]
    more = f" and {len(known) - 3} more" if len(known) > 3 else ""
    return ", ".join(known[:3]) + more

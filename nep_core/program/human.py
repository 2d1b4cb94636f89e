"""What the person does, as the program last heard it."""

from __future__ import annotations

import contextvars
import math
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from nep_core.networks.network import Network
from nep_core.networks.transports import default_network
from nep_core.wire.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.wire.pubsub import Subscriber
from nep_core.wire.states import HEARD, NOISE, word_of_state

from .tasks import CLOCK, POLL_S, Countdown, Stamp, current_task

LONGEST_WAIT_S = 3600.0


def next_state(
    heard: list[str], seconds: float, resume: Callable[[], object] = lambda: None
) -> str:
    """Wait for the first state of ``heard``, which grows meanwhile; "" when none is in time.

    What is heard while this part is held was said to somebody else; then ``resume`` is called, and
    it waits on.
    """
    task, countdown = current_task(), Countdown(seconds)
    while True:
        if heard:
            return heard[0]
        if (left_s := countdown.left_s()) <= 0:
            return ""
        task.sleep(min(POLL_S, left_s))
        if task.is_held:
            task.stand_still()
            resume()
            countdown.skip()
            heard.clear()


REMEMBER_S = 3.0
"""How long a state such as a gesture stays the human's state after it was seen."""


MOST_STATES = 1000
"""So many states are remembered, of which the oldest are forgotten."""

Listener = Callable[[HumanBehavior], None]


@dataclass
class Seen:
    """When a state was last seen (by the program's clock, s), and how often."""

    last_s: float = 0.0
    times: int = 0


class HumanListener:
    """Hears ``/human_behavior`` for a whole program.

    What comes before the first listener is there is kept for it (the last 100 messages).
    """

    def __init__(self, network: Network) -> None:
        self.state = ""
        """What was heard last."""
        self.heard_s = -math.inf
        """When anything was last heard, by the program's clock."""
        self._seen: dict[str, Seen] = {}
        self.told: dict[str, Stamp] = {}
        """When each robot or node told of the person last."""
        self.of_rules: frozenset[str] = frozenset()
        """The states that rules of the program wait for."""
        self.remembered_until_s: dict[str, float] = {}
        """Until when, by the program's clock, states are remembered."""
        self._lock = threading.RLock()
        self._listeners: list[Listener] = []
        self._kept: deque[HumanBehavior] = deque(maxlen=100)
        self.subscriber = Subscriber(
            HUMAN_BEHAVIOR, HumanBehavior, network=network, callback=self._on_behavior
        )

    def listen(self, listener: Listener) -> None:
        """Call ``listener`` with every message, in their order, from another thread."""
        with self._lock:
            self._listeners.append(listener)
            while self._kept:
                listener(self._kept.popleft())

    def unlisten(self, listener: Listener) -> None:
        """Call ``listener`` no more."""
        with self._lock:
            self._listeners.remove(listener)

    def seen(self, state: str) -> Seen:
        """When a state was last seen, and how often; times 0 when never."""
        return self._seen.get(state, Seen())

    def last_of(self, beginning: str, *others: str) -> str:
        """The state seen last of those that begin so, but for others; "" when there was none."""
        with self._lock:
            fitting = [s for s in self._seen if s.startswith(beginning) and s not in others]
            return max(fitting, key=lambda state: self._seen[state].last_s, default="")

    @contextmanager
    def following(self, counts: Callable[[HumanBehavior], bool]) -> Iterator[list[str]]:
        """Give a list that grows by every state from now on that counts."""
        states: list[str] = []

        def note(behavior: HumanBehavior) -> None:
            if counts(behavior):
                states.append(behavior.human_state)

        with self._lock:
            self._listeners.append(note)  # not by listen(): what was before is not meant
        try:
            yield states
        finally:
            self.unlisten(note)

    def _on_behavior(self, behavior: HumanBehavior) -> None:
        with self._lock:
            self.state, self.heard_s = behavior.human_state, CLOCK.now_s()
            self.told.pop(behavior.source, None)
            self.told[behavior.source] = Stamp(behavior.time, time.monotonic())
            if len(self.told) > MOST_STATES:
                del self.told[next(iter(self.told))]
            seen = self._seen.pop(self.state, Seen())  # the newest last
            self._seen[self.state] = Seen(self.heard_s, seen.times + 1)
            if len(self._seen) > MOST_STATES:
                del self._seen[next(iter(self._seen))]
            if not self._listeners:
                self._kept.append(behavior)
            for listener in list(self._listeners):
                listener(behavior)


def human_listener(network: Network | None = None) -> HumanListener:
    """The listener of this program's network."""
    return (network or default_network()).shared(HumanListener)


def human_state() -> str:
    """What the person did last, such as "gesture_karate"; "" when nothing for 3 s."""
    listener = human_listener()
    return listener.state if CLOCK.now_s() - listener.heard_s <= REMEMBER_S else ""


def was_seen(state: str, seconds: float) -> bool:
    """Whether the person did that in the last so many seconds."""
    seen = human_listener().seen(state)
    return seen.times > 0 and CLOCK.now_s() - seen.last_s <= seconds


def times_seen(state: str) -> int:
    """How often the person did that since the program has started."""
    return human_listener().seen(state).times


def remember(state: str, seconds: float) -> None:
    """Remember something from now on for some seconds."""
    human_listener().remembered_until_s[state] = CLOCK.now_s() + seconds


def is_remembered(state: str) -> bool:
    """Whether something is remembered still."""
    return CLOCK.now_s() < human_listener().remembered_until_s.get(state, 0.0)


def until_state(state: str, most: float = float("inf")) -> Iterator[int]:
    """Count 1, 2, 3 ... until the person does that, at most so far: for loops.

    What they did before the loop began does not count; it is looked at before each turn.
    """
    task, number = current_task(), 0
    before = times_seen(state)
    while number < most and times_seen(state) == before:
        task.stand_still()
        number += 1
        yield number


def heard_word() -> str:
    """The word that was heard last, "" when there was none."""
    return word_of_state(human_listener().last_of(HEARD, NOISE))


_answer: contextvars.ContextVar[str] = contextvars.ContextVar("nep_answer", default="")


def heard_answer() -> str:
    """What was answered to the question asked last in this part of a rule; "" when nothing was.

    It is a word that was wanted, or another one as it was heard; "" for one not understood.
    """
    return _answer.get()


def note_answer(answer: str) -> None:
    """Let this be what was answered last in this part of a rule; "" where a rule begins."""
    _answer.set(answer)

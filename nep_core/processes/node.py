"""A node: a small program with a name, which tells how it is doing and stops when it is asked."""

from __future__ import annotations

import logging
import math
import os
import select
import signal
import socket
import time
import unicodedata
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar, get_args
from weakref import ref

from faults import Fault, Words, fault_in, fault_of, text_of
from nep_core.errors import NepError, ParameterError
from nep_core.networks.network import Network, Policy
from nep_core.networks.transports import network_for
from nep_core.wire.frames import MOST, Encoding
from nep_core.wire.io_thread import Wake
from nep_core.wire.messages import (
    LONGEST_NAME,
    NODE_STATE,
    NodeEvent,
    NodeState,
    NodeType,
    described,
)
from nep_core.wire.pubsub import Publisher, Subscriber

log = logging.getLogger(__name__)


def check_node_name(name: str) -> str:
    """Give back ``name``, or raise ParameterError that says what is wrong with it."""
    if not name.strip():
        wrong = text_of("A node has no name.")
    elif len(name) > LONGEST_NAME:
        wrong = text_of(
            "The name {name}... is longer than {longest_name} letters.",
            name=repr(name[:20]),
            longest_name=LONGEST_NAME,
        )
    elif any(unicodedata.category(letter) in ("Cc", "Cs") for letter in name):
        wrong = text_of(
            "The name {name} has a letter in it that cannot be written.", name=repr(name)
        )
    else:
        return name
    raise ParameterError(wrong, checklist=("Give the node a short name, such as watch.",))


T = TypeVar("T")

HEARTBEAT_S = 1.0
LONGEST_WAIT_S = 1e9
"""Thirty years: no system waits longer at once."""
MEASURES_S = 0.5
"""Measures alone are sent no more often than this."""
QUIET_BEATS = 5
"""After so many heartbeats without another lost message a node is well again."""
STOP_SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGTERM", "SIGINT", "SIGBREAK") if hasattr(signal, name)
)


@dataclass(eq=False)
class _Listening:
    """A subscriber, as long as the node keeps it, and how many messages it had lost so far."""

    subscriber: ref[Subscriber[Any]]
    lost: int = 0


class Node:
    """A node in this process; raises MasterNotFound, NameTaken or ParameterError if it cannot join.

    Its states go out on ``/node_state``, with a heartbeat once a second. Use it in a ``with``
    statement: leaving it tells "stopped", or "crashed" with the error's sentence.
    """

    def __init__(self, name: str, type: NodeType, *, network: Network | None = None) -> None:
        self.name = check_node_name(name)
        self.type = _check(type, NodeType, "type")
        self.network = network or network_for(name)
        self.was_asked = False
        """Whether it stops because somebody in the network asked it to."""
        self.stopping = False
        """Whether it has been asked to stop."""
        self._stopped = Wake()  # an Event could deadlock in a signal handler
        self._host = socket.gethostname()
        self._listening: list[_Listening] = []
        self._beats_since_loss = QUIET_BEATS
        self._well_again = ""
        self._next_beat_s = time.monotonic() + HEARTBEAT_S
        self._next_measures_s = -math.inf
        self._last_state: tuple[NodeEvent, Fault] | None = None
        try:
            self._states = Publisher(NODE_STATE, network=self.network)
        except BaseException:
            if network is None:
                self.network.close()  # else it would go on asking for the name
            raise
        self.state("starting")
        self.network.on_stop = self._on_stop_asked
        self.network.io.tend(self._beat)

    def publisher(
        self, topic: str, *, encoding: Encoding | None = None, latched: bool | None = None
    ) -> Publisher:
        """A publisher of this node."""
        return Publisher(topic, network=self.network, encoding=encoding, latched=latched)

    def subscriber(
        self,
        topic: str,
        kind: type[T] | None = None,
        *,
        callback: Callable[[T], None] | None = None,
        policy: Policy | None = None,
    ) -> Subscriber[T]:
        """A subscriber of this node; its waits end when the node stops.

        ``topic`` is heard, ``kind`` the struct that messages are read into; ``callback``
        and ``policy`` are as those of Subscriber.
        """
        subscriber = Subscriber(topic, kind, network=self.network, callback=callback, policy=policy)
        self.follow(subscriber)
        return subscriber

    def follow(self, subscriber: Subscriber[Any]) -> None:
        """Tell of the messages that this one loses, too, which somebody else has made."""
        self._listening.append(_Listening(ref(subscriber)))

    def state(
        self,
        event: NodeEvent,
        words: Words | Fault = "",
        /,
        *,
        code: str = "",
        checklist: Sequence[Words] = (),
        measures: Mapping[str, float] | None = None,
        **values: object,
    ) -> bool:
        """Tell how the node is doing, and what it measures about itself; whether it went out.

        ``words`` are a template whose places the ``values`` fill; ``code`` says the same to
        programs, ``checklist`` what a person may try. The same state again with measures goes out
        as a heartbeat with them, at most twice a second, so that it can be told as often as the
        node likes.

        ``event`` is which state it is in.
        """
        fault = fault_of(words, code=code, checklist=checklist, **values)
        if measures is not None and (event == "alive" or self._last_state == (event, fault)):
            return self._measure(measures)
        self._last_state = (_check(event, NodeEvent, "state"), fault)
        self._states.send(self._state(event, fault, measures))
        return True

    def ready(self, words: Words = "", /, **values: object) -> None:
        """Tell that the node is ready, and for what."""
        self.state("ready", text_of(words, **values))

    def warn(
        self,
        words: Words | Fault,
        /,
        *,
        code: str = "",
        checklist: Sequence[Words] = (),
        **values: object,
    ) -> None:
        """Tell of something that a person should look at."""
        fault = fault_of(words, code=code, checklist=checklist, **values)
        log.warning("%s", " ".join(str(words) for words in (fault, *fault.checklist)))
        self.state("warning", fault)

    def wait(self, seconds: float) -> bool:
        """Wait so long; True at once when the node is asked to stop."""
        if not self.stopping:
            select.select([self._stopped], [], [], max(0.0, min(seconds, LONGEST_WAIT_S)))
        return self.stopping

    def stop(self) -> None:
        """Ask the node to stop; safe in a signal handler and from any thread."""
        self.stopping = True
        self._stopped()
        self.network.interrupt()

    def stop_on_signals(self) -> None:
        """Stop cleanly on SIGTERM, Ctrl-C and (Windows) Ctrl-Break; only in the main thread."""
        for number in STOP_SIGNALS:
            signal.signal(number, self._on_signal)

    def close(self, event: NodeEvent = "stopped", fault: Fault | None = None) -> None:
        """Say how it ended and leave the network."""
        if not self.network.closed:
            self.network.io.forget(self._beat)
            if fault is None:
                fault = fault_of("It was asked to stop." if self.was_asked else "")
            self.state(event, fault)
            self.network.close()

    def __enter__(self) -> Node:
        return self

    def __exit__(self, _kind: object, error: BaseException | None, _trace: object) -> None:
        is_its_end = self.stopping and isinstance(error, NepError)  # the network has gone first
        if error is None or is_its_end or isinstance(error, KeyboardInterrupt | SystemExit):
            self.close()
        else:
            self.close("crashed", fault_in(error))

    def _on_stop_asked(self) -> None:
        self.was_asked = True
        self.stop()

    def _on_signal(self, number: int, _frame: Any) -> None:
        if self.stopping and number == signal.SIGINT:  # a second Ctrl-C: somebody is in a hurry
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
        self.stop()

    def _measure(self, measures: Mapping[str, float]) -> bool:
        if time.monotonic() < self._next_measures_s:
            return False
        self._next_measures_s = time.monotonic() + MEASURES_S
        self._states.send(self._state("alive", measures=measures), latch=False)
        return True

    def _state(
        self,
        event: NodeEvent,
        fault: Fault | None = None,
        measures: Mapping[str, float] | None = None,
    ) -> NodeState:
        told = (measures or {}).items()
        return NodeState(
            node=self.name,
            type=self.type,
            event=event,
            # JSON has no NaN and no infinities
            measures={name: value for name, value in told if math.isfinite(value)},
            pid=os.getpid(),
            host=self._host,
            **(described(fault) if fault is not None else {}),
        )

    def _beat(self) -> None:
        if time.monotonic() >= self._next_beat_s:
            self._next_beat_s = time.monotonic() + HEARTBEAT_S
            # Not latched: a late joiner wants to know that the node is ready, not that it lives.
            self._states.send(self._state("alive"), latch=False)
            self._look_for_losses()
            if warning := self.network.take_warning():
                self.warn(warning)
                self._beats_since_loss, self._well_again = 0, "The network is quiet again."

    def _look_for_losses(self) -> None:
        """Warn when more messages came than the node could take, and say when that is over."""
        lost: Counter[str] = Counter()
        for one in list(self._listening):
            if (subscriber := one.subscriber()) is None:
                self._listening.remove(one)
            elif (count := subscriber.lost) > one.lost:
                lost[subscriber.topic] += count - one.lost
                one.lost = count
        if lost:
            self._beats_since_loss, self._well_again = 0, "It keeps up again."
            words = "Messages of {lost} were lost: {count}. It could not keep up."
            self.state("warning", words, lost=", ".join(lost), count=min(lost.total(), MOST))
        elif self._beats_since_loss < QUIET_BEATS:
            self._beats_since_loss += 1
            if self._beats_since_loss == QUIET_BEATS:
                self.state("running", self._well_again)


def _check(word: T, known: Any, what: str) -> T:
    """Give back one of the words that others know; raises ParameterError."""
    words = get_args(known)
    if word not in words:
        raise ParameterError(
            "{word} is no {what} of a node.",
            checklist=("Use one of: {words}.",),
            word=repr(word),
            what=what,
            words=", ".join(words),
        )
    return word

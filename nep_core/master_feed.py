"""Following what a master has registered, for tools that show it."""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from collections.abc import Callable
from typing import Self

import msgspec
import zmq

from nep_core import master_messages as says
from nep_core import security
from nep_core.endpoints import fixed_endpoint
from nep_core.io_thread import Wake
from nep_core.registry import Registration

log = logging.getLogger(__name__)

RENEW_S = 0.5
"""How often the feed asks again: for the lease, and for what it may have missed."""
SILENT_S = 3 * RENEW_S
LOOK_MS = 100

OnChange = Callable[[list[Registration]], None]


class MasterFeed:
    """Calls ``on_change``, in a thread of its own, with all registrations whenever they change.

    While no master answers the last registrations stay, since programs go on without it;
    ``is_answered`` says so, and that change is told too. Raises NetworkError when ``master`` is
    not an endpoint.
    """

    def __init__(self, master: str, on_change: OnChange) -> None:
        self.master = fixed_endpoint(master)
        trust = security.trust_in_master()
        self.is_answered = False
        self._on_change = on_change
        self._told: dict[str, Registration] = {}
        self._epoch, self._number = "", 0
        self._heard_s = self._asked_s = 0.0
        self._is_closed = False
        self._wake = Wake()
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._socket = self._context.socket(zmq.DEALER)
        self._socket.linger = 0
        self._socket.setsockopt(zmq.IMMEDIATE, 1)
        self._socket.setsockopt(zmq.IPV6, int("[" in master))
        self._socket.reconnect_ivl_max = 500
        trust(self._socket)
        self._socket.connect(master)
        self._thread = threading.Thread(target=self._run, name="nep-master-feed", daemon=True)
        self._thread.start()

    @property
    def registrations(self) -> list[Registration]:
        """What was registered when the master was last heard."""
        return list(self._told.values())

    def close(self) -> None:
        """Follow no more; waits for a callback that is running, unless it is the caller."""
        self._is_closed = True
        self._wake()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _run(self) -> None:
        poller = zmq.Poller()
        poller.register(self._socket, zmq.POLLIN)
        poller.register(self._wake.fileno(), zmq.POLLIN)
        while not self._is_closed:
            before = self._told, self.is_answered
            self._ask()
            poller.poll(LOOK_MS)
            self._hear()
            if not self._is_closed and (self._told, self.is_answered) != before:
                self._tell()
        self._context.destroy(linger=0)
        self._wake.close()

    def _tell(self) -> None:
        try:
            self._on_change(self.registrations)
        except Exception:
            log.exception("the callback of the master's feed failed")

    def _ask(self) -> None:
        now_s = time.monotonic()
        self.is_answered = self.is_answered and now_s - self._heard_s < SILENT_S
        if now_s - self._asked_s < RENEW_S:
            return
        with contextlib.suppress(zmq.Again):  # the master is away
            request = says.Watch(epoch=self._epoch, number=self._number)
            self._socket.send(says.encode(request), zmq.NOBLOCK)
            self._asked_s = now_s

    def _hear(self) -> None:
        """Take in what has come."""
        with contextlib.suppress(zmq.Again):
            while True:
                frame = self._socket.recv(zmq.NOBLOCK)
                try:
                    answer = says.decode_answer(frame)
                except msgspec.MsgspecError as error:
                    log.warning("the master says what cannot be read: %s", error)
                    continue
                self._take_in(answer)

    def _take_in(self, answer: says.Answer) -> None:
        self.is_answered, self._heard_s = True, time.monotonic()
        match answer:
            case says.Listing():
                self._epoch, self._number = answer.epoch, answer.number
                self._told = {told.instance: told for told in answer.registrations}
            case says.Changed() if answer.epoch == self._epoch:
                if answer.number > self._number + 1:
                    self._asked_s = 0.0  # one was missed: ask at once
                    return
                self._number = max(answer.number, self._number)
                came = {told.instance: told for told in answer.came}
                self._told = {
                    i: told for i, told in {**self._told, **came}.items() if i not in answer.gone
                }

"""A program's side of the talk with the master: register, stay known, hear of changes."""

from __future__ import annotations

import contextlib
import copy
import logging
import os
import socket as sockets
import threading
import time
from collections.abc import Callable

import msgspec
import zmq

from nep_core import master_messages as says
from nep_core.errors import NameTaken, NetworkError
from nep_core.io_thread import IoThread
from nep_core.master_probe import no_master
from nep_core.registry import Publishing, Registration

log = logging.getLogger(__name__)

HEARTBEAT_S = 0.5
ANSWER_S = 5.0
"""How long a program waits for its master before it says that there is none."""

OnPublishers = Callable[[str, list[Publishing]], None]


class MasterClient:
    """Keeps this program's registration true; its DEALER socket belongs to the I/O thread."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        io: IoThread,
        master: str,
        told: Registration,
        on_publishers: OnPublishers,
    ) -> None:
        self.master = master
        self._told = told
        self._on_publishers = on_publishers
        self._io = io
        self._socket = context.socket(zmq.DEALER)
        self._socket.linger = 200
        self._socket.setsockopt(zmq.IMMEDIATE, 1)  # nothing piles up while the master is away
        self._socket.reconnect_ivl_max = 500
        self._socket.connect(master)
        self._changed = threading.Condition()
        self._version = 0
        self._sent_version = 0
        self._answer: says.Registered | says.Refused | None = None
        self._epoch = ""
        self._next_beat_s = 0.0
        self._closed = False
        io.watch(self._socket)
        io.tend(self.tend)

    @staticmethod
    def registration(node: str, instance: str, endpoint: str) -> Registration:
        """What this process tells of itself before it has any topic."""
        return Registration(
            instance=instance,
            node=node,
            pid=os.getpid(),
            host=sockets.gethostname(),
            endpoint=endpoint,
        )

    def change(self, edit: Callable[[Registration], None]) -> says.Registered:
        """Change what is told and wait for the master's answer; MasterNotFound or NameTaken."""
        with self._changed:
            told = copy.deepcopy(self._told)
            edit(told)
            self._told = told
            self._version += 1
            version = self._version
            self._io.wake()
            self._changed.wait_for(lambda: self._closed or self._answered(version), ANSWER_S)
            answer, answered = self._answer, self._answered(version)
        if self._closed:
            raise NetworkError(
                f"The network of {told.node} is closed.", checklist=("Start it again.",)
            )
        if not answered or answer is None:
            raise no_master(self.master)
        if isinstance(answer, says.Refused):
            raise NameTaken(answer.sentence, checklist=tuple(answer.checklist))
        return answer

    def change_later(self, edit: Callable[[Registration], None]) -> None:
        """Change what is told without waiting."""
        with self._changed:
            self._told = copy.deepcopy(self._told)
            edit(self._told)
            self._version += 1
        self._io.wake()

    def tend(self) -> None:
        """Read what the master says, and say what it should know (the I/O thread)."""
        for answer in self._arrived():
            self._hear(answer)
        if self._sent_version < self._version:
            self._register()
        elif time.monotonic() >= self._next_beat_s:
            self._next_beat_s = time.monotonic() + HEARTBEAT_S
            self._say(says.Alive(instance=self._told.instance))

    def close(self) -> None:
        """Say good-bye; after the I/O thread has ended."""
        self._say(says.Bye(instance=self._told.instance))
        self._socket.close()
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _answered(self, version: int) -> bool:
        return self._answer is not None and self._answer.version >= version

    def _arrived(self) -> list[says.Answer]:
        answers = []
        with contextlib.suppress(zmq.Again):
            while True:
                frame = self._socket.recv(zmq.NOBLOCK)
                try:
                    answers.append(says.decode_answer(frame))
                except msgspec.MsgspecError as error:
                    log.warning("the master says what cannot be read: %s", error)
        return answers

    def _hear(self, answer: says.Answer) -> None:
        match answer:
            case says.Registered():
                self._epoch = answer.epoch
                for topic, publishers in answer.publishers.items():
                    self._on_publishers(topic, publishers)
                self._note(answer)
            case says.Refused():
                self._note(answer)
            case says.Publishers():
                self._on_publishers(answer.topic, answer.publishers)
            case says.Heard():
                if not answer.known or answer.epoch != self._epoch:
                    self._sent_version = 0  # a new master: tell all again
            case _:
                log.warning("the master answered: %s", answer)

    def _note(self, answer: says.Registered | says.Refused) -> None:
        with self._changed:
            self._answer = answer
            self._changed.notify_all()

    def _register(self) -> None:
        with self._changed:
            version, told = self._version, self._told
        if self._say(says.Register(version=version, registration=told)):
            self._sent_version = version
            self._next_beat_s = time.monotonic() + HEARTBEAT_S

    def _say(self, request: says.Request) -> bool:
        try:
            self._socket.send(says.encode(request), zmq.NOBLOCK)
        except zmq.Again:
            return False  # the master is away: the next tick tries again
        return True

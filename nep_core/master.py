"""The NEP Master: the name server of a p2p network. Nothing is sent through it but names.

It keeps nothing on disk: after a restart the programs register again by themselves, because
its new epoch in the answer to their heartbeat tells them to.
"""

from __future__ import annotations

import logging
import os
import socket as sockets
import threading
import time
import uuid

import msgspec
import psutil
import zmq

from nep_core import master_messages as says
from nep_core.endpoints import check_endpoint, master_endpoint
from nep_core.errors import NameTaken, PortTaken
from nep_core.master_probe import ask_master
from nep_core.outbox import bind
from nep_core.registry import Registration, Registry

log = logging.getLogger(__name__)

CHECK_S = 0.25
"""How often the master looks for programs that are gone."""


class Master:
    """Serves in a thread of its own; raises PortTaken when the endpoint is in use."""

    def __init__(self, endpoint: str | None = None) -> None:
        self.epoch = uuid.uuid4().hex
        self._host = sockets.gethostname()
        self._registry = Registry()
        self._stopping = threading.Event()
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._socket = self._context.socket(zmq.ROUTER)
        self._socket.linger = 200
        try:
            self._bind(check_endpoint(endpoint or master_endpoint()))
        except BaseException:
            self._context.destroy(linger=0)
            raise
        self.endpoint = self._socket.getsockopt_string(zmq.LAST_ENDPOINT)
        self._thread = threading.Thread(target=self._run, name="nep-master", daemon=True)
        self._thread.start()

    def wait(self, timeout_s: float | None = None) -> None:
        """Wait until the master is closed."""
        self._thread.join(timeout_s)

    def close(self) -> None:
        """Stop serving and free the port."""
        self._stopping.set()
        self._thread.join()
        self._context.destroy(linger=200)

    def _bind(self, endpoint: str) -> None:
        try:
            bind(self._socket, endpoint)
        except PortTaken as error:
            if ask_master(endpoint, timeout_s=0.5) is None:
                raise
            raise PortTaken(
                f"Another NEP master is already running at {endpoint}.",
                checklist=(
                    "Use that one: programs started now join it by themselves.",
                    "Or stop it, and start this one again.",
                    "Or choose another port: --endpoint tcp://127.0.0.1:7200.",
                ),
            ) from error

    def _run(self) -> None:
        next_check_s = 0.0
        while not self._stopping.is_set():
            try:
                if self._socket.poll(int(CHECK_S * 1000)):
                    self._serve(self._socket.recv_multipart())
                if time.monotonic() >= next_check_s:
                    next_check_s = time.monotonic() + CHECK_S
                    self._drop_the_gone()
            except Exception:  # a fault of ours must not end everybody's name server
                log.exception("the master goes on after an error")

    def _serve(self, frames: list[bytes]) -> None:
        address, *rest = frames
        try:
            answer = self._answer(says.decode_request(rest[-1] if rest else b""), address)
        except (msgspec.MsgspecError, RecursionError) as error:
            log.info("a request could not be read: %s", error)
            answer = says.Mistake(sentence=f"This request cannot be read: {error}.")
        if answer is not None:
            self._send(address, answer)

    def _answer(self, request: says.Request, address: bytes) -> says.Answer | None:
        match request:
            case says.Register():
                return self._register(request, address)
            case says.Alive():
                known = self._registry.confirm(request.instance, time.monotonic())
                return says.Heard(epoch=self.epoch, known=known)
            case says.Bye():
                self._tell_changes(self._registry.remove(request.instance))
                return None
            case says.List():
                told = [entry.registration for entry in self._registry.entries.values()]
                return says.Listing(epoch=self.epoch, pid=os.getpid(), registrations=told)

    def _register(self, request: says.Register, address: bytes) -> says.Answer:
        self._drop_the_gone()
        told = request.registration
        try:
            changed = self._registry.register(told, address, time.monotonic())
        except NameTaken as error:
            return says.Refused(
                version=request.version, sentence=error.sentence, checklist=list(error.checklist)
            )
        self._tell_changes(changed)
        wanted = set(told.subscribes.values())
        return says.Registered(
            epoch=self.epoch,
            version=request.version,
            publishers={topic: self._registry.publishers(topic) for topic in wanted},
            subscribers={topic: self._registry.subscribers(topic) for topic in told.publishes},
        )

    def _drop_the_gone(self) -> None:
        entries = self._registry.entries
        gone = set(self._registry.expired(time.monotonic()))
        gone |= {i for i, entry in entries.items() if self._has_ended(entry.registration)}
        for instance in gone:
            log.info("%s is gone", entries[instance].registration.node)
            self._tell_changes(self._registry.remove(instance))

    def _has_ended(self, told: Registration) -> bool:
        if told.host != self._host or told.pid == os.getpid():
            return False  # another computer's processes cannot be seen
        try:
            return bool(psutil.Process(told.pid).status() == psutil.STATUS_ZOMBIE)
        except psutil.NoSuchProcess:
            return True
        except psutil.Error:
            return False

    def _tell_changes(self, topics: set[str]) -> None:
        for topic in topics:
            news = says.Publishers(topic=topic, publishers=self._registry.publishers(topic))
            for address in self._registry.listeners(topic):
                self._send(address, news)

    def _send(self, address: bytes, answer: says.Answer) -> None:
        # A ROUTER drops what it cannot deliver: a program that is gone needs no answer.
        self._socket.send_multipart([address, says.encode(answer)])

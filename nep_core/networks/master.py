"""The NEP Master: the name server of a p2p network. Nothing is sent through it but names.

It keeps nothing on disk: after a restart the programs register again by themselves, because
its new epoch in the answer to their heartbeat tells them to.
"""

from __future__ import annotations

import logging
import math
import os
import socket
import threading
import time
import uuid
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import psutil
import zmq

from faults import Fault
from nep_core.errors import NameTaken, NetworkError, PortTaken
from nep_core.wire.frames import CANNOT_DECODE
from nep_core.wire.io_thread import Wake
from nep_core.wire.outbox import bind

from . import master_messages as says
from . import security
from .endpoints import check_endpoint, master_endpoint
from .master_messages import ask_master
from .registry import LEASE_S, Registration, Registry, check_registration

if TYPE_CHECKING:
    from .security.opening import Admission

log = logging.getLogger(__name__)


# What the master has to tell others after a change, told once for many changes.
#
# A topic such as /node_state is published and heard by all: when many nodes come at once, telling
# each change at once would be the square of the nodes in messages, each as long as the list.

REST = 10.0
"""After telling, the master rests for so many times as long as it took, while more gathers ..."""
LONGEST_REST_S = 0.1
"""... but not longer: a new publisher waits a second for its subscribers."""

Send = Callable[[bytes, bytes], bool]


class News:
    """Gathers changes and tells who should know: subscribers of topics, and who watches.

    ``send`` gives an encoded answer to an address; False when it cannot be delivered.
    """

    def __init__(self, epoch: str, registry: Registry, send: Send) -> None:
        self.number = 0
        self._epoch = epoch
        self._registry = registry
        self._send = send
        self._topics: set[str] = set()
        self._instances: set[str] = set()
        self._watchers: dict[bytes, float] = {}
        self._rest_until_s = 0.0

    def note(self, instance: str, topics: Iterable[str]) -> None:
        """A program has changed, and with it the publishers of these topics."""
        self._instances.add(instance)
        self._topics.update(topics)

    def watch(self, address: bytes, now_s: float) -> None:
        """Tell this one of all changes for a lease."""
        self._watchers[address] = now_s + LEASE_S

    def due_in_s(self, now_s: float) -> float:
        """When there is something to tell."""
        is_any = self._topics or self._instances
        return max(0.0, self._rest_until_s - now_s) if is_any else float("inf")

    def tell(self, now_s: float) -> None:
        """Tell what is due."""
        if self.due_in_s(now_s) > 0:
            return
        began_s = time.perf_counter()
        topics, self._topics = self._topics, set()
        instances, self._instances = self._instances, set()
        for topic in topics:
            if listeners := self._registry.listeners(topic):
                publishers = self._registry.publishers(topic)
                news = says.encode(says.Publishers(topic=topic, publishers=publishers))
                for entry in listeners:
                    if not self._send(entry.address, news):
                        entry.has_missed = True  # its next heartbeat makes it register again
        self._tell_watchers(instances, now_s)
        took_s = time.perf_counter() - began_s
        self._rest_until_s = now_s + min(REST * took_s, LONGEST_REST_S)

    def _tell_watchers(self, instances: set[str], now_s: float) -> None:
        self.number += 1
        self._watchers = {who: until for who, until in self._watchers.items() if until > now_s}
        if not self._watchers:
            return
        entries = self._registry.entries
        came = [entries[i].registration for i in instances if i in entries]
        gone = [i for i in instances if i not in entries]
        changed = says.Changed(epoch=self._epoch, number=self.number, came=came, gone=gone)
        news = says.encode(changed)
        self._watchers = {who: s for who, s in self._watchers.items() if self._send(who, news)}


class Processes:
    """Sees the processes of programs that are on this computer, as far as it can be known.

    ``key`` is this computer's in an opened network: two computers may have one host name. A
    program whose process is not to be seen when it registers is elsewhere, in a container for
    example; its lease tells when it is gone, as it does for a number that another process has by
    now. Each process is remembered: to look again is then three times quicker.
    """

    def __init__(self, key: str = "") -> None:
        self._here = socket.gethostname(), key
        self._known: dict[int, psutil.Process] = {}
        self._elsewhere: set[str] = set()

    def register(self, told: Registration) -> None:
        """See whether a program that says now that it lives has a process here."""
        self._elsewhere.discard(told.instance)
        if self.has_ended(told):
            self._elsewhere.add(told.instance)

    def has_ended(self, told: Registration) -> bool:
        """Whether the program's process has ended; False when that cannot be seen."""
        is_here = (told.host, told.key) == self._here and told.instance not in self._elsewhere
        if not is_here or told.pid == os.getpid():
            return False
        try:
            if told.pid not in self._known:
                self._known[told.pid] = psutil.Process(told.pid)
            return bool(self._known[told.pid].status() == psutil.STATUS_ZOMBIE)
        except psutil.NoSuchProcess:
            return True
        except psutil.Error:
            return False

    def keep_only(self, programs: Iterable[Registration]) -> None:
        """Forget all others."""
        kept = list(programs)
        pids = {told.pid for told in kept}
        self._known = {pid: process for pid, process in self._known.items() if pid in pids}
        self._elsewhere &= {told.instance for told in kept}


CHECK_S = 0.25
"""How often the master looks for programs that are gone."""
TURN_S = 0.01
"""How long requests are answered before what they changed is told."""
GRACE_S = 0.5
"""After a restart newcomers wait so long for their names: one heartbeat, see _has_to_wait."""
LARGEST_REQUEST = 4_000_000
ANSWERS_KEPT = 300
"""So many answers are kept for a program that does not read, then they are dropped."""


class Master:
    """Serves in a thread of its own; raises PortTaken when the endpoint is in use.

    ``is_shared``: it is there for all programs of this computer, not for one session.
    """

    def __init__(self, endpoint: str | None = None, *, is_shared: bool = False) -> None:
        self._is_shared = is_shared
        self.epoch = uuid.uuid4().hex
        self._registry = Registry()
        self._news = News(self.epoch, self._registry, self._send)
        self._stopping = threading.Event()
        self._wake = Wake()
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._security = security.from_environment(self._context)
        self._admission = self._admit_by_keys()
        self._processes = Processes(self._security.key if self._security else "")
        self._socket = self._context.socket(zmq.ROUTER)
        self._socket.linger = 200
        self._socket.sndhwm = ANSWERS_KEPT
        self._socket.router_mandatory = 1  # so that we know what could not be delivered
        self._socket.maxmsgsize = LARGEST_REQUEST
        try:
            self._bind(check_endpoint(endpoint or master_endpoint()))
        except BaseException:
            self._socket.close(linger=0)
            self._context.term()
            raise
        self.endpoint = self._socket.getsockopt_string(zmq.LAST_ENDPOINT)
        self._poller = zmq.Poller()
        self._poller.register(self._socket, zmq.POLLIN)
        self._poller.register(self._wake.fileno(), zmq.POLLIN)
        self._next_check_s = time.monotonic() + CHECK_S
        self._grace_until_s = time.monotonic() + GRACE_S
        self._is_restart = False
        self._waiting: list[tuple[says.Register, bytes]] = []
        self._thread = threading.Thread(target=self._run, name="nep-master", daemon=True)
        self._thread.start()

    def wait(self, timeout_s: float | None = None) -> None:
        """Wait until the master is closed."""
        self._thread.join(timeout_s)

    def close(self) -> None:
        """Stop serving and free the port."""
        self._stopping.set()
        self._wake()
        self._thread.join()
        self._wake.close()
        self._socket.close(linger=200)
        self._context.term()

    def take_warning(self) -> Fault | None:
        """Who was refused since the last time, and what to do; None when nobody was."""
        return self._security.take_warning() if self._security else None

    def _admit_by_keys(self) -> Admission | None:
        if self._security is None:
            return None
        from .security.opening import Admission

        return Admission(self._security, self._registry, self._send)

    def _bind(self, endpoint: str) -> None:
        try:
            bind(self._socket, endpoint, self._security)
        except PortTaken as error:
            if ask_master(endpoint, timeout_s=0.5) is None:
                raise
            raise PortTaken(
                "Another NEP master is already running at {endpoint}.",
                checklist=(
                    "Use that one: programs started now join it by themselves.",
                    "Or stop it, and start this one again.",
                    "Or choose another port: --endpoint tcp://127.0.0.1:7200.",
                ),
                endpoint=endpoint,
            ) from error

    def _run(self) -> None:
        while not self._stopping.is_set():
            try:
                self._turn()
            except Exception:  # a fault of ours must not end everybody's name server
                log.exception("the master goes on after an error")
                self._stopping.wait(TURN_S)  # never spin on an error that repeats

    def _turn(self) -> None:
        """Answer what has come, tell what it changed, look for who is gone."""
        wait_s = min(CHECK_S, self._news.due_in_s(time.monotonic()))
        is_quiet = not self._poller.poll(math.ceil(1000 * wait_s)) or self._serve_for(TURN_S)
        now_s = time.monotonic()
        if self._admission is not None:
            for told in self._admission.look():
                self._drop(told)
        self._news.tell(now_s)
        if self._waiting and now_s >= self._grace_until_s:
            # Register the newcomers that had to wait
            waiting, self._waiting = self._waiting, []
            for request, address in waiting:
                answer = self._register(request, address)
                if answer is not None:
                    self._send(address, says.encode(answer))
        if is_quiet and now_s >= self._next_check_s:  # not while heartbeats wait unread
            self._registry.lengthen_leases(max(0.0, now_s - self._next_check_s - CHECK_S))
            self._next_check_s = now_s + CHECK_S
            entries, ended = self._registry.entries, self._processes.has_ended
            gone = {i for i, entry in entries.items() if ended(entry.registration)}
            for instance in gone.union(self._registry.expired(now_s)):
                self._drop(entries[instance].registration)
            self._processes.keep_only(entry.registration for entry in entries.values())

    def _serve_for(self, seconds: float) -> bool:
        """Answer requests; True when there are no more."""
        until_s = time.monotonic() + seconds
        while time.monotonic() < until_s:
            try:
                frames = self._socket.recv_multipart(zmq.NOBLOCK, copy=False)
            except zmq.Again:
                return True
            if self._admission is None or self._admission.hears(frames[0]):
                self._serve([frame.bytes for frame in frames])
        return False

    def _serve(self, frames: list[bytes]) -> None:
        address, *rest = frames
        try:
            answer = self._answer(says.decode_request(rest[-1] if rest else b""), address)
        except CANNOT_DECODE as error:
            log.info("a request could not be read: %s", error)
            answer = says.Mistake(sentence=f"This request cannot be read: {error}.")
        except NetworkError as error:
            answer = says.Mistake(sentence=str(error))
        except Exception:  # a fault of ours: who asked should not wait in vain
            log.exception("a request could not be answered")
            answer = says.Mistake(sentence="The master could not answer this request.")
        if answer is not None:
            self._send(address, says.encode(answer))

    def _answer(self, request: says.Request, address: bytes) -> says.Answer | None:
        now_s = time.monotonic()
        match request:
            case says.Register():
                return self._register(request, address)
            case says.Change():
                return self._change(request, address)
            case says.Alive(instance=instance):
                self._is_restart |= instance not in self._registry.entries
                known = self._registry.confirm(instance, address, now_s)
                return says.Heard(epoch=self.epoch, known=known)
            case says.Bye(instance=instance):
                self._news.note(instance, self._registry.remove(instance))
                return None
            case says.List():
                return self._listing()
            case says.Find(topic=topic):
                publishers = self._registry.publishers(topic)
                subscribers = self._registry.subscribers(topic)
                return says.Found(topic=topic, publishers=publishers, subscribers=subscribers)
            case says.Watch():
                self._news.watch(address, now_s)
                if (request.epoch, request.number) != (self.epoch, self._news.number):
                    return self._listing()
                return says.Changed(epoch=self.epoch, number=request.number, came=[], gone=[])
            case says.Stop(node=node):
                entry = self._registry.holder(node)
                asked = says.encode(says.StopAsked())
                return says.Passed(known=entry is not None and self._send(entry.address, asked))

    def _listing(self) -> says.Listing:
        return says.Listing(
            epoch=self.epoch,
            pid=os.getpid(),
            registrations=[entry.registration for entry in self._registry.entries.values()],
            number=self._news.number,
            shared=self._is_shared,
        )

    def _register(self, request: says.Register, address: bytes) -> says.Answer | None:
        told = request.registration
        check_registration(told)
        if self._admission is not None and not self._admission.admits(told, address):
            return None  # its computer was forgotten
        if self._has_to_wait(request):
            self._waiting.append((request, address))
            return None
        holder = self._registry.holder(told.node)
        if holder is not None and self._processes.has_ended(holder.registration):
            self._drop(holder.registration)
        try:
            changed = self._registry.register(told, address, time.monotonic(), request.version)
        except NameTaken as error:
            return says.Refused(
                version=request.version,
                sentence=str(error),
                checklist=list(map(str, error.checklist)),
                fault=error.fault,
            )
        self._processes.register(told)
        self._news.note(told.instance, changed)
        return self._registered(request.version, told.publishes, told.subscribes.values())

    def _has_to_wait(self, request: says.Register) -> bool:
        """Whether the name of a newcomer may belong to somebody who has not come back yet.

        Programs that live come back within a heartbeat of a restart. That it is one, the first of
        them tells: without a sign of them, as after a computer's start, nobody has to wait.
        """
        self._is_restart |= request.epoch not in ("", self.epoch)
        is_known = request.epoch or request.registration.instance in self._registry.entries
        return self._is_restart and not is_known and time.monotonic() < self._grace_until_s

    def _change(self, request: says.Change, address: bytes) -> says.Answer:
        entry = self._registry.entries.get(request.instance)
        if entry is None or (entry.version, entry.address) != (request.base, address):
            return says.Heard(epoch=self.epoch, known=False)
        told = request.of(entry.registration)
        check_registration(told)
        changed = self._registry.register(told, address, time.monotonic(), request.version)
        self._news.note(told.instance, changed)
        return self._registered(request.version, request.publishes, request.subscribes.values())

    def _registered(
        self, version: int, publishes: Iterable[str], wanted: Iterable[str]
    ) -> says.Registered:
        return says.Registered(
            epoch=self.epoch,
            version=version,
            publishers={topic: self._registry.publishers(topic) for topic in set(wanted)},
            subscribers={topic: self._registry.subscribers(topic) for topic in publishes},
        )

    def _drop(self, told: Registration) -> None:
        log.info("%s is gone", told.node)
        self._news.note(told.instance, self._registry.remove(told.instance))

    def _send(self, address: bytes, answer: bytes) -> bool:
        """Whether it goes: not to who has gone, nor to who has not read for long."""
        try:
            self._socket.send_multipart([address, answer], zmq.NOBLOCK)
        except zmq.ZMQError:
            return False
        return True

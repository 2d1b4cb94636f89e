"""A stage for goals: a behaviour that runs in a thread, a person before it, and a diary."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.behavior import Behavior
from nep_core.program.human import human_listener
from nep_core.program.tasks import wait
from nep_core.wire.messages import HUMAN_BEHAVIOR, PROGRAM_STATE, HumanBehavior, ProgramState
from nep_core.wire.pubsub import Publisher, Subscriber

Join = Callable[[str], PeerNetwork]
LONG_S = 60.0
WAIT_S = 5.0


class Diary:
    """What goals did, in order; a test waits for the next entry."""

    def __init__(self) -> None:
        self._entries: queue.Queue[str] = queue.Queue()

    def write(self, entry: str) -> None:
        self._entries.put(entry)

    def next(self) -> str:
        return self._entries.get(timeout=WAIT_S)

    def is_quiet(self, seconds: float = 0.3) -> bool:
        try:
            self._entries.get(timeout=seconds)
        except queue.Empty:
            return True
        return False


class Scene:
    """A behaviour that runs in a thread, and a person before it."""

    def __init__(self, network: PeerNetwork, person: PeerNetwork) -> None:
        tasks.PROGRAM.cancelled.clear()
        tasks.PROGRAM._children.clear()
        self.behavior = Behavior("Goals")
        self.diary = Diary()
        self.error: BaseException | None = None
        human_listener(network)
        self._person = Publisher(HUMAN_BEHAVIOR, network=person)
        self.told = Subscriber(PROGRAM_STATE, ProgramState, network=network)
        self._thread = threading.Thread(target=self._run)

    def goal(self, name: str, seconds: float = LONG_S, **options: object) -> None:
        """A goal that writes when it begins and when it is done, and begins with its name."""

        @self.behavior.goal(name, when=name, **options)
        def goal() -> None:
            self.diary.write(f"{name} begins")
            wait(seconds)
            self.diary.write(f"{name} done")

    def hook(self, name: str, event: str) -> None:
        self.behavior.when_goal(name, event)(lambda: self.diary.write(f"{name} {event}"))

    def begin(self) -> None:
        started = threading.Event()
        self.behavior.when_started(started.set)
        self._thread.start()
        assert started.wait(WAIT_S)

    def does(self, *states: str) -> None:
        for state in states:
            self._person.send(HumanBehavior(human_state=state))

    def end(self) -> None:
        tasks.PROGRAM.cancel()
        if self._thread.ident:
            self._thread.join(WAIT_S)
            assert not self._thread.is_alive()

    def join(self) -> None:
        self._thread.join(WAIT_S)

    def _run(self) -> None:
        try:
            self.behavior.run()
        except BaseException as error:
            self.error = error

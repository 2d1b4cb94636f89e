"""The API as the paper prints it (Coronado et al., Node Primitives, 2017, section "The NEP API").

A thin coat: ``from nep_core.paper import *`` and the paper's listings run as they stand.
"""

from __future__ import annotations

import atexit
import contextlib
import inspect
import queue
from collections.abc import Callable
from typing import Any

from nep_core.errors import NepError

from .processes.launcher import LaunchedNode, Launcher
from .program.human import human_listener
from .program.robot import Robot
from .program.tasks import PROGRAM, Cancelled
from .wire.messages import HumanBehavior
from .wire.pubsub import Publisher, Subscriber

__all__ = ["launcher", "publisher", "robot", "robot_behaviors", "subscriber"]

Message = dict[Any, Any] | str


class publisher:  # noqa: N801  the paper's name
    """Sends messages on a topic."""

    def __init__(self, topic: str) -> None:
        self._publisher = Publisher(topic)

    def send_info(self, message: Message) -> None:
        """Send a dictionary (as JSON) or a text."""
        self._publisher.send(message)


class subscriber:  # noqa: N801  the paper's name
    """Receives the messages of a topic."""

    TIMEOUT_S = 0.1

    def __init__(self, topic: str) -> None:
        self._subscriber: Subscriber[Any] = Subscriber(topic)

    def listen_info(self, block: bool = True) -> tuple[bool, Any]:
        """Whether a message came, and the message; without ``block`` waits a tenth of a second."""
        message = self._subscriber.receive(None if block else self.TIMEOUT_S)
        if message is None and block:
            raise Cancelled  # the program is asked to end: without this, its loop would not
        return message is not None, {} if message is None else message


class launcher:  # noqa: N801  the paper's name
    """Starts nodes; they end with this program."""

    def __init__(self) -> None:
        self._launcher = Launcher()
        atexit.register(self._launcher.close)

    def nep_launch(self, type_node: str, node_name: str, *parameters: str) -> LaunchedNode:
        """Start a node and wait until it is ready; parameters in the order of its manifest."""
        manifest = self._launcher.catalog.find(f"{type_node}/{node_name}")
        settings = dict(zip(manifest.parameters, parameters, strict=False))
        launched = self._launcher.launch(manifest.id, node_name, settings)
        launched.wait_ready()
        return launched


class robot:  # noqa: N801  the paper's name
    """What robots can be asked to do; each call returns when all have done it."""

    def __init__(self) -> None:
        self._robot: Robot | None = None

    def setRobots(self, robots: list[str]) -> None:  # noqa: N802  the paper's name
        """Choose the robots that act."""
        self._robot = Robot(robots)

    def say(self, text: str, gesture: str = "no_gesture") -> None:
        """Say a text, perhaps with a gesture."""
        self._chosen().say(text, gesture=gesture)

    def do(self, posture: str) -> None:
        """Take a posture."""
        self._chosen().do(posture)

    def imitate(self, animal: str) -> None:
        """Imitate an animal."""
        self._chosen().imitate(animal)

    def _chosen(self) -> Robot:
        if self._robot is None:
            raise NepError(
                "No robot has been chosen.", checklist=('Write r.setRobots(["NAO"]) first.',)
            )
        return self._robot


class robot_behaviors:  # noqa: N801  the paper's name
    """A reactive behaviour: ``reactive_function(self, human_state)``, set with setattr."""

    reactive_function: Callable[..., object]

    def __init__(self, kind: str = "reactive") -> None:
        if kind != "reactive":
            raise NepError(
                'There is no "{kind}" behaviour.',
                checklist=('Use robot_behaviors("reactive").',),
                kind=kind,
            )

    def run(self) -> None:
        """Call the reactive function with each state of the person, until stopped."""
        function = getattr(self, "reactive_function", None)
        if function is None:
            raise NepError(
                "The behaviour has no reactive function.",
                checklist=('Write setattr(behavior, "reactive_function", your_function).',),
            )
        takes_self = len(inspect.signature(function).parameters) > 1
        states: queue.SimpleQueue[HumanBehavior] = queue.SimpleQueue()
        listener = human_listener()
        listener.listen(states.put)
        while not PROGRAM.cancelled.is_set():
            with contextlib.suppress(queue.Empty):
                state = states.get(timeout=0.1).human_state
                function(self, state) if takes_self else function(state)
        listener.unlisten(states.put)

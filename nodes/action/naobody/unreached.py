"""The driver of a real NAO, as far as this version goes: it looks whether NAO answers.

Driving the real robot is not built yet, and this says so. Nothing here waits: each try runs in a
thread of its own, with a time limit.
"""

from __future__ import annotations

import queue
import socket
import threading
from collections.abc import Callable, Collection

from nep_core.errors import ActionFailed, ParameterError
from nep_core.messages import RobotState, SenseRequest
from nodes.action.naobody.actions import Action
from nodes.action.naobody.driver import Connection, Ended
from nodes.action.naobody.limbs import Limb

NAOQI_PORT = 9559
TIMEOUT_S = 3.0
FIRST_PAUSE_S = 1.0
LONGEST_PAUSE_S = 30.0

Address = tuple[str, int]


def read_address(text: str) -> Address:
    """Return host and port of text such as ``192.168.1.10``, ``nao.local`` or ``host:9559``.

    Raises ParameterError.
    """
    host, colon, port = text.strip().rpartition(":")
    if not colon:
        host, port = text.strip(), str(NAOQI_PORT)
    # int() would also take "1_0" and signs; str.isdigit() alone would take "²".
    is_number = port.isascii() and port.isdigit()
    if not host or any(c.isspace() or c in ":/" for c in host) or not is_number:
        raise _not_an_address(text)
    if not 0 < int(port) < 65536:
        raise _not_an_address(text)
    return host, int(port)


def answers(address: Address) -> bool:
    """Return whether a program answers at an address; waits at most TIMEOUT_S after the look-up."""
    try:
        with socket.create_connection(address, timeout=TIMEOUT_S):
            return True
    except OSError:  # refused, no route, no such name, time-out: nobody answers
        return False
    except UnicodeError:  # a name that cannot be looked up, such as one with an empty part
        return False


class UnreachedNao:
    """A NAO in the room: tries its address again and again, and fails every action with the reason.

    ``knock`` is ``answers`` unless a test stands in for the network.
    """

    def __init__(
        self, robot: str, address: str, knock: Callable[[Address], bool] = answers
    ) -> None:
        self.robot = robot
        self.address = read_address(address)
        self.moving = False
        self.connection = Connection("disconnected", "")
        self._knock = knock
        self._answers: queue.SimpleQueue[bool] = queue.SimpleQueue()
        self._trying = False
        self._next_try_s = 0.0
        self._pause_s = FIRST_PAUSE_S

    def connect(self) -> None:
        """Begin to look for the robot; ``step`` keeps at it."""
        self.connection = Connection("connecting", f"Looking for {self.robot} at {self._place}.")
        self._try()

    def disconnect(self) -> None:
        """Give the robot up. A try that is under way ends by itself."""
        self.connection = Connection("disconnected", "")

    def limbs(self, action: Action) -> frozenset[Limb]:
        """Raise ActionFailed: nothing can be done without the robot."""
        raise ActionFailed(self.connection.description.splitlines()[0])

    def start(self, command_id: str, action: Action) -> None:
        """Raise ActionFailed: nothing can be done without the robot."""
        self.limbs(action)

    def stop(self, command_ids: Collection[str]) -> None:
        """There is nothing to stop."""

    def step(self, now_s: float) -> list[Ended]:
        """Take in the answer of the last try, or try again when it is time."""
        if self._trying and not self._answers.empty():
            self._trying = False
            self._next_try_s = now_s + self._pause_s
            self._pause_s = min(2.0 * self._pause_s, LONGEST_PAUSE_S)
            self.connection = self._failed(has_answered=self._answers.get())
        elif not self._trying and now_s >= self._next_try_s:
            self._try()
        return []

    def state(self) -> RobotState | None:
        """Return None: where the robot's body is is not known."""
        return None

    def sense(self, request: SenseRequest) -> list[str]:
        """Return nothing: a real robot senses by itself."""
        return []

    @property
    def _place(self) -> str:
        host, port = self.address
        return host if port == NAOQI_PORT else f"{host}:{port}"

    def _try(self) -> None:
        self._trying = True
        threading.Thread(
            target=lambda: self._answers.put(self._knock(self.address)), daemon=True
        ).start()

    def _failed(self, *, has_answered: bool) -> Connection:
        steps: tuple[str, ...]
        if has_answered:
            sentence = (
                f"A program answers at {self._place}, but this version of NEP Studio can drive "
                f"the virtual NAO only: {self.robot} will not move."
            )
            steps = (f"Let {self.robot} be the virtual NAO: set its driver to virtual.",)
        else:
            sentence = (
                f"{self.robot} does not answer: the program could not reach it at {self._place}."
            )
            steps = (
                f"Is {self.robot} switched on? Its chest button should glow.",
                f"Is this computer on the same network as {self.robot}?",
                f"Press {self.robot}'s chest button once: it says its address. "
                f"Is it {self.address[0]}?",
                "Try the program on the robot on your screen first.",
            )
        told = "\n".join([sentence, *(f"[ ] {step}" for step in steps)])
        return Connection("connection_failed", told)


def _not_an_address(text: str) -> ParameterError:
    return ParameterError(
        f'"{text}" is not the address of a robot.',
        checklist=(
            "Press NAO's chest button once: it says its address, such as 192.168.1.10.",
            "Write it in the robot's address.",
            "Or set the robot's driver to virtual: then it needs no address.",
        ),
    )

"""What every robot driver offers to the action node, be its robot on the screen or in the room."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Literal, NamedTuple, Protocol

from faults import Fault

from .actions import Action
from .limbs import Limb
from .messages import NOTHING, RobotState, SenseRequest, Thing


class Connection(NamedTuple):
    """How the link to the robot is, and what there is to say about it."""

    event: Literal["connecting", "connected", "connection_failed", "disconnected", "warning"]
    fault: Fault = NOTHING


class Ended(NamedTuple):
    """A command that the robot has ended, and what there is to say about it."""

    id: str
    state: Literal["done", "failed"]
    fault: Fault = NOTHING


class Driver(Protocol):
    """One robot. Nothing here waits: ``step`` is called often, and moves on what goes on."""

    @property
    def connection(self) -> Connection:
        """How the link to the robot is."""

    @property
    def moving(self) -> bool:
        """Whether the robot does something."""

    def connect(self) -> None:
        """Begin to connect, and keep trying until ``disconnect``."""

    def disconnect(self) -> None:
        """Give the robot up."""

    def limbs(self, action: Action) -> frozenset[Limb]:
        """Return the limbs that an action needs. Raises ActionFailed if it cannot be done."""

    def start(self, command_id: str, action: Action) -> None:
        """Begin an action; ``step`` tells when it has ended."""

    def stop(self, command_ids: Collection[str]) -> None:
        """End some actions at once; ``step`` does not tell of them any more."""

    def step(self, now_s: float) -> list[Ended]:
        """Go on to a time. Returns early, as soon as a command ends: call until it is empty."""

    def state(self) -> RobotState | None:
        """Return where the robot's body is, or None when that is not known."""

    def sense(self, request: SenseRequest) -> list[str]:
        """Let a virtual robot feel, see or hear something; return the human states that follow."""

    def surroundings(self, things: Sequence[Thing]) -> None:
        """Let a virtual robot know what stands around it; a real one sees for itself."""

    def expect(self, words: Sequence[str]) -> None:
        """Let a real robot listen for the words that rules wait for; a virtual one hears all."""

    def noticed(self) -> list[str]:
        """Return the human states that the robot has noticed by itself since the last call."""

    def halt(self) -> None:
        """Let the robot stop whatever it does, also what this driver does not know of."""

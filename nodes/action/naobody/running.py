"""What a robot does at the moment: tasks by the command that asked for them."""

from __future__ import annotations

from collections.abc import Generator
from typing import NamedTuple

from nep_core.errors import ActionFailed
from nodes.action.naobody.driver import Ended
from nodes.action.naobody.limbs import Limb

Task = Generator[None, None, str]
"""Goes on by one step at each ``next``; returns what there is to say at its end."""


class Running(NamedTuple):
    """A task that has begun, and the limbs that it uses."""

    task: Task
    limbs: frozenset[Limb]


def advance(running: dict[str, Running], command_id: str) -> Ended | None:
    """Let a task go on by one step; one that has ended or failed is taken out, and told."""
    try:
        next(running[command_id].task)
    except StopIteration as end:
        ended = Ended(command_id, "done", end.value)
    except ActionFailed as problem:
        ended = Ended(command_id, "failed", problem.sentence)
    else:
        return None
    del running[command_id]
    return ended

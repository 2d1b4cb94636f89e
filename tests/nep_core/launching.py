"""Words that the launcher's tests share."""

from __future__ import annotations

import queue

from nep_core.processes.launcher import LaunchedNode
from nep_core.processes.process import Outcome

Ends = queue.Queue[tuple[LaunchedNode, Outcome, bool]]
"""What the launcher told: which node ended, how, and whether it is started again."""

WAIT = 'node.ready("waits")\nwhile not node.wait(1): pass'
"""A node that does nothing until it is stopped."""


def first_line(launched: LaunchedNode) -> str:
    """The first line that a node wrote, as soon as it is there."""
    assert launched.process is not None
    while not launched.process.last_lines:
        assert not launched.ended.wait(0.01)
    return launched.process.last_lines[0]

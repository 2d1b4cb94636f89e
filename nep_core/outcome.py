"""How a process ended, as data that can say it in a sentence."""

from __future__ import annotations

import signal
from dataclasses import dataclass

from nep_core.lifeline import ORPHANED

ASKED = 71
"""The exit code of a launched node that somebody in the network asked to stop."""

_SIGNALS = {
    "SIGKILL": "was killed",
    "SIGTERM": "was asked to stop before it could answer",
    "SIGINT": "was interrupted",
    "SIGSEGV": "crashed (it used memory that is not its own)",
    "SIGABRT": "crashed (it aborted itself)",
}


@dataclass(frozen=True)
class Outcome:
    """How a node's process ended.

    ``code`` is its exit code, negative for a signal; ``asked`` whether the launcher stopped it;
    ``last_words`` the last line that it wrote, and ``checklist`` the steps that it wrote below.
    """

    node: str
    code: int
    asked: bool = False
    last_words: str = ""
    checklist: tuple[str, ...] = ()

    @property
    def was_successful(self) -> bool:
        """Whether it ended as it should."""
        return self.asked or self.code in (0, ASKED)

    def __str__(self) -> str:
        """One sentence, without the final full stop."""
        if self.asked:
            return f"{self.node} was stopped"
        if self.code < 0:
            return f"{self.node} {_signal_words(-self.code)}"
        if self.code == 0:
            return f"{self.node} ended by itself"
        if self.code == ASKED:
            return f"{self.node} was asked to stop"
        if self.code == ORPHANED:
            return f"{self.node} ended because the program that started it is gone"
        reason = self.last_words.rstrip(".") or f"exit code {self.code}"
        return f"{self.node} ended with an error: {reason}"


def _signal_words(number: int) -> str:
    try:
        name = signal.Signals(number).name
    except ValueError:
        return f"was ended by signal {number}"
    return _SIGNALS.get(name, f"was ended by {name}")

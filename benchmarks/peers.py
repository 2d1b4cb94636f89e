"""Whether other programs are measured too: they are fetched first, so only when asked for."""

from __future__ import annotations

import os

_VARIABLE = "NEP_STUDIO_BENCH_WITH_PEERS"


def ask_for_peers() -> None:
    """Let the benchmarks that are started from now on measure their peers."""
    os.environ[_VARIABLE] = "1"


def are_wanted() -> bool:
    """Whether somebody has asked for peers."""
    return os.environ.get(_VARIABLE) == "1"

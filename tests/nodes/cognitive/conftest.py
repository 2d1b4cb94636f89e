"""Programs that are followed while they run, by each way in which this Python can do it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from program_following import Followed

from nep_core.program import tasks
from nodes.cognitive.tracing.tracer import WatchMaker
from nodes.cognitive.tracing.watches import SettraceWatch

Follow = Callable[[str], Followed]


@pytest.fixture(autouse=True)
def _own_program() -> Iterator[None]:
    """A program of its own for each test: PROGRAM is one a process."""
    _begin_program()
    yield
    _begin_program()


@pytest.fixture(params=["settrace", "monitoring"])
def make_watch(request: pytest.FixtureRequest) -> WatchMaker:
    if request.param == "settrace":
        return SettraceWatch
    if sys.version_info < (3, 12):
        pytest.skip("sys.monitoring begins with Python 3.12")
    from nodes.cognitive.tracing.watches import MonitoringWatch

    return MonitoringWatch


@pytest.fixture
def follow(tmp_path: Path, make_watch: WatchMaker) -> Iterator[Follow]:
    """Makes programs that are stopped at the end."""
    followed: list[Followed] = []

    def make(source: str) -> Followed:
        followed.append(Followed(tmp_path / f"program{len(followed)}.py", source, make_watch))
        return followed[-1]

    yield make
    for program in followed:
        program.stop()


def _begin_program() -> None:
    tasks.PROGRAM.cancelled.clear()
    tasks.PROGRAM._children.clear()
    tasks.PROGRAM.undo.clear()

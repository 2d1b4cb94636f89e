"""The threads of a program, and the lines of its file that each of them is in."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from types import FrameType

from nep_core.tasks import Task, current_task

MOST_CALLS = 50
"""So many calls of a thread are told."""


@dataclass(eq=False)
class ProgramThread:
    """A thread that is in the program's file; ``frames`` are its calls there, outermost first."""

    name: str
    task: Task
    frames: list[FrameType] = field(default_factory=list)
    is_stepped: bool = False
    """Whether it runs one line more of a paused program."""
    is_cancelled: bool = False
    """Whether it has been told, by Cancelled, to end."""

    def lines(self) -> list[int]:
        """The lines that it is in; of very many calls the outermost and the innermost."""
        frames = list(self.frames)
        if len(frames) > MOST_CALLS:
            frames = frames[: MOST_CALLS // 2] + frames[-MOST_CALLS // 2 :]
        return [frame.f_lineno or 0 for frame in frames]


class ProgramThreads:
    """Who is where; each thread notes its own calls, any thread may look."""

    def __init__(self) -> None:
        self._threads: dict[int, ProgramThread] = {}

    def enter(self, frame: FrameType) -> None:
        """Note that this thread calls a function of the file."""
        thread = self._threads.get(threading.get_ident())
        if thread is None:
            thread = ProgramThread(threading.current_thread().name, current_task())
            self._threads[threading.get_ident()] = thread
        thread.frames.append(frame)

    def leave(self, frame: FrameType) -> None:
        """Note that a call has ended, and those that it made."""
        thread = self._threads.get(threading.get_ident())
        if thread is None:
            return
        if thread.frames[-1] is frame:
            thread.frames.pop()
        elif frame in thread.frames:  # those that it made have ended unseen
            del thread.frames[thread.frames.index(frame) :]
        if not thread.frames:
            self.forget()

    def forget(self) -> None:
        """Note that this thread is in the file no more."""
        self._threads.pop(threading.get_ident(), None)

    def this(self) -> ProgramThread | None:
        """The thread that asks."""
        return self._threads.get(threading.get_ident())

    def frames(self) -> list[FrameType]:
        """All calls that have not ended yet."""
        return [frame for thread in list(self._threads.values()) for frame in list(thread.frames)]

    def lines(self) -> dict[str, list[int]]:
        """The lines that each thread is in now, the outermost call first."""
        lines = {thread.name: thread.lines() for thread in list(self._threads.values())}
        return {name: stack for name, stack in lines.items() if stack}

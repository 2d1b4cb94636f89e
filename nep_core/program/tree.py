"""Behaviour trees: nodes that are looked at again and again, and succeed, fail or still run.

A tree is grown by a function, in which each node stands inside the ``with`` of the node above it::

    @behavior.tree("greet")
    def greet():
        with Fallback():
            with Sequence():
                Check(lambda: human_state() == "seen_face")

                @Step("say hello")
                def say_hello():
                    nao.say("Hello")

The nodes are those that py_trees and BehaviorTree.CPP have, and behave as theirs do. They are our
own because a step runs in a part of the program, which a pause holds, a halt cancels with what it
began on a robot, and which wakes its tree by itself when it ends.
"""

from __future__ import annotations

import math
import sys
import threading
import time
from collections.abc import Callable
from collections.abc import Sequence as Row
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar

from nep_core.errors import NepError

from .tasks import CLOCK, Part, RuleStopped, current_task
from .values import to_nearest

Status = Literal["idle", "running", "succeeded", "failed"]
IDLE: Status = "idle"
RUNNING: Status = "running"
SUCCEEDED: Status = "succeeded"
FAILED: Status = "failed"

PERIOD_S = 0.05
"""A tree is looked at so often, and at once when a step of it ends."""
SHORTEST_S = 0.005
"""But not more often than this: steps that take no time, repeated, would leave none to others."""
DEEPEST = 150
"""So many nodes may be inside each other, those of the trees in a tree too."""

Number = float | Callable[[], float]
"""A number, or what gives it each time that a part begins."""
_Given = TypeVar("_Given")
Action = Callable[[], object]
Condition = Callable[[], object]
Tell = Callable[[dict[int, Status]], None]


class StepFailed(BaseException):
    """The step in which this part of the program runs has failed."""


class NoTreeValue(NepError, title="A value of a behaviour tree is missing"):
    """A name stands for nothing in a tree yet."""


def fail_step() -> None:
    """End the step that runs here: it has failed."""
    if not current_task().in_step:
        raise NepError(
            "Only a step of a behaviour tree can say that it has failed.",
            code="outside_step",
            checklist=("Put it into a “step” block of a tree.",),
        )
    raise StepFailed


# How a tree grows: the nodes that are open, and what all of its nodes share.


@dataclass(slots=True)
class Trunk:
    """What the nodes of one run of a tree share: who wakes it, and who is told of it.

    ``tell`` is given the status of nodes by their line in the program, ``note_error`` what a step
    ended by.
    """

    name: str
    tell: Tell
    note_error: Callable[[BaseException], None]
    news: threading.Event = field(default_factory=threading.Event)
    open: list[Node] = field(default_factory=list)
    lines: dict[int, list[Node]] = field(default_factory=dict)
    changed: dict[int, Status] = field(default_factory=dict)
    told: dict[int, Status] = field(default_factory=dict)
    """The status of nodes as it was told last."""

    def note(self, node: Node) -> None:
        """Remember that the status of a node has changed; of several in a line, one may run."""
        if node.line:
            others = self.lines[node.line]
            is_running = any(other.status == RUNNING for other in others)
            self.changed[node.line] = RUNNING if is_running else node.status

    def tell_changes(self) -> None:
        """Tell what has changed since that was told last."""
        noted, self.changed = self.changed, {}
        # at each look a check may have begun anew, and come to the same
        news = {line: status for line, status in noted.items() if self.told.get(line) != status}
        if news:
            self.told |= news
            self.tell(news)


_growing: ContextVar[Trunk | None] = ContextVar("nep_tree", default=None)


def _trunk() -> Trunk:
    trunk = _growing.get()
    if trunk is None:
        raise NepError(
            "This part of a behaviour tree stands outside of a tree.",
            code="outside_tree",
            checklist=("Put it into a function with “@behavior.tree” above it.",),
        )
    return trunk


def _line() -> int:
    """The line of the program that makes a node."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename == __file__:
        frame = frame.f_back
    return frame.f_lineno


class Node:
    """A node of a tree; it hangs itself below the node whose ``with`` it stands in."""

    def __init__(self) -> None:
        self.status: Status = IDLE
        self.children: list[Node] = []
        self.line = _line()
        self._trunk = trunk = _trunk()
        if len(trunk.open) >= DEEPEST:
            raise NepError(
                "The tree “{name}” is too deep: {deepest} parts inside each other at most.",
                code="tree_too_deep",
                checklist=("Look whether a tree has itself inside.",),
                name=trunk.name,
                deepest=DEEPEST,
            )
        trunk.lines.setdefault(self.line, []).append(self)
        if trunk.open:
            trunk.open[-1].children.append(self)

    def tick(self) -> Status:
        """Look at the node, and so at those below it that it asks; gives its status."""
        if self.status != RUNNING:
            self._begin()
        self._become(self._look())
        return self.status

    def halt(self) -> None:
        """End what runs in the node, which has not come to an end; nothing is known of it then."""
        for child in self.children:
            if child.status != IDLE:
                child.halt()
        self._become(IDLE)

    def _begin(self) -> None:
        """What is done before the first look, and again after an end."""

    def _look(self) -> Status:
        raise NotImplementedError

    def _become(self, status: Status) -> None:
        if status != self.status:
            self.status = status
            self._trunk.note(self)


class Branch(Node):
    """A node with others below it, which stand in its ``with``."""

    def __enter__(self) -> Branch:
        self._trunk.open.append(self)
        return self

    def __exit__(self, *_error: object) -> None:
        self._trunk.open.pop()

    def _halt_from(self, first: int) -> None:
        for child in self.children[first:]:
            if child.status != IDLE:
                child.halt()


def _number(number: Number) -> float:
    return number() if callable(number) else number


def _times(number: Number) -> float:
    """How often: a whole number, or without end."""
    times = _number(number)
    return times if times == math.inf else to_nearest(times)


# Nodes that ask several others.


class _InOrder(Branch):
    """Asks its children one after the other, until one of them does not end with ``_goes_on``."""

    _goes_on: Status

    def __init__(self, *, reactive: bool = False, keeps_place: bool = False) -> None:
        super().__init__()
        self._is_reactive = reactive
        self._keeps_place = keeps_place
        self._at = 0

    def _begin(self) -> None:
        if not self._keeps_place:
            self._at = 0
        self._halt_from(self._at)

    def _look(self) -> Status:
        first = 0 if self._is_reactive else self._at
        for at in range(first, len(self.children)):
            status = self.children[at].tick()
            if status != self._goes_on:
                self._at = at
                if self._is_reactive:
                    self._halt_from(at + 1)
                return status
        self._at = 0
        return self._goes_on


class Sequence(_InOrder):
    """Does its children one after the other; fails as soon as one fails.

    ``reactive``: asks from the first again each time, and halts the later one that runs when an
    earlier one does not succeed any more. ``keeps_place``: begins with the one that failed when it
    is done again.
    """

    _goes_on = SUCCEEDED


class Fallback(_InOrder):
    """Tries its children one after the other; succeeds as soon as one succeeds.

    ``reactive``: tries from the first again each time, and halts the later one that runs.
    """

    _goes_on = FAILED

    def __init__(self, *, reactive: bool = False) -> None:
        super().__init__(reactive=reactive)


class Parallel(Branch):
    """Does its children side by side; fails as soon as one fails.

    Succeeds when ``enough`` of them have, all of them if that is not said.
    """

    def __init__(self, enough: Number = math.inf) -> None:
        super().__init__()
        self._enough = enough
        self._wanted = 0.0

    def _begin(self) -> None:
        self._wanted = min(len(self.children), _times(self._enough))
        self._halt_from(0)

    def _look(self) -> Status:
        for child in self.children:
            if child.status != SUCCEEDED:
                child.tick()
        done = sum(child.status == SUCCEEDED for child in self.children)
        if any(child.status == FAILED for child in self.children):
            status = FAILED
        elif done >= self._wanted:
            status = SUCCEEDED
        else:
            return RUNNING
        for child in self.children:
            if child.status == RUNNING:
                child.halt()
        return status


# Nodes that change what the one below them means, or when it is asked.


class _Around(Branch):
    """A node around one other; several in it are done one after the other."""

    def __exit__(self, *error: object) -> None:
        if len(self.children) != 1:
            children, self.children = self.children, []
            row = Sequence()
            self._trunk.lines[row.line].remove(row)
            row.line = 0  # it is not in the program
            row.children = children
        super().__exit__(*error)

    @property
    def _child(self) -> Node:
        return self.children[0]

    def _halt_child(self) -> None:
        if self._child.status == RUNNING:
            self._child.halt()


class WhileTrue(_Around):
    """Does what is in it while ``condition()`` is true; fails as soon as it is not."""

    def __init__(self, condition: Condition) -> None:
        super().__init__()
        self._condition = condition

    def _look(self) -> Status:
        if self._condition():
            return self._child.tick()
        self._halt_child()
        return FAILED


class _Counted(_Around):
    """Does what is in it until it has ended ``times`` times as ``_counts``, once each look."""

    _counts: Status

    def __init__(self, times: Number = math.inf) -> None:
        super().__init__()
        self._times = times
        self._most = 0.0
        self._done = 0

    def _begin(self) -> None:
        self._most = _times(self._times)
        self._done = 0

    def _look(self) -> Status:
        if self._most < 1:
            return self._counts
        status = self._child.tick()
        if status != self._counts:
            return status
        self._done += 1
        return RUNNING if self._done < self._most else status


class Retry(_Counted):
    """Does what is in it again until it succeeds, ``times`` times at most."""

    _counts = FAILED


class Repeat(_Counted):
    """Does what is in it again until it fails, ``times`` times at most."""

    _counts = SUCCEEDED


class _Timed(_Around):
    """A node that looks at the time; pauses of the program do not count."""

    def __init__(self, seconds: Number) -> None:
        super().__init__()
        self._seconds = seconds

    def _later_s(self) -> float:
        """The time after so many seconds."""
        return CLOCK.now_s() + _number(self._seconds)


class TimeLimit(_Timed):
    """Halts what is in it, and fails, when that runs for longer than ``seconds``."""

    _until_s = 0.0

    def _begin(self) -> None:
        self._until_s = self._later_s()

    def _look(self) -> Status:
        status = self._child.tick()
        if status == RUNNING and CLOCK.now_s() > self._until_s:
            self._child.halt()
            return FAILED
        return status


class CoolDown(_Timed):
    """Fails without doing what is in it, for ``seconds`` after that has ended."""

    _until_s = -math.inf

    def _look(self) -> Status:
        if self._child.status != RUNNING and CLOCK.now_s() < self._until_s:
            return FAILED
        status = self._child.tick()
        if status != RUNNING:
            self._until_s = self._later_s()
        return status


class Delay(_Timed):
    """Does what is in it after ``seconds``."""

    _from_s = 0.0

    def _begin(self) -> None:
        self._from_s = self._later_s()

    def _look(self) -> Status:
        return self._child.tick() if CLOCK.now_s() >= self._from_s else RUNNING


class _Instead(_Around):
    """Ends otherwise than what is in it."""

    _ends: dict[Status, Status]

    def _look(self) -> Status:
        status = self._child.tick()
        return self._ends.get(status, status)


class Invert(_Instead):
    """Fails when what is in it succeeds, and the other way round."""

    _ends = {SUCCEEDED: FAILED, FAILED: SUCCEEDED}  # noqa: RUF012 - never changed


class ForceSuccess(_Instead):
    """Succeeds when what is in it ends, however that ends."""

    _ends = {FAILED: SUCCEEDED}  # noqa: RUF012 - never changed


class ForceFailure(_Instead):
    """Fails when what is in it ends, however that ends."""

    _ends = {SUCCEEDED: FAILED}  # noqa: RUF012 - never changed


# Leaves: what is asked, and what is done.


class Check(Node):
    """Succeeds when ``condition()`` is true, else fails."""

    def __init__(self, condition: Condition) -> None:
        super().__init__()
        self._condition = condition

    def _look(self) -> Status:
        return SUCCEEDED if self._condition() else FAILED


class Step(Node):
    """Does the decorated function, in a part of its own: succeeds when that ends.

    It fails when the function says so, or ends by an error, which is told. Halted, it is cancelled
    with what it began on robots.
    """

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name
        self._action: Action = _nothing
        self._part: Part | None = None
        self._has_ended = threading.Event()

    def __call__(self, action: Action) -> Action:
        """What it does."""
        self._action = action
        return action

    def halt(self) -> None:
        """Cancel what it does, and wait until that has ended."""
        if self._part is not None:
            self._part.task.cancel()
            self._part.await_end()
            self._part = None
        super().halt()

    def _begin(self) -> None:
        self._has_ended = ended = threading.Event()

        def play() -> None:
            try:
                self._action()
            finally:
                ended.set()
                self._trunk.news.set()

        self._part = Part(play, f"nep-step-{self.name}", current_task())
        self._part.task.in_step = True
        self._part.start()

    def _look(self) -> Status:
        part = self._part
        if part is None or not self._has_ended.is_set():
            return RUNNING
        part.join()  # it is at its end
        self._part, error = None, part.error
        if error is None:
            return SUCCEEDED
        if isinstance(error, RuleStopped):
            raise error
        if not isinstance(error, StepFailed):
            self._trunk.note_error(error)
        return FAILED


def _nothing() -> None:
    """What a step does that has been given nothing."""


# Trees in trees, with the values that go in and out.


class SubTree(Branch):
    """Does another tree by its name; named values of its own go in and out as it says.

    In its ``with`` stand what it is given (``Input``) and what is taken from it (``Output``).
    """

    def __init__(self, name: str) -> None:
        super().__init__()
        self._name = name
        self._board: dict[str, Any] = {}
        self._inputs: list[tuple[str, Condition]] = []
        self._outputs: list[tuple[str, str]] = []
        self._above = [*self._trunk.open, self]

    def give(self, name: str, value: Condition) -> None:
        """Let it have a value under this name when it begins."""
        self._inputs.append((name, value))

    def take(self, name: str, ours: str) -> None:
        """Let the tree around it have a value of it when it ends."""
        self._outputs.append((name, ours))

    def _begin(self) -> None:
        self._halt_from(0)
        for name, value in self._inputs:
            try:
                self._board[name] = value()
            except NoTreeValue:
                self._board.pop(name, None)  # what has no value yet is not given
        if not self.children:
            self._inside(self._grow)

    def _look(self) -> Status:
        status = self._inside(self.children[0].tick)
        if status in (SUCCEEDED, FAILED):
            board = current_task().board
            board.update(
                {ours: self._board[name] for name, ours in self._outputs if name in self._board}
            )
        return status

    def halt(self) -> None:
        """Halt what is in it."""
        self._inside(super().halt)

    def _grow(self) -> None:
        _grow(_plan(self._name), self._trunk, self._above)

    def _inside(self, act: Callable[[], _Given]) -> _Given:
        """Do something among the values of the tree."""
        task = current_task()
        around, task.board = task.board, self._board
        try:
            return act()
        finally:
            task.board = around


def Input(name: str, value: Condition) -> None:  # noqa: N802 - it reads as the nodes around it
    """Give the tree in whose ``with`` this stands what ``value()`` is when it begins."""
    _sub_tree().give(name, value)


def Output(name: str, ours: str) -> None:  # noqa: N802 - it reads as the nodes around it
    """Take the value ``name`` of the tree in whose ``with`` this stands as ``ours``, at its end."""
    _sub_tree().take(name, ours)


def _sub_tree() -> SubTree:
    above = _trunk().open[-1:]
    if above and isinstance(above[0], SubTree):
        return above[0]
    raise NepError(
        "Values go in and out of a tree that is inside another one.",
        code="outside_sub_tree",
        checklist=("Put this into the “with” of a “SubTree”.",),
    )


def tree_value(name: str) -> Any:
    """The value of this name that belongs to the tree that runs here."""
    board = current_task().board
    if name not in board:
        raise NoTreeValue(
            "Nothing is called “{name}” in this tree yet.",
            code="no_tree_value",
            checklist=(
                "Give it a value before it is used.",
                "Is the name written as it is where the value is set?",
            ),
            name=name,
        )
    return board[name]


def set_tree_value(name: str, value: object) -> None:
    """Give a name in the tree that runs here a value."""
    current_task().board[name] = value


# The trees of a program, and their runs.


@dataclass(frozen=True, slots=True)
class Plan:
    """A tree as a program says it: ``plant`` makes its nodes each time that it begins."""

    name: str
    plant: Action
    tell: Tell
    note_error: Callable[[BaseException], None]


_plans: dict[str, Plan] = {}


def plant(plan: Plan) -> None:
    """Let a tree be known by its name; of two, the later one."""
    _plans[plan.name] = plan


def _plan(name: str) -> Plan:
    if name not in _plans:
        raise NepError(
            "There is no behaviour tree “{name}”.",
            code="no_tree",
            checklist=("Write the name as the tree's own block has it.",),
            name=name,
        )
    return _plans[name]


def _grow(plan: Plan, trunk: Trunk, above: Row[Node] = ()) -> Node:
    """Make the nodes of a tree; several at its top are done one after the other."""
    before, trunk.open = trunk.open, list(above)
    growing = _growing.set(trunk)
    try:
        with Sequence() as root:
            trunk.lines[root.line].remove(root)
            root.line = 0  # it is not in the program
            plan.plant()
    finally:
        _growing.reset(growing)
        trunk.open = before
    if len(root.children) != 1:
        return root
    if above:
        above[-1].children[-1] = root.children[0]
    return root.children[0]


def do_tree(name: str) -> bool:
    """Do a behaviour tree from its beginning to its end; whether it succeeded."""
    task, board = current_task(), dict[str, Any]()
    around, task.board = task.board, board
    try:
        return _do(_plan(name), again=False)
    finally:
        task.board = around


def do_tree_again(name: str) -> None:
    """Do a behaviour tree again and again, for ever; its nodes remember what they do of before."""
    current_task().board = {}
    _do(_plan(name), again=True)


def _do(plan: Plan, *, again: bool) -> bool:
    trunk = Trunk(plan.name, plan.tell, plan.note_error)
    root = _grow(plan, trunk)
    try:
        while True:
            CLOCK.hold()
            begun_s = time.monotonic()
            trunk.news.clear()
            status = root.tick()
            trunk.tell_changes()
            if status != RUNNING and not again:
                return status == SUCCEEDED
            _rest(trunk, begun_s)
    except BaseException:
        root.halt()
        trunk.tell_changes()
        raise


def _rest(trunk: Trunk, begun_s: float) -> None:
    """Wait for the next look: a while after the last one, or until a step ends."""
    task = current_task()
    task.sleep(SHORTEST_S)
    trunk.news.wait(max(0.0, begun_s + PERIOD_S - time.monotonic()))
    task.check()

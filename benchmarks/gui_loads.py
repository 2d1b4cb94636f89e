"""What the window has to stand: many nodes, a long log, many messages, a large program."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

from nep_studio.run.plan import Ending, PlannedNode
from nep_studio.ui.shell.main_window import MainWindow

Wait = Callable[[Callable[[], bool]], None]
"""Runs the window until a condition holds; fails when that takes too long."""

NODES = 10
LINES = 200_000
MESSAGES_HZ = 5_000
MESSAGES = 15_000
BLOCKS = 5_000
STACK_BLOCKS = 100
RUN_S = 4.0

_RUNS = count(1)

FLOOD = f"""\
for number in range({LINES}):
    print("line", number, "of a node that has much to say")
"""

TALK = f"""\
import time

from nep_core.wire.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.wire.pubsub import Publisher

publisher = Publisher(HUMAN_BEHAVIOR)
publisher.wait_for_subscribers(1, 10)
began_s = time.perf_counter()
for number in range({MESSAGES}):
    publisher.send(HumanBehavior(human_state="emotion_happy", certainty=0.5))
    ahead_s = number / {MESSAGES_HZ} - (time.perf_counter() - began_s)
    if ahead_s > 0.002:
        time.sleep(ahead_s)
time.sleep(0.5)
"""


def start_ten_nodes(window: MainWindow, folder: Path, wait: Wait) -> None:
    """Start nodes by hand, all at once, and wait until each is ready."""
    runner = window.running.runner
    names = [f"node{number}" for number in range(NODES)]
    for name in names:
        runner.start_node(PlannedNode("perceptual/gesture", name, {"gesture": "karate"}))
    wait(lambda: all(_health(window, name) in ("ready", "busy") for name in names))
    for name in names:
        runner.stop_node(name)
    wait(lambda: all(_health(window, name) == "stopped" for name in names))


def flood_a_log(window: MainWindow, folder: Path, wait: Wait) -> None:
    """A node writes lines as fast as it can."""
    name = _run_text(window, folder, "flood", FLOOD, wait)
    runner = window.running.runner
    wait(lambda: any(f"line {LINES - 1} of" in line for line in runner.log_of(name)[-5:]))


def hear_many_messages(window: MainWindow, folder: Path, wait: Wait) -> None:
    """Somebody speaks 5,000 times a second for some seconds."""
    heard = [0]

    def hear(batch: list[object]) -> None:
        heard[0] += len(batch)

    runner = window.running.runner
    runner.arrived.connect(hear)
    _run_text(window, folder, "talk", TALK, wait)
    runner.arrived.disconnect(hear)
    assert heard[0] > MESSAGES / 10, f"only {heard[0]} of {MESSAGES} messages were heard"


def open_a_large_program(window: MainWindow, folder: Path, wait: Wait) -> None:
    """Open it, and let the first checks be over."""
    file = folder / "large.nep"
    file.write_text(json.dumps(large_program()), encoding="utf-8")
    checked: list[object] = []
    window.workbench.checks.found.connect(checked.append)
    window.files.open(file)
    wait(lambda: window.files.document is not None and window.workbench.canvas.isVisible())
    wait(lambda: bool(checked))
    window.workbench.checks.found.disconnect(checked.append)


def press_run(window: MainWindow, folder: Path, wait: Wait) -> None:
    """The Python of all blocks is made, the nodes and the program are started."""
    runner = window.running.runner
    with _undisturbed(window):
        runner.run()
        wait(lambda: runner.state == "running")


def start_a_large_program(window: MainWindow, folder: Path, wait: Wait) -> None:
    """Open it and press Run."""
    open_a_large_program(window, folder, wait)
    press_run(window, folder, wait)


def run_a_large_program(window: MainWindow, folder: Path, wait: Wait) -> None:
    """Fifty rules run at once, line by line, while the window shows where they are; then Stop."""
    runner, stage = window.running.runner, window.running.stage
    with _undisturbed(window):
        wait(lambda: bool(stage.marks.glowing))
        end_s = time.monotonic() + RUN_S
        wait(lambda: time.monotonic() > end_s)
        runner.stop()
        wait(lambda: runner.state == "idle")


def large_program() -> dict[str, object]:
    """A project of 5,000 blocks that all run: in each stack a rule that counts for ever."""
    blocks: list[dict[str, object]] = []
    stacks = []
    for stack in range(BLOCKS // STACK_BLOCKS):
        hat, loop = f"h{stack}", f"l{stack}"
        counting = [f"c{stack}x{number}" for number in range(STACK_BLOCKS - 3)]
        fields = {"variable": "v1", "amount": 1}
        blocks.append({"id": hat, "type": "event.started"})
        blocks += [{"id": one, "type": "variable.change", "fields": fields} for one in counting]
        pause = f"w{stack}"
        blocks.append({"id": pause, "type": "control.wait", "fields": {"seconds": 0.05}})
        body = {"do": [*counting, pause]}
        blocks.append({"id": loop, "type": "control.forever", "bodies": body})
        place = {"x": 420 * (stack % 10), "y": 5000 * (stack // 10)}
        stacks.append({"id": f"s{stack}", **place, "body": [hat, loop]})
    return {
        "format": "nep-studio-project",
        "version": 2,
        "name": "Large",
        "variables": [{"id": "v1", "name": "count"}],
        "blocks": blocks,
        "pages": {"behaviour": stacks, "robots": [], "nodes": []},
    }


Load = Callable[[MainWindow, Path, Wait], None]

PREPARATIONS: dict[str, Load] = {
    "Run is pressed on 5,000 blocks": open_a_large_program,
    "5,000 blocks run": start_a_large_program,
}
"""What is done before a load, without being measured."""

LOADS: dict[str, Load] = {
    "10 nodes start": start_ten_nodes,
    "a log of 200,000 lines": flood_a_log,
    "5,000 messages a second": hear_many_messages,
    "Run is pressed on 5,000 blocks": press_run,
    "5,000 blocks run": run_a_large_program,
}


def _run_text(window: MainWindow, folder: Path, title: str, text: str, wait: Wait) -> str:
    """Run a program to its end; its name is new each time, as an earlier one has ended already."""
    name = f"{title}{next(_RUNS)}"
    file = folder / f"{name}.py"
    file.write_text(text, encoding="utf-8")
    window.running.runner.start_node(PlannedNode("cognitive/program", name, {"file": str(file)}))
    wait(lambda: _health(window, name) == "stopped")
    return name


def _health(window: MainWindow, name: str) -> str:
    status = window.running.runner.board.nodes.get(name)
    return "" if status is None else status.health


@contextmanager
def _undisturbed(window: MainWindow) -> Iterator[None]:
    """Fail with the reason when a program that should run does not."""
    endings: list[Ending] = []
    window.running.runner.ended.connect(endings.append)
    yield
    window.running.runner.ended.disconnect(endings.append)
    problems = [ending.problem for ending in endings if ending.problem is not None]
    assert not problems, problems

"""Measure the canvas and its reference on one platform, in a process of its own.

``python -m benchmarks._canvas_child figures`` prints what was measured as one line of JSON,
``... memory`` the memory of a process that shows 5,000 blocks and has done nothing else.
"""

from __future__ import annotations

import gc
import json
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import psutil
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication, QLineEdit

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.generate.program import ProgramGenerator, generate_program
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import LIGHT, load_theme

from .canvas_driving import Driver, NotPainted
from .canvas_reference import ReferenceView
from .canvas_workload import drag_path, language, made, one_stack
from .codegen import STACKS
from .codegen import workload as running_workload

SIZE = (1280, 800)
SIZES = (100, 1_000, 5_000, 20_000)
REFERENCE_SIZES = (100, 5_000)
LOADS, ROUNDS, UNDO_ROUNDS = 3, 20, 7
LONGEST_STACK = 10_000
FIRST_BLOCK = QPointF(20.0, 14.0)
"""Where a block is taken: on its first word, from its corner."""

CORNER = QPointF(0.0, -120.0)
"""What is seen: a drag from here stays away from the edges, where a canvas may scroll by itself."""

FIRST_STACK, EDITED = "s0", "b9"
"""In the reference program: the stack that is dragged, and a text of it that is edited."""

View = Canvas | ReferenceView
Figures = dict[str, float]


class Bench:
    """What is measured needs the language and the look once."""

    def __init__(self) -> None:
        self.words = language()
        self.theme = load_theme(LIGHT)

    def opened(self, kind: type[View], data: bytes) -> tuple[View, Driver, float]:
        """Open a file in a new view; the CPU until it is painted."""
        gc.collect()
        start_s = time.process_time()
        editor = Editor(from_bytes(data, "workload.nep", self.words), self.words)
        view = kind(editor, self.theme)
        view.resize(*SIZE)
        driver = Driver(view)
        view.show()
        driver.wait_for_paint()
        load_ms = (time.process_time() - start_s) * 1000
        driver.settle()
        if isinstance(view, ReferenceView):
            view.look_at(CORNER)
        else:
            view.sight.move_camera(CORNER.x(), CORNER.y())
        driver.settle()
        return view, driver, load_ms

    @contextmanager
    def open(self, kind: type[View], data: bytes) -> Iterator[tuple[View, Driver]]:
        """A view of a file, closed at the end."""
        view, driver, _ = self.opened(kind, data)
        try:
            yield view, driver
        finally:
            close(view)


def close(view: View) -> None:
    """Take a view away with all that is in it."""
    view.close()
    view.deleteLater()
    QApplication.processEvents()
    gc.collect()


def figures() -> Figures:
    """Everything that is measured, in ms of CPU unless the name says otherwise."""
    bench, found = Bench(), Figures()
    for blocks in SIZES:
        data = to_bytes(made(blocks, bench.words))
        found |= loading(bench, Canvas, data, f"ours {blocks}")
        with bench.open(Canvas, data) as (view, driver):
            assert isinstance(view, Canvas)
            found |= dragging(view, driver, f"ours {blocks}")
            found |= undoing(view, driver, f"ours {blocks}")
            if blocks == 5_000:
                found |= looking(view, driver) | typing(view, driver)
        if blocks in REFERENCE_SIZES:
            found |= loading(bench, ReferenceView, data, f"reference {blocks}")
            with bench.open(ReferenceView, data) as (view, driver):
                found |= dragging(view, driver, f"reference {blocks}")
                found |= undoing(view, driver, f"reference {blocks}")
    return found | coding(bench) | long_stack(bench)


def loading(bench: Bench, kind: type[View], data: bytes, name: str) -> Figures:
    """From the bytes of a file to what a person sees."""
    times_ms = []
    for _ in range(LOADS):
        view, _, load_ms = bench.opened(kind, data)
        times_ms.append(load_ms)
        close(view)
    return {f"{name} load": statistics.median(times_ms)}


def dragging(view: View, driver: Driver, name: str) -> Figures:
    """Each step of a drag of a 100-block stack over its neighbours, with what it would snap to."""
    gaps: list[bool] = []
    before = gap_of(view)

    def note_gap() -> None:
        nonlocal before
        if not is_carrying(view):
            raise NotPainted("The stack was not dragged.")
        now = gap_of(view)
        gaps.append(now != before)
        before = now

    times_ms = driver.drag(grip(view), drag_path(), note_gap)
    while view.editor.history.undo():  # a drop may have moved the stack a little
        driver.settle()
    steps = [t for t, is_new in zip(times_ms, gaps, strict=True) if not is_new]
    previews = [t for t, is_new in zip(times_ms, gaps, strict=True) if is_new]
    found = {
        f"{name} drag": statistics.median(times_ms),
        f"{name} drag p95": statistics.quantiles(times_ms, n=20)[-1],
        f"{name} drag without preview": statistics.median(steps),
    }
    return found | ({f"{name} preview": statistics.median(previews)} if previews else {})


def is_carrying(view: View) -> bool:
    """Whether a stack is being dragged."""
    return view.layers.sprite is not None if isinstance(view, Canvas) else view.is_carrying


def gap_of(view: View) -> object:
    """What says where the dragged blocks would go, as far as it is drawn among the blocks."""
    return view.page_layout.layout.gap if isinstance(view, Canvas) else None


def grip(view: View) -> QPointF:
    """Where the first stack is taken, in the viewport."""
    stack = view.editor.project.stacks[FIRST_STACK]
    place = QPointF(stack.x, stack.y) + FIRST_BLOCK
    if isinstance(view, Canvas):
        return view.sight.camera.to_view(place.x(), place.y())
    return QPointF(view.mapFromScene(place))


def undoing(view: View, driver: Driver, name: str) -> Figures:
    """Taking back the deletion of a 100-block stack."""
    editor, times_ms = view.editor, []
    for _ in range(UNDO_ROUNDS):
        body = editor.project.stacks[FIRST_STACK].body
        driver.cpu_ms(lambda body=body: editor.apply(DeleteBlocks(body[0], len(body))))  # type: ignore[misc]
        times_ms.append(driver.cpu_ms(editor.history.undo))
    return {f"{name} undo": statistics.median(times_ms)}


def looking(view: Canvas, driver: Driver) -> Figures:
    """Scroll and zoom with the wheel, and paint all anew."""
    before = view.sight.camera.y
    found = {"scroll": _median(driver, lambda: driver.wheel(-1))}
    zoom_ms = _median(driver, lambda: driver.wheel(-1, is_zooming=True), rounds=6)
    if view.sight.camera.y == before or view.sight.camera.scale == 1.0:
        raise NotPainted("The wheel did not scroll and zoom.")
    found["zoom"] = zoom_ms
    view.sight.zoom(1.0)
    driver.settle()
    view.layers.sharpen.stop()
    found["full repaint"] = _median(driver, view.repaint_all)
    view.sight.move_camera(CORNER.x(), CORNER.y())
    return found


def typing(view: Canvas, driver: Driver) -> Figures:
    """Set a field, and type a letter into the line that opens over it."""
    texts = iter(f"changed {number}" for number in range(10**6))
    found = {
        "field edit": _median(
            driver, lambda: view.editor.apply(SetField(EDITED, "text", next(texts)))
        )
    }
    place = view.sight.view_rect_of(EDITED)
    if place is not None:
        driver.click(place.center())
        line = QApplication.focusWidget()
        if isinstance(line, QLineEdit):
            found["keystroke"] = driver.keys_ms(line, "abcdefghijklmnop")
            view.setFocus()
    return found


def coding(bench: Bench) -> Figures:
    """The Python beside 5,000 blocks that run, after an edit of one of them."""
    editor = Editor(running_workload(STACKS), bench.words)
    edited = next(b.id for b in editor.project.blocks.values() if b.fields.get("text") == "step 3")
    generator = ProgramGenerator(editor.project, bench.words)
    generator.generate()
    times_ms = []
    for number in range(ROUNDS):
        editor.apply(SetField(edited, "text", f"said {number}"))
        times_ms.append(Driver.ms(generator.generate))
    return {"live code": statistics.median(times_ms)}


def long_stack(bench: Bench) -> Figures:
    """A single stack of 10,000 statements: load, save, drag, generate."""
    data = to_bytes(one_stack(LONGEST_STACK, bench.words))
    view, driver, load_ms = bench.opened(Canvas, data)
    project, words = view.editor.project, view.editor.language
    found = {
        "long load": load_ms,
        "long save": Driver.ms(lambda: to_bytes(project)),
        "long generate": Driver.ms(lambda: generate_program(project, words)),
    }
    times_ms = driver.drag(grip(view) + QPointF(0, 16), drag_path())
    close(view)
    return found | {"long drag": statistics.median(times_ms)}


def memory() -> Figures:
    """What a process needs that shows 5,000 blocks."""
    bench = Bench()
    view, _, _ = bench.opened(Canvas, to_bytes(made(5_000, bench.words)))
    rss_mb = psutil.Process().memory_info().rss / 1e6
    close(view)
    return {"rss": rss_mb}


def _median(driver: Driver, work: Callable[[], object], rounds: int = ROUNDS) -> float:
    return statistics.median(driver.cpu_ms(work) for _ in range(rounds))


if __name__ == "__main__":
    application = QApplication(sys.argv[:1])
    measured = memory() if sys.argv[1:] == ["memory"] else figures()
    print(json.dumps(measured))

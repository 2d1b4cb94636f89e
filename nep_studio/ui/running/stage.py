"""Shows on the canvas what a running program does."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from copy import deepcopy
from dataclasses import dataclass, field, replace

from PySide6.QtCore import QObject, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen

from nep_core.wire import messages as m
from nep_core.wire.messages import PlannedStep, ProgramState
from nep_studio.blocks.generate.source_map import Code, ReporterPlaces
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import Placed
from nep_studio.ui.canvas.painting.overlay import rings
from nep_studio.ui.words import tr

from .runner import Runner

# What a running program has done to each block, as data.

LONGEST_VALUE = 40
CALL = "@"
"""What the name of a value begins with that a call gave: "@line:begin-end"."""
MOST_PLANS = 20
OF_PLAN = {
    "plan_made": "",
    "plan_step": "running",
    "plan_step_failed": "failed",
    "plan_done": "succeeded",
}
"""The status of a plan after each event that tells of it."""


@dataclass(frozen=True)
class Plan:
    """A plan for a goal in words; the ``step`` from 1 is the one that has begun, 0 before any.

    The ``status`` is that of this step: running, failed, or succeeded where it was the last one.
    It is empty before the first step, and where the program has ended on the way.
    """

    goal: str
    steps: tuple[PlannedStep, ...]
    step: int = 0
    status: str = ""


@dataclass
class Marks:
    """The blocks that run, where the program pauses, how often rules fired, and what values are.

    ``glowing`` are the innermost blocks that run, ``around`` those that they were called from;
    ``values`` are by the Python name of the variable; ``results`` are what the reporters in a
    statement gave last, by the statement and the reporter. ``places`` finds a reporter's block.
    ``nodes`` are the parts of behaviour trees that run, or have ended, as the program tells them;
    ``modes`` are the states in which state machines are, by the names of these, and ``plans``
    are those that were made for goals, by these in words: at most ``MOST_PLANS``, the newest last.
    """

    code: Code = field(default_factory=lambda: Code("", ()))
    places: ReporterPlaces | None = None
    glowing: frozenset[str] = frozenset()
    around: frozenset[str] = frozenset()
    paused: dict[str, str] = field(default_factory=dict)
    counts: Counter[str] = field(default_factory=Counter)
    values: dict[str, str] = field(default_factory=dict)
    results: dict[str, dict[str, str]] = field(default_factory=dict)
    nodes: dict[str, str] = field(default_factory=dict)
    modes: dict[str, str] = field(default_factory=dict)
    plans: dict[str, Plan] = field(default_factory=dict)

    def take(self, state: ProgramState) -> None:
        """Take in what the program told."""
        match state.event:
            case "line":
                inner, outer = set[str](), set[str]()
                for stack in state.lines.values():
                    blocks = [block for line in stack if (block := self.code.block_at(line))]
                    inner.update(blocks[-1:])
                    outer.update(blocks[:-1])
                self.glowing, self.around = frozenset(inner), frozenset(outer - inner)
                for thread in [one for one in self.paused if one not in state.lines]:
                    del self.paused[thread]
            case "value":
                for name, text in state.values.items():
                    self._value(name, clipped(text))
            case "tree":
                self._nodes(state.nodes)
            case "state_entered":
                self.modes[state.machine] = state.rule
            case "plan_made" | "plan_step" | "plan_step_failed" | "plan_done":
                self._plan(state)
            case "paused":
                block = self.code.block_at(state.line)
                if block is not None:
                    self.paused[state.thread] = block
            case "resumed":
                thread = state.thread
                if thread:
                    self.paused.pop(thread, None)
                else:
                    self.paused.clear()
            case "rule_started":
                block = self.code.block_at(state.line)
                if block is not None:
                    self.counts[block] += 1
            case "started":
                # Nothing has run yet: it has just been started, perhaps again after it was killed
                self.still()
                self.counts.clear()
                self.values.clear()
                self.results.clear()
                self.nodes.clear()
                self.plans.clear()
            case "finished" | "failed":
                self.still()

    def still(self) -> None:
        """Nothing runs any more; counts and values stay, for whoever wants to read them."""
        self.glowing = self.around = frozenset()
        self.paused.clear()
        self.modes.clear()
        self.nodes = {block: how for block, how in self.nodes.items() if how != "running"}
        for goal, plan in self.plans.items():
            if plan.status == "running":
                self.plans[goal] = replace(plan, status="")

    def _nodes(self, told: Mapping[str, str]) -> None:
        for line, status in told.items():
            block = self.code.block_at(int(line)) if line.isdecimal() else None
            if block is not None:
                self.nodes.pop(block, None)
                if status in STATUSES:
                    self.nodes[block] = status

    def _plan(self, state: ProgramState) -> None:
        """A plan that is made anew for a goal takes the place of the one before."""
        self.plans.pop(state.rule, None)
        if state.plan:  # else it was true already
            steps, status = tuple(state.plan), OF_PLAN[state.event]
            self.plans[state.rule] = Plan(state.rule, steps, state.step, status)
        while len(self.plans) > MOST_PLANS:
            del self.plans[next(iter(self.plans))]

    def _value(self, name: str, text: str) -> None:
        if not name.startswith(CALL):
            self.values[name] = text
            return
        block = self.places.block_at(name) if self.places is not None else None
        line = int(name[1:].partition(":")[0])
        statement = self.code.block_at(line)
        if block is not None and statement is not None:
            self.results.setdefault(statement, {})[block] = text


def clipped(text: str) -> str:
    """A value that is not too long for a block."""
    text = " ".join(text.split())
    return text if len(text) <= LONGEST_VALUE else f"{text[: LONGEST_VALUE - 1]}…"


# What a running program draws over the blocks: the glow, pauses, counts and values.

HALO = ((14.0, 40), (9.0, 80), (4.0, 255))
"""Width in pixels and opacity of each line of the glow, the widest first."""
AROUND = ((2.5, 150),)
"""The same around a block from which the one was called that runs."""

STATUSES = {"running": "info", "succeeded": "success", "failed": "error"}
"""The colour of a part of a behaviour tree by its status; a word stands beside it."""
OF_NODE = ((3.0, 220),)
"""Width and opacity of the line around a part of a behaviour tree."""

REACH = 260.0
"""How far beside a block its chips may reach, in canvas units of a line of text of 18."""


class RunOverlay:
    """Draws the marks of the blocks in view; ``names`` give each variable's Python name by id."""

    def __init__(self) -> None:
        self.marks = Marks()
        self.breakpoints: frozenset[str] = frozenset()
        self.names: dict[str, str] = {}

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw them."""
        marks = self.marks
        for blocks, lines in ((marks.around, AROUND), (marks.glowing, HALO)):
            found = [placed for one in blocks if (placed := view.page_layout.placed(one))]
            for width, opacity in lines:
                colour = QColor(view.look.theme.colour("glow"))
                colour.setAlpha(opacity)
                rings(painter, view, found, colour, width / view.sight.camera.scale)
        for block, status in marks.nodes.items():
            found = [placed] if (placed := view.page_layout.placed(block)) else []
            for width, opacity in OF_NODE:
                colour = QColor(view.look.theme.colour(STATUSES[status]))
                colour.setAlpha(opacity)
                rings(painter, view, found, colour, width / view.sight.camera.scale)
        known = (marks.counts, marks.values, marks.results, marks.paused, marks.nodes)
        if not (self.breakpoints or any(known)):
            return
        paused = frozenset(marks.paused.values())
        for placed in view.page_layout.boxes(view.sight.visible_page_rect()):
            block = placed.box.block
            if block in self.breakpoints:
                _disc(painter, view, placed, 6.5, "stop", "stop_text" if block in paused else "")
            elif block in paused:
                _disc(painter, view, placed, 8, "warning", "canvas")
            if words := self._chip(view, block):
                _chip(painter, view, placed, words)

    def _chip(self, view: CanvasHost, block: str) -> str:
        """The words beside a block: how often it fired, how it ended, what values it gave."""
        if (count := self.marks.counts.get(block, 0)) > 0:
            return tr("{n}\N{MULTIPLICATION SIGN}", n=count)
        if (status := self.marks.nodes.get(block)) is not None:
            return _word_of(status)
        if results := self.marks.results.get(block):
            return "   ".join(results.values())
        made = view.editor.project.blocks.get(block)
        if made is None or not self.marks.values or not made.type.startswith("variable."):
            return ""
        if made.type == "variable.get":
            return ""
        name = self.names.get(str(made.fields.get("variable", "")), "")
        return self.marks.values.get(name, "")


def _word_of(status: str) -> str:
    """How a part of a behaviour tree is, in a word."""
    if status == "running":
        return tr("running")
    return tr("succeeded") if status == "succeeded" else tr("failed")


def _disc(
    painter: QPainter, view: CanvasHost, placed: Placed, size: float, fill: str, bars: str
) -> None:
    """A dot before a block; with two bars, in a colour of their own, while the program waits."""
    unit, theme, centre = view.look.measures.unit, view.look.theme, _before(view, placed)
    painter.setPen(QPen(theme.colour("canvas"), 1.5 * unit))
    painter.setBrush(theme.colour(fill))
    painter.drawEllipse(centre, size * unit, size * unit)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(theme.colour(bars or fill))
    for side in (-1, 1) if bars else ():
        middle = centre.x() + side * 2 * unit
        painter.drawRect(QRectF(middle - unit * 0.9, centre.y() - 3 * unit, unit * 1.8, 6 * unit))


def _before(view: CanvasHost, placed: Placed) -> QPointF:
    """The place before the first row of a block, where reading begins."""
    unit = view.look.measures.unit
    way = 12 * unit
    x = placed.x + placed.box.width + way if placed.box.is_mirrored else placed.x - way
    return QPointF(x, _first_row(placed, unit))


def _first_row(placed: Placed, unit: float) -> float:
    """The height of the middle of the first words of a block; those of a hat are below its cap."""
    if placed.box.outline == "hat":
        return placed.y + placed.box.height - 18 * unit
    return placed.y + 15 * unit


def _chip(painter: QPainter, view: CanvasHost, placed: Placed, words: str) -> None:
    """A small label after the first row of a block."""
    unit = view.look.measures.unit
    metrics = QFontMetricsF(view.look.badge_font)
    wide = min(metrics.horizontalAdvance(words), (REACH - 40) * unit)
    height = metrics.height() + 4 * unit
    width = wide + 14 * unit
    gap = 10 * unit
    after = placed.x - gap - width if placed.box.is_mirrored else placed.x + placed.box.width + gap
    rect = QRectF(after, _first_row(placed, unit) - height / 2, width, height)
    painter.setPen(QPen(view.look.theme.colour("field_line"), unit))
    painter.setBrush(view.look.theme.colour("menu"))
    painter.drawRoundedRect(rect, height / 2, height / 2)
    painter.setPen(view.look.theme.colour("text"))
    painter.setFont(view.look.badge_font)
    shown = metrics.elidedText(words, Qt.TextElideMode.ElideRight, wide + unit)
    painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, shown)


# The blocks at which a program is to pause.


class Breakpoints(QObject):
    """Ids of statement blocks; a block that is deleted is simply not met any more."""

    changed = Signal()

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.ids: frozenset[str] = frozenset()

    def toggle(self, blocks: Iterable[str]) -> None:
        """Pause at these blocks, or, if all of them are known already, no longer."""
        wanted = frozenset(blocks)
        self._set(self.ids - wanted if wanted <= self.ids else self.ids | wanted)

    def clear(self) -> None:
        """Pause nowhere."""
        self._set(frozenset())

    def _set(self, ids: frozenset[str]) -> None:
        if ids != self.ids:
            self.ids = ids
            self.changed.emit()


Batch = list[tuple[str, object]]


class Stage(QObject):
    """The glow, the pauses, the counts and the values on one canvas at a time."""

    def __init__(self, runner: Runner, breakpoints: Breakpoints) -> None:
        super().__init__(runner)
        self.marks = Marks()
        self.overlay = RunOverlay()
        self.overlay.marks = self.marks
        self._breakpoints = breakpoints
        self._canvas: Canvas | None = None
        runner.arrived.connect(self._on_arrived)
        runner.state_changed.connect(self._on_state_changed)
        breakpoints.changed.connect(self._on_breakpoints_changed)

    def show_on(self, canvas: Canvas) -> None:
        """Show it on this canvas from now on."""
        self._canvas = canvas
        canvas.layers.show_overlay(self.overlay)
        canvas.menu_sections.append(self._menu)

    def begin(self, code: Code) -> None:
        """A program is about to run: nothing is known of it yet."""
        places = None
        if self._canvas is not None and code.text:
            editor = self._canvas.editor
            places = ReporterPlaces(code, editor.project, editor.language)
        self.marks = self.overlay.marks = Marks(code, places)
        self.overlay.names = dict(code.variables)
        self._repaint_all()

    def clear(self) -> None:
        """Forget what ran: another project is shown."""
        self.begin(Code("", ()))

    def _on_arrived(self, batch: Batch) -> None:
        states = [message for _, message in batch if isinstance(message, m.ProgramState)]
        if not states:
            return
        before = self._shown()
        values, results = dict(self.marks.values), deepcopy(self.marks.results)
        paused = dict(self.marks.paused)
        counts, nodes = self.marks.counts.copy(), self.marks.nodes.copy()
        for state in states:
            self.marks.take(state)
        has_fewer = bool(counts - self.marks.counts)  # the program was started again
        if has_fewer or (values, results) != (self.marks.values, self.marks.results):
            self._repaint_all()
        else:
            self._touch(before ^ self._shown())
            self._touch(self.marks.counts - counts, with_chips=True)
            changed = {block for block, _ in nodes.items() ^ self.marks.nodes.items()}
            self._touch(changed, with_chips=True)
        # Show the block at which the program has just paused
        new = [block for thread, block in self.marks.paused.items() if paused.get(thread) != block]
        canvas = self._canvas
        if new and canvas is not None and new[0] in canvas.editor.project.blocks:
            canvas.show_block(new[0])
        elif canvas is not None:
            canvas.following.follow(self.marks.glowing)

    def _shown(self) -> frozenset[str]:
        marks = self.marks
        return marks.glowing | marks.around | frozenset(marks.paused.values())

    def _touch(self, blocks: Iterable[str], *, with_chips: bool = False) -> None:
        """Paint blocks and the glow around them again, perhaps with what stands beside them."""
        view = self._canvas
        if view is None or not view.isVisible():
            return
        reach = REACH * view.look.measures.unit if with_chips else 20.0
        for block in blocks:
            placed = view.page_layout.placed(block)
            if placed is not None:
                wide, high = placed.box.width + 2 * reach, placed.box.height + 32
                view.layers.update_page(Rect(placed.x - reach, placed.y - 16, wide, high))

    def _repaint_all(self) -> None:
        if self._canvas is not None:
            self._canvas.area.viewport().update()

    def _on_state_changed(self, state: str) -> None:
        if state == "idle":
            before, nodes = self._shown(), frozenset(self.marks.nodes)
            self.marks.still()
            self._touch(before)
            self._touch(nodes, with_chips=True)

    def _on_breakpoints_changed(self) -> None:
        self.overlay.breakpoints = self._breakpoints.ids
        self._repaint_all()

    def _menu(self, canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
        """Let the program pause at a block."""
        if (
            place.hit is None
            or canvas.editor.project.kind_of_page(canvas.page_layout.page) != "behaviour"
        ):
            return []
        block = statement_at(canvas, place.hit.block)
        if not block:
            return []
        is_on = block in self._breakpoints.ids
        words = tr("Do not pause here any more") if is_on else tr("Pause here")
        toggle = self._breakpoints.toggle
        return [MenuEntry("breakpoint", words, lambda: toggle([block]), "pause", True, "F9")]


def statement_at(canvas: CanvasHost, block: str) -> str:
    """The block that does something which a block is, or is a part of; "" where there is none."""
    project, language = canvas.editor.project, canvas.editor.language
    while block in project.blocks:
        definition = language.definitions.get(project.blocks[block].type)
        if definition is not None and definition.shape in ("statement", "c", "cap", "hat"):
            return block
        parent = project.parents.get(block)
        block = parent.owner if parent is not None else ""
    return ""

"""Move blocks: pick them up and drop them, put them around others, and tidy a page."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Literal, NamedTuple

from faults import Text
from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.edit_rules import why_not_below, why_not_chained
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import Edit
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.edits.placing import CreateBlocks, MoveBlocks
from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InBody, InInput, InStack, NewStack, Place, chain_at, place_of
from nep_studio.blocks.procedures import procedure_of
from nep_studio.blocks.program import Block, Project

from .copying import STEP, UNKNOWN, Clip, Points, clip_of, paste_at
from .selection import Run, chain_around, is_within_run, members, run_from, runs

# Tidying: stacks that lie on each other are pushed apart, the others stay where they are.

GAP = 24.0
"""How far apart stacks are put, in canvas units."""


class Box(NamedTuple):
    """A rectangle on a page, in canvas units."""

    x: float
    y: float
    width: float
    height: float

    def overlaps(self, other: Box, gap: float = 0.0) -> bool:
        """Whether two boxes are nearer to each other than ``gap``, or lie on each other."""
        return (
            self.x < other.x + other.width + gap
            and other.x < self.x + self.width + gap
            and self.y < other.y + other.height + gap
            and other.y < self.y + self.height + gap
        )


def pushed_apart(box: Box, others: Collection[Box]) -> Box:
    """The box moved right or down, whichever is less each time, until it is clear of the others.

    Once clear of a box it stays so, as it never goes back: at most one move for each.
    """
    while other := next((other for other in others if box.overlaps(other, GAP)), None):
        right, down = other.x + other.width + GAP, other.y + other.height + GAP
        is_right_nearer = right - box.x < down - box.y
        box = box._replace(x=right) if is_right_nearer else box._replace(y=down)
    return box


Sizes = Mapping[str, tuple[float, float]]
"""The width and height of each stack, in canvas units."""


def tidy(
    editor: Editor,
    page: str,
    sizes: Sizes,
    *,
    align: Literal["", "columns"] = "",
    is_mirrored: bool = False,
) -> tuple[str, ...]:
    """Push overlapping stacks apart, or put all in columns; gives the stacks that moved.

    No stack gets a place before one that was before it: the order of reading stays. On a mirrored
    page, where a stack's place is its right corner, everything goes from right to left.
    """
    side = -1 if is_mirrored else 1
    boxes = {
        stack.id: Box(side * stack.x, stack.y, *sizes.get(stack.id, (0.0, 0.0)))
        for stack in editor.project.pages[page]
    }
    placed = in_columns(boxes) if align == "columns" else apart(boxes)
    moved = tuple(stack for stack, box in placed.items() if box[:2] != boxes[stack][:2])
    with editor.transaction("tidy up"):
        for stack in moved:
            editor.apply(MoveStack(stack, side * placed[stack].x, placed[stack].y))
    return moved


def apart(boxes: Mapping[str, Box]) -> dict[str, Box]:
    """Boxes in reading order, each pushed clear of those before it; who is clear stays."""
    placed: dict[str, Box] = {}
    for stack, box in sorted(boxes.items(), key=lambda item: (item[1].y, item[1].x)):
        is_touching = any(box.overlaps(other) for other in placed.values())
        placed[stack] = pushed_apart(box, placed.values()) if is_touching else box
    return placed


def in_columns(boxes: Mapping[str, Box]) -> dict[str, Box]:
    """Boxes in columns: those whose left edges are near each other are one column."""
    placed: dict[str, Box] = {}
    by_x = sorted(boxes, key=lambda stack: boxes[stack].x)
    right = min((box.x for box in boxes.values()), default=0.0)
    top = min((box.y for box in boxes.values()), default=0.0)
    for _, column in groupby(by_x, key=_column_numbers(boxes, by_x).__getitem__):
        x, y = right, top
        for stack in sorted(column, key=lambda stack: (boxes[stack].y, boxes[stack].x)):
            placed[stack] = boxes[stack]._replace(x=x, y=y)
            y += boxes[stack].height + GAP
            right = max(right, x + boxes[stack].width + GAP)
    return placed


def _column_numbers(boxes: Mapping[str, Box], by_x: list[str]) -> dict[str, int]:
    """A box begins a column when it begins right of the middle of the column's first box."""
    numbers: dict[str, int] = {}
    number, middle = -1, float("-inf")
    for stack in by_x:
        box = boxes[stack]
        if number < 0 or box.x > middle:
            number, middle = number + 1, box.x + max(box.width / 2, GAP)
        numbers[stack] = number
    return numbers


# Making way: a stack that grows pushes those away that it would cover.

NEAREST = 8.0
"""Stacks that come nearer to each other than this look as if they were joined."""

MOST_PUSHES = 500
"""So often stacks are pushed for one step at most."""


def make_way(before: Mapping[str, Box], now: Mapping[str, Box]) -> dict[str, Box]:
    """Where stacks go that those which have grown would newly cover, and in turn those push.

    ``before`` are the boxes of all stacks, ``now`` those that are others now. What was below goes
    down, what was beside goes aside; who covers another already stays there.
    """
    pushed: dict[str, Box] = {}
    boxes, waiting = {**before, **now}, list(now)
    for _ in range(MOST_PUSHES):
        if not waiting:
            break
        pusher = waiting.pop(0)
        old, new = before[pusher], boxes[pusher]
        for stack, box in list(boxes.items()):
            was = before[stack]
            if stack == pusher or not new.overlaps(box, NEAREST) or old.overlaps(was, NEAREST):
                continue
            if was.y >= old.y + old.height:
                box = box._replace(y=new.y + new.height + GAP)
            elif was.x >= old.x + old.width:
                box = box._replace(x=new.x + new.width + GAP)
            else:
                continue
            boxes[stack] = pushed[stack] = box
            waiting.append(stack)
    return pushed


# Picking up and dropping: what is in the way is moved aside, and nothing is lost.

# Whether blocks can land in a place, and which blocks they would push away there.


@dataclass(frozen=True, slots=True)
class Load:
    """Blocks that are about to land: their chain, and the edit that puts them into a place."""

    chain: Sequence[Block]
    edit: Callable[[Place], Edit]
    run: Run | None = None

    @property
    def ids(self) -> frozenset[str]:
        """The blocks that leave their place; none when they are new."""
        return frozenset(block.id for block in self.chain) if self.run else frozenset()


def load_of_run(project: Project, run: Run) -> Load:
    """The load that blocks of the project are."""
    chain = [project.blocks[block] for block in members(project, run)]
    return Load(chain, lambda place: MoveBlocks(run.first, run.count, place), run)


def why_not_land(editor: Editor, load: Load, place: Place, *, wrap: bool) -> Text | None:
    """Why blocks cannot land in a place, or None when they can."""
    if load.run is not None and is_within_run(editor.project, place, load.run):
        return Text("A block cannot be put inside itself.")
    if isinstance(place, InInput) and len(load.chain) > 1:
        return Text("Only one block goes into a slot.")
    below = blocks_below(editor.project, load, place)
    if below and (mouth(editor, load, wrap=wrap) or is_cut(editor, load, place)):
        # The same question when the blocks below go away, or into the mouth of the new block
        project, definitions = editor.project, editor.language.definitions
        moved = load.ids
        left = [block for block in chain_at(project, place) if block not in moved]
        over = project.blocks[left[-len(below) - 1]] if len(below) < len(left) else None
        first = definitions.get(load.chain[0].type)
        is_top = over is None and isinstance(place, InStack)
        reason = editor.why_not(load.edit(editor.new_stack(page_at(project, place), 0, 0)))
        reason = reason or why_not_chained(first, first_in_stack=is_top)
        if reason is None and over is not None:
            reason = why_not_below(definitions.get(over.type))
        if reason is None and mouth(editor, load, wrap=wrap):
            top = definitions.get(project.blocks[below[0]].type)
            reason = why_not_chained(top, first_in_stack=False)
        return reason
    return editor.why_not(load.edit(place))


def is_cut(editor: Editor, load: Load, place: Place) -> bool:
    """Whether the blocks below a place have to leave, as nothing goes below the last new block."""
    last = editor.language.definitions.get(load.chain[-1].type)
    return bool(blocks_below(editor.project, load, place)) and (
        last is not None and not last.is_value and last.is_last
    )


def mouth(editor: Editor, load: Load, *, wrap: bool) -> str:
    """The body that would take in the blocks below, or an empty text: of one C block, and empty."""
    definition = editor.language.definitions.get(load.chain[0].type)
    if not wrap or len(load.chain) > 1 or definition is None:
        return ""
    key = first_body(definition, load.chain[0])
    return "" if load.chain[0].bodies.get(key) else key


def first_body(definition: Definition, block: Block) -> str:
    """The first body of a block, or an empty text when it has none."""
    bodies = (key for key, slot in definition.keys(block.groups) if slot.kind.name == "body")
    return next(bodies, "")


def blocks_below(project: Project, load: Load, place: Place) -> list[str]:
    """The blocks that would be below the new ones in their chain."""
    moved = load.ids
    left = [block for block in chain_at(project, place) if block not in moved]
    return left[place.index :] if isinstance(place, InStack | InBody) else []


def page_at(project: Project, place: Place) -> str:
    """The page of a place."""
    if isinstance(place, NewStack):
        return place.page
    return project.page_of(place.stack if isinstance(place, InStack) else place.block)


Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Carried:
    """Blocks that have been picked up: several runs when a selection is carried."""

    runs: tuple[Run, ...]

    @property
    def first(self) -> str:
        """The block by which they are carried: the first of the first run."""
        return self.runs[0].first


def pick_up(
    project: Project, block: str, *, alone: bool = False, selected: Collection[str] = ()
) -> Carried:
    """What a person carries who takes hold of a block.

    The block with all below it; ``alone``, only the block (what is below moves up); when it is one
    of the blocks ``selected``, those.
    """
    if block in selected:
        return Carried(runs(project, selected))
    return Carried((Run(block, 1) if alone else run_from(project, block),))


def why_not_drop(
    editor: Editor, carried: Carried, place: Place, *, wrap: bool = False
) -> Text | None:
    """Why what is carried cannot be dropped into a place, or None when it can."""
    if len(carried.runs) > 1:
        return Text("Several stacks can be put onto a page only, not into one place.")
    if carried.first not in editor.project.blocks:
        return Text("This block is not there any more.")
    return why_not_land(editor, load_of_run(editor.project, carried.runs[0]), place, wrap=wrap)


def drop(
    editor: Editor,
    carried: Carried,
    place: Place,
    *,
    wrap: bool = False,
    beside: Point | None = None,
    at: Point | None = None,
) -> None:
    """Put one run into a place, as one step; raises EditRefused.

    A block already plugged in there is pushed out: into the only slot of the new block that takes
    it, else onto the page at ``beside``. When nothing goes below the last block, the blocks that
    would be below become a stack at ``beside``. With ``wrap``, a C block with an empty mouth takes
    the rest of the chain into it. ``at`` is where the stack lies then, when its top is new.
    """
    if (reason := why_not_drop(editor, carried, place, wrap=wrap)) is not None:
        raise EditRefused(reason)
    run = carried.runs[0]
    if place_of(editor.project, run.first, run.count) == place:
        return
    with editor.transaction("move blocks"):
        if isinstance(place, InInput):
            owner = editor.project.blocks[place.block]
            pushed = owner.inputs.get(place.slot)
            if pushed is not None:
                set_aside(editor, Run(pushed, 1), beside)
            editor.apply(MoveBlocks(run.first, 1, place))
            if pushed is not None and (slot := _only_slot_for(editor, pushed, run.first)):
                editor.apply(MoveBlocks(pushed, 1, InInput(run.first, slot)))
        else:
            _chain(editor, run, place, wrap, beside)
        if at is not None:
            editor.apply(MoveStack(editor.project.stack_of(run.first).id, *at))


def create_and_drop(
    editor: Editor,
    clip: Clip,
    place: Place,
    *,
    wrap: bool = False,
    beside: Point | None = None,
    at: Point | None = None,
) -> tuple[str, ...]:
    """Put the new blocks of a clip of one stack into a place, as one step; gives their ids.

    The place is made free as by ``drop``. ``clip_of`` makes a clip of a block of the palette.
    """
    if isinstance(place, NewStack):
        return paste_at(editor, clip, place)
    if (reason := why_not_create(editor, clip, place, wrap=wrap)) is not None:
        raise EditRefused(reason)
    with editor.transaction("add blocks"):
        page = page_at(editor.project, place)
        new = paste_at(editor, clip, editor.new_stack(page, 0, 0))
        carried = Carried((Run(new[0], len(new)),))
        drop(editor, carried, place, wrap=wrap, beside=beside, at=at)
    return new


def why_not_create(editor: Editor, clip: Clip, place: Place, *, wrap: bool = False) -> Text | None:
    """Why the new blocks of a clip cannot be put into a place, or None when they can."""
    if len(clip.stacks) != 1:
        return Text("Several stacks can be put onto a page only, not into one place.")
    roots = clip.roots[0]
    blocks = tuple(clip.project.within(roots))
    chain = [clip.project.blocks[root] for root in roots]
    load = Load(chain, lambda there: CreateBlocks(roots, blocks, there))
    return why_not_land(editor, load, place, wrap=wrap)


def move_by(
    editor: Editor, moved: Iterable[Run], dx: float, dy: float, at: Points = UNKNOWN
) -> None:
    """Move runs of blocks on their page, as one step.

    Whole stacks move; runs of blocks inside others come out and become stacks. ``at`` says where
    those lie now (by their first block).
    """
    project = editor.project
    with editor.transaction("move blocks"):
        for run in moved:
            stack = project.stack_of(run.first)
            if stack.body[0] == run.first and len(stack.body) == run.count:
                editor.apply(MoveStack(stack.id, stack.x + dx, stack.y + dy))
                continue
            x, y = at.get(run.first, (stack.x + STEP, stack.y + STEP))
            place = editor.new_stack(project.page_of(stack.id), x + dx, y + dy)
            editor.apply(MoveBlocks(run.first, run.count, place))


def set_aside(editor: Editor, run: Run, beside: Point | None = None) -> None:
    """Make a loose stack of a run, at ``beside`` or somewhat right of and below where it is."""
    stack = editor.project.stack_of(run.first)
    x, y = beside or (stack.x + 2 * STEP, stack.y + 2 * STEP)
    place = editor.new_stack(editor.project.page_of(stack.id), x, y)
    editor.apply(MoveBlocks(run.first, run.count, place))


def _only_slot_for(editor: Editor, block: str, owner: str) -> str:
    """The free slot of ``owner`` that takes a block, when there is exactly one."""
    taker = editor.project.blocks[owner]
    definition = editor.language.definitions.get(taker.type)
    if definition is None:
        return ""
    fitting = [
        key
        for key, slot in definition.keys(taker.groups)
        if slot.pluggable
        and key not in taker.inputs
        and editor.why_not(MoveBlocks(block, 1, InInput(owner, key))) is None
    ]
    return fitting[0] if len(fitting) == 1 else ""


def _chain(editor: Editor, run: Run, place: Place, wrap: bool, beside: Point | None) -> None:
    """Put a run into a chain; what cannot stay below goes into its mouth or onto the page."""
    project = editor.project
    load = load_of_run(project, run)
    below = blocks_below(project, load, place)
    body = mouth(editor, load, wrap=wrap) if below else ""
    if body or is_cut(editor, load, place):
        if project.parents[run.first] == project.parents[below[0]]:
            set_aside(editor, run)  # so that the blocks below follow each other
        stack = project.stack_of(below[0])
        page = project.page_of(stack.id)
        again = NewStack(page, stack.id, stack.x, stack.y, project.pages[page].index(stack))
        if body:
            editor.apply(MoveBlocks(below[0], len(below), InBody(run.first, body, 0)))
        else:
            set_aside(editor, Run(below[0], len(below)), beside)
        if isinstance(place, InStack) and stack.id not in project.stacks:
            place = again  # a stack that became empty by that has to be made anew
    editor.apply(MoveBlocks(run.first, run.count, place))


# Where a stack goes that was dropped very near to another one, without snapping to it.


def bumped(box: Box, others: Mapping[str, Box]) -> tuple[float, float] | None:
    """Where the stack in ``box`` has to move so that it is clear, or None when it is clear.

    ``others`` are the boxes of the other stacks of the page by stack.
    """
    if not any(box.overlaps(other) for other in others.values()):
        return None
    clear = pushed_apart(box, others.values())
    return clear.x, clear.y


# Put a C block that is there already around a run of blocks: exactly these go into its mouth.


def without_hat(editor: Editor, run: Run) -> Run | None:
    """The run without a hat at its beginning; None when nothing else is in it."""
    definition = editor.language.definitions.get(editor.project.blocks[run.first].type)
    if definition is None or definition.shape != "hat":
        return run
    return Run(members(editor.project, run)[1], run.count - 1) if run.count > 1 else None


def why_not_enclose(editor: Editor, block_type: str, run: Run) -> Text | None:
    """Why a C block of a type cannot go around a run of blocks, or None when it can."""
    chain = chain_around(editor.project, run.first)
    end = chain.index(run.first) + run.count
    if end > len(chain):
        return Text("These blocks do not follow each other any more.")
    return why_not_below(editor.language.definitions.get(block_type)) if end < len(chain) else None


def enclose(editor: Editor, block: str, run: Run) -> None:
    """Put a C block, which comes out of its place alone, around a run; raises EditRefused."""
    project = editor.project
    holder = project.blocks[block]
    body = first_body(editor.language.definitions[holder.type], holder)
    if not body or holder.bodies.get(body):
        raise EditRefused(
            "This block has no free place for blocks inside it.",
            checklist=("Take out what is inside it, or take another block.",),
        )
    with editor.transaction("put a block around"):
        if not isinstance(place_of(project, block, 1), NewStack):
            stack, page = project.stack_of(run.first), project.page_of(run.first)
            editor.apply(MoveBlocks(block, 1, editor.new_stack(page, stack.x, stack.y)))
        place = place_of(project, run.first, run.count)
        editor.apply(MoveBlocks(run.first, run.count, InBody(block, body, 0)))
        editor.apply(MoveBlocks(block, 1, place))


# The reporter that a person drags out of a block: of its variable, or of its parameter.


def reporter_of(project: Project, language: Language, block_id: str, slot: str) -> Clip | None:
    """A clip of the reporter for what is in a field of a block, or None when there is none.

    For a field of kind variable it gives the variable, for a parameter of an own block's header
    the parameter.
    """
    block = project.blocks[block_id]
    definition = language.definitions.get(block.type)
    there = definition.slot(slot, block.groups) if definition is not None else None
    if definition is None or there is None:
        return None
    if there.kind.name == "variable":
        variable = project.variable(str(definition.value(block, slot)))
        getters = (d.id for d in language.definitions.values() if d.generator == "variable")
        getter = next(getters, "")
        if variable is None or not getter:
            return None
        clip = clip_of(language, getter, variable=variable.id)
        clip.project.variables.append(variable)
        return clip
    if there.kind.name == "parameter" and there.table in language.definitions:
        clip = clip_of(language, there.table)
        AddProcedure(project.procedures[procedure_of(there.table)], 0).apply(clip.project)
        return clip
    return None

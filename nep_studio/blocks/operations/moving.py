"""Pick blocks up and drop them: what is in the way is moved aside, and nothing is lost."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from ..editor import Editor
from ..edits import MoveBlocks, MoveStack
from ..errors import EditRefused
from ..places import InBody, InInput, InStack, NewStack, Place, place_of
from ..program import Project
from .copying import STEP, UNKNOWN, Clip, Points
from .landing import Load, blocks_below, is_cut, load_of_clip, load_of_run, mouth, page_at
from .landing import why_not_land as _why_not_land
from .pasting import paste_at
from .selection import Run, require_runs, run_from, runs

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Carried:
    """Blocks that have been picked up: several runs when a selection is carried."""

    runs: tuple[Run, ...]

    @property
    def first(self) -> str:
        """The block by which they are carried: the first of the first run."""
        return self.runs[0].first

    @property
    def is_single(self) -> bool:
        """Whether it is one run, which can be dropped into any place."""
        return len(self.runs) == 1


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
) -> str | None:
    """Why what is carried cannot be dropped into a place, or None when it can."""
    if not carried.is_single:
        return "Several stacks can be put onto a page only, not into one place."
    if carried.first not in editor.project.blocks:
        return "This block is not there any more."
    return _why_not_land(editor, load_of_run(editor.project, carried.runs[0]), place, wrap=wrap)


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
            _plug(editor, run, place, beside)
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


def why_not_create(editor: Editor, clip: Clip, place: Place, *, wrap: bool = False) -> str | None:
    """Why the new blocks of a clip cannot be put into a place, or None when they can."""
    if len(clip.stacks) != 1:
        return "Several stacks can be put onto a page only, not into one place."
    return _why_not_land(editor, load_of_clip(clip), place, wrap=wrap)


def move_by(editor: Editor, ids: Iterable[str], dx: float, dy: float, at: Points = UNKNOWN) -> None:
    """Move selected blocks on their page, as one step.

    Whole stacks move; runs of blocks inside others come out and become stacks. ``at`` says where
    those lie now (by their first block).
    """
    project = editor.project
    with editor.transaction("move blocks"):
        for run in require_runs(project, ids):
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


def _plug(editor: Editor, run: Run, place: InInput, beside: Point | None) -> None:
    owner = editor.project.blocks[place.block]
    pushed = owner.inputs.get(place.slot)
    if pushed is not None:
        set_aside(editor, Run(pushed, 1), beside)
    editor.apply(MoveBlocks(run.first, 1, place))
    if pushed is not None and (slot := _only_slot_for(editor, pushed, run.first)):
        editor.apply(MoveBlocks(pushed, 1, InInput(run.first, slot)))


def _only_slot_for(editor: Editor, block: str, owner: str) -> str:
    """The free slot of ``owner`` that takes a block, when there is exactly one."""
    taker = editor.project.blocks[owner]
    definition = editor.language.definitions.get(taker.type)
    if definition is None:
        return ""
    fitting = [
        key
        for key, slot in definition.keys(taker.groups)
        if slot.kind.pluggable
        and key not in taker.inputs
        and editor.why_not(MoveBlocks(block, 1, InInput(owner, key))) is None
    ]
    return fitting[0] if len(fitting) == 1 else ""


def _chain(editor: Editor, run: Run, place: Place, wrap: bool, beside: Point | None) -> None:
    project = editor.project
    load = load_of_run(project, run)
    below = blocks_below(project, load, place)
    body = mouth(editor, load, wrap=wrap) if below else ""
    if body or is_cut(editor, load, place):
        place = _clear_below(editor, run, load, place, below, body, beside)
    editor.apply(MoveBlocks(run.first, run.count, place))


def _clear_below(
    editor: Editor,
    run: Run,
    load: Load,
    place: Place,
    below: list[str],
    body: str,
    beside: Point | None,
) -> Place:
    """Take away the blocks below a place, into the mouth ``body`` or onto the page.

    Gives the place again: a stack that became empty by that has to be made anew.
    """
    project = editor.project
    if project.parents[run.first] == project.parents[below[0]]:
        set_aside(editor, run)  # so that the blocks below follow each other
    rest = Run(below[0], len(below))
    stack = project.stack_of(below[0])
    page = project.page_of(stack.id)
    again = NewStack(page, stack.id, stack.x, stack.y, project.pages[page].index(stack))
    if body:
        editor.apply(MoveBlocks(rest.first, rest.count, InBody(run.first, body, 0)))
    else:
        set_aside(editor, rest, beside)
    return again if isinstance(place, InStack) and stack.id not in project.stacks else place

"""One page laid out: its stacks in their places, what is where, and what has changed."""

from __future__ import annotations

import gc
import time
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Changes, Project

from .boxes import Box, Chain, Measures, Piece
from .index import GridIndex, Rect
from .layout import Layout


@contextmanager
def paused_garbage_collection() -> Iterator[None]:
    """Search again afterwards; without this a third of a large layout's time is the search."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


# The stacks of a page as chains of boxes, each laid out when somebody first looks at it.

MOST_AT_ONCE = 600
"""A page with fewer blocks is laid out at once."""


class Stacks(Mapping[str, Chain]):
    """Chains by stack, and in ``index`` where they are.

    Of a stack that is not laid out yet the index has a rectangle that is large enough, but for
    blocks very deep inside each other; ``outgrown`` are the places of those that were larger.
    """

    def __init__(self, layout: Layout) -> None:
        self.index = GridIndex()
        self.outgrown: list[Rect] = []
        self._layout = layout
        self._chains: dict[str, Chain] = {}
        self.waiting: dict[str, None] = {}
        """Those that are not laid out yet."""

    def begin(self, stack_ids: Iterable[str]) -> None:
        """Forget all, and take these stacks."""
        self.index.clear()
        self._chains.clear()
        self.waiting.clear()
        counts = {stack: self._count(stack) for stack in stack_ids}
        if sum(counts.values()) <= MOST_AT_ONCE:
            for stack in counts:
                self.lay_out(stack)
            return
        for stack, count in counts.items():
            self._wait(stack, count)

    def __getitem__(self, stack_id: str) -> Chain:
        if stack_id in self.waiting:
            self.lay_out(stack_id)
        return self._chains[stack_id]

    def __iter__(self) -> Iterator[str]:
        return iter([*self._chains, *self.waiting])

    def __len__(self) -> int:
        return len(self._chains) + len(self.waiting)

    def __contains__(self, stack_id: object) -> bool:
        return stack_id in self._chains or stack_id in self.waiting

    def postpone(self, stack_id: str) -> None:
        """Lay a stack out anew when somebody next looks at it."""
        self.drop(stack_id)
        self._wait(stack_id, self._count(stack_id))

    def drop(self, stack_id: str) -> Chain | None:
        """Take a stack out; gives its chain when it was laid out."""
        self.waiting.pop(stack_id, None)
        self.index.remove(stack_id)
        return self._chains.pop(stack_id, None)

    def lay_out(self, stack_id: str) -> None:
        """Lay a stack out now; one whose blocks are all carried has no chain."""
        assumed = self.index.rects[stack_id] if stack_id in self.waiting else None
        self.drop(stack_id)
        stack = self._layout.project.stacks[stack_id]
        chain = self._layout.chain(stack.body, owner=stack_id)
        if not chain.boxes:
            return
        chain.x, chain.y = stack.x, stack.y
        self._chains[stack_id] = chain
        rect = bounds_of(chain, stack.x, stack.y, self._layout.measures.notch_depth)
        self.index.set(stack_id, rect)
        if assumed is not None and rect.united(assumed) != assumed:
            self.outgrown.append(rect)

    def lay_out_some(self, seconds: float) -> bool:
        """Lay out stacks that wait, for so long; whether others wait still."""
        end = time.perf_counter() + seconds
        with paused_garbage_collection():
            while self.waiting and time.perf_counter() < end:
                self.lay_out(next(iter(self.waiting)))
        return bool(self.waiting)

    def lay_out_all(self) -> None:
        """Lay out all stacks that wait."""
        self.lay_out_some(float("inf"))

    def _wait(self, stack_id: str, count: int) -> None:
        self.waiting[stack_id] = None
        # A rectangle that holds a stack, however its sentences are broken into rows
        stack, measures = self._layout.project.stacks[stack_id], self._layout.measures
        width = 2 * measures.widest
        left = stack.x - (width if measures.is_mirrored else 0.0)
        self.index.set(stack_id, Rect(left, stack.y, width, (count + 2) * 2 * measures.row_height))

    def _count(self, stack_id: str) -> int:
        """How many blocks a stack has."""
        project = self._layout.project
        blocks, waiting = project.blocks, list(project.stacks[stack_id].body)
        count = 0
        while waiting:
            block = blocks[waiting.pop()]
            count += 1
            if block.inputs or block.bodies:
                waiting.extend(block.children())
        return count


# What of a stack must be painted again: its old and its new layout are compared.

Pair = tuple[Chain, Chain, float, float]

_OF_OUTSIDE = (
    *("block", "type", "outline", "width", "segments"),
    *("is_mirrored", "is_disabled", "is_collapsed"),
)
"""What the whole of a block is painted from."""


def changed_rects(old: Chain, new: Chain, rest: float) -> list[Rect]:
    """The rectangles of the page in which two layouts of a stack differ.

    Boxes that have not changed are the same objects, so that the search goes down only where
    something has changed. ``rest`` is how far blocks reach over their lower side.
    """
    if (old.x, old.y, old.is_mirrored) != (new.x, new.y, new.is_mirrored):
        return [bounds_of(chain, chain.x, chain.y, rest) for chain in (old, new)]
    rects: list[Rect] = []
    waiting: list[Pair] = [(old, new, new.x, new.y)]
    while waiting:
        one, other, x, y = waiting.pop()
        if one.ys != other.ys:
            rects.append(_from_first_difference(one, other, x, y, rest))
            continue
        for before, after, top in zip(one.boxes, other.boxes, other.ys, strict=False):
            if before is not after:
                left = x - after.width if other.is_mirrored else x
                waiting += _mouths(before, after, left, y + top, rects)
    return rects


def _mouths(before: Box, after: Box, x: float, y: float, rects: list[Rect]) -> Iterator[Pair]:
    """The mouths to compare; what else differs of a block is added to the rectangles."""
    if any(getattr(before, name) != getattr(after, name) for name in _OF_OUTSIDE):
        reach = max(before.reach, after.reach)
        left = x + after.width - reach if after.is_mirrored else x
        rects.append(Rect(left, y, reach, max(before.height, after.height)))
        return
    if before.pieces != after.pieces or before.plugs != after.plugs:
        rects += _rows(after, x, y)
    for one, other in zip(before.mouths, after.mouths, strict=True):
        yield one, other, x + other.x, y + other.y


def _rows(box: Box, x: float, y: float) -> Iterator[Rect]:
    """The rows of a block, without its mouths."""
    for number, height in enumerate(box.segments):
        if number % 2 == 0:
            yield Rect(x, y, box.width, height)
        y += height


def _from_first_difference(old: Chain, new: Chain, x: float, y: float, rest: float) -> Rect:
    """From the first box that differs down to the end of the longer chain, and around it."""
    number = 0
    for before, after in zip(old.boxes, new.boxes, strict=False):
        if before is not after:
            break
        number += 1
    top = new.ys[min(number, len(new.ys) - 1)]
    whole = bounds_of(old, x, y, rest).united(bounds_of(new, x, y, rest))
    return Rect(whole.x, y + top, whole.width, whole.y + whole.height - y - top)


def bounds_of(chain: Chain, x: float, y: float, rest: float = 0.0) -> Rect:
    """The rectangle around a chain at a place, and ``rest`` below it."""
    left = x - chain.width if chain.is_mirrored else x
    return Rect(left, y, chain.width, chain.height + rest)


MOST_STACKS_AT_ONCE = 12
"""When a step changes more stacks, those out of view are laid out while nobody waits."""


@dataclass(frozen=True, slots=True)
class Placed:
    """A box with its top left corner on the page."""

    box: Box
    x: float
    y: float

    @property
    def rect(self) -> Rect:
        """The block itself, without what hangs in its mouths."""
        return Rect(self.x, self.y, self.box.width, self.box.height)


@dataclass(frozen=True, slots=True)
class Hit:
    """What is under a point: a block, and the field, socket or button of it, if there is one."""

    block: str
    placed: Placed
    piece: Piece | None = None


class PageLayout:
    """The stacks of the page that is shown."""

    def __init__(self, project: Project, language: Language, measures: Measures) -> None:
        self.project = project
        self.layout = Layout(project, language, measures)
        self.page = "behaviour"
        self.chains = Stacks(self.layout)
        self.index = self.chains.index
        """Where the stacks are; of those that are not laid out yet, roughly."""
        self._order: dict[str, int] = {}
        """The stacks of the page, each with its number: later ones lie over earlier ones."""
        self.show(self.page)

    def show(self, page: str) -> None:
        """Lay out the stacks of a page."""
        self.page = page
        stacks = self.project.pages.get(page, [])
        self._order = {stack.id: number for number, stack in enumerate(stacks)}
        with paused_garbage_collection():
            self.chains.begin(self._order)

    def refresh_all(self) -> None:
        """Lay everything out anew: the language, the font or the direction has changed."""
        self.layout.forget_all()
        self.show(self.page)

    def change(self, changes: Changes) -> list[Rect]:
        """Take in what a step changed; gives the places to paint again."""
        if changes.whole:
            old = self.bounds()
            self.refresh_all()
            return [rect for rect in (old, self.bounds()) if rect is not None]
        stacks = self.project.pages.get(self.page, [])
        self._order = {stack.id: number for number, stack in enumerate(stacks)}
        self.layout.forget(changes.owners)
        if len(changes.stacks) > MOST_STACKS_AT_ONCE:
            return self._postpone(changes.stacks)
        return self.update(changes.stacks)

    def update(self, stacks: set[str]) -> list[Rect]:
        """Lay these stacks out anew; gives the places to paint again."""
        rects: list[Rect] = []
        for stack_id in stacks:
            rect = self.index.rects.get(stack_id)
            old = self.chains.drop(stack_id)
            if stack_id in self._order:
                self.chains.lay_out(stack_id)
            new = self.chains.get(stack_id)
            if old is not None and new is not None:
                rects += changed_rects(old, new, self.layout.measures.notch_depth)
            elif rect is not None:
                rects.append(rect)
            elif new is not None:
                rects.append(self.index.rects[stack_id])
        return rects

    def _postpone(self, stacks: set[str]) -> list[Rect]:
        """Lay many changed stacks out when they are looked at; gives the place around them."""
        around: Rect | None = None
        for stack_id in stacks:
            rects = [self.index.rects[stack_id]] if stack_id in self.index.rects else []
            if stack_id in self._order:
                self.chains.postpone(stack_id)
                rects.append(self.index.rects[stack_id])
            else:
                self.chains.drop(stack_id)
            for rect in rects:
                around = rect.united(around) if around is not None else rect
        return [around] if around is not None else []

    def corners(self, ids: Iterable[str]) -> dict[str, tuple[float, float]]:
        """Where chains that begin with these blocks lie on the page."""
        corners = {}
        for block in ids:
            placed = self.placed(block)
            if placed is not None:
                right = placed.box.width if placed.box.is_mirrored else 0.0
                corners[block] = placed.x + right, placed.y
        return corners

    def near(self, rect: Rect) -> list[str]:
        """The stacks that touch a rectangle, all of them laid out, the one on top last."""
        near = list(self.index.near(rect))
        if waiting := [stack_id for stack_id in near if stack_id in self.chains.waiting]:
            with paused_garbage_collection():
                for stack_id in waiting:
                    self.chains.lay_out(stack_id)
            near = list(self.index.near(rect))
        return sorted(near, key=self._order.__getitem__)

    def bounds(self) -> Rect | None:
        """The rectangle around all stacks and notes, or None on an empty page.

        While stacks wait to be laid out it may be too large; ``chains.lay_out_all`` makes it exact.
        """
        bounds = self.index.bounds()
        for note in self.project.notes.values():
            if note.page == self.page:
                left = note.x - note.width if self.layout.measures.is_mirrored else note.x
                rect = Rect(left, note.y, note.width, note.height)
                bounds = bounds.united(rect) if bounds is not None else rect
        return bounds

    def boxes(self, rect: Rect) -> Iterator[Placed]:
        """The boxes that touch a rectangle, each before what is inside it."""
        for stack_id in self.near(rect):
            yield from boxes_of(self.chains[stack_id], rect)

    def placed(self, block_id: str) -> Placed | None:
        """Where a block is on the page; None when it is not on it, or inside a collapsed one."""
        path = [block_id]
        while path[-1] in self.project.parents:
            path.append(self.project.parents[path[-1]].owner)
        chain = self.chains.get(path.pop())
        if chain is None:
            return None
        found = _in_chain(chain, chain.x, chain.y, path.pop())
        while found is not None and path:
            found = _inside(found, path.pop())
        return found

    def hit(self, x: float, y: float) -> Hit | None:
        """What is under a point of the page; what lies on top is found first."""
        point = Rect(x, y, 0.0, 0.0)
        for stack_id in reversed(self.near(point)):
            found = None
            for placed in boxes_of(self.chains[stack_id], point):
                if placed.box.block and _covers(placed, x, y):
                    found = placed
            if found is not None:
                inner = (p for p in found.box.pieces if p.piece != "words")
                piece = next((p for p in inner if p.holds(x - found.x, y - found.y)), None)
                return Hit(found.box.block, found, piece)
        return None


def boxes_of(chain: Chain, rect: Rect) -> Iterator[Placed]:
    """The boxes of a chain (whose x and y are on the page) that touch a rectangle."""
    waiting: list[tuple[Chain | Box, float, float]] = [(chain, chain.x, chain.y)]
    while waiting:
        item, x, y = waiting.pop()
        if isinstance(item, Chain):
            waiting += reversed(list(boxes_touching(item, x, y, rect)))
            continue
        yield Placed(item, x, y)
        for mouth in reversed(item.mouths):
            waiting.append((mouth, x + mouth.x, y + mouth.y))
        for plug in reversed(item.plugs):
            waiting.append((plug.box, x + plug.x, y + plug.y))


def boxes_touching(
    chain: Chain, x: float, y: float, rect: Rect
) -> Iterator[tuple[Box, float, float]]:
    """The boxes of a chain at (x, y) that a rectangle touches by its height, with their corners."""
    bottom = rect.y + rect.height
    if not chain.boxes or y > bottom or y + chain.height < rect.y - 20:
        return
    first, count = bisect_right(chain.ys, rect.y - 20 - y), len(chain.boxes)
    end = min(bisect_right(chain.ys, bottom - y), count)
    for number in range(max(min(first, count) - 1, 0), end):
        box = chain.boxes[number]
        left = x - box.width if chain.is_mirrored else x
        yield box, left, y + chain.ys[number]


def _in_chain(chain: Chain, x: float, y: float, block_id: str) -> Placed | None:
    for box, top in zip(chain.boxes, chain.ys, strict=False):
        if box.block == block_id:
            return Placed(box, x - box.width if chain.is_mirrored else x, y + top)
    return None


def _inside(placed: Placed, block_id: str) -> Placed | None:
    """A block directly inside a placed one."""
    for plug in placed.box.plugs:
        if plug.box.block == block_id:
            return Placed(plug.box, placed.x + plug.x, placed.y + plug.y)
    for mouth in placed.box.mouths:
        found = _in_chain(mouth, placed.x + mouth.x, placed.y + mouth.y, block_id)
        if found is not None:
            return found
    return None


def _covers(placed: Placed, x: float, y: float) -> bool:
    """Whether a point is on a block itself: in its rectangle, but not in its mouths."""
    if not placed.rect.holds(x, y):
        return False
    box, left, top = placed.box, x - placed.x, y - placed.y
    for mouth in box.mouths:
        height = max(mouth.height, box.segments[2 * box.mouths.index(mouth) + 1])
        beside = left < mouth.x if box.is_mirrored else left > mouth.x
        if beside and mouth.y <= top <= mouth.y + height:
            return False
    return True

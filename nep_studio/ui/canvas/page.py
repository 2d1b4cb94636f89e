"""One page laid out: its stacks in their places, what is where, and what has changed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Changes, Project

from .boxes import Box, Chain, Piece
from .garbage import paused_garbage_collection
from .index import GridIndex, Rect
from .layout import Gap, Layout
from .measures import Measures
from .repairs import changed_rects
from .stacks import Stacks

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
        self._order: dict[str, int] = {}
        self.show(self.page)

    def show(self, page: str) -> None:
        """Lay out the stacks of a page."""
        self.page = page
        self._order = self._new_order()
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
        self.layout.forget(changes.owners)
        if len(changes.stacks) > MOST_STACKS_AT_ONCE:
            return self._postpone(changes.stacks)
        return self._update(changes.stacks)

    def preview(self, hidden: frozenset[str], gap: Gap | None) -> list[Rect]:
        """Take blocks out and open a gap, for the eye only; gives the places to paint again."""
        return self._update(self.layout.preview(hidden, gap))

    def _update(self, stacks: set[str]) -> list[Rect]:
        here = self._order = self._new_order()
        rects: list[Rect] = []
        for stack_id in stacks:
            rect = self.index.rect(stack_id) if stack_id in self.index else None
            old = self.chains.drop(stack_id)
            if stack_id in here:
                self.chains.lay_out(stack_id)
            new = self.chains.get(stack_id)
            if old is not None and new is not None:
                rects += changed_rects(old, new, self.layout.measures.notch_depth)
            elif rect is not None:
                rects.append(rect)
            elif new is not None:
                rects.append(self.index.rect(stack_id))
        return rects

    def _postpone(self, stacks: set[str]) -> list[Rect]:
        """Lay many changed stacks out when they are looked at; gives the place around them."""
        here = self._order = self._new_order()
        around: Rect | None = None
        for stack_id in stacks:
            rects = [self.index.rect(stack_id)] if stack_id in self.index else []
            if stack_id in here:
                self.chains.postpone(stack_id)
                rects.append(self.index.rect(stack_id))
            else:
                self.chains.drop(stack_id)
            for rect in rects:
                around = rect.united(around) if around is not None else rect
        return [around] if around is not None else []

    def _new_order(self) -> dict[str, int]:
        """The stacks of the page, each with its number: later ones lie over earlier ones."""
        stacks = self.project.pages.get(self.page, [])
        return {stack.id: number for number, stack in enumerate(stacks)}

    def near(self, rect: Rect) -> list[str]:
        """The stacks that touch a rectangle, the one on top last."""
        return sorted(self.chains.near(rect), key=self._order.__getitem__)

    @property
    def index(self) -> GridIndex:
        """Where the stacks are; of those that are not laid out yet, roughly."""
        return self.chains.index

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
    if not chain.boxes or y > rect.bottom or y + chain.height < rect.y - 20:
        return
    first, last = chain.index_at(rect.y - 20 - y), chain.index_at(rect.bottom - y)
    for number in range(first, last + 1):
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
        height = max(mouth.height, _mouth_height(box, mouth))
        beside = left < mouth.x if box.is_mirrored else left > mouth.x
        if beside and mouth.y <= top <= mouth.y + height:
            return False
    return True


def _mouth_height(box: Box, mouth: Chain) -> float:
    return box.segments[2 * box.mouths.index(mouth) + 1]

"""Where carried blocks would go: the seam or slot that is nearest to where they are held."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from math import hypot
from typing import Literal

from faults import Text
from nep_studio.blocks.operations.selection import Run
from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.ui.canvas.layout.boxes import Box, Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import PageLayout, Placed, boxes_of

RADIUS_PX = 48.0
"""How near to a place blocks must be held to snap to it, in pixels of the view: a child's reach."""

PREFERENCE_PX = 8.0
"""How much nearer another place must be to take over from the one that is shown.

Zoomed out it shrinks with the blocks, which are hardly higher than this then.
"""

INNER_DISTANCE = 2.0
"""How much farther than the output the inside of a reporter counts; with the output one aims."""

Point = tuple[float, float]
Join = Literal["below", "above", "around", "input"]
WhyNot = Callable[["Target"], Text | None]


@dataclass(frozen=True, slots=True)
class Ends:
    """Where carried blocks can be joined to others: points of the page, None where they cannot.

    ``top`` goes below another block, ``bottom`` onto the head of a stack, ``mouth`` (an empty one)
    around blocks, ``output`` into a slot; ``inner`` is the middle of what is seen behind the
    output, which may be held over the slot instead.
    """

    top: Point | None = None
    bottom: Point | None = None
    mouth: Point | None = None
    output: Point | None = None
    inner: Point | None = None

    def moved(self, dx: float, dy: float) -> Ends:
        """The same ends elsewhere on the page."""
        points = (self.top, self.bottom, self.mouth, self.output, self.inner)
        return Ends(*(point and (point[0] + dx, point[1] + dy) for point in points))


@dataclass(frozen=True, slots=True)
class Target:
    """A place to drop blocks into, and the point of the page that it is at.

    ``around`` takes what is below into the mouth of the dropped block: ``run``, or all the rest of
    the chain when there is none.
    """

    place: Place
    join: Join
    x: float
    y: float
    run: Run | None = None

    @property
    def is_around(self) -> bool:
        """Whether blocks go into the mouth of the dropped one."""
        return self.join == "around"

    def is_same(self, other: Target | None) -> bool:
        """Whether both are one place, wherever it is drawn."""
        return other is not None and (self.place, self.join) == (other.place, other.join)


@dataclass(frozen=True, slots=True)
class Snap:
    """What a search found: a place that fits, or why the nearest one does not."""

    target: Target | None = None
    reason: Text | None = None


@dataclass(frozen=True, slots=True)
class Seam:
    """A point between two blocks of a chain, or at one of its ends; ``below`` is what follows."""

    owner: str
    slot: str
    index: int
    x: float
    y: float
    below: str

    @property
    def is_head(self) -> bool:
        """Whether it is the top of a stack."""
        return not self.slot and self.index == 0

    @property
    def place(self) -> Place:
        """Where blocks would go that are put here."""
        if self.slot:
            return InBody(self.owner, self.slot, self.index)
        return InStack(self.owner, self.index)


class Ground:
    """The page under carried blocks, as it is without the gap that is shown.

    The gap moves blocks aside; searched as they are drawn, they would run away from the pointer.
    """

    def __init__(self, page: PageLayout) -> None:
        self._page = page
        self._plain: dict[str, Chain] = {}

    def remember(self, stack_id: str) -> None:
        """Keep a stack as it is now, before a gap opens in it."""
        if stack_id in self._page.chains:
            self._plain.setdefault(stack_id, self._page.chains[stack_id])

    def near(self, around: Rect) -> Iterator[tuple[str, Chain]]:
        """The stacks that touch a rectangle of the page."""
        for stack_id in self._page.index.near(around):
            yield stack_id, self._plain.get(stack_id) or self._page.chains[stack_id]


def ends_of(chain: Chain) -> Ends:
    """The ends of a chain of blocks whose x and y are on the page."""
    first, last = chain.boxes[0], chain.boxes[-1]
    if first.outline not in ("statement", "hat", "cap"):
        middle = chain.y + first.height / 2
        inside = min(first.width, 2 * first.height) / 2
        inner = chain.x + (-inside if chain.is_mirrored else inside)
        return Ends(output=(chain.x, middle), inner=(inner, middle))
    return Ends(
        top=(chain.x, chain.y) if first.outline != "hat" else None,
        bottom=(chain.x, chain.y + chain.height) if last.outline != "cap" else None,
        mouth=_empty_mouth(chain),
    )


def search(
    ground: Ground,
    ends: Ends,
    why_not: WhyNot,
    *,
    scale: float = 1.0,
    current: Target | None = None,
    run: Run | None = None,
) -> Snap:
    """The nearest place that takes the carried blocks; ``run`` are selected blocks to go around."""
    radius, preference = RADIUS_PX / scale, PREFERENCE_PX / max(scale, 1.0)
    found: list[tuple[float, int, Target]] = []
    for target, distance in targets(ground, ends, radius + preference, run):
        is_input, number = target.join == "input", len(found)
        if target.is_same(current):
            distance -= preference if not is_input else min(preference, distance)
        if distance <= radius:  # over a slot inside another, the inner one counts: it comes later
            found.append((distance, -number if is_input else number, target))
    found.sort(key=lambda each: each[:2])
    return _first_that_fits((target for _, _, target in found), why_not)


def targets(
    ground: Ground, ends: Ends, radius: float, run: Run | None = None
) -> Iterator[tuple[Target, float]]:
    """All places within a distance of the ends, fitting or not, each with how far it is."""
    if ends.output is not None:
        yield from _near_slots(ground, ends, radius)
    if ends.top is not None:
        for seam, distance in _near_seams(ground, ends.top, radius):
            if run is not None and ends.mouth is not None and seam.below == run.first:
                yield Target(seam.place, "around", seam.x, seam.y, run), distance
            elif not seam.is_head:
                yield Target(seam.place, "below", seam.x, seam.y), distance
    if ends.mouth is not None:
        for seam, distance in _near_seams(ground, ends.mouth, radius):
            if seam.below:
                inner = run if run is not None and seam.below == run.first else None
                yield Target(seam.place, "around", seam.x, seam.y, inner), distance
    if ends.bottom is not None:
        for stack_id, chain in ground.near(_around(ends.bottom, radius)):
            distance = _distance(ends.bottom, chain.x, chain.y)
            if distance <= radius:
                yield Target(InStack(stack_id, 0), "above", chain.x, chain.y), distance


def seams(stack_id: str, chain: Chain, low: float, high: float) -> Iterator[Seam]:
    """The seams of a stack, those of mouths too, between two heights of the page."""
    waiting = [(stack_id, chain, chain.x, chain.y)]
    while waiting:
        owner, inner, x, y = waiting.pop()
        ys = inner.ys
        for index in range(bisect_left(ys, low - y), bisect_right(ys, high - y)):
            below = inner.boxes[index].block if index < len(inner.boxes) else ""
            yield Seam(owner, inner.key, index, x, y + ys[index], below)
        first, last = bisect_right(ys, low - y) - 1, bisect_right(ys, high - y)
        for index in range(max(0, first), min(last, len(inner.boxes))):
            box = inner.boxes[index]
            left = x - box.width if inner.is_mirrored else x
            for mouth in box.mouths:
                waiting.append((box.block, mouth, left + mouth.x, y + ys[index] + mouth.y))


def slots(placed: Placed) -> Iterator[tuple[str, Rect]]:
    """The fields, sockets and plugged blocks of a placed block, by key."""
    for piece in placed.box.pieces:
        if piece.piece in ("field", "socket"):
            yield piece.key, Rect(placed.x + piece.x, placed.y + piece.y, piece.width, piece.height)
    for plug in placed.box.plugs:
        size = plug.box.width, plug.box.height
        yield plug.key, Rect(placed.x + plug.x, placed.y + plug.y, *size)


def _near_seams(ground: Ground, point: Point, radius: float) -> Iterator[tuple[Seam, float]]:
    for stack_id, chain in ground.near(_around(point, radius)):
        for seam in seams(stack_id, chain, point[1] - radius, point[1] + radius):
            distance = _distance(point, seam.x, seam.y)
            if distance <= radius:
                yield seam, distance


def _near_slots(ground: Ground, ends: Ends, radius: float) -> Iterator[tuple[Target, float]]:
    """The slots that carried blocks are held over (wherever over them), or beside."""
    points = [
        (point, more)
        for point, more in ((ends.output, 0.0), (ends.inner, INNER_DISTANCE))
        if point is not None
    ]
    around = _around(points[0][0], radius).united(_around(points[-1][0], radius))
    for _, chain in ground.near(around):
        for placed in boxes_of(chain, around):
            for key, rect in slots(placed):
                distance = min(rect.distance(*point) + more for point, more in points)
                if distance <= radius:
                    x = rect.right if placed.box.is_mirrored else rect.x
                    place, y = InInput(placed.box.block, key), rect.y + rect.height / 2
                    yield Target(place, "input", x, y), distance


def _first_that_fits(found: Iterable[Target], why_not: WhyNot) -> Snap:
    """The first target that fits, or else the reason against the first of all."""
    first_reason = None
    for target in found:
        reason = why_not(target)
        if reason is None:
            return Snap(target)
        first_reason = first_reason or reason
    return Snap(None, first_reason)


def _empty_mouth(chain: Chain) -> Point | None:
    """Where the first mouth of a single C block is, if nothing is in it."""
    box: Box = chain.boxes[0]
    if len(chain.boxes) > 1 or not box.mouths or box.mouths[0].boxes or box.outline == "hat":
        return None
    mouth = box.mouths[0]
    left = chain.x - box.width if chain.is_mirrored else chain.x
    return left + mouth.x, chain.y + mouth.y


def _around(point: Point, radius: float) -> Rect:
    return Rect(point[0] - radius, point[1] - radius, 2 * radius, 2 * radius)


def _distance(point: Point, x: float, y: float) -> float:
    return hypot(point[0] - x, point[1] - y)

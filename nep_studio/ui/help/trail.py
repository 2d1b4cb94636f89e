"""The pages that were read, to go back and forth between."""

from __future__ import annotations

from dataclasses import dataclass, field

MOST_STEPS = 200


@dataclass
class Step:
    """A page, and how far it was scrolled."""

    page: str
    place: int = 0


@dataclass
class Trail:
    """Where a reader has been, and where they are among that."""

    _steps: list[Step] = field(default_factory=list)
    _at: int = -1

    @property
    def current(self) -> str:
        """The page that is read; empty when none is."""
        return self._steps[self._at].page if self._at >= 0 else ""

    @property
    def place(self) -> int:
        """How far it was scrolled when it was left."""
        return self._steps[self._at].place if self._at >= 0 else 0

    @property
    def can_go_back(self) -> bool:
        """Whether there is a page before."""
        return self._at > 0

    @property
    def can_go_forward(self) -> bool:
        """Whether there is a page after."""
        return self._at < len(self._steps) - 1

    def leave(self, place: int) -> None:
        """Note how far the page is scrolled."""
        if self._at >= 0:
            self._steps[self._at].place = place

    def go(self, page: str) -> None:
        """Read another page; what was gone back from is forgotten."""
        if page == self.current:
            return
        del self._steps[self._at + 1 :]
        self._steps.append(Step(page))
        del self._steps[:-MOST_STEPS]
        self._at = len(self._steps) - 1

    def back(self, place: int) -> bool:
        """Go to the page before; False when there is none."""
        return self._move(-1, place)

    def forward(self, place: int) -> bool:
        """Go to the page after; False when there is none."""
        return self._move(1, place)

    def _move(self, way: int, place: int) -> bool:
        self.leave(place)
        if not 0 <= self._at + way < len(self._steps):
            return False
        self._at += way
        return True

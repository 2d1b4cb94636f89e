"""A finger that rests opens the menu of what is under it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .gesture import Pointer

if TYPE_CHECKING:
    from ..canvas import Canvas

LONG_PRESS_MS = 500
"""How long a finger rests until it means the menu."""


class LongPress:
    """The menu is open; lifting the finger means nothing more."""

    def __init__(self, canvas: Canvas, pointer: Pointer) -> None:
        canvas.request_menu(pointer.view.toPoint())

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """The menu stays where it is."""

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """The menu stays open."""

    def cancel(self, canvas: Canvas) -> None:
        """The menu closes by itself."""

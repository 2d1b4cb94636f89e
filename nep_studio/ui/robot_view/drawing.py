"""Which way of painting bodies is used: QPainter's, or OpenGL's where there is a GPU."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING, Literal, Protocol

from PySide6.QtGui import QImage

from .bodies import Dress
from .camera import Lens
from .figure import Placed
from .shading import Shades

if TYPE_CHECKING:
    from .gl_context import GlContext

log = logging.getLogger(__name__)

Drawing = Literal["auto", "painter", "opengl"]
"""``auto`` is OpenGL where there is a GPU; ``opengl`` is also one that only pretends to be one."""
Group = tuple[Placed, Dress]


class NoContext(Exception):
    """There is no OpenGL here that can be used; the text says why."""


class OnGpu(Protocol):
    """Paints bodies with a GPU."""

    @property
    def renderer(self) -> str:
        """What paints, in the words of the driver."""

    def picture(self, groups: Sequence[Group], lens: Lens, shades: Shades) -> QImage:
        """The bodies on nothing. Raises NoContext when the GPU is gone or too small."""


def gl_bodies(drawing: Drawing) -> OnGpu | None:
    """What paints with OpenGL, the same for all views; None to paint with QPainter."""
    if drawing == "painter":
        return None
    try:
        is_wanted = drawing == "opengl" or _context().is_fast
        return _bodies() if is_wanted else None
    except NoContext as error:
        log.info("Robots are painted without OpenGL: %s", error)
        return None


@cache
def _context() -> GlContext:
    try:
        from .gl_context import GlContext  # Qt's part for it needs libraries of the system
    except ImportError as error:
        raise NoContext(str(error)) from error
    return GlContext.made()


@cache
def _bodies() -> OnGpu:
    context = _context()
    from .gl_bodies import GlBodies

    return GlBodies(context)

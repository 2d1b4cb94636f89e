"""Which way of painting bodies is used: QPainter's, or OpenGL's where there is a GPU."""

from __future__ import annotations

import logging
from functools import cache
from typing import TYPE_CHECKING, Literal

from .bodies import Dress
from .figure import Placed

if TYPE_CHECKING:
    from .gl_bodies import GlBodies

log = logging.getLogger(__name__)

Drawing = Literal["auto", "painter", "opengl"]
"""``auto`` is OpenGL where there is a GPU; ``opengl`` is also one that only pretends to be one."""
Group = tuple[Placed, Dress]


class NoContext(Exception):
    """There is no OpenGL here that can be used; the text says why."""


def gl_bodies(drawing: Drawing) -> GlBodies | None:
    """What paints with OpenGL, the same for all views; None to paint with QPainter."""
    if drawing == "painter":
        return None
    try:
        from .gl_context import GlContext  # Qt's part for it needs libraries of the system

        is_wanted = drawing == "opengl" or GlContext.made().is_fast
        return _bodies() if is_wanted else None
    except (ImportError, NoContext) as error:
        log.info("Robots are painted without OpenGL: %s", error)
        return None


@cache
def _bodies() -> GlBodies:
    from .gl_bodies import GlBodies
    from .gl_context import GlContext

    return GlBodies(GlContext.made())

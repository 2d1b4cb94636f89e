"""Paints placed parts with OpenGL into a picture that is laid over the floor."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QSize
from PySide6.QtGui import QImage
from PySide6.QtOpenGL import QOpenGLFramebufferObject

from .camera import Lens
from .drawing import Group, NoContext
from .gl_buffers import STRIP, TRIANGLES, GpuRows, OnGpu
from .gl_context import GlContext, program
from .gl_meshes import mesh_of
from .gl_shaders import BODY_FRAGMENT, BODY_VERTEX, GLOW_FRAGMENT, GLOW_VERTEX, MOST_PARTS
from .gl_values import glows_of, rows_of, tell_lens
from .shading import Shades
from .shapes import Solids

MOST_MESHES = 100
"""So many kinds of robots and sizes of things are kept."""
COLOUR_AND_DEPTH = 0x4000 | 0x0100
DEPTH_TEST, BLEND, LEQUAL = 0x0B71, 0x0BE2, 0x0203
ONE, ONE_MINUS_SRC_ALPHA = 1, 0x0303


class GlBodies:
    """Paints bodies with a context; made once, used for every frame."""

    def __init__(self, context: GlContext) -> None:
        self._gl = context
        context.use()
        self._calls = context.context.extraFunctions()
        self._body = program(BODY_VERTEX, BODY_FRAGMENT)
        self._glow = program(GLOW_VERTEX, GLOW_FRAGMENT)
        self._meshes: dict[int, tuple[Solids, OnGpu]] = {}
        self._glow_sheet = OnGpu((3, 2, 3))
        self._sheet: QOpenGLFramebufferObject | None = None
        self._rows = GpuRows(self._calls)

    @property
    def renderer(self) -> str:
        """What paints, in the words of the driver."""
        return self._gl.renderer

    def picture(self, groups: Sequence[Group], lens: Lens, shades: Shades) -> QImage:
        """The bodies on nothing. Raises NoContext when the GPU is gone or too small."""
        self._gl.use()
        size = QSize(math.ceil(lens.width * lens.ratio), math.ceil(lens.height * lens.ratio))
        if self._sheet is None or self._sheet.size() != size:
            self._sheet = self._gl.sheet(size)
        self._sheet.bind()
        self._calls.glViewport(0, 0, size.width(), size.height())
        self._calls.glClearColor(0.0, 0.0, 0.0, 0.0)
        self._calls.glClear(COLOUR_AND_DEPTH)
        self._calls.glEnable(DEPTH_TEST)
        self._calls.glDepthFunc(LEQUAL)
        self._calls.glDisable(BLEND)
        self._paint_bodies(groups, lens, shades)
        self._paint_glows(groups, lens)
        image = self._sheet.toImage()
        self._sheet.release()
        self._gl.leave()
        image.setDevicePixelRatio(lens.ratio)
        return image

    def _paint_bodies(self, groups: Sequence[Group], lens: Lens, shades: Shades) -> None:
        self._body.bind()
        tell_lens(self._body, lens)
        for placed, dress in groups:
            if len(placed.parts) > MOST_PARTS:
                raise NoContext(f"a robot of {len(placed.parts)} parts is too much for it")
            self._rows.fill(rows_of(placed, dress, lens, shades))
            self._mesh(placed.solids).draw(self._calls, self._body, STRIP)
        self._body.release()

    def _mesh(self, solids: Solids) -> OnGpu:
        known = self._meshes.get(id(solids))
        if known is None:
            if len(self._meshes) >= MOST_MESHES:
                self._meshes.clear()
            made = OnGpu((3, 3, 1))
            made.fill(mesh_of(solids))
            known = self._meshes[id(solids)] = (solids, made)
        return known[1]

    def _paint_glows(self, groups: Sequence[Group], lens: Lens) -> None:
        corners = [glows_of(placed, dress, lens) for placed, dress in groups]
        vertices = np.concatenate([np.zeros((0, 8)), *corners]).astype(np.float32)
        if not len(vertices):
            return
        self._calls.glEnable(BLEND)
        self._calls.glDepthMask(0)
        self._calls.glBlendFunc(ONE, ONE_MINUS_SRC_ALPHA)
        self._glow.bind()
        tell_lens(self._glow, lens)
        self._glow_sheet.fill(vertices)
        self._glow_sheet.draw(self._calls, self._glow, TRIANGLES)
        self._glow.release()
        self._calls.glDepthMask(1)
        self._calls.glDisable(BLEND)

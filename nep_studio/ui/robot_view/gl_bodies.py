"""Paints placed parts with OpenGL into a picture that is laid over the floor."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QImage, QMatrix3x3, QMatrix4x4, QOpenGLExtraFunctions, QVector3D
from PySide6.QtOpenGL import (
    QOpenGLBuffer,
    QOpenGLFramebufferObject,
    QOpenGLShaderProgram,
    QOpenGLVertexArrayObject,
)

from nep_studio.ui.theme.colours import mixed

from .bodies import GLOW_GROWTH, Dress
from .camera import Lens
from .drawing import Group, NoContext
from .figure import Placed
from .gl_context import (
    BODY_FRAGMENT,
    BODY_VERTEX,
    GLOW_FRAGMENT,
    GLOW_VERTEX,
    MOST_PARTS,
    ROWS,
    GlContext,
    program,
)
from .parts import Solids
from .shading import Shades

# What the bodies need in the memory of a GPU: triangles, and the places and colours of parts.

FLOAT, TRIANGLES, STRIP = 0x1406, 0x0004, 0x0005
UNIFORM_BUFFER = 0x8A11
BYTES = 4
"""Of a float32."""


class OnGpu:
    """Vertices, of values as wide as ``widths`` says."""

    def __init__(self, widths: tuple[int, ...]) -> None:
        self._widths = widths
        self._state = QOpenGLVertexArrayObject()
        self._vertices = QOpenGLBuffer(QOpenGLBuffer.Type.VertexBuffer)
        self._count = 0
        self._state.create()
        self._vertices.create()

    def fill(self, vertices: NDArray[np.float32]) -> None:
        """Put vertices (n, all widths) into the memory of the GPU."""
        _put(self._vertices, vertices.tobytes())
        self._count = len(vertices)

    def draw(self, calls: QOpenGLExtraFunctions, program: QOpenGLShaderProgram, how: int) -> None:
        """Paint the vertices as triangles, or a strip of them, with a program that is in use."""
        self._state.bind()
        self._vertices.bind()
        stride, start = BYTES * sum(self._widths), 0
        for number, width in enumerate(self._widths):
            program.enableAttributeArray(number)
            program.setAttributeBuffer(number, FLOAT, start, width, stride)
            start += BYTES * width
        calls.glDrawArrays(how, 0, self._count)
        self._state.release()


class GpuRows:
    """The only uniform block of a program, which says where parts are and how they look.

    It is found at 0, as OpenGL counts what nobody has numbered.
    """

    def __init__(self, calls: QOpenGLExtraFunctions) -> None:
        self._calls = calls
        # To the GPU a buffer is a buffer: Qt knows no other kind for uniform blocks.
        self._buffer = QOpenGLBuffer(QOpenGLBuffer.Type.VertexBuffer)
        self._buffer.create()

    def fill(self, rows: NDArray[np.float32]) -> None:
        """Use these rows from now on."""
        _put(self._buffer, rows.tobytes())
        self._calls.glBindBufferBase(UNIFORM_BUFFER, 0, self._buffer.bufferId())


def _put(buffer: QOpenGLBuffer, data: bytes) -> None:
    buffer.bind()
    buffer.allocate(data, len(data))


# Triangles of parts for a GPU: the farthest points in directions all around, as vertices.

Array = NDArray[np.float64]
FINENESS = ((0.0, 5, 10), (0.008, 6, 14), (0.016, 9, 20), (0.034, 14, 30))
"""From which half length on (m) parts have how many rings and corners."""


def mesh_of(solids: Solids) -> NDArray[np.float32]:
    """One strip of triangles (n, 7) for all parts: place, normal, and the number of the part.

    Places and normals are along the axes of the part. Normals are exact, as each vertex is the
    farthest along one. Triangles that lead from one ring to the next, or to the next part, have no
    area.
    """
    classes = np.digitize(solids.extent.max(axis=1), [size for size, _, _ in FINENESS]) - 1
    vertices = []
    for one, (_, rings, corners) in enumerate(FINENESS):
        ways = _strip(rings, corners)
        places = solids.farthest(np.broadcast_to(ways, (len(classes), *ways.shape)))
        for number in np.flatnonzero(classes == one).tolist():
            numbers = np.full((len(ways), 1), number)
            rows = np.concatenate([places[number], ways, numbers], axis=1)
            vertices.append(np.concatenate([rows[:1], rows, rows[-1:]]))
    return np.concatenate(vertices).astype(np.float32)


def _strip(rings: int, corners: int) -> Array:
    """Directions all around (n, 3) in the order of one strip, ring after ring."""
    tilts = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    turns = np.linspace(0, 2 * math.pi, corners + 1)
    tilt, turn = np.meshgrid(tilts, turns, indexing="ij")
    ways = np.stack([np.cos(tilt) * np.cos(turn), np.cos(tilt) * np.sin(turn), np.sin(tilt)], 2)
    # Flat shapes turn what is nearly nothing into something: let it be nothing.
    ways = ways.round(9)
    zigzag = np.stack([ways[:-1], ways[1:]], axis=2).reshape(rings, -1, 3)
    return np.concatenate([zigzag[:, :1], zigzag, zigzag[:, -1:]], axis=1).reshape(-1, 3)


# Places, colours and lights of parts as the numbers that the programs of the GPU read.

NEAR_M, FAR_M = 0.05, 40.0
LIFT_M, LAYER_M, GLOW_LIFT_M = 0.008, 0.00025, 0.028
"""How much nearer parts that lie on others count, those over them, and the glow of lights."""
HIDDEN = -1.0
STRENGTHS = {"satin": 1.0, "matte": 0.4, "flat": 0.0}
PALE_STRENGTH = 0.35
SQUARE = ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1))


def tell_lens(program: QOpenGLShaderProgram, lens: Lens) -> None:
    """Tell a program that is in use where the eye is and what it sees."""
    axes = lens.camera.axes * ((1.0,), (1.0,), (-1.0,))
    program.setUniformValue(program.uniformLocation("lens"), QMatrix4x4(*_matrix(lens)))
    place = program.uniformLocation("axes")
    if place >= 0:
        program.setUniformValue(place, QMatrix3x3(axes.ravel().tolist()))
        program.setUniformValue(program.uniformLocation("eye"), QVector3D(*lens.eye.tolist()))


def _matrix(lens: Lens) -> list[float]:
    """From the room to what OpenGL clips, (4, 4) row by row."""
    view = np.eye(4)
    view[:3, :3] = lens.camera.axes * ((1.0,), (1.0,), (-1.0,))
    view[:3, 3] = -view[:3, :3] @ lens.eye
    width, height = 2 * lens.scale / lens.width, 2 * lens.scale / lens.height
    deep = FAR_M - NEAR_M
    clip = np.zeros((4, 4))
    clip[0, 0], clip[1, 1] = width, height
    clip[2, 2], clip[2, 3] = -(FAR_M + NEAR_M) / deep, -2 * FAR_M * NEAR_M / deep
    clip[3, 2] = -1.0
    return (clip @ view).ravel().tolist()


def rows_of(placed: Placed, dress: Dress, lens: Lens, shades: Shades) -> NDArray[np.float32]:
    """The rows (MOST_PARTS, ROWS, 4) of some parts; the shader says what they are."""
    count = len(placed.parts)
    rows = np.zeros((MOST_PARTS, ROWS, 4), np.float32)
    rows[:count, :3, :3] = placed.turns
    rows[:count, :3, 3] = placed.origins
    rows[:count, 4, 3] = _lifts(placed, lens)
    for number, part in enumerate(placed.parts):
        light, colour = dress.light_of(part), dress.colours[part.colour]
        base = shades.base(colour, dress.is_pale)
        strength = PALE_STRENGTH if dress.is_pale else STRENGTHS[part.finish]
        if light:
            base, strength = mixed(QColor.fromRgb(light), QColor("#ffffff"), 0.2), 0.0
        rows[number, 3, :3] = base.getRgbF()[:3]  # type: ignore[index]
        rows[number, 4, :3] = shades.outline(colour, dress.is_pale).getRgbF()[:3]  # type: ignore[index]
        rows[number, 5, :2] = strength, 0.0 if dress.is_pale else part.gloss
    return rows


def _lifts(placed: Placed, lens: Lens) -> Array:
    """How much nearer each part counts; hidden ones lie on the far side of others."""
    to_eye = lens.eye - placed.origins
    is_away = np.einsum("pij,pj,pi->p", placed.turns, placed.assembly.normals, to_eye) <= 0
    layers = placed.assembly.layers
    lifts = np.where(layers > 0, LIFT_M + LAYER_M * layers, 0.0)
    lifts[(layers > 0) & is_away] = HIDDEN
    return lifts


def glows_of(placed: Placed, dress: Dress, lens: Lens) -> Array:
    """Two triangles (6 * lights, 8) round each light that is on: place, corner, colour."""
    lights = [(number, dress.light_of(part)) for number, part in enumerate(placed.parts)]
    lifts, middles = _lifts(placed, lens), placed.middles()
    right, up = lens.camera.axes[:2]
    vertices = []
    for number, light in lights:
        if not light or lifts[number] == HIDDEN:
            continue
        way = lens.eye - middles[number]
        middle = middles[number] + way * (GLOW_LIFT_M / np.sqrt(way @ way))
        size = np.sort(placed.assembly.solids.extent[number])
        radius = GLOW_GROWTH * float(np.sqrt(size[1] * size[2]))
        colour = QColor.fromRgb(light).getRgbF()[:3]  # type: ignore[index]
        for x, y in SQUARE:
            place = middle + radius * (x * right + y * up)
            vertices.append([*place.tolist(), x, y, *colour])
    return np.array(vertices, dtype=np.float64).reshape(-1, 8)


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
        self._body.bind()
        tell_lens(self._body, lens)
        for placed, dress in groups:
            if len(placed.parts) > MOST_PARTS:
                raise NoContext(f"a robot of {len(placed.parts)} parts is too much for it")
            self._rows.fill(rows_of(placed, dress, lens, shades))
            self._mesh(placed.assembly.solids).draw(self._calls, self._body, STRIP)
        self._body.release()
        self._paint_glows(groups, lens)
        image = self._sheet.toImage()
        self._sheet.release()
        self._gl.leave()
        image.setDevicePixelRatio(lens.ratio)
        return image

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

"""Places, colours and lights of parts as the numbers that the programs of the GPU read."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor, QMatrix3x3, QMatrix4x4, QVector3D
from PySide6.QtOpenGL import QOpenGLShaderProgram

from .bodies import GLOW_GROWTH, Dress
from .camera import Lens
from .gl_shaders import MOST_PARTS, ROWS
from .placed import Placed
from .shading import Shades, lit_colour, mixed

Array = NDArray[np.float64]
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
        program.setUniformValue(
            program.uniformLocation("eye"), QVector3D(*lens.camera.eye.tolist())
        )


def _matrix(lens: Lens) -> list[float]:
    """From the room to what OpenGL clips, (4, 4) row by row."""
    axes, eye = lens.camera.axes, lens.camera.eye
    view = np.eye(4)
    view[:3, :3] = axes * ((1.0,), (1.0,), (-1.0,))
    view[:3, 3] = -view[:3, :3] @ eye
    width, height = 2 * lens.scale / lens.width, 2 * lens.scale / lens.height
    deep = FAR_M - NEAR_M
    clip = np.zeros((4, 4))
    clip[0, 0], clip[1, 1] = width, height
    clip[2, 2], clip[2, 3] = -(FAR_M + NEAR_M) / deep, -2 * FAR_M * NEAR_M / deep
    clip[3, 2] = -1.0
    numbers: list[float] = (clip @ view).ravel().tolist()
    return numbers


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
            base, strength = mixed(lit_colour(light), QColor("#ffffff"), 0.2), 0.0
        rows[number, 3, :3] = base.getRgbF()[:3]  # type: ignore[index]
        rows[number, 4, :3] = shades.outline(colour, dress.is_pale).getRgbF()[:3]  # type: ignore[index]
        rows[number, 5, :2] = strength, 0.0 if dress.is_pale else part.gloss
    return rows


def _lifts(placed: Placed, lens: Lens) -> Array:
    """How much nearer each part counts; hidden ones lie on the far side of others."""
    to_eye = lens.camera.eye - placed.origins
    is_away = np.einsum("pij,pj,pi->p", placed.turns, placed.normals, to_eye) <= 0
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
        way = lens.camera.eye - middles[number]
        middle = middles[number] + way * (GLOW_LIFT_M / np.sqrt(way @ way))
        size = np.sort(placed.solids.extent[number])
        radius = GLOW_GROWTH * float(np.sqrt(size[1] * size[2]))
        colour = lit_colour(light).getRgbF()[:3]  # type: ignore[index]
        for x, y in SQUARE:
            place = middle + radius * (x * right + y * up)
            vertices.append([*place.tolist(), x, y, *colour])
    return np.array(vertices, dtype=np.float64).reshape(-1, 8)

"""An OpenGL context of our own that paints into pictures, where the machine has one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from PySide6.QtCore import QSize
from PySide6.QtGui import QGuiApplication, QOffscreenSurface, QOpenGLContext, QSurfaceFormat
from PySide6.QtOpenGL import (
    QOpenGLFramebufferObject,
    QOpenGLFramebufferObjectFormat,
    QOpenGLShader,
    QOpenGLShaderProgram,
)

from nep_studio.support import safe_mode

from .drawing import NoContext
from .shading import LIGHT_AT, REACH, SHADE, STOPS

VERSION = (3, 3)
SAMPLES = 4
WITHOUT = ("offscreen", "minimal", "vnc", "linuxfb")
"""Platforms of Qt that have no OpenGL; some crash when they are asked for it."""
SLOW = ("llvmpipe", "softpipe", "swiftshader", "software", "gdi generic", "basic render")
"""Parts of the names of those that paint without a GPU: QPainter is as fast there."""
GL_RENDERER = 0x1F01


@dataclass(frozen=True, eq=False)
class GlContext:
    """A context with the surface that it needs; neither is ever seen."""

    context: QOpenGLContext
    surface: QOffscreenSurface
    renderer: str

    @property
    def is_fast(self) -> bool:
        """Whether there is a GPU behind it."""
        return not any(name in self.renderer.lower() for name in SLOW)

    @classmethod
    @cache
    def made(cls) -> GlContext:
        """Make a context of OpenGL 3.3, one for all. Raises NoContext."""
        if QGuiApplication.platformName() in WITHOUT:
            raise NoContext(f"the platform {QGuiApplication.platformName()} has no OpenGL")
        if safe_mode.is_on():
            raise NoContext("safe mode leaves the graphics card alone")
        wanted = QSurfaceFormat()
        wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
        wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
        wanted.setVersion(*VERSION)
        # They go with the application: a driver that is asked later may crash.
        app = QGuiApplication.instance()
        context, surface = QOpenGLContext(app), QOffscreenSurface(None, app)
        context.setFormat(wanted)
        if not context.create():
            raise NoContext("no context can be made")
        surface.setFormat(context.format())
        surface.create()
        if not surface.isValid() or not context.makeCurrent(surface):
            raise NoContext("the context cannot be used")
        got = context.format().version()
        if (got[0], got[1]) < VERSION:
            raise NoContext(f"only OpenGL {got[0]}.{got[1]} is there")
        return cls(context, surface, str(context.functions().glGetString(GL_RENDERER)))

    def use(self) -> None:
        """Let what follows paint here. Raises NoContext when the GPU is gone."""
        if not self.context.makeCurrent(self.surface):
            raise NoContext("the context is lost")

    def leave(self) -> None:
        """Let what follows paint elsewhere."""
        self.context.doneCurrent()

    def sheet(self, size: QSize) -> QOpenGLFramebufferObject:
        """Something to paint on, with smooth edges where that costs little. Raises NoContext."""
        wanted = QOpenGLFramebufferObjectFormat()
        wanted.setSamples(SAMPLES if self.is_fast else 0)
        wanted.setAttachment(QOpenGLFramebufferObject.Attachment.Depth)
        sheet = QOpenGLFramebufferObject(size, wanted)
        if not sheet.isValid():
            raise NoContext(f"no picture of {size.width()} x {size.height()} pixels")
        return sheet


def program(vertex: str, fragment: str) -> QOpenGLShaderProgram:
    """A program of the GPU. Raises NoContext when it is not understood."""
    made, kinds = QOpenGLShaderProgram(), QOpenGLShader.ShaderTypeBit
    is_well = (
        made.addShaderFromSourceCode(kinds.Vertex, vertex.lstrip())
        and made.addShaderFromSourceCode(kinds.Fragment, fragment.lstrip())
        and made.link()
    )
    if not is_well:
        raise NoContext(made.log())
    return made


# The programs of the GPU: bodies that look as QPainter's do, and the glow of lights.

MOST_PARTS = 170
"""So many parts fit into the smallest uniform block that a GPU may have (16 kB)."""
ROWS = 6
"""vec4 of a part: three of its place and turn, colour, rim and how near, shade and gloss."""

BODY_VERTEX = f"""
#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in float part;
layout(std140) uniform Parts {{ vec4 rows[{ROWS * MOST_PARTS}]; }};
uniform mat4 lens;
uniform mat3 axes;
uniform vec3 eye;
out vec3 seen_normal;
out vec3 to_eye;
flat out vec3 colour;
flat out vec3 rim;
flat out vec2 finish;

void main() {{
    int row = int(part + 0.5) * {ROWS};
    mat3 turn = transpose(mat3(rows[row].xyz, rows[row + 1].xyz, rows[row + 2].xyz));
    vec3 world = turn * place + vec3(rows[row].w, rows[row + 1].w, rows[row + 2].w);
    vec3 way = normalize(eye - world);
    float nearer = rows[row + 4].w;
    vec4 nearest = lens * vec4(world + way * nearer, 1.0);
    gl_Position = lens * vec4(world, 1.0);
    gl_Position.z = nearest.z / nearest.w * gl_Position.w;
    if (nearer < 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    seen_normal = axes * (turn * normal);
    to_eye = axes * way;
    colour = rows[row + 3].rgb;
    rim = rows[row + 4].rgb;
    finish = rows[row + 5].xy;
}}
"""


STEPS = "\n".join(
    f"    if (d >= {start:.3f}) tone = mix(vec2({white:.3f}, {shade:.3f}), "
    f"vec2({more_white:.3f}, {more_shade:.3f}), "
    f"clamp((d - {start:.3f}) / {end - start:.3f}, 0.0, 1.0));"
    for (start, white, shade), (end, more_white, more_shade) in pairwise(STOPS)
)
"""The steps of the gradient from the light, as nested mixes of white and shade."""

BODY_FRAGMENT = f"""
#version 330 core
in vec3 seen_normal;
in vec3 to_eye;
flat in vec3 colour;
flat in vec3 rim;
flat in vec2 finish;
out vec4 painted;
const vec3 SHADE = vec3({SHADE.redF():.3f}, {SHADE.greenF():.3f}, {SHADE.blueF():.3f});

void main() {{
    vec3 n = normalize(seen_normal);
    vec2 p = vec2(n.x, -n.y);
    float d = clamp(length(p - vec2({LIGHT_AT.x():.3f}, {LIGHT_AT.y():.3f})) / {REACH:.3f}, 0., 1.);
    vec2 tone = vec2({STOPS[0][1]:.3f}, {STOPS[0][2]:.3f});
{STEPS}
    tone *= finish.x;
    vec3 lit = mix(mix(colour, vec3(1.0), tone.x), SHADE, tone.y);
    vec2 q = p - vec2(-0.4, -0.52);
    q = vec2(0.788 * q.x - 0.616 * q.y, 0.616 * q.x + 0.788 * q.y) / vec2(0.3, 0.2);
    lit = mix(lit, vec3(1.0), finish.y * 0.85 * smoothstep(1.0, 0.0, length(q)));
    float facing = dot(n, normalize(to_eye));
    float edge = 1.0 - smoothstep(0.2, 1.3, facing / max(fwidth(facing), 1e-4));
    painted = vec4(mix(lit, rim, 0.85 * edge * step(0.001, finish.x)), 1.0);
}}
"""

GLOW_VERTEX = """
#version 330 core
layout(location = 0) in vec3 place;
layout(location = 1) in vec2 corner;
layout(location = 2) in vec3 light;
uniform mat4 lens;
out vec2 off;
flat out vec3 colour;

void main() {
    gl_Position = lens * vec4(place, 1.0);
    off = corner;
    colour = light;
}
"""

GLOW_FRAGMENT = """
#version 330 core
in vec2 off;
flat in vec3 colour;
out vec4 painted;

void main() {
    float far = min(length(off), 1.0);
    float alpha = 0.26 * pow(1.0 - far, 2.2);
    painted = vec4(colour * alpha, alpha);
}
"""

"""An OpenGL context of our own that paints into pictures, where the machine has one."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QSize
from PySide6.QtGui import QGuiApplication, QOffscreenSurface, QOpenGLContext, QSurfaceFormat
from PySide6.QtOpenGL import (
    QOpenGLFramebufferObject,
    QOpenGLFramebufferObjectFormat,
    QOpenGLShader,
    QOpenGLShaderProgram,
)

from nep_studio import safe_mode

from .drawing import NoContext

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
    def made(cls) -> GlContext:
        """Make a context of OpenGL 3.3. Raises NoContext."""
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

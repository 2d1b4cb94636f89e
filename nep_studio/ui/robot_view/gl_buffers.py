"""What the bodies need in the memory of a GPU: triangles, and the places and colours of parts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QOpenGLExtraFunctions
from PySide6.QtOpenGL import QOpenGLBuffer, QOpenGLShaderProgram, QOpenGLVertexArrayObject

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

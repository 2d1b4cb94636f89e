"""Carried blocks outside the view: over the palette, on their way to the canvas or to the trash."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QLabel

if TYPE_CHECKING:
    from ..canvas import Canvas


class FloatingPicture(QLabel):
    """The picture of the carried blocks, shown over the whole window."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setScaledContents(True)
        self.hide()

    def follow(self, canvas: Canvas, pointer: QPointF) -> None:
        """Show the carried blocks where they are, if the pointer is not in the view."""
        sprite, view = canvas.sprite, canvas.viewport()
        if sprite is None or view.rect().contains(pointer.toPoint()):
            self.hide()
            return
        window = canvas.window()
        if self.parentWidget() is not window:
            self.setParent(window)
        if self.pixmap().cacheKey() != sprite.pixmap.cacheKey():
            self.setPixmap(sprite.pixmap)
        scale = canvas.camera.scale
        self.resize(round(sprite.width * scale), round(sprite.height * scale))
        corner = canvas.camera.to_view(sprite.x, sprite.y).toPoint()
        self.move(view.mapTo(window, corner))
        self.show()
        self.raise_()

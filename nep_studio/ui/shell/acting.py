"""Robots that act in the pictures of the start page: small loops, drawn ahead by our own painter.

A loop is an animated WebP of ``tools/example_loops.py``. One frame of it is in memory, and only a
picture that somebody sees is moving.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QRectF, QSize, Qt, QTimer
from PySide6.QtGui import (
    QColor,
    QHideEvent,
    QImage,
    QImageReader,
    QLinearGradient,
    QPainter,
    QPainterPath,
    QPaintEvent,
)
from PySide6.QtWidgets import QSizePolicy, QStyle, QWidget

from nep_studio import paths
from nep_studio.ui.theme.look import Look

FRAME_MS = 143
"""As the loops are drawn; faster would be smoother, and costs more."""
STAGE = 0.22
"""How much of the accent is in the light behind a robot."""
FLOOR = 0.8
"""Where the floor begins, from the top."""


class ActingPicture(QWidget):
    """The robots of an example: they stand still until they are to act.

    ``is_acting`` says whether they move now: they do not while nobody sees them, nor where the
    computer is set to move as little as possible. ``round_`` is the radius of the upper corners,
    and of the lower ones too where it ``is_alone``. ``at`` is where the robots stand, 0 to 1 from
    where reading begins.
    """

    def __init__(self, name: str, look: Look, *, round_: float, is_alone: bool = False) -> None:
        super().__init__()
        self.name, self._look, self._round, self._is_alone = name, look, round_, is_alone
        self.at = 0.5
        self._reader: QImageReader | None = None
        self._frame: QImage | None = None
        self._is_wanted = False
        self._turns = QTimer(self, interval=FRAME_MS)
        self._turns.timeout.connect(self._on_turn)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)

    @property
    def is_acting(self) -> bool:
        """Whether the picture moves."""
        return self._turns.isActive()

    def act(self, is_wanted: bool = True) -> None:
        """Move from now on while somebody sees it, or stand still again."""
        if is_wanted == self._is_wanted:
            return
        self._is_wanted = is_wanted
        if not is_wanted:
            self._stand_still()
        self.update()

    def sizeHint(self) -> QSize:
        """As high as it is made."""
        return QSize(0, self.minimumHeight())

    def hideEvent(self, event: QHideEvent) -> None:
        """Stop while nobody looks."""
        self._turns.stop()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the stage and the robots; this is where it is known that somebody sees them."""
        if self._frame is None:
            self._read_next()
        if self._is_wanted and not self._turns.isActive() and self._may_move():
            self._turns.start()
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            self._paint_stage(painter)
            if self._frame is not None and not self._frame.isNull():
                painter.drawImage(self._place(self._frame.size()), self._frame)

    def _paint_stage(self, painter: QPainter) -> None:
        """A wall with some light on it, and a floor."""
        theme, room = self._look.theme, self.rect().toRectF()
        wall, light = theme.colour("panel_alt"), theme.colour("accent")
        shape = QPainterPath()
        below = 0.0 if self._is_alone else self._round  # there goes on what it belongs to
        shape.addRoundedRect(room.adjusted(0, 0, 0, below), self._round, self._round)
        gradient = QLinearGradient(room.topLeft(), room.bottomLeft())
        gradient.setColorAt(0.0, _mixed(wall, light, STAGE / 2))
        gradient.setColorAt(FLOOR - 0.001, _mixed(wall, light, STAGE))
        gradient.setColorAt(FLOOR, _mixed(wall, light, STAGE * 1.6))
        gradient.setColorAt(1.0, _mixed(wall, light, STAGE * 1.2))
        painter.fillPath(shape, gradient)

    def _place(self, size: QSize) -> QRectF:
        """As large as there is room for, on the floor in the middle."""
        room = self.rect().toRectF()
        scale = min(room.width() / size.width(), room.height() / size.height())
        wide, high = size.width() * scale, size.height() * scale
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        middle = room.width() * (1 - self.at if is_mirrored else self.at)
        left = min(max(middle - wide / 2, 0.0), room.width() - wide)
        return QRectF(left, room.height() - high, wide, high)

    def _may_move(self) -> bool:
        hint = QStyle.StyleHint.SH_Widget_Animation_Duration
        return self.style().styleHint(hint, None, self) > 0

    def _on_turn(self) -> None:
        if self.window().isMinimized() or self.visibleRegion().isEmpty():
            self._turns.stop()  # painted again, it goes on
            return
        self._read_next()
        self.update()

    def _stand_still(self) -> None:
        self._turns.stop()
        self._reader = self._frame = None  # painted again, it is the first frame

    def _read_next(self) -> None:
        """Take the next frame, the first one after the last."""
        for _ in range(2):
            if self._reader is None:
                self._reader = QImageReader(str(picture_file(self.name)))
            frame = self._reader.read()
            if not frame.isNull():
                self._frame = frame
                break
            self._reader = None
        if not self._is_wanted:
            self._reader = None  # it holds the whole file


def picture_file(name: str) -> Path:
    """Where the loop of an example is."""
    return paths.examples() / "pictures" / f"{name}.webp"


def _mixed(one: QColor, other: QColor, share: float) -> QColor:
    parts = zip(one.getRgbF()[:3], other.getRgbF()[:3], strict=True)  # type: ignore[index]
    red, green, blue = (a + (b - a) * share for a, b in parts)
    return QColor.fromRgbF(red, green, blue)

"""What is drawn over the curves: takes, the recording, a countdown, and words where none are."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QFontMetricsF, QPainter, QPen

from nep_studio.ui.theme import Theme
from nep_studio.ui.trainer.curves import Window
from nep_studio.ui.words import tr

HANDLE_LINES = 0.55
_FAULT_ALPHA, _TAKE_ALPHA, _RECORDED_ALPHA = 46, 40, 16


@dataclass(frozen=True)
class Mark:
    """A stretch with words on it; one with a fault is hatched."""

    start_s: float
    end_s: float
    words: str
    is_fault: bool = False


def fault_words(fault: str) -> str:
    """Why a movement does not count, in a few words."""
    return {
        "short": tr("too short"),
        "still": tr("too still"),
        "long": tr("too long"),
        "gap": tr("samples are missing"),
    }.get(fault, fault)


def paint_recorded(painter: QPainter, window: Window, start_s: float, theme: Theme) -> None:
    """Tint all that is part of the recording, with a line where it began."""
    left = max(window.rect.left(), window.x(start_s))
    if left >= window.rect.right():
        return
    rect = QRectF(QPointF(left, window.rect.top()), window.rect.bottomRight())
    painter.fillRect(rect, _tint(theme.colour("stop"), _RECORDED_ALPHA))
    if window.x(start_s) >= window.rect.left():
        painter.setPen(QPen(theme.colour("stop"), 2))
        painter.drawLine(rect.topLeft(), rect.bottomLeft())


def _place(window: Window, mark: Mark) -> QRectF:
    """Where a stretch is, as far as it is in the window."""
    left, right = window.x(mark.start_s), window.x(mark.end_s)
    whole = QRectF(left, window.rect.top(), right - left, window.rect.height())
    return whole.intersected(window.rect)


def _colour(mark: Mark, theme: Theme) -> QColor:
    return theme.colour("warning" if mark.is_fault else "success")


def paint_mark(painter: QPainter, window: Window, mark: Mark, theme: Theme) -> None:
    """Tint a stretch, with a bar at the top."""
    rect, colour = _place(window, mark), _colour(mark, theme)
    if rect.isEmpty():
        return
    if mark.is_fault:
        painter.fillRect(rect, QBrush(_tint(colour, 2 * _FAULT_ALPHA), Qt.BrushStyle.BDiagPattern))
    painter.fillRect(rect, _tint(colour, _FAULT_ALPHA if mark.is_fault else _TAKE_ALPHA))
    painter.fillRect(QRectF(rect.left(), rect.top(), rect.width(), 3), colour)


def paint_label(painter: QPainter, window: Window, mark: Mark, theme: Theme, font: QFont) -> None:
    """Write the words of a stretch at its top, over the curves."""
    rect, colour, words = _place(window, mark), _colour(mark, theme), mark.words
    if rect.isEmpty():
        return
    metrics = QFontMetricsF(font)
    width = metrics.horizontalAdvance(words) + metrics.height() * 0.6
    x = min(max(rect.center().x() - width / 2, window.rect.left()), window.rect.right() - width)
    room = QRectF(x, rect.top() + 5, width, metrics.height() * 1.1)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(colour, 1))
    painter.setBrush(theme.colour("field"))
    painter.drawRoundedRect(room, room.height() / 2, room.height() / 2)
    painter.setFont(font)
    painter.setPen(theme.colour("field_text"))
    painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)


def paint_handle(
    painter: QPainter, window: Window, time_s: float, theme: Theme, line: float, *, is_held: bool
) -> None:
    """Draw an end of a take, which can be dragged."""
    x = window.x(time_s)
    colour = theme.colour("focus" if is_held else "success")
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(colour, 3 if is_held else 2))
    painter.drawLine(QPointF(x, window.rect.top()), QPointF(x, window.rect.bottom()))
    grip = QRectF(0, 0, line * HANDLE_LINES, line * 1.3)
    grip.moveCenter(QPointF(x, window.rect.center().y()))
    painter.setBrush(theme.colour("field"))
    painter.drawRoundedRect(grip, 3, 3)


def paint_big(
    painter: QPainter, rect: QRectF, words: str, theme: Theme, font: QFont, share: float
) -> None:
    """Write a few words as large as this share of the height, readable over curves."""
    big = QFont(font)
    metrics = QFontMetricsF(big)
    width = max(metrics.horizontalAdvance(words), 1.0)
    scale = min(rect.height() * share / metrics.height(), rect.width() * share / width)
    big.setPixelSize(max(8, round(metrics.height() * scale * 0.8)))
    big.setWeight(QFont.Weight.DemiBold)
    metrics = QFontMetricsF(big)
    room = QRectF(0, 0, metrics.horizontalAdvance(words) + metrics.height(), metrics.height() * 1.1)
    room.moveCenter(rect.center())
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(_tint(theme.colour("field"), 225))
    painter.drawRoundedRect(room, room.height() / 3, room.height() / 3)
    painter.setFont(big)
    painter.setPen(theme.colour("field_text"))
    painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)


def paint_words(painter: QPainter, rect: QRectF, words: str, theme: Theme, font: QFont) -> None:
    """Say in the middle what is missing, readable over curves."""
    metrics = QFontMetricsF(font)
    flags = int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap)
    room = rect.adjusted(metrics.height(), 4, -metrics.height(), -4)
    written = metrics.boundingRect(room, flags, words)
    around = metrics.height() * 0.4
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(_tint(theme.colour("field"), 230))
    painter.drawRoundedRect(written.adjusted(-around, -around, around, around), around, around)
    painter.setFont(font)
    painter.setPen(theme.colour("muted"))
    painter.drawText(room, flags, words)


def _tint(colour: QColor, alpha: int) -> QColor:
    tinted = QColor(colour)
    tinted.setAlpha(alpha)
    return tinted

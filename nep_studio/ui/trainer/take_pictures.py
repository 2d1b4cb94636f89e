"""Little pictures of takes, painted when they are first seen and kept."""

from __future__ import annotations

from collections import OrderedDict

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPixmap

from nep_studio.blocks.own_gestures import OwnTake
from nep_studio.ui.theme import Theme
from nep_studio.ui.trainer.curves import Window, paint_lines, value_range
from nep_studio.ui.trainer.desk import TrainerDesk

MOST_KEPT = 1500

Key = tuple[str, float, float, int, int, float, str]


class TakePictures:
    """The curves of takes as pixmaps; all takes of all cards share one store."""

    def __init__(self, desk: TrainerDesk) -> None:
        self._desk = desk
        self._kept: OrderedDict[Key, QPixmap] = OrderedDict()

    def picture(self, take: OwnTake, size: QSize, ratio: float, metrics: QFontMetricsF) -> QPixmap:
        """The curves of a take, this large in logical pixels."""
        theme = self._desk.look.theme
        key = (take.id, take.start_s, take.end_s, size.width(), size.height(), ratio, theme.name)
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        made = self._kept[key] = self._paint(take, size, ratio, theme, metrics)
        while len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)
        return made

    def _paint(
        self, take: OwnTake, size: QSize, ratio: float, theme: Theme, metrics: QFontMetricsF
    ) -> QPixmap:
        pixmap = QPixmap(size * ratio)
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        samples = self._desk.take_samples(take)
        if not len(samples):
            return pixmap
        low, high = value_range(samples)
        rect = QRectF(0, 0, size.width(), size.height())
        window = Window(rect, float(samples.t[0]), float(samples.t[-1]), low, high)
        with QPainter(pixmap) as painter:
            paint_lines(painter, window, samples, theme, metrics)
        return pixmap

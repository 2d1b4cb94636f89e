"""The icons of the program, drawn in any colour and sharp at any size."""

from __future__ import annotations

from functools import cache, lru_cache
from pathlib import Path

from PySide6.QtCore import QByteArray, QPointF, QRect, QRectF, QSize, QSizeF, Qt
from PySide6.QtGui import QColor, QIcon, QIconEngine, QPainter, QPixmap, QPixmapCache
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QAbstractButton, QTabBar, QTabWidget, QWidget

from nep_studio import paths

from .colours import Theme

CATEGORY_ICONS = {
    "events": "flag",
    "control": "repeat",
    "robot": "bot",
    "sensing": "eye",
    "logic": "git-branch",
    "math": "calculator",
    "text": "type",
    "variables": "variable",
    "lists": "list",
    "tables": "table",
    "my_blocks": "puzzle",
    "colours": "palette",
    "code": "code",
    "goals": "target",
    "trees": "list-tree",
    "plans": "map",
    "nodes": "network",
    "robots": "plug",
    "robot_events": "hand",
    "speech": "message-square-text",
    "moves": "footprints",
    "lights": "lightbulb",
    "senses": "ear",
    "camera": "camera",
    "time": "clock",
    "states": "route",
}
"""A category's icon, by the category's ``colour``: so that colour never speaks alone."""

APPLICATION_ICON = "nep-studio"


class UnknownIcon(KeyError):
    """An icon was asked for that is not in resources/icons."""


def icon_path(name: str) -> Path:
    """Return the drawing of an icon; raises UnknownIcon."""
    path = paths.resources() / "icons" / f"{name}.svg"
    if not path.is_file():
        raise UnknownIcon(f"There is no icon {name} in {path.parent}.")
    return path


def category_icon_name(category_colour: str) -> str:
    """Return the icon of a category, or of blocks in general for one that has none."""
    return CATEGORY_ICONS.get(category_colour, "blocks")


def icon(name: str, colour: Theme | QColor, of_theme: str = "text") -> QIcon:
    """Return an icon in one colour, or in a theme's, and paler where it is disabled.

    One in a colour of the theme that the windows wear follows them to another theme.
    """
    if isinstance(colour, Theme):
        return QIcon(_DrawnIcon(name, _Ink(colour, of_theme)))
    return QIcon(_DrawnIcon(name, QColor(colour)))


_worn: Theme | None = None


def wear(theme: Theme) -> None:
    """The windows are dressed in this theme from now on, and with them their icons."""
    global _worn
    _worn = theme


class _Ink:
    """A colour of a theme; while the windows wear that theme, of the one that they wear."""

    def __init__(self, theme: Theme, name: str) -> None:
        self._theme, self._name, self._is_worn = theme, name, theme is _worn

    def colour(self, mode: QIcon.Mode) -> QColor:
        """The colour as it is now."""
        theme = _worn if self._is_worn and _worn is not None else self._theme
        return theme.colour("disabled" if mode == QIcon.Mode.Disabled else self._name)


def icon_pixmap(name: str, colour: QColor, size: float, ratio: float = 1.0) -> QPixmap:
    """Return an icon of ``size`` logical pixels for a screen with this device pixel ratio."""
    side = max(1, round(size * ratio))
    return _drawn(name, colour, QSize(side, side), ratio)


def _drawn(name: str, colour: QColor, pixels: QSize, ratio: float) -> QPixmap:
    pixmap = QPixmap(pixels)
    pixmap.fill(Qt.GlobalColor.transparent)
    with QPainter(pixmap) as painter:
        paint_icon(painter, QRectF(pixmap.rect()), name, colour)
    pixmap.setDevicePixelRatio(ratio)
    return pixmap


def paint_icon(painter: QPainter, rect: QRectF, name: str, colour: QColor) -> None:
    """Draw an icon as large as fits in the middle of a rectangle."""
    side = min(rect.width(), rect.height())
    square = QRectF(QPointF(), QSizeF(side, side))
    square.moveCenter(rect.center())
    opacity = painter.opacity()
    painter.setOpacity(opacity * colour.alphaF())
    _renderer(name, colour.name()).render(painter, square)
    painter.setOpacity(opacity)


def recoloured(name: str, colour: QColor) -> str:
    """Return the drawing of an icon, as SVG text, in one colour."""
    return _source(name).replace("currentColor", colour.name())


def application_icon() -> QIcon:
    """Return the icon of the program itself, in its own colours."""
    return QIcon(_DrawnIcon(APPLICATION_ICON, QColor(Qt.GlobalColor.black)))


@cache
def _source(name: str) -> str:
    return icon_path(name).read_text(encoding="utf-8")


@lru_cache(maxsize=256)
def _renderer(name: str, colour: str) -> QSvgRenderer:
    """What draws an icon: to read it takes longer than to draw it."""
    return QSvgRenderer(QByteArray(_source(name).replace("currentColor", colour).encode()))


class _DrawnIcon(QIconEngine):
    """Draws an icon for each size and screen once, in the colour of its state."""

    def __init__(self, name: str, ink: _Ink | QColor) -> None:
        super().__init__()
        _source(name)  # a name that does not exist is told where it is written
        self._name, self._ink = name, ink

    def _colour(self, mode: QIcon.Mode) -> QColor:
        if isinstance(self._ink, _Ink):
            return self._ink.colour(mode)
        colour = QColor(self._ink)
        if mode == QIcon.Mode.Disabled and self._name != APPLICATION_ICON:
            colour.setAlphaF(colour.alphaF() * 0.45)
        return colour

    def paint(self, painter: QPainter, rect: QRect, mode: QIcon.Mode, state: QIcon.State) -> None:
        paint_icon(painter, QRectF(rect), self._name, self._colour(mode))

    def pixmap(self, size: QSize, mode: QIcon.Mode, state: QIcon.State) -> QPixmap:
        return self.scaledPixmap(size, mode, state, 1.0)

    def scaledPixmap(
        self, size: QSize, mode: QIcon.Mode, state: QIcon.State, scale: float
    ) -> QPixmap:
        pixels = size * scale
        if pixels.isEmpty():  # of a widget that has no room just now
            return QPixmap()
        colour = self._colour(mode)
        name = colour.name(QColor.NameFormat.HexArgb)
        key = f"{self._name} {name} {pixels.width()} x {pixels.height()} at {scale}"
        pixmap = QPixmap()
        if not QPixmapCache.find(key, pixmap):  # many widgets show the same icon
            pixmap = _drawn(self._name, colour, pixels, scale)
            QPixmapCache.insert(key, pixmap)
        return pixmap

    def clone(self) -> QIconEngine:
        return _DrawnIcon(self._name, self._ink)


# Icons as large as the text beside them, which Qt leaves at one size.

ICON_LINES = 1.0
"""How high an icon is, in lines of text."""

WIDENING = 1.3
"""How much wider than high the room of an icon beside a word is: Qt leaves too little there."""


def fit_icons(root: QWidget) -> None:
    """Give the icons of all buttons and tabs inside a widget the size of their text."""
    for button in root.findChildren(QAbstractButton):
        side = _side(button)
        button.setIconSize(icon_room(side) if button.text() else QSize(side, side))
    for bar in root.findChildren(QTabBar):
        bar.setIconSize(icon_room(_side(bar)))
    for tabs in root.findChildren(QTabWidget):
        tabs.setIconSize(icon_room(_side(tabs)))


def _side(widget: QWidget) -> int:
    return round(widget.fontMetrics().height() * ICON_LINES)


def icon_room(side: int) -> QSize:
    """The room of an icon that stands beside a word."""
    return QSize(round(side * WIDENING), side)

"""A QR code, drawn in whole pixels of the screen so that every camera reads it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPixmap
from PySide6.QtWidgets import QButtonGroup, QLabel, QPushButton, QSizePolicy, QWidget

from nep_studio import paths
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import column_in
from nep_studio.ui.widgets.layouts import Flow
from nep_studio.ui.words import tr

QUIET = 4
"""So many modules of white are around a code: the standard asks for them."""
LINES_WIDE = 13
FEWEST_PIXELS = 3
"""A module of fewer pixels is hard to read from a screen."""

Modules = Sequence[Sequence[int]]


class QrCode(QWidget):
    """Black on white in every theme: cameras do not all read a code in other colours."""

    def __init__(self) -> None:
        super().__init__()
        self.url = ""
        self._modules: Modules = ()
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)

    def show_url(self, url: str) -> None:
        """Show the code of an address; "" shows none."""
        if url == self.url:
            return
        self.url = url
        self._modules = modules_of(url) if url else ()
        self.setAccessibleName(url)
        self.setToolTip(url)
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """Large enough for a camera that is an arm's length away."""
        side = max(self.fontMetrics().height() * LINES_WIDE, self.minimumSizeHint().width())
        return QSize(side, side)

    def minimumSizeHint(self) -> QSize:
        """What can still be read."""
        side = (len(self._modules) + 2 * QUIET) * FEWEST_PIXELS
        return QSize(side, side)

    def module_pixels(self) -> int:
        """How many pixels of the screen one module is wide."""
        pixels = min(self.width(), self.height()) * self.devicePixelRatioF()
        return max(1, int(pixels / (len(self._modules) + 2 * QUIET)))

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it in the middle."""
        if not self._modules:
            return
        painter, ratio = QPainter(self), self.devicePixelRatioF()
        painter.scale(1 / ratio, 1 / ratio)
        module = self.module_pixels()
        side = (len(self._modules) + 2 * QUIET) * module
        left = (round(self.width() * ratio) - side) // 2
        top = (round(self.height() * ratio) - side) // 2
        painter.fillRect(QRect(left, top, side, side), Qt.GlobalColor.white)
        for y, row in enumerate(self._modules, QUIET):
            for x, is_dark in enumerate(row, QUIET):
                if is_dark:
                    place = QRect(left + x * module, top + y * module, module, module)
                    painter.fillRect(place, Qt.GlobalColor.black)
        painter.end()


def modules_of(url: str) -> Modules:
    """The modules of the code of an address, row by row; 1 is dark."""
    import segno

    return [list(row) for row in segno.make(url, error="m", micro=False).matrix]


# The one warning of the phone page: how it looks on each kind of phone, and what to press.

SUFFIXES = (".svg", ".png", ".webp", ".jpg")
PICTURE_LINES_WIDE = 22.0


def picture_path(phone: str, is_dark: bool) -> Path | None:
    """The picture of the warning on a phone; None where there is none."""
    folder = paths.resources() / "phone_page"
    shade = "dark" if is_dark else "light"
    names = [folder / f"warning_{phone}_{shade}{suffix}" for suffix in SUFFIXES]
    return next((path for path in names if path.is_file()), None)


class Picture(QWidget):
    """A picture from a file, as wide as there is room, sharp on every screen."""

    def __init__(self) -> None:
        super().__init__()
        self._picture = QPixmap()
        policy = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)

    def show_file(self, path: Path | None, words: str) -> None:
        """Show it, with words for those who do not see it; without a file it is hidden."""
        self._picture = QPixmap() if path is None else _read(path, self._sharp_width)
        self.setAccessibleName(words)
        self.setVisible(not self._picture.isNull())
        self.updateGeometry()
        self.update()

    @property
    def _sharp_width(self) -> int:
        return round(self.fontMetrics().height() * PICTURE_LINES_WIDE * self.devicePixelRatioF())

    def sizeHint(self) -> QSize:
        """A part of a page wide."""
        width = round(self.fontMetrics().height() * PICTURE_LINES_WIDE)
        return QSize(width, self.heightForWidth(width))

    def heightForWidth(self, width: int) -> int:
        """As the picture is."""
        if self._picture.isNull():
            return 0
        wide = min(width, round(self.fontMetrics().height() * PICTURE_LINES_WIDE))
        return round(wide * self._picture.height() / self._picture.width())

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it where reading begins."""
        if self._picture.isNull():
            return
        ratio = self.devicePixelRatioF()
        size = QSize(round(self.width() * ratio), round(self.height() * ratio))
        scaled = self._picture.scaled(
            size, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
        )
        scaled.setDevicePixelRatio(ratio)
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        left = self.width() - round(scaled.width() / ratio) if is_mirrored else 0
        with QPainter(self) as painter:
            painter.drawPixmap(left, 0, scaled)


def _read(path: Path, width: int) -> QPixmap:
    """A picture; drawings as large as they will be shown."""
    if path.suffix != ".svg":
        return QPixmap(str(path))
    from PySide6.QtSvg import QSvgRenderer

    drawing = QSvgRenderer(str(path))
    if not drawing.isValid():
        return QPixmap()
    usual = drawing.defaultSize()
    picture = QPixmap(width, round(width * usual.height() / max(1, usual.width())))
    picture.fill(Qt.GlobalColor.transparent)
    with QPainter(picture) as painter:
        drawing.render(painter)
    return picture


class WarningHelp(QWidget):
    """Two buttons for the kinds of phone; below, the picture of its warning and what to press."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.buttons = {"android": QPushButton("Android"), "ios": QPushButton("iPhone")}
        self.words = QLabel(wordWrap=True)
        self.picture = Picture()
        self._group = QButtonGroup(self)
        row = QWidget()
        Flow(row, self.fontMetrics().height() // 3, self.buttons.values())
        for phone, button in self.buttons.items():
            button.setCheckable(True)
            button.setAutoDefault(False)
            button.clicked.connect(lambda _=False, phone=phone: self.show_phone(phone))
            self._group.addButton(button)
        column_in(self, row, self.words, self.picture)
        self.words.hide()
        self.picture.hide()

    def redraw(self) -> None:
        """Show the picture for another theme."""
        for phone, button in self.buttons.items():
            if button.isChecked():
                self.show_phone(phone)

    def show_phone(self, phone: str) -> None:
        """Show how it is on this kind of phone."""
        told = {
            "android": tr("In Chrome: press “Advanced”, then “Proceed to …”."),
            "ios": tr("In Safari: press “Show Details”, then “visit this website”, and confirm."),
        }
        self.buttons[phone].setChecked(True)
        self.words.setText(told[phone])
        self.words.show()
        self.picture.show_file(picture_path(phone, self._look.theme.is_dark), told[phone])

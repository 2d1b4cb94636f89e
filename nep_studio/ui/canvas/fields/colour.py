"""A colour: named ones in a grid, those used last, and the hexadecimal number."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import (
    QColor,
    QHelpEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    qGray,
)
from PySide6.QtWidgets import QLabel, QLineEdit, QToolTip, QWidget

from nep_studio.blocks.slots import COLOURS, NAMES_OF_COLOURS
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.widgets.layouts import in_row
from nep_studio.ui.words import tr

from .field_edit import Editing
from .popup import FieldPopup

if TYPE_CHECKING:
    from .editors import FieldEditors

COLUMNS = 6


def name_of_colour(code: str) -> str:
    """What a colour is called, or its number when it has no name."""
    name = NAMES_OF_COLOURS.get(code.lower())
    return tr(name) if name is not None else code


class Swatches(QWidget):
    """Squares of colour in rows; the arrow keys and the mouse choose one."""

    def __init__(
        self, theme: Theme, codes: Sequence[str], side: int, chosen: Callable[[str, bool], None]
    ) -> None:
        super().__init__()
        self._theme, self.codes, self._side, self._chosen = theme, list(codes), side, chosen
        self.at = -1
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        rows = -(-len(self.codes) // COLUMNS)
        self.setFixedSize(QSize(COLUMNS * side, rows * side))
        self.setAccessibleName(tr("Colours"))

    def show_colour(self, code: str) -> None:
        """Point at a colour, if it is one of these."""
        self.at = self.codes.index(code) if code in self.codes else -1
        self.setAccessibleDescription(name_of_colour(code))
        self.update()

    def rect_of(self, index: int) -> QRect:
        """Where a colour is."""
        column, row = index % COLUMNS, index // COLUMNS
        if self.layoutDirection() == Qt.LayoutDirection.RightToLeft:
            column = COLUMNS - 1 - column
        return QRect(column * self._side, row * self._side, self._side, self._side)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The arrows go from colour to colour."""
        forward = -1 if self.layoutDirection() == Qt.LayoutDirection.RightToLeft else 1
        steps = {
            Qt.Key.Key_Left: -forward,
            Qt.Key.Key_Right: forward,
            Qt.Key.Key_Up: -COLUMNS,
            Qt.Key.Key_Down: COLUMNS,
        }
        step = steps.get(Qt.Key(event.key()))
        if step is None:
            super().keyPressEvent(event)
        elif 0 <= (new := max(self.at, 0) + step if self.at >= 0 else 0) < len(self.codes):
            self._chosen(self.codes[new], False)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the colour under the mouse."""
        index = self._index_at(event.position())
        if index >= 0:
            self._chosen(self.codes[index], True)

    def event(self, event: QEvent) -> bool:
        """Tell the name of the colour under the mouse."""
        if isinstance(event, QHelpEvent):
            index = self._index_at(QPointF(event.pos()))
            if index >= 0:
                QToolTip.showText(event.globalPos(), name_of_colour(self.codes[index]), self)
            return True
        return super().event(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the colours, and a tick on the one that is chosen."""
        gap = max(2, self._side // 9)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            for index, code in enumerate(self.codes):
                rect = QRectF(self.rect_of(index)).adjusted(gap, gap, -gap, -gap)
                is_here = index == self.at
                line = self._theme.colour("focus" if is_here else "field_line")
                painter.setPen(QPen(line, gap if is_here else 1))
                painter.setBrush(QColor(code))
                painter.drawRoundedRect(rect, 2 * gap, 2 * gap)
                if is_here:
                    ink = QColor("white") if qGray(QColor(code).rgb()) < 128 else QColor("black")
                    painter.setPen(QPen(ink, rect.width() / 10))
                    middle, half = rect.center(), rect.width() / 4
                    painter.drawPolyline(
                        [
                            middle + QPointF(-half, 0),
                            middle + QPointF(-half / 4, half * 0.7),
                            middle + QPointF(half, -half * 0.7),
                        ]
                    )

    def _index_at(self, point: QPointF) -> int:
        at = point.toPoint()
        here = (i for i in range(len(self.codes)) if self.rect_of(i).contains(at))
        return next(here, -1)


class ColourPopup(FieldPopup):
    """The palette, the colours used last, and a line for any other."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors, edit, title)
        theme, side = editors.canvas.look.theme, round(1.7 * self.line)
        self.palette_grid = Swatches(theme, [c for _, c in COLOURS], side, self._on_chosen)
        self.column.addWidget(self.palette_grid)
        self.recent: Swatches | None = None
        if editors.recent_colours:
            heading = QLabel(tr("Used last"), self)
            heading.setProperty("role", "hint")
            self.column.addWidget(heading)
            self.recent = Swatches(theme, editors.recent_colours, side, self._on_chosen)
            self.recent.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            self.column.addWidget(self.recent)
        self.code = QLineEdit(str(edit.value or ""), self)
        self.code.setAccessibleName(tr("Colour as a number, such as #00aaff"))
        self.code.setMaximumWidth(6 * self.line)
        self.code.textEdited.connect(self._on_typed)
        self.name = QLabel(self)
        self.column.addLayout(in_row(self.code, (self.name, 1)))
        self._show()

    def first(self) -> QWidget:
        """The palette has the keyboard."""
        return self.palette_grid

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """What is typed goes into the line for the number."""
        typed = event.text()
        if not self.code.hasFocus() and typed and typed in "#0123456789abcdefABCDEF":
            self.code.setFocus(Qt.FocusReason.OtherFocusReason)
            self.code.setText(typed if typed == "#" else "#" + typed)
            self._on_typed(self.code.text())
        else:
            super().keyPressEvent(event)

    def _on_chosen(self, code: str, is_last: bool) -> None:
        if self.try_set(code):
            self.code.setText(code)
            self._show()
            self._editors.canvas.news.announced.emit(name_of_colour(code))
            if is_last:
                self._editors.close()

    def _on_typed(self, text: str) -> None:
        plain = text.strip()
        if self.try_set((plain if plain.startswith("#") else "#" + plain).lower()):
            self._show()

    def _show(self) -> None:
        now = str(self.edit.value or "")
        self.palette_grid.show_colour(now)
        self.name.setText((NAMES_OF_COLOURS.get(now) and name_of_colour(now)) or "")

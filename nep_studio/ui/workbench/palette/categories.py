"""The column of categories: each with its sign, its name and the colour of its blocks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QPoint, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QIcon, QPainter, QPixmap, QResizeEvent
from PySide6.QtWidgets import QButtonGroup, QScrollArea, QToolButton, QWidget

from nep_studio.ui.canvas.editing.drag_blocks import DragBlocks
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.labels import labelled
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.widgets.layouts import in_column

from .entries import RECENT, Drawer, recent_drawer
from .shelf_layout import paint_badge

WORDS_SCALE = 0.9
SIGN_LINES = 1.15
"""How large the words are beside those of the window, and the signs in lines of text."""


class CategoryColumn(QScrollArea):
    """One button for each drawer; ``opened`` brings the id of the one that was pressed."""

    opened = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.buttons: dict[str, QToolButton] = {}
        self._shown: object = None
        self._sign_size = QSize()
        self._is_narrow = False
        self._words_width = self.wide_width = 0
        self._to_come: QToolButton | None = None
        """The button of what was used last: its room is kept, so that nothing moves later."""
        self._group = QButtonGroup(self)
        self.setWidgetResizable(True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        labelled(self, name="Categories of blocks")

    def show_drawers(self, drawers: Sequence[Drawer], theme: Theme) -> None:
        """Show a button for each of these."""
        self.ensurePolished()  # before that letters have another size
        size = self.fontMetrics().height(), self.devicePixelRatioF()
        ids = [drawer.id for drawer in drawers]
        shown = (ids, theme, self.font(), size)
        if shown != self._shown:
            self._shown = shown
            self._make(drawers, theme)
        for drawer in (*drawers, recent_drawer()):
            button = self.buttons.get(drawer.id, self._to_come)
            if button is not None:
                button.setText(drawer.title)
                button.setToolTip(drawer.title)
                button.setAccessibleName(drawer.title)
        self._fit()

    def _make(self, drawers: Sequence[Drawer], theme: Theme) -> None:
        inner = QWidget()
        self.buttons = {drawer.id: self._button(drawer, theme, inner) for drawer in drawers}
        in_column(*self.buttons.values(), 1, of=inner, margins=2, spacing=0)
        self._to_come = None
        if RECENT not in self.buttons:
            self._to_come = self._button(recent_drawer(), theme, inner)
            self._group.removeButton(self._to_come)
            self._to_come.hide()
        self.setWidget(inner)

    def set_narrow(self, is_narrow: bool) -> None:
        """Show the signs without the names."""
        if is_narrow == self._is_narrow:
            return
        self._is_narrow = is_narrow
        for button in self._measured():
            button.setToolButtonStyle(self._style())
        self._fit()

    def mark(self, drawer: str) -> None:
        """Show which drawer is in view."""
        button = self.buttons.get(drawer)
        if button is not None and not button.isChecked():
            button.setChecked(True)
            self.ensureWidgetVisible(button, 0, 4)

    def _button(self, drawer: Drawer, theme: Theme, parent: QWidget) -> QToolButton:
        button = QToolButton(parent, autoRaise=True)
        button.setCheckable(True)
        font = button.font()
        font.setPointSizeF(font.pointSizeF() * WORDS_SCALE)
        button.setFont(font)
        side = round(self.fontMetrics().height() * SIGN_LINES)
        # The sign with a little room around it, which sets it off from the word
        ratio = self.devicePixelRatioF()
        gap = side / 6
        pixmap = QPixmap(round((side + 2 * gap) * ratio), round(side * ratio))
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        with QPainter(pixmap) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            paint_badge(painter, QRectF(gap + 1, 1, side - 2, side - 2), drawer, theme)
        badge = QIcon(pixmap)
        button.setIcon(badge)
        self._sign_size = badge.actualSize(QSize(2 * side, side))
        button.setToolButtonStyle(self._style())
        button.clicked.connect(lambda: self.opened.emit(drawer.id))
        self._group.addButton(button)
        return button

    def _style(self) -> Qt.ToolButtonStyle:
        styles = Qt.ToolButtonStyle
        return styles.ToolButtonIconOnly if self._is_narrow else styles.ToolButtonTextBesideIcon

    def _measured(self) -> list[QToolButton]:
        """The buttons, also the one that is to come."""
        return [*self.buttons.values(), *([self._to_come] if self._to_come is not None else [])]

    def _fit(self) -> None:
        for button in self._measured():
            button.ensurePolished()  # before that the style sheet does not count
            button.setIconSize(self._sign_size)  # a change of the style makes it smaller
            button.setMinimumWidth(0)
        widest = max((b.sizeHint().width() for b in self._measured()), default=40)
        for button in self.buttons.values():
            button.setMinimumWidth(widest)
        self._words_width = widest + 4
        if not self._is_narrow:
            self.wide_width = self._words_width
        self._make_room()

    def _make_room(self) -> None:
        """Be as wide as the words, with a scroll bar only where one is needed."""
        inner = self.widget()
        more = self._to_come.sizeHint().height() if self._to_come is not None else 0
        high = inner.sizeHint().height() + more if inner is not None else 0
        is_long = high > self.viewport().height()
        bar = self.verticalScrollBar().sizeHint().width() if is_long else 0
        self.setFixedWidth(self._words_width + bar)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Give the scroll bar its room, or take it back."""
        super().resizeEvent(event)
        self._make_room()


# Widgets onto which blocks are dropped to delete them.


class DeleteAreas:
    """Says for a canvas whether a place of the screen takes blocks away, and remembers where."""

    def __init__(self, before: Callable[[QPoint], bool]) -> None:
        self._before = before
        self.widgets: list[QWidget] = []
        self.entered: QWidget | None = None

    def __call__(self, place: QPoint) -> bool:
        """Whether a place is on one of the widgets."""
        self.entered = next((widget for widget in self.widgets if holds(widget, place)), None)
        return self.entered is not None or self._before(place)


def add_delete_area(canvas: CanvasHost, widget: QWidget) -> None:
    """Let blocks of a canvas that are dropped on a widget be deleted, beside where they were."""
    if not isinstance(canvas.marks.delete_area, DeleteAreas):
        canvas.marks.delete_area = DeleteAreas(canvas.marks.delete_area)
    canvas.marks.delete_area.widgets.append(widget)


def is_taking(canvas: CanvasHost, widget: QWidget) -> bool:
    """Whether blocks of the program are carried over a widget, so that letting go deletes them."""
    areas, gesture = canvas.marks.delete_area, canvas.pointing.gesture
    is_here = isinstance(areas, DeleteAreas) and areas.entered is widget
    return is_here and isinstance(gesture, DragBlocks) and bool(gesture.cargo.hidden)


def holds(widget: QWidget, place: QPoint) -> bool:
    """Whether a place of the screen is on a widget that is shown."""
    return widget.isVisible() and widget.rect().contains(widget.mapFromGlobal(place))

"""Layouts: rows and columns in one call, widgets that flow like words, pages that scroll."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Generic, TypeVar

from PySide6.QtCore import QEvent, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QFrame,
    QHBoxLayout,
    QLabel,
    QLayout,
    QLayoutItem,
    QScrollArea,
    QStyle,
    QVBoxLayout,
    QWidget,
    QWidgetItem,
)

from nep_studio.ui.theme.icons import fit_icons

Part = (
    QWidget | QLayout | int | tuple[QWidget | QLayout, int] | tuple[QWidget, int, Qt.AlignmentFlag]
)
"""What stands in a row or column: a widget or layout, with its stretch and alignment where it has
any; a number alone is room that stretches so much."""
Margins = int | tuple[int, int, int, int]
"""Pixels on all sides; or left, above, right and below."""


def in_row(
    *parts: Part,
    of: QWidget | None = None,
    margins: Margins | None = None,
    spacing: int | None = None,
) -> QHBoxLayout:
    """Put parts beside each other; in the widget ``of`` they become its layout."""
    return _filled(QHBoxLayout(), parts, of, margins, spacing)


def in_column(
    *parts: Part,
    of: QWidget | None = None,
    margins: Margins | None = None,
    spacing: int | None = None,
) -> QVBoxLayout:
    """Put parts below each other; in the widget ``of`` they become its layout."""
    return _filled(QVBoxLayout(), parts, of, margins, spacing)


Box = TypeVar("Box", bound=QBoxLayout)


def _filled(
    box: Box,
    parts: Sequence[Part],
    of: QWidget | None,
    margins: Margins | None,
    spacing: int | None,
) -> Box:
    if of is not None:
        of.setLayout(box)
    if margins is not None:
        box.setContentsMargins(*((margins,) * 4 if isinstance(margins, int) else margins))
    if spacing is not None:
        box.setSpacing(spacing)
    for part in parts:
        match part:
            case int():
                box.addStretch(part)
            case QWidget():
                box.addWidget(part)
            case QLayout():
                box.addLayout(part)
            case (QLayout() as inner, stretch):
                box.addLayout(inner, stretch)
            case (QWidget() as widget, stretch):
                box.addWidget(widget, stretch)
            case (widget, stretch, alignment):
                box.addWidget(widget, stretch, alignment)
    return box


class InLines(QWidget):
    """A widget whose size is told in lines of text, as its width and its height."""

    usual_lines: tuple[float, float]
    least_lines: tuple[float, float] = (0, 0)
    """Zeros where its layout knows better."""

    def sizeHint(self) -> QSize:
        """What it would like."""
        (wide, high), line = self.usual_lines, self.fontMetrics().height()
        return QSize(round(line * wide), round(line * high))

    def minimumSizeHint(self) -> QSize:
        """Less is of no use."""
        (wide, high), line = self.least_lines, self.fontMetrics().height()
        least = QSize(round(line * wide), round(line * high))
        return super().minimumSizeHint() if least.isNull() else least


Page = TypeVar("Page", bound=QWidget)


class LatePanel(InLines, Generic[Page]):
    """Makes its page when it is shown for the first time: what draws it is slow to load.

    ``made`` gives the page then.
    """

    made = Signal(object)

    def __init__(self, make: Callable[[], Page]) -> None:
        super().__init__()
        self._make = make
        self.page: Page | None = None
        self._box = in_column(of=self, margins=0)

    def opened(self) -> Page:
        """What is in it; made now if it is not there yet."""
        if self.page is None:
            self.page = self._make()
            self._box.addWidget(self.page)
            fit_icons(self.page)
            self.made.emit(self.page)  # before it is shown: who listens to it hears of all
            self.page.show()  # now: what is done with it next may need to see it
        return self.page

    def forget(self) -> None:
        """Let go of what is in it; it is made anew when it is shown again."""
        if self.page is not None:
            self.page.hide()
            self.page.deleteLater()
            self.page = None

    def showEvent(self, event: QShowEvent) -> None:
        """Open it."""
        self.opened()
        super().showEvent(event)


class Flow(QLayout):
    """Items beside each other, in the next row where there is no room for them."""

    def __init__(
        self, parent: QWidget | None = None, spacing: int = 6, widgets: Iterable[QWidget] = ()
    ) -> None:
        super().__init__(parent)
        self._items: list[QLayoutItem] = []
        self._heights: dict[int, int] = {}
        self.setContentsMargins(0, 0, 0, 0)
        self.setSpacing(spacing)
        for widget in widgets:
            self.addWidget(widget)

    def addWidget(self, widget: QWidget) -> None:
        """Take a widget, the last one.

        Its item is made here. One that Qt makes is known to Python by its place in memory, where
        another one was before: it would be taken for that, and be gone when that is thrown away.
        """
        self.addChildWidget(widget)
        self.addItem(QWidgetItem(widget))

    def addItem(self, item: QLayoutItem) -> None:
        """Take an item, the last one."""
        self._items.append(item)
        self.invalidate()

    def count(self) -> int:
        """How many items there are."""
        return len(self._items)

    def itemAt(self, index: int) -> QLayoutItem | None:
        """The item, or None."""
        return self._items[index] if 0 <= index < len(self._items) else None

    def takeAt(self, index: int) -> QLayoutItem | None:
        """Take an item out."""
        return self._items.pop(index) if 0 <= index < len(self._items) else None

    def expandingDirections(self) -> Qt.Orientation:
        """It wants no more room than its items."""
        return Qt.Orientation(0)

    def hasHeightForWidth(self) -> bool:
        """A narrow one is high."""
        return True

    def heightForWidth(self, width: int) -> int:
        """How high it is when it is so wide."""
        if width not in self._heights:  # it is asked for again and again
            self._heights[width] = self._place(QRect(0, 0, width, 0), is_real=False)
        return self._heights[width]

    def invalidate(self) -> None:
        """Measure again: something in it has changed."""
        self._heights.clear()
        super().invalidate()

    def setGeometry(self, rect: QRect) -> None:
        """Put the items in their places."""
        super().setGeometry(rect)
        self._place(rect, is_real=True)

    def sizeHint(self) -> QSize:
        """All items in one row."""
        sizes = [item.sizeHint() for item in self._items if not item.isEmpty()]
        wide = sum(size.width() for size in sizes) + self.spacing() * max(0, len(sizes) - 1)
        return QSize(wide, max((size.height() for size in sizes), default=0))

    def minimumSize(self) -> QSize:
        """The widest item alone."""
        sizes = [item.minimumSize() for item in self._items if not item.isEmpty()]
        return QSize(
            max((size.width() for size in sizes), default=0),
            max((size.height() for size in sizes), default=0),
        )

    def _place(self, room: QRect, *, is_real: bool) -> int:
        """Go through the rows; gives how high they are together."""
        owner = self.parentWidget()
        direction = owner.layoutDirection() if owner else Qt.LayoutDirection.LeftToRight
        x, y, row = room.x(), room.y(), 0
        for item in self._items:
            if item.isEmpty():
                continue
            size = item.sizeHint()
            size.setWidth(min(size.width(), max(room.width(), item.minimumSize().width())))
            if item.hasHeightForWidth():
                size.setHeight(item.heightForWidth(size.width()))
            if x > room.x() and x + size.width() > room.right() + 1:
                x, y, row = room.x(), y + row + self.spacing(), 0
            if is_real:
                place = QRect(QPoint(x, y), size)
                item.setGeometry(QStyle.visualRect(direction, room, place))
            x += size.width() + self.spacing()
            row = max(row, size.height())
        return y + row - room.y()


class ReadingLabel(QLabel):
    """Begins at its side of the window, whatever letters its words begin with."""

    def __init__(self, words: str = "", parent: QWidget | None = None) -> None:
        super().__init__(words, parent)
        self._begin()

    def changeEvent(self, event: QEvent) -> None:
        """Go to the other side with the window."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.LayoutDirectionChange:
            self._begin()

    def _begin(self) -> None:
        flags = Qt.AlignmentFlag
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        side = flags.AlignRight | flags.AlignAbsolute if is_mirrored else flags.AlignLeft
        self.setAlignment(side | flags.AlignVCenter)


# Widgets beside each other, in as many rows as they need.


class FlowLayout(Flow):
    """Asks for no more width than its widest widget: a panel may be narrow."""

    sizeHint = Flow.minimumSize  # noqa: N815 - as Qt calls it


# Puts widgets below each other, in as many columns as there is room for.

COLUMN_LINES = 17
"""A column is at least so wide, in lines of text."""
MOST_COLUMNS = 5


class Columns(QWidget):
    """Keeps the widgets in their order: down the first column, then down the next.

    Each column is a widget: a layout within a layout is not told that something has grown.
    """

    def __init__(self, widgets: Sequence[QWidget], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._widgets = list(widgets)
        self.count = 0
        line = self.fontMetrics().height()
        self._holders = [QWidget(self) for _ in range(MOST_COLUMNS)]
        self._columns = [in_column(of=one, margins=0, spacing=line // 4) for one in self._holders]
        in_row(*((holder, 1) for holder in self._holders), of=self, margins=0, spacing=line)
        self.spread(1)

    def spread(self, count: int) -> None:
        """Use so many columns, about equally high."""
        if count == self.count:
            return
        self.count = count
        for column in self._columns:
            while column.count():
                column.takeAt(0)
        left = sum(widget.sizeHint().height() for widget in self._widgets)
        number, filled = 0, 0
        for widget in self._widgets:
            height = widget.sizeHint().height()
            if filled and filled + height / 2 > left / (count - number) and number < count - 1:
                left, filled, number = left - filled, 0, number + 1
            self._columns[number].addWidget(widget)
            filled += height
        for number, column in enumerate(self._columns):
            column.addStretch(1)
            self._holders[number].setVisible(number < count)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Use the room that there is."""
        super().resizeEvent(event)
        line = self.fontMetrics().height()
        fitting = event.size().width() // (COLUMN_LINES * line)
        self.spread(min(max(fitting, 1), MOST_COLUMNS, len(self._widgets)))


# Two parts beside each other where there is room, else one below the other.


class Halves(QWidget):
    """``first`` and ``second`` are columns; ``wide_lines`` is the width, in lines of text, from
    which on they are beside each other.
    """

    def __init__(self, wide_lines: float, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._wide_lines = wide_lines
        self._box = QBoxLayout(QBoxLayout.Direction.TopToBottom, self)
        self._box.setContentsMargins(0, 0, 0, 0)
        self.first, self.second = self._column(), self._column()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put them where there is room."""
        super().resizeEvent(event)
        line = self.fontMetrics().height()
        has_room = self.width() >= self._wide_lines * line
        down, beside = QBoxLayout.Direction.TopToBottom, QBoxLayout.Direction.LeftToRight
        if has_room != (self._box.direction() != QBoxLayout.Direction.TopToBottom):
            self._box.setDirection(beside if has_room else down)
            self._box.setSpacing(line if has_room else -1)

    def add(self, *widgets: QWidget) -> None:
        """Add widgets to the first column."""
        for widget in widgets:
            self.first.addWidget(widget)

    def add_beside(self, *widgets: QWidget) -> None:
        """Add widgets to the second column."""
        for widget in widgets:
            self.second.addWidget(widget)

    def _column(self) -> QVBoxLayout:
        holder = QWidget()
        column = in_column(of=holder, margins=0)
        column.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._box.addWidget(holder, 1)
        return column


# Pages that scroll when there is no room for all of them.


def scrolled(page: QWidget) -> QScrollArea:
    """Put a page into an area that scrolls up and down."""
    area = QScrollArea(widgetResizable=True)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setWidget(page)
    return area


def show_top(area: QScrollArea, shown: QWidget) -> None:
    """Scroll so far that something is seen, of what is too high its beginning."""
    page = area.widget()
    if page is None or not page.isAncestorOf(shown):
        return
    room = area.viewport().height()
    top = shown.mapTo(page, shown.rect().topLeft()).y()
    bar, margin = area.verticalScrollBar(), area.fontMetrics().height() // 2
    bottom = top + shown.height()
    if top < bar.value() or bottom > bar.value() + room:
        is_too_high = shown.height() + margin > room
        bar.setValue(top - margin if is_too_high else bottom + margin - room)

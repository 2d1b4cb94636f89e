"""The legend: which line is what, which are shown, their newest values or what was measured."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QEvent, QSortFilterProxyModel, Qt, QTimer, Signal
from PySide6.QtGui import QFontMetricsF, QHideEvent, QShowEvent, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QLineEdit,
    QPushButton,
    QTreeView,
    QTreeWidget,
    QTreeWidgetItem,
    QWidget,
)

from nep_core.wire.messages import IMU
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.network_feed import NetworkFeed, Seen
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import is_right_to_left, tr

from .curves import Curve, CurveKey, icon_size
from .feed import Field, SensorFeed, numbers_in
from .measuring import measure
from .plots import Plots
from .streams import Samples

_REFRESH_MS = 250
_NOTHING, _MINUS = "\N{EN DASH}", "\N{MINUS SIGN}"
_LEFT_TO_RIGHT = "\N{LEFT-TO-RIGHT MARK}"
"""Before a number, so that its sign stays before it."""


class CurveList(QTreeWidget):
    """Lists the curves of the plots; a box before each shows and hides it.

    ``measured`` gives the words for the time between the cursors, "" without cursors.
    """

    measured = Signal(str)

    def __init__(self, plots: Plots, look: Look) -> None:
        super().__init__()
        self._plots, self._look = plots, look
        self._items: dict[CurveKey, QTreeWidgetItem] = {}
        self.setRootIsDecorated(False)
        self.setIndentation(0)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        labelled(self, name="Curves")
        self.header().setStretchLastSection(False)
        self.itemChanged.connect(self._on_item_changed)
        self._timer = QTimer(self, interval=_REFRESH_MS)
        self._timer.timeout.connect(self.refresh)
        plots.rows_changed.connect(self.fill)
        plots.cursors_changed.connect(self.refresh)
        plots.view_changed.connect(self.refresh)
        look.theme_changed.connect(self.fill)
        follow_words(self, self.fill)

    def fill(self) -> None:
        """List the curves that there are."""
        self.blockSignals(True)
        self.clear()
        self._items.clear()
        metrics = QFontMetricsF(self.font())
        self.setIconSize(icon_size(metrics))
        for row in self._plots.rows:
            heading = QTreeWidgetItem(self, [f"{row.row.heading}, {row.row.source}"])
            heading.setFirstColumnSpanned(True)
            heading.setFlags(Qt.ItemFlag.ItemIsEnabled)
            heading.setToolTip(0, plain_tip(heading.text(0)))
            for curve in row.row.curves:
                self._items[curve.key] = self._item(heading, curve, metrics)
        self.expandAll()
        self.blockSignals(False)
        self._size_columns()
        self.refresh()

    def refresh(self) -> None:
        """Show the newest values, or what is between the cursors."""
        self._set_columns(self._titles())
        if not self.isVisible():
            return
        self.blockSignals(True)
        samples: dict[object, Samples] = {}
        for key, item in self._items.items():
            if key.stream not in samples:
                samples[key.stream] = self._samples(key)
            for column, words in enumerate(self._values(samples[key.stream], key), start=1):
                if item.text(column) != words:
                    item.setText(column, words)
        self.blockSignals(False)
        self.measured.emit(self._between())

    def _samples(self, key: CurveKey) -> Samples:
        if key.stream in self._plots.feed.streams and not self._plots.cursors:
            return self._plots.feed.streams[key.stream].samples(1)
        return self._plots.samples(key.stream)

    def _values(self, samples: Samples, key: CurveKey) -> list[str]:
        if not self._plots.cursors:
            return [_shown(float(samples.values[key.channel][-1]) if len(samples.t) else None)]
        one = measure(samples.t, samples.values[key.channel], *self._plots.cursors[:2])
        frequency = f"{_shown(one.frequency_hz)} Hz" if one.frequency_hz else _NOTHING
        numbers = (one.first, one.last, one.change, one.least, one.greatest, one.mean)
        return [*map(_shown, numbers), frequency]

    def _between(self) -> str:
        if len(self._plots.cursors) < 2:
            return ""
        seconds = self._plots.cursors[1] - self._plots.cursors[0]
        often = f" ({_shown(1 / abs(seconds))} Hz)" if seconds else ""
        return tr("From A to B: {seconds} s", seconds=_shown(seconds)) + often

    def _titles(self) -> list[str]:
        if not self._plots.cursors:
            return [tr("Curve"), tr("Now")]
        found = (tr("Difference"), tr("Least"), tr("Greatest"), tr("Mean"), tr("Frequency"))
        return [tr("Curve"), "A", "B", *found]

    def _set_columns(self, titles: list[str]) -> None:
        if titles == [self.headerItem().text(at) for at in range(self.columnCount())]:
            return
        self.setColumnCount(len(titles))
        self.setHeaderLabels(titles)
        for at in range(len(titles)):
            self.headerItem().setTextAlignment(at, _side(at))
        self._size_columns()

    def _size_columns(self) -> None:
        metrics = QFontMetricsF(self.font())
        # Room for box, line and name of every curve; the headings go over all columns
        names = [curve.name for curve in self._plots.curves.values()]
        widest = max((metrics.horizontalAdvance(name) for name in names), default=0.0)
        self.setColumnWidth(0, round(widest + self.iconSize().width() + 3 * metrics.height()))
        for at in range(1, self.columnCount()):
            title = self.headerItem().text(at)
            words = max(metrics.horizontalAdvance(title), metrics.horizontalAdvance("-0.0000000"))
            self.setColumnWidth(at, round(words + metrics.height() * 1.6))

    def _item(
        self, heading: QTreeWidgetItem, curve: Curve, metrics: QFontMetricsF
    ) -> QTreeWidgetItem:
        item = QTreeWidgetItem(heading, [curve.name])
        item.setData(0, Qt.ItemDataRole.UserRole, curve.key)
        item.setIcon(0, curve.look.icon(self._look.theme, metrics, self.devicePixelRatioF()))
        is_hidden = curve.key in self._plots.hidden
        item.setCheckState(0, Qt.CheckState.Unchecked if is_hidden else Qt.CheckState.Checked)
        for column in range(1, 8):
            item.setTextAlignment(column, _side(column))
        return item

    def _on_item_changed(self, item: QTreeWidgetItem, column: int) -> None:
        key = item.data(0, Qt.ItemDataRole.UserRole)
        if isinstance(key, CurveKey) and column == 0:
            self._plots.set_hidden(key, item.checkState(0) == Qt.CheckState.Unchecked)

    def showEvent(self, event: QShowEvent) -> None:
        """Follow the values."""
        super().showEvent(event)
        self._timer.start()
        self.refresh()

    def hideEvent(self, event: QHideEvent) -> None:
        """Do nothing while nobody looks."""
        super().hideEvent(event)
        self._timer.stop()

    def changeEvent(self, event: QEvent) -> None:
        """Take another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.fill()


def _side(column: int) -> Qt.AlignmentFlag:
    side = Qt.AlignmentFlag.AlignRight if column else Qt.AlignmentFlag.AlignLeading
    return side | Qt.AlignmentFlag.AlignVCenter


def _shown(value: float | None) -> str:
    if value is None or value != value:
        return _NOTHING
    side = _LEFT_TO_RIGHT if is_right_to_left() else ""
    return side + f"{value:.4g}".replace("-", _MINUS)


# Lets a person choose which numbers of which topics are plotted.

_FIELD = int(Qt.ItemDataRole.UserRole)
_WIDTH_LINES, _HEIGHT_LINES = 28, 22


class FieldChooser(QDialog):
    """All topics with numbers in their last message; a box before each number plots it."""

    chosen = Signal()

    def __init__(self, feed: SensorFeed, network: NetworkFeed, parent: QWidget) -> None:
        super().__init__(parent)
        self._feed, self._network = feed, network
        self._items: dict[Field, QStandardItem] = {}
        self._topics: dict[str, QStandardItem] = {}
        labelled(self, window_title="Choose what is plotted")
        self.search = labelled(QLineEdit(clearButtonEnabled=True), placeholder="Find a number")
        self.hint = hint("Numbers appear here as soon as a node sends some.")
        self.model = QStandardItemModel(0, 2, self)
        follow_words(self, self._name_columns)
        self.model.itemChanged.connect(self._on_item_changed)
        self._found = QSortFilterProxyModel(self)
        self._found.setSourceModel(self.model)
        self._found.setRecursiveFilteringEnabled(True)
        self._found.setAutoAcceptChildRows(True)
        self._found.setFilterCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        self.search.textChanged.connect(self._on_search_changed)
        self.tree = QTreeView(uniformRowHeights=True)
        self.tree.setModel(self._found)
        self.tree.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        labelled(self.tree, name="Numbers that nodes send")
        buttons = QDialogButtonBox()
        close = labelled(QPushButton(), text="Close")
        close.clicked.connect(self.accept)
        buttons.addButton(close, QDialogButtonBox.ButtonRole.AcceptRole)
        in_column(self.search, self.hint, self.tree, buttons, of=self)
        line = self.fontMetrics().height()
        self.resize(line * _WIDTH_LINES, line * _HEIGHT_LINES)
        network.changed.connect(self._on_changed)

    def _name_columns(self) -> None:
        self.model.setHorizontalHeaderLabels([tr("Number"), tr("Last value")])

    def show_topic(self, topic: str) -> None:
        """Show the numbers of one topic."""
        self.search.setText(topic)

    def show_messages(self, messages: Mapping[str, Any]) -> None:
        """List the numbers in the last messages of topics."""
        is_new = False
        for topic in sorted(messages):
            numbers = {} if topic == IMU else numbers_in(messages[topic])
            for path, value in numbers.items():
                is_new |= self._show(Field(topic, path), value)
        self.hint.setVisible(not self._items)
        if is_new:
            self.tree.expandAll()
            self.tree.resizeColumnToContents(0)

    def _show(self, field: Field, value: float) -> bool:
        """Show one number; whether it was not there before."""
        is_new = field not in self._items
        if is_new:
            self._items[field] = self._added(field)
        item, words = self._items[field], f"{value:.6g}"
        shown = item.parent().child(item.row(), 1)
        if shown.text() != words:
            shown.setText(words)
        return is_new

    def _added(self, field: Field) -> QStandardItem:
        item = QStandardItem(field.path)
        item.setCheckable(True)
        is_plotted = field in self._feed.fields
        item.setCheckState(Qt.CheckState.Checked if is_plotted else Qt.CheckState.Unchecked)
        item.setData(field, _FIELD)
        topic = self._topics.get(field.topic)
        if topic is None:
            topic = self._topics[field.topic] = QStandardItem(field.topic)
            self.model.appendRow([topic, QStandardItem()])
        topic.appendRow([item, QStandardItem()])
        return item

    def _on_item_changed(self, item: QStandardItem) -> None:
        field = item.data(_FIELD)
        if not isinstance(field, Field):
            return
        is_wanted = item.checkState() == Qt.CheckState.Checked
        if is_wanted and field not in self._feed.fields:
            self._feed.plot(field)
            self.chosen.emit()
        elif not is_wanted:
            self._feed.leave(field)

    def _on_search_changed(self, words: str) -> None:
        self._found.setFilterFixedString(words)
        self.tree.expandAll()

    def _on_changed(self, seen: Seen) -> None:
        if self.isVisible():
            heard = {name: one.last for name, one in seen.topics.items() if one.last is not None}
            self.show_messages(heard)

    def showEvent(self, event: QShowEvent) -> None:
        """Look at the network."""
        super().showEvent(event)
        self._network.watch(self)
        self._on_changed(self._network.seen)

    def hideEvent(self, event: QHideEvent) -> None:
        """Look no more."""
        super().hideEvent(event)
        self._network.unwatch(self)

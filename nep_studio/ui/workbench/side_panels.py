"""The areas around the canvas, and the panels in them that a person shows and hides."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Literal

from PySide6.QtCore import QObject, QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QAction, QResizeEvent
from PySide6.QtWidgets import QSplitter, QTabWidget, QToolButton, QWidget

from faults import Words
from nep_studio.settings import Settings
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

AreaName = Literal["left", "right", "bottom"]


@dataclass
class Panel:
    """A widget beside the canvas, and the action that shows and hides it."""

    widget: QWidget
    title: Words
    icon_name: str
    area: Area
    action: QAction
    is_usual: bool
    """Whether it is shown as long as nobody has shown or hidden it."""
    name: str
    """What it is called in the settings."""


class Area(QTabWidget):
    """Panels on top of each other; an area without a shown panel takes no room."""

    close_asked = Signal(QWidget)

    def __init__(self, name: AreaName, look: Look) -> None:
        super().__init__()
        self._look = look
        self._is_wide = name == "bottom"
        self._titles: dict[QWidget, Words] = {}
        self.setDocumentMode(True)
        self.setUsesScrollButtons(True)
        self.setTabBarAutoHide(name == "left")
        self.close_button = QToolButton(self)  # without a parent it would keep this area for ever
        self.close_button.setVisible(name != "left")
        labelled(self.close_button, tip="Hide this panel", name="Hide this panel")
        self.close_button.clicked.connect(lambda: self.close_asked.emit(self.currentWidget()))
        if name != "left":
            self.setCornerWidget(self.close_button, Qt.Corner.TopRightCorner)
        self.currentChanged.connect(self._on_current_changed)
        follow_words(self, self._say_titles)
        self.hide()

    def add_panel(self, widget: QWidget, title: Words) -> None:
        """Add a tab."""
        self._titles[widget] = title
        self.addTab(widget, "")
        self._say_titles()

    def _say_titles(self) -> None:
        for widget, title in self._titles.items():
            self.setTabToolTip(self.indexOf(widget), tr(title))
            self.tabBar().setAccessibleTabName(self.indexOf(widget), tr(title))
        self._fit_titles()

    def minimumSizeHint(self) -> QSize:
        """Room for the panel on top: larger ones below must not make the window wider or higher.

        At the side an area keeps its width, whichever panel is on top.
        """
        panel, tabs = self.currentWidget(), self.tabBar().minimumSizeHint()
        if panel is None:
            return super().minimumSizeHint()
        least = panel.minimumSizeHint().expandedTo(panel.minimumSize())
        across = max(least.width(), tabs.width() + self.close_button.sizeHint().width())
        above = tabs.height() if self.tabBar().isVisibleTo(self) else 0
        height = above + least.height()
        return QSize(across if self._is_wide else super().minimumSizeHint().width(), height)

    def tabs_width(self) -> int:
        """How wide it must be to show its tabs, one of them with its title."""
        return self.tabBar().sizeHint().width() + self.close_button.sizeHint().width()

    def _fit_titles(self) -> None:
        """Show all titles where there is room, else the one on top: the others have their signs."""
        bar, metrics, room = self.tabBar(), self.fontMetrics(), 0
        for widget, title in self._titles.items():  # how wide each tab is with its title
            index = self.indexOf(widget)
            if self.isTabVisible(index):
                shown = bar.tabText(index)
                more = metrics.horizontalAdvance(tr(title)) - metrics.horizontalAdvance(shown)
                room += bar.tabRect(index).width() + more + (0 if shown else metrics.height())
        is_narrow = room > self.width() - self.close_button.sizeHint().width()
        for widget, title in self._titles.items():
            is_short = is_narrow and widget is not self.currentWidget()
            words = "" if is_short else tr(title)
            if self.tabText(self.indexOf(widget)) != words:
                self.setTabText(self.indexOf(widget), words)

    def _on_current_changed(self) -> None:
        self._fit_titles()
        self.updateGeometry()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Give the titles the room that there is."""
        super().resizeEvent(event)
        self._fit_titles()

    def show_panel(self, widget: QWidget, is_shown: bool) -> None:
        """Show or hide a panel, and with the last one the area."""
        index = self.indexOf(widget)
        self.setTabVisible(index, is_shown)
        if is_shown:
            self.setCurrentIndex(index)
        self._fit_titles()
        self.setVisible(any(self.isTabVisible(i) for i in range(self.count())))

    def show_first(self) -> None:
        """Let the first of the panels that are shown be on top."""
        shown = [index for index in range(self.count()) if self.isTabVisible(index)]
        self.setCurrentIndex(shown[0] if shown else 0)


class Panels(QObject):
    """All panels of one window, around ``middle``."""

    def __init__(self, middle: QWidget, look: Look, settings: Settings, parent: QWidget) -> None:
        super().__init__(parent)
        self._look, self._settings = look, settings
        self.all: list[Panel] = []
        self.areas: dict[AreaName, Area] = {
            "left": Area("left", look),
            "right": Area("right", look),
            "bottom": Area("bottom", look),
        }
        self.column = QSplitter(Qt.Orientation.Vertical)
        self.row = QSplitter(Qt.Orientation.Horizontal)
        # the outer ones first: a widget is dressed anew in each parent
        in_column(self.row, of=parent, margins=0)
        for beside in (self.areas["left"], self.column, self.areas["right"]):
            self.row.addWidget(beside)
        for widget in (middle, self.areas["bottom"]):
            self.column.addWidget(widget)
        for splitter, stretched in ((self.column, 0), (self.row, 1)):
            splitter.setChildrenCollapsible(False)
            splitter.setStretchFactor(stretched, 1)
        for area in self.areas.values():
            area.close_asked.connect(self._on_close_asked)
        look.theme_changed.connect(self._on_theme_changed)

    def add(
        self,
        widget: QWidget,
        title: Words,
        icon_name: str,
        area: AreaName,
        *,
        is_shown: bool = True,
    ) -> Panel:
        """Add a panel; whether it is shown is as the person left it, else as it is said."""
        place = self.areas[area]
        place.add_panel(widget, title)
        action = labelled(QAction(self, checkable=True), text=title)
        panel = Panel(widget, title, icon_name, place, action, is_shown, type(widget).__name__)
        self.all.append(panel)
        action.setChecked(self._settings.is_shown(panel.name, default=is_shown))
        place.show_panel(widget, action.isChecked())
        place.show_first()
        action.toggled.connect(partial(self._on_toggled, panel))
        self._dress(panel)
        return panel

    def show(self, widget: QWidget) -> None:
        """Show a panel, on top of the others of its area."""
        for panel in self.all:
            if panel.widget is widget:
                panel.action.setChecked(True)
                panel.area.setCurrentWidget(widget)

    def give_room(self, panel: Panel, share: float) -> None:
        """Let a panel of the bottom have at least this share of the height when it is opened."""

        def grow(is_on: bool) -> None:
            above, below = self.column.sizes()
            wanted = round((above + below) * share)
            if is_on and below < wanted:
                self.column.setSizes([above + below - wanted, wanted])

        panel.action.toggled.connect(grow)

    def hide_at_first(self, area: AreaName) -> None:
        """Hide the panels of an area that the person has not shown or hidden yet."""
        for panel in self.all:
            if panel.area is self.areas[area] and not self._settings.is_chosen(panel.name):
                self._set_shown(panel, False)

    def show_usual(self) -> None:
        """Show the panels that are shown as long as nobody has chosen."""
        for panel in self.all:
            self._set_shown(panel, panel.is_usual)
        for area in self.areas.values():
            area.show_first()

    def _set_shown(self, panel: Panel, is_shown: bool) -> None:
        with QSignalBlocker(panel.action):  # this is not the person's choice
            panel.action.setChecked(is_shown)
        panel.area.show_panel(panel.widget, is_shown)

    def restore(self, line: int) -> None:
        """Give the areas the sizes that they had, or good ones; ``line`` is a line of text."""
        if not self.row.restoreState(self._settings.state("row")):
            width = self.row.window().width()  # it may not have been shown yet
            left = min(self.areas["left"].sizeHint().width(), width * 36 // 100)
            right = max(min(line * 16, width * 21 // 100), self.areas["right"].tabs_width())
            right = min(right, width * 30 // 100)
            self.row.setSizes([left, width - left - right, right])
        if not self.column.restoreState(self._settings.state("column")):
            height = self.row.window().height()
            self.column.setSizes([height - line * 9, line * 9])

    def widen(self, area: AreaName, width: int) -> None:
        """Make an area at the side so wide, or so narrow; the middle takes or gives the room."""
        place, sizes = self.row.indexOf(self.areas[area]), self.row.sizes()
        middle = self.row.indexOf(self.column)
        sizes[middle] += sizes[place] - width
        sizes[place] = width
        self.row.setSizes(sizes)

    def remember(self) -> None:
        """Note the sizes in the settings."""
        self._settings.set_state("row", self.row.saveState())
        self._settings.set_state("column", self.column.saveState())

    def _on_toggled(self, panel: Panel, is_on: bool) -> None:
        panel.area.show_panel(panel.widget, is_on)
        self._settings.set_shown(panel.name, is_on)

    def _on_close_asked(self, widget: QWidget) -> None:
        for panel in self.all:
            if panel.widget is widget:
                panel.action.setChecked(False)

    def _on_theme_changed(self) -> None:
        for panel in self.all:
            self._dress(panel)

    def _dress(self, panel: Panel) -> None:
        theme = self._look.theme
        panel.action.setIcon(icon(panel.icon_name, theme))
        panel.area.setTabIcon(panel.area.indexOf(panel.widget), icon(panel.icon_name, theme))
        panel.area.close_button.setIcon(icon("x", theme))

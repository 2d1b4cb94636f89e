"""The rooms of the window: what stands around the canvas, and the pages that take its place."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Literal, Protocol

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, QSize, Qt, Signal, SignalInstance
from PySide6.QtGui import QAction, QIcon, QResizeEvent
from PySide6.QtWidgets import QSplitter, QStackedWidget, QTabWidget, QToolButton, QWidget

from faults import Words
from nep_studio.settings import Settings
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

AreaName = Literal["left", "right", "bottom", "stage", "person", "page"]
"""Where a panel stands: the ``stage`` is at the far side of the canvas at all times, the ``person``
under it, ``right`` between the canvas and them. A ``page`` takes the place of the canvas."""


@dataclass
class Panel:
    """A widget beside the canvas, and the action that shows and hides it."""

    widget: QWidget
    title: Words
    icon_name: str
    area: Area | Rooms
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
        self._is_back = False
        self._titles: dict[QWidget, Words] = {}
        self.setDocumentMode(True)
        self.setUsesScrollButtons(True)
        self.setTabBarAutoHide(name == "left")
        # a hidden row of tabs would keep the Tab key for ever
        self.setFocusProxy(None)  # type: ignore[arg-type]  # none, which PySide6's types forget
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        labelled(self.tabBar(), name="Panels")
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
        self._show_if_wanted()

    def stand_back(self, is_back: bool) -> None:
        """Take no room for a while, whatever is shown here."""
        self._is_back = is_back
        self._show_if_wanted()

    def _show_if_wanted(self) -> None:
        is_wanted = any(self.isTabVisible(index) for index in range(self.count()))
        self.setVisible(is_wanted and not self._is_back)

    def dress(self, widget: QWidget, sign: QIcon, theme: Theme) -> None:
        """Take the signs of a theme."""
        self.setTabIcon(self.indexOf(widget), sign)
        self.close_button.setIcon(icon("x", theme))

    def show_first(self) -> None:
        """Let the first of the panels that are shown be on top."""
        shown = [index for index in range(self.count()) if self.isTabVisible(index)]
        self.setCurrentIndex(shown[0] if shown else 0)


class OwnHistory(Protocol):
    """What undo and redo of the window mean while a page is shown that has steps of its own."""

    history_changed: SignalInstance

    @property
    def undo_label(self) -> str:
        """What undo would take back, "" for nothing."""

    @property
    def redo_label(self) -> str:
        """What redo would do again, "" for nothing."""

    def undo(self) -> None:
        """Take the last step back."""

    def redo(self) -> None:
        """Do again what was taken back."""


class Rooms(QStackedWidget):
    """The canvas, or the panel that takes its place; ``changed`` tells which there are and what
    is on top. Those that are open have a tab beside the pages of the project.
    """

    changed = Signal()
    open_asked = Signal(QWidget)
    close_asked = Signal(QWidget)

    def __init__(self, canvas: QWidget) -> None:
        super().__init__()
        self.titles: dict[QWidget, Words] = {}
        """Of all rooms, in the order of their tabs."""
        self.signs: dict[QWidget, QIcon] = {}
        self.open: list[QWidget] = []
        self.histories: dict[QWidget, OwnHistory] = {}
        """Of those rooms in which undo means something else than in the project."""
        self.with_own_robot: set[QWidget] = set()
        """Those that show a robot themselves: two beside each other would be one too many."""
        self.addWidget(canvas)
        self.currentChanged.connect(self.changed)

    @property
    def shown(self) -> QWidget | None:
        """The room that is on top; None while that is the canvas."""
        return self.currentWidget() if self.currentIndex() else None

    @property
    def history(self) -> OwnHistory | None:
        """What undo means in the room that is shown, if that is something of its own."""
        shown = self.shown
        return None if shown is None else self.histories.get(shown)

    def add_panel(self, widget: QWidget, title: Words) -> None:
        """Add a room, behind the others."""
        self.titles[widget] = title
        self.addWidget(widget)

    def show_panel(self, widget: QWidget, is_shown: bool) -> None:
        """Give a room its tab and show it; or take both away."""
        before = list(self.open)
        if is_shown and widget not in self.open:
            self.open = [one for one in self.titles if one in (*self.open, widget)]
        elif not is_shown and widget in self.open:
            self.open.remove(widget)
        if is_shown:
            self.setCurrentWidget(widget)
        elif self.currentWidget() is widget:
            self.show_canvas()
        if self.open != before:
            self.changed.emit()

    def show_first(self) -> None:
        """Show the canvas."""
        self.show_canvas()

    def show_canvas(self) -> None:
        """Show the canvas; the rooms keep their tabs."""
        self.setCurrentIndex(0)

    def dress(self, widget: QWidget, sign: QIcon, _theme: Theme) -> None:
        """Take the sign of a theme."""
        self.signs[widget] = sign
        if widget in self.open:
            self.changed.emit()

    def minimumSizeHint(self) -> QSize:
        """Room for what is on top: a larger one below must not make the window larger."""
        shown = self.currentWidget()
        if shown is None:
            return super().minimumSizeHint()
        return shown.minimumSizeHint().expandedTo(shown.minimumSize())


WIDEST = 16777215  # Qt's own

CANVAS_SHARE = 0.56
"""So much of the window's width the canvas has at least, as long as nobody moved a border."""

STAGE_SHARE, WIDEST_STAGE = 0.21, 34
"""How much of the width the stage has, and how many lines of text it is wide at most."""

LEAST_STAGE = 12
"""So many lines of text it is wide as long as that takes nothing of the share of the canvas."""

PERSON_SHARE = 0.38
"""How much of the height beside the canvas the person has when somebody looks at it."""

BELOW_SHARE, LEAST_BELOW = 0.28, 9
"""How much of the height panels below the canvas have, and how many lines of text at least: from
a window of the usual size on, a card of What runs is seen whole."""


class Panels(QObject):
    """All panels of one window: around ``middle``, and the ``rooms`` in it."""

    def __init__(
        self, middle: QWidget, rooms: Rooms, look: Look, settings: Settings, parent: QWidget
    ) -> None:
        super().__init__(parent)
        self._look, self._settings, self.rooms = look, settings, rooms
        self.all: list[Panel] = []
        sides: tuple[AreaName, ...] = ("left", "right", "bottom", "stage", "person")
        self.areas = {name: Area(name, look) for name in sides}
        self.column = QSplitter(Qt.Orientation.Vertical)
        self.stage = QSplitter(Qt.Orientation.Vertical)
        self.row = QSplitter(Qt.Orientation.Horizontal)
        self._is_arranged = False
        """Whether somebody has moved a border of the row: then it is left as it is."""
        self._is_closing = False
        # the outer ones first: a widget is dressed anew in each parent
        in_column(self.row, of=parent, margins=0)
        for beside in (self.areas["left"], self.column, self.areas["right"], self.stage):
            self.row.addWidget(beside)
        for splitter, parts in (
            (self.column, (middle, self.areas["bottom"])),
            (self.stage, (self.areas["stage"], self.areas["person"])),
        ):
            for widget in parts:
                splitter.addWidget(widget)
        for splitter, stretched in ((self.column, 0), (self.row, 1), (self.stage, 0)):
            splitter.setChildrenCollapsible(False)
            splitter.setStretchFactor(stretched, 1)
        self.row.splitterMoved.connect(self._on_row_moved)
        self.row.installEventFilter(self)
        self.stage.hide()
        for place in self._places():
            place.close_asked.connect(self._on_close_asked)
        rooms.open_asked.connect(self._on_open_asked)
        rooms.changed.connect(self._on_rooms_changed)
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
        place = self.rooms if area == "page" else self.areas[area]
        place.add_panel(widget, title)
        # a picture would stand where the tick does
        action = labelled(QAction(self, checkable=True, iconVisibleInMenu=False), text=title)
        panel = Panel(widget, title, icon_name, place, action, is_shown, type(widget).__name__)
        self.all.append(panel)
        action.setChecked(self._settings.is_shown(panel.name, default=is_shown))
        place.show_panel(widget, action.isChecked())
        place.show_first()
        action.toggled.connect(partial(self._on_toggled, panel))
        self._dress(panel)
        self._show_stage()
        return panel

    def show(self, widget: QWidget) -> None:
        """Show a panel, on top of the others of its area."""
        for panel in self.all:
            if panel.widget is widget:
                panel.action.setChecked(True)
                panel.area.setCurrentWidget(widget)
                if isinstance(panel.area, Area):
                    panel.area.stand_back(False)
                    self._show_stage()
                    self._share_width()

    def show_usual(self) -> None:
        """Show the panels that are shown as long as nobody has chosen."""
        for panel in self.all:
            with QSignalBlocker(panel.action):  # this is not the person's choice
                panel.action.setChecked(panel.is_usual)
            panel.area.show_panel(panel.widget, panel.is_usual)
        for place in self._places():
            place.show_first()
        self._show_stage()

    def restore(self, line: int) -> None:
        """Give the areas the sizes that they had, or good ones; ``line`` is a line of text."""
        self._is_arranged = self.row.restoreState(self._settings.state("row"))
        self._share_width()
        height = self.row.window().height()  # it may not have been shown yet
        if not self.column.restoreState(self._settings.state("column")):
            below = max(round(height * BELOW_SHARE), line * LEAST_BELOW)
            self.column.setSizes([height - below, below])
        if not self.stage.restoreState(self._settings.state("stage")):
            below = round(height * PERSON_SHARE)
            self.stage.setSizes([height - below, below])

    def remember(self) -> None:
        """Note the sizes in the settings."""
        if self._is_arranged:
            self._settings.set_state("row", self.row.saveState())
        self._settings.set_state("column", self.column.saveState())
        self._settings.set_state("stage", self.stage.saveState())

    def give_left(self, width: int, *, is_fixed: bool) -> None:
        """Let the area at the left be so wide, and no wider if it ``is_fixed``.

        What it does not need goes to the canvas, and comes from there.
        """
        area, sizes = self.areas["left"], self.row.sizes()
        area.setMaximumWidth(width if is_fixed else WIDEST)
        if self._is_arranged and sizes[0]:
            self.row.setSizes([width, sizes[1] + sizes[0] - width, *sizes[2:]])
        else:
            self._share_width()

    def _places(self) -> list[Area | Rooms]:
        return [*self.areas.values(), self.rooms]

    def _share_width(self) -> None:
        """Share the width anew, unless somebody has chosen: the canvas keeps the larger part."""
        if self._is_arranged:
            return
        area, line = self.areas["left"], self.row.fontMetrics().height()
        whole = self.row.width() if self.row.isVisible() else self.row.window().width()
        rest = whole - round(whole * CANVAS_SHARE)
        wanted = 0 if area.isHidden() else min(area.sizeHint().width(), area.maximumWidth())
        stage = max(round(whole * STAGE_SHARE), min(rest - wanted, line * LEAST_STAGE))
        stage = 0 if self.stage.isHidden() else min(stage, line * WIDEST_STAGE)
        left = 0 if area.isHidden() else max(min(wanted, rest - stage), area.minimumWidth())
        right = self.areas["right"]
        beside = 0 if right.isHidden() else max(round(whole * 0.22), right.tabs_width())
        self.row.setSizes([left, whole - left - stage - beside, beside, stage])

    def _show_stage(self) -> None:
        is_shown = not (self.areas["stage"].isHidden() and self.areas["person"].isHidden())
        if is_shown == self.stage.isHidden():
            self.stage.setVisible(is_shown)
            self._share_width()

    def _on_row_moved(self) -> None:
        self._is_arranged = True

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """In a window of another size the parts keep their shares."""
        if event.type() == QEvent.Type.Resize:
            self._share_width()
        return super().eventFilter(watched, event)

    def _on_toggled(self, panel: Panel, is_on: bool) -> None:
        is_behind = panel.area is self.rooms and self.rooms.shown is not panel.widget
        if not is_on and is_behind and not self._is_closing:  # in the menu: somebody wants it
            panel.action.setChecked(True)
            return
        panel.area.show_panel(panel.widget, is_on)
        self._show_stage()
        if panel.area is self.areas["right"]:
            self._share_width()
        self._settings.set_shown(panel.name, is_on)

    def _on_open_asked(self, widget: QWidget) -> None:
        """Show a room, and give it the keyboard: who opened it wants to work there."""
        self.show(widget)
        for child in widget.findChildren(QWidget):
            can_have = child.focusPolicy() & Qt.FocusPolicy.TabFocus and child.isEnabled()
            if can_have and child.isVisible():
                child.setFocus(Qt.FocusReason.TabFocusReason)
                return

    def _on_close_asked(self, widget: QWidget) -> None:
        self._is_closing = True
        for panel in self.all:
            if panel.widget is widget:
                panel.action.setChecked(False)
        self._is_closing = False

    def _on_rooms_changed(self) -> None:
        """A room has the whole page: what tells of the canvas stands back."""
        shown = self.rooms.shown
        for area in (self.areas["left"], self.areas["right"], self.areas["bottom"]):
            area.stand_back(shown is not None)
        for area in (self.areas["stage"], self.areas["person"]):
            area.stand_back(shown in self.rooms.with_own_robot)
        self._show_stage()
        self._share_width()

    def _on_theme_changed(self) -> None:
        for panel in self.all:
            self._dress(panel)

    def set_sign(self, widget: QWidget, icon_name: str) -> None:
        """Give a panel another picture: it tells of something."""
        for panel in self.all:
            if panel.widget is widget and panel.icon_name != icon_name:
                panel.icon_name = icon_name
                self._dress(panel)

    def _dress(self, panel: Panel) -> None:
        theme = self._look.theme
        sign = icon(panel.icon_name, theme)
        panel.action.setIcon(sign)
        panel.area.dress(panel.widget, sign, theme)

"""What is done with the plots: by mouse and keys, and by a tool bar that folds what has no room."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import cast

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtGui import QAction, QActionGroup, QKeyEvent, QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QMenu, QToolBar, QToolButton

from faults import Words, text_of
from nep_studio.ui.labels import explained, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look

from .curves_view import CurvesView
from .measuring import LENGTHS_S, ZOOM_STEP
from .plots import PlotRow, Plots
from .recorder import Recorder

# What mouse and keys do with the plots: pan, zoom, pause, and move the cursors.

_NOTCH = 120
"""What Qt gives for one notch of a wheel."""
_STEP = 0.1
"""How far an arrow key goes, as a part of the width."""
_FINE = 0.005
_REACH_LINES = 0.6
"""How near to a cursor it is taken, in lines of text."""


class Hand(QObject):
    """Listens to the mouse over the plots and to the keys while they have the focus."""

    def __init__(self, plots: Plots) -> None:
        super().__init__(plots)
        self._plots = plots
        self._held: int | None = None
        """The cursor that is moved, by its place; None while the plot itself is."""
        self._at: tuple[float, float] | None = None
        plots.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        plots.installEventFilter(self)
        plots.rows_changed.connect(self._on_rows_changed)
        self._on_rows_changed()

    def measure(self, is_on: bool) -> None:
        """Put both cursors into the picture, which stands still then; or take them away."""
        if not is_on:
            self._plots.set_cursors()
            return
        self._plots.pause()
        start_s, end_s = self._plots.shown_s
        third_s = (end_s - start_s) / 3
        self._plots.set_cursors(start_s + third_s, end_s - third_s)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Do what the mouse or a key asks for."""
        if event.type() == QEvent.Type.KeyPress:
            return self._press_key(cast(QKeyEvent, event))
        if not isinstance(watched, CurvesView):
            return False
        row = next((one for one in self._plots.rows if one.view is watched), None)
        return row is not None and self._use_mouse(row, event)

    def _use_mouse(self, row: PlotRow, event: QEvent) -> bool:
        match event.type():
            case QEvent.Type.Wheel:
                self._turn_wheel(row, cast(QWheelEvent, event))
            case QEvent.Type.MouseButtonPress:
                self._press(row, cast(QMouseEvent, event))
            case QEvent.Type.MouseMove if self._at is not None:
                self._drag(row, cast(QMouseEvent, event))
            case QEvent.Type.MouseMove:
                is_near = self._cursor_at(row, cast(QMouseEvent, event).position().x()) is not None
                shape = Qt.CursorShape.SplitHCursor if is_near else Qt.CursorShape.ArrowCursor
                row.view.setCursor(shape)
            case QEvent.Type.MouseButtonRelease:
                self._at = self._held = None
            case QEvent.Type.MouseButtonDblClick:
                self._plots.fit()
            case _:
                return False
        return True

    def _turn_wheel(self, row: PlotRow, event: QWheelEvent) -> None:
        """Zoom the time; with Ctrl the values; with Shift, or sideways, go through the time."""
        notches = event.angleDelta().y() / _NOTCH
        sideways = event.angleDelta().x() / _NOTCH
        place = event.position()
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self._zoom_values(row, ZOOM_STEP**-notches, 1 - place.y() / row.view.height())
        elif event.modifiers() & Qt.KeyboardModifier.ShiftModifier or sideways:
            self._plots.move_time(-(notches + sideways) * _STEP * self._plots.view.length_s)
        else:
            self._plots.zoom(ZOOM_STEP**-notches, place.x() / row.width)

    def _zoom_values(self, row: PlotRow, factor: float, share: float) -> None:
        row.is_fitting = False
        row.set_values(row.values.zoomed(factor, share))
        self._plots.draw()

    def _press(self, row: PlotRow, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        self._plots.setFocus(Qt.FocusReason.MouseFocusReason)
        self._at = (event.position().x(), event.position().y())
        self._held = self._cursor_at(row, event.position().x())

    def _drag(self, row: PlotRow, event: QMouseEvent) -> None:
        if self._at is None:
            return
        x, y = event.position().x(), event.position().y()
        seconds = (x - self._at[0]) / row.width * self._plots.view.length_s
        if self._held is not None:
            self._move_cursor(self._held, seconds)
        elif seconds:
            self._plots.move_time(-seconds)
        if self._held is None and not row.is_fitting:
            share = (y - self._at[1]) / row.view.height()
            row.set_values(row.values.moved(share * row.values.height))
            self._plots.draw()
        self._at = (x, y)

    def _cursor_at(self, row: PlotRow, x: float) -> int | None:
        """The cursor that is near enough to be taken, the nearest one."""
        start_s, end_s = self._plots.shown_s
        frame = row.frame(start_s, end_s - start_s)
        reach = self._plots.fontMetrics().height() * _REACH_LINES
        distances = [abs(frame.x(time_s) - x) for time_s in self._plots.cursors]
        near = [(distance, at) for at, distance in enumerate(distances) if distance <= reach]
        return min(near)[1] if near else None

    def _move_cursor(self, at: int, seconds: float) -> None:
        cursors = list(self._plots.cursors)
        if at < len(cursors):
            start_s, end_s = self._plots.shown_s
            cursors[at] = min(max(cursors[at] + seconds, start_s), end_s)
            self._plots.set_cursors(*cursors)

    def _press_key(self, event: QKeyEvent) -> bool:
        plots = self._plots
        length_s = plots.view.length_s
        does: dict[int, Callable[[], object]] = {
            Qt.Key.Key_Space: plots.pause if plots.view.is_live else plots.go_live,
            Qt.Key.Key_Plus: lambda: plots.zoom(1 / ZOOM_STEP),
            Qt.Key.Key_Equal: lambda: plots.zoom(1 / ZOOM_STEP),
            Qt.Key.Key_Minus: lambda: plots.zoom(ZOOM_STEP),
            Qt.Key.Key_Home: plots.fit,
            Qt.Key.Key_End: plots.go_live,
            Qt.Key.Key_PageUp: lambda: plots.move_time(-length_s),
            Qt.Key.Key_PageDown: lambda: plots.move_time(length_s),
            Qt.Key.Key_Left: lambda: self._go(event, -1),
            Qt.Key.Key_Right: lambda: self._go(event, 1),
        }
        do = does.get(event.key())
        if do is None:
            return False
        do()
        return True

    def _go(self, event: QKeyEvent, direction: int) -> None:
        """Through the time; with Alt cursor A goes, with Shift cursor B."""
        length_s = self._plots.view.length_s
        modifiers = event.modifiers()
        if modifiers & Qt.KeyboardModifier.AltModifier:
            self._move_cursor(0, direction * _FINE * length_s)
        elif modifiers & Qt.KeyboardModifier.ShiftModifier:
            self._move_cursor(1, direction * _FINE * length_s)
        else:
            self._plots.move_time(direction * _STEP * length_s)

    def _on_rows_changed(self) -> None:
        for row in self._plots.rows:
            row.view.setMouseTracking(True)
            row.view.installEventFilter(self)


# The actions of the panel, on a tool bar that folds away what has no room.

_PAGE = 0.5
"""How far a button goes through the time, as a part of the width."""


class Tools(QToolBar):
    """What can be done with the plots; each action says its keys in its tool tip."""

    def __init__(self, plots: Plots, hand: Hand, recorder: Recorder, look: Look) -> None:
        super().__init__()
        self._plots, self._look, self._recorder = plots, look, recorder
        self._icons: dict[QAction, str] = {}
        self.by_name: dict[str, QAction] = {}
        self.lengths: dict[float, QAction] = {}
        self.setMovable(False)
        self._add_time()
        zoom = self._plots.zoom
        self.addSeparator()
        self._add("earlier", "chevron-left", lambda: self._go(-_PAGE), words="Earlier (Left)")
        self._add("later", "chevron-right", lambda: self._go(_PAGE), words="Later (Right)")
        self._add("zoom_in", "zoom-in", lambda: zoom(1 / ZOOM_STEP), words="Less time (+)")
        self._add("zoom_out", "zoom-out", lambda: zoom(ZOOM_STEP), words="More time (−)")  # noqa: RUF001 - what is on the key
        measure = self._add(
            "measure",
            "ruler",
            lambda: None,
            words="Measure",
            tip="Measure between two cursors (Alt or Shift with Left and Right)",
            is_checkable=True,
            has_words=True,
        )
        measure.triggered.connect(hand.measure)
        self._add_keeping()
        for changed in (plots.view_changed, plots.cursors_changed, plots.rows_changed):
            changed.connect(self.refresh)
        recorder.started.connect(self.refresh)
        recorder.stopped.connect(self.refresh)
        look.theme_changed.connect(self._dress)
        self.refresh()

    def refresh(self) -> None:
        """Say what the plots do now, and what can be done."""
        plots, pause = self._plots, self.by_name["pause"]
        is_live = plots.view.is_live
        labelled(
            pause,
            text="Pause" if is_live else "Live",
            tip="Let the picture stand still (Space)" if is_live else "Show what comes (Space)",
        )
        self._icons[pause] = "pause" if is_live else "play"
        for length_s, action in self.lengths.items():
            action.setChecked(not plots.is_fit and plots.view.length_s == length_s)
        self.by_name["fit"].setChecked(plots.is_fit)
        self.by_name["measure"].setChecked(bool(plots.cursors))
        self.by_name["record"].setEnabled(not self._recorder.is_recording)
        views = ("zoom_in", "zoom_out", "earlier", "later", "fit")
        for name in ("pause", "measure", *views, "export"):
            self.by_name[name].setEnabled(bool(plots.rows))
        self._dress()

    def _add_time(self) -> None:
        plots = self._plots
        self._add("pause", "pause", self._on_pause, words="Pause", has_words=True)
        group = QActionGroup(self)
        group.setExclusionPolicy(QActionGroup.ExclusionPolicy.ExclusiveOptional)
        for length_s in LENGTHS_S:
            seconds = f"{length_s:g}"
            action = self._add(
                f"length_{seconds}",
                "",
                partial(self._show_length, length_s),
                words=text_of("{seconds} s", seconds=seconds),
                tip=text_of("Show {seconds} seconds", seconds=seconds),
                is_checkable=True,
            )
            self.lengths[length_s] = group.addAction(action)
        fit = self._add(
            "fit",
            "",
            plots.fit,
            words="All",
            tip="Show all that is kept, and all values (Home)",
            is_checkable=True,
        )
        group.addAction(fit)

    def _show_length(self, length_s: float) -> None:
        self._plots.set_view(self._plots.view.with_length(length_s))

    def _add_keeping(self) -> None:
        self.addSeparator()
        self._add("choose", "chart-line", lambda: None, words="Choose…", has_words=True)
        self._add("record", "circle-dot", lambda: None, words="Record", has_words=True)
        self._add("replay", "circle-play", lambda: None, words="Replay…", has_words=True)
        menu = QMenu(self)
        self.by_name["csv"] = labelled(menu.addAction(""), text="Numbers (CSV)…")
        self.by_name["png"] = labelled(menu.addAction(""), text="Picture (PNG)…")
        export = self._add("export", "download", lambda: None, words="Export", has_words=True)
        export.setMenu(menu)
        button = self.widgetForAction(export)
        if isinstance(button, QToolButton):
            button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)

    def _add(
        self,
        name: str,
        icon_name: str,
        do: Callable[[], object],
        *,
        words: Words,
        tip: Words = "",
        is_checkable: bool = False,
        has_words: bool = False,
    ) -> QAction:
        action = self.by_name[name] = labelled(QAction(self), text=words, tip=tip or words)
        action.setCheckable(is_checkable)
        action.triggered.connect(lambda: do())
        if icon_name:
            self._icons[action] = icon_name
        self.addAction(action)
        button = self.widgetForAction(action)
        if isinstance(button, QToolButton):
            beside = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
            alone = Qt.ToolButtonStyle.ToolButtonIconOnly
            button.setToolButtonStyle(beside if has_words or not icon_name else alone)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            labelled(button, name=words)
        return action

    def _go(self, share: float) -> None:
        self._plots.move_time(share * self._plots.view.length_s)

    def _on_pause(self) -> None:
        if self._plots.view.is_live:
            self._plots.pause()
        else:
            self._plots.go_live()

    def _dress(self) -> None:
        line = self.fontMetrics().height()
        self.setIconSize(QSize(line, line))
        more = self.findChild(QToolButton, "qt_toolbar_ext_button")
        if isinstance(more, QToolButton):  # Qt's own arrow is too small, and lost in the dark
            more.setIcon(icon("ellipsis", self._look.theme))
            more.setMinimumWidth(line)
            explained(more, "More")
        for action, name in self._icons.items():
            action.setIcon(icon(name, self._look.theme))

"""The actions of the panel, on a tool bar that folds away what has no room."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolBar, QToolButton, QWidget

from faults import Words, text_of
from nep_studio.ui.labels import explained, labelled
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look

from .measuring import LENGTHS_S, ZOOM_STEP
from .plots import Plots
from .pointing import Hand
from .recorder import Recorder

_PAGE = 0.5
"""How far a button goes through the time, as a part of the width."""


class Tools(QToolBar):
    """What can be done with the plots; each action says its keys in its tool tip."""

    def __init__(
        self,
        plots: Plots,
        hand: Hand,
        recorder: Recorder,
        look: Look,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
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
        self._dress()

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
        for name in ("pause", "measure", "zoom_in", "zoom_out", "earlier", "later", "fit"):
            self.by_name[name].setEnabled(bool(plots.rows))
        self.by_name["export"].setEnabled(bool(plots.rows))
        self._dress()

    def _add_time(self) -> None:
        plots = self._plots
        self._add("pause", "pause", self._on_pause, words="Pause", has_words=True)
        group = QActionGroup(self)
        group.setExclusionPolicy(QActionGroup.ExclusionPolicy.ExclusiveOptional)
        for length_s in LENGTHS_S:
            show, seconds = self._show_length(length_s), f"{length_s:g}"
            action = self._add(
                f"length_{seconds}",
                "",
                show,
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

    def _show_length(self, length_s: float) -> Callable[[], None]:
        plots = self._plots
        return lambda: plots.set_view(plots.view.with_length(length_s))

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
            has_icon = bool(icon_name)
            style = Qt.ToolButtonStyle.ToolButtonIconOnly
            if has_words or not has_icon:
                style = Qt.ToolButtonStyle.ToolButtonTextBesideIcon
            button.setToolButtonStyle(style)
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

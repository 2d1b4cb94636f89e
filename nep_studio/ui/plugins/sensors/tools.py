"""The actions of the panel, on a tool bar that folds away what has no room."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolBar, QToolButton, QWidget

from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import tr

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
        self._add_views(hand)
        self.addSeparator()
        self._add("choose", tr("Choose…"), "chart-line", lambda: None, has_words=True)
        self._add("record", tr("Record"), "circle-dot", lambda: None, has_words=True)
        self._add("replay", tr("Replay…"), "circle-play", lambda: None, has_words=True)
        menu = QMenu(self)
        for name, words in (("csv", tr("Numbers (CSV)…")), ("png", tr("Picture (PNG)…"))):
            self.by_name[name] = menu.addAction(words)
        export = self._add("export", tr("Export"), "download", lambda: None, has_words=True)
        export.setMenu(menu)
        button = self.widgetForAction(export)
        if isinstance(button, QToolButton):
            button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
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
        pause.setText(tr("Pause") if is_live else tr("Live"))
        pause.setToolTip(
            tr("Let the picture stand still (Space)") if is_live else tr("Show what comes (Space)")
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
        self._add("pause", tr("Pause"), "pause", self._on_pause, has_words=True)
        group = QActionGroup(self)
        group.setExclusionPolicy(QActionGroup.ExclusionPolicy.ExclusiveOptional)
        for length_s in LENGTHS_S:
            words = tr("{seconds} s", seconds=f"{length_s:g}")
            show = self._show_length(length_s)
            action = self._add(f"length_{length_s:g}", words, "", show, is_checkable=True)
            action.setToolTip(tr("Show {seconds} seconds", seconds=f"{length_s:g}"))
            self.lengths[length_s] = group.addAction(action)
        fit = self._add("fit", tr("All"), "", plots.fit, is_checkable=True)
        fit.setToolTip(tr("Show all that is kept, and all values (Home)"))
        group.addAction(fit)

    def _show_length(self, length_s: float) -> Callable[[], None]:
        plots = self._plots
        return lambda: plots.set_view(plots.view.with_length(length_s))

    def _add_views(self, hand: Hand) -> None:
        plots = self._plots
        self.addSeparator()
        self._add("earlier", tr("Earlier (Left)"), "chevron-left", lambda: self._go(-_PAGE))
        self._add("later", tr("Later (Right)"), "chevron-right", lambda: self._go(_PAGE))
        self._add("zoom_in", tr("Less time (+)"), "zoom-in", lambda: plots.zoom(1 / ZOOM_STEP))
        self._add("zoom_out", tr("More time (−)"), "zoom-out", lambda: plots.zoom(ZOOM_STEP))  # noqa: RUF001 - what is on the key
        measure = self._add(
            "measure", tr("Measure"), "ruler", lambda: None, is_checkable=True, has_words=True
        )
        measure.setToolTip(tr("Measure between two cursors (Alt or Shift with Left and Right)"))
        measure.triggered.connect(hand.measure)

    def _add(
        self,
        name: str,
        words: str,
        icon_name: str,
        do: Callable[[], object],
        *,
        is_checkable: bool = False,
        has_words: bool = False,
    ) -> QAction:
        action = self.by_name[name] = QAction(words, self)
        action.setToolTip(words.removesuffix("…"))
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
            button.setAccessibleName(words.removesuffix("…"))
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
            more.setToolTip(tr("More"))
            more.setAccessibleName(tr("More"))
        for action, name in self._icons.items():
            action.setIcon(icon(name, self._look.theme))

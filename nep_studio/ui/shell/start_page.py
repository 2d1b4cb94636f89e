"""What the window shows while no project is open: begin, go on, or try an example."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QWidget,
)

from faults import text_of, verbatim
from nep_studio.ui.document_files import Files
from nep_studio.ui.labels import labelled, plain_tip
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.icons import application_icon, icon, icon_pixmap
from nep_studio.ui.widgets.forms import styled
from nep_studio.ui.widgets.layouts import Flow, ReadingLabel, in_column, in_row

from .gallery import Card, Gallery

# The offer of the tour on the start page, until somebody has taken it or wants none.


class TourOffer(QFrame):
    """One line that offers the tour; ``accepted`` begins it."""

    accepted = Signal()

    def __init__(self, studio: Studio, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio = studio
        line, theme = self.fontMetrics().height(), studio.look.theme
        ratio = self.devicePixelRatioF()
        sign = QLabel(pixmap=icon_pixmap("map", theme.colour("text"), line * 1.4, ratio))
        self.words = labelled(
            ReadingLabel(), text="New here? Five short steps show how a robot gets its behaviour."
        )
        self.words.setWordWrap(True)
        row = Flow(spacing=line // 3)
        self.take_button = labelled(QPushButton(), text="Take the tour")
        self.take_button.setIcon(icon("footprints", theme))
        self.take_button.clicked.connect(self._on_taken)
        self.leave_button = labelled(
            styled(QPushButton(), kind="quiet"),
            text="Not now",
            tip="The tour stays in the Help menu",
        )
        self.leave_button.clicked.connect(self._on_left)
        row.addWidget(self.take_button)
        row.addWidget(self.leave_button)
        words = in_column(self.words, row)
        parts = (sign, 0, Qt.AlignmentFlag.AlignTop), (words, 1)
        in_row(*parts, of=styled(self, kind="info"), margins=line // 2, spacing=line // 2)
        if studio.settings.tour_done:
            self.hide()

    def _on_taken(self) -> None:
        self._on_left()
        self.accepted.emit()

    def _on_left(self) -> None:
        self._studio.settings.tour_done = True
        self.hide()


MOST_RECENT = 5


class StartPage(QScrollArea):
    """Three ways to begin, the recent projects, and the examples.

    ``try_requested`` gives the file of an example that is to be opened and run on the simulator;
    ``tour_requested`` asks for the tour.
    """

    try_requested = Signal(Path)
    tour_requested = Signal()

    def __init__(self, studio: Studio, files: Files, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio, self._files = studio, files
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.recent_buttons: dict[Path, QPushButton] = {}
        files.recent_changed.connect(self._fill_recent)
        studio.look.theme_changed.connect(self._fill)
        self._fill()

    @property
    def cards(self) -> dict[Path, Card]:
        """The cards of the examples by file."""
        return self.gallery.cards

    def _fill(self) -> None:
        line = self.fontMetrics().height()
        inner = QWidget()
        inner.setObjectName("start")
        self.tour_offer = TourOffer(self._studio)
        self.tour_offer.accepted.connect(self.tour_requested)
        self._recent = in_column(spacing=line // 6)
        self._examples_heading = _heading("Examples to try and change", line)
        gallery = self.gallery = Gallery(self._studio)
        gallery.opened.connect(self._files.open_example)
        gallery.try_requested.connect(self.try_requested)
        gallery.focus_moved.connect(lambda widget: self.ensureWidgetVisible(widget, 0, 50))
        above = (self._header(line), self._beginnings(line), self.tour_offer, self._recent)
        self._box = in_column(*above, self._examples_heading, gallery, 1, of=inner, spacing=line)
        self._fill_recent()
        self.setWidget(inner)
        self._fit()

    def _header(self, line: int) -> QHBoxLayout:
        side = QSize(line * 4, line * 4)
        sign = QLabel(pixmap=application_icon().pixmap(side, self.devicePixelRatioF()))
        title = ReadingLabel("NEP Studio")
        title.setStyleSheet(f"font-size: {round(line * 1.7)}px; font-weight: 600;")
        about = labelled(
            styled(ReadingLabel(), role="hint"),
            text="Give a social robot its behaviour with blocks, without programming.",
        )
        about.setWordWrap(True)
        words = in_column(1, title, about, 1, spacing=line // 4)
        row = in_row(sign)
        row.addSpacing(line)
        row.addLayout(words, 1)
        return row

    def _beginnings(self, line: int) -> Flow:
        theme = self._studio.look.theme
        row = Flow(spacing=line // 2)
        self.example_button = labelled(QPushButton(), text="Try an example")
        self.example_button.setProperty("kind", "primary")
        self.example_button.setIcon(icon("graduation-cap", theme.colour("accent_text")))
        self.example_button.clicked.connect(self.show_examples)
        self.new_button = labelled(QPushButton(), text="Start empty")
        self.new_button.setIcon(icon("file-plus", theme))
        self.new_button.clicked.connect(self._files.new)
        self.open_button = labelled(QPushButton(), text="Open a project…")
        self.open_button.setIcon(icon("folder-open", theme))
        self.open_button.clicked.connect(self._files.choose)
        for button in (self.example_button, self.new_button, self.open_button):
            row.addWidget(button)
        return row

    def show_examples(self) -> None:
        """Go to the first example."""
        first = next(iter(self.gallery.shown), None)
        self._box.activate()  # cards that were made just now have a place only then
        bar = self.verticalScrollBar()
        bar.setValue(min(bar.maximum(), self._examples_heading.y()))
        (first or self.gallery.search).setFocus(Qt.FocusReason.OtherFocusReason)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put as many cards beside each other as there is room for."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        # Much room at the sides, but not in a narrow window
        line = self.fontMetrics().height()
        margin = min(line * 2, max(line // 2, self.viewport().width() // 20))
        self._box.setContentsMargins(margin, line * 2, margin, line * 2)
        self.gallery.show_in(self.viewport().width() - 2 * margin)

    def _fill_recent(self) -> None:
        while (item := self._recent.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        self.recent_buttons = {}
        recent = self._studio.settings.recent_files[:MOST_RECENT]
        if recent:
            self._recent.addWidget(_heading("Go on with", self.fontMetrics().height()))
        for path in recent:
            self._recent.addWidget(self._recent_button(path), 0, Qt.AlignmentFlag.AlignLeading)

    def _recent_button(self, path: Path) -> QPushButton:
        is_there = path.is_file()
        name = f"{path.stem}   —   {_short(path.parent)}"
        button = styled(QPushButton(), kind="quiet")
        if is_there:
            labelled(button, text=verbatim(name))
        else:
            labelled(button, text=text_of("{name} (not there any more)", name=name))
        button.setIcon(icon("file-text", self._studio.look.theme))
        button.setEnabled(is_there)
        button.setToolTip(plain_tip(str(path)))
        button.clicked.connect(lambda: self._files.open(path))
        self.recent_buttons[path] = button
        return button


def _heading(words: str, line: int) -> QLabel:
    label = labelled(styled(ReadingLabel(), role="title"), text=words)
    label.setContentsMargins(0, line // 2, 0, 0)
    return label


def _short(folder: Path) -> str:
    """A folder as a person calls it."""
    try:
        return f"~/{folder.relative_to(Path.home())}"
    except (ValueError, RuntimeError):
        return str(folder)

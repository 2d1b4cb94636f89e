"""What the window shows while no project is open: begin, go on, or try an example."""

from __future__ import annotations

import contextlib
from pathlib import Path

from PySide6.QtCore import QDateTime, QLocale, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QFont, QMouseEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QWidget,
)

from faults import text_of
from nep_studio.blocks.errors import BlocksError
from nep_studio.project.examples import examples
from nep_studio.ui.document_files import Files
from nep_studio.ui.labels import explained, follow_words, labelled, plain_tip
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.icons import icon, icon_pixmap, icon_room
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel, styled
from nep_studio.ui.widgets.layouts import Flow, ReadingLabel, in_column, in_row
from nep_studio.ui.words import is_right_to_left, language_code, tr

from .acting import ActingPicture
from .gallery import Card, Gallery, PictureCard

# The offer of the tour on the start page, until somebody has taken it or wants none.


class TourOffer(QWidget):
    """A small button that offers the tour; ``accepted`` begins it."""

    accepted = Signal()

    def __init__(self, studio: Studio, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio = studio
        theme = studio.look.theme
        self.take_button = labelled(
            styled(QPushButton(), kind="quiet"),
            text="Take the tour",
            tip="New here? Five short steps show how a robot gets its behaviour.",
        )
        self.take_button.setIcon(icon("footprints", theme))
        self.take_button.clicked.connect(self._on_taken)
        self.leave_button = explained(
            styled(QPushButton(), kind="quiet"), "No tour: it stays in the Help menu"
        )
        self.leave_button.setIcon(icon("x", theme.colour("muted")))
        self.leave_button.clicked.connect(self._on_left)
        in_row(self.take_button, self.leave_button, of=self, margins=0, spacing=0)
        if studio.settings.tour_done:
            self.hide()

    def _on_taken(self) -> None:
        self._on_left()
        self.accepted.emit()

    def _on_left(self) -> None:
        self._studio.settings.tour_done = True
        self.hide()


# The first thing that is seen: a robot that acts, and one button that lets it.

WIDE_LINES = 36
"""A picture that is so wide has room for the button beside the robot."""
ASIDE = 0.64
"""Where the robot stands then."""


class BigPicture(QFrame):
    """A big picture of an example with one big button, which plays it."""

    pressed = Signal()

    def __init__(self, name: str, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        line = self.fontMetrics().height()
        self.picture = ActingPicture(name, look, round_=line * 0.6, is_alone=True)
        self.play_button = labelled(styled(QPushButton(), kind="primary"), text="Try an example")
        self.play_button.setIcon(icon("play", look.theme.colour("accent_text")))
        self.play_button.setIconSize(icon_room(round(line * 1.6)))
        self._sheet = (
            f"font-size: {round(line * 1.1)}px; font-weight: 600;"
            f" padding: {round(line * 0.6)}px {round(line * 1.2)}px;"
            f" border-radius: {round(line * 0.6)}px;"
        )
        self.play_button.clicked.connect(self.pressed)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        self._grid.addWidget(self.picture, 0, 0)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def fit(self, width: int, height: int) -> None:
        """Take so much room; the button is beside the robot, or below where that is narrow."""
        line = self.fontMetrics().height()
        self.picture.setFixedHeight(height)
        is_wide = width >= WIDE_LINES * line
        self.picture.at = ASIDE if is_wide else 0.5
        side = Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignVCenter
        at = (0, side) if is_wide else (1, Qt.AlignmentFlag(0))
        self._grid.addWidget(self.play_button, at[0], 0, at[1])
        self._grid.setVerticalSpacing(line // 2)
        air = round(width * 0.1) if is_wide else 0
        sheet = f"{self._sheet} margin: 0px {air}px;"
        if self.play_button.styleSheet() != sheet:
            self.play_button.setStyleSheet(sheet)
            self._grid.activate()  # now, not in the next turn: its words would be cut till then

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """A click on the picture plays it, too."""
        is_inside = self.rect().contains(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and is_inside:
            self.pressed.emit()


# What the person has worked on: cards with a picture of the blocks.

RECENT_LINES = 5.5
"""How high the picture of a recent project is, in lines of text."""


class RecentCard(PictureCard):
    """A project of the person: what its blocks look like, its name, when it was changed.

    One whose file is gone says so, and ``removed`` takes it out of the list.
    """

    removed = Signal()

    def __init__(self, path: Path, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(look, parent)
        self.path, self.is_there = path, path.is_file()
        line = self.fontMetrics().height()
        self.picture = QLabel(alignment=Qt.AlignmentFlag.AlignCenter)
        self.picture.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.picture.setFixedHeight(round(line * RECENT_LINES))
        sign = icon_pixmap(
            "file-text" if self.is_there else "circle-question-mark",
            look.theme.colour("muted"),
            line * 2.0,
            self.devicePixelRatioF(),
        )
        self.picture.setPixmap(sign)
        title = ElidedLabel()
        title.set_words(path.stem)
        font = title.font()
        font.setWeight(QFont.Weight.DemiBold)
        title.setFont(font)
        self.when = styled(ReadingLabel(), role="hint")
        self.remove_button = explained(
            styled(QPushButton(), kind="quiet"),
            text_of("Remove “{name}” from the list", name=path.stem),
        )
        self.remove_button.setIcon(icon("x", look.theme.colour("muted")))
        self.remove_button.clicked.connect(self.removed)
        self.remove_button.setCursor(Qt.CursorShape.ArrowCursor)
        self.remove_button.setVisible(not self.is_there)
        inside = in_column(
            *(in_row((title, 1), self.remove_button), self.when),
            margins=(line // 2, line // 4, line // 2, 0),
            spacing=line // 6,
        )
        in_column(self.picture, inside, of=self, margins=(2, 2, 2, line // 2), spacing=0)
        self.setToolTip(plain_tip(str(path)))
        if not self.is_there:
            self.setCursor(Qt.CursorShape.ArrowCursor)
            self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        follow_words(self, self._say)

    def _say(self) -> None:
        self.when.setText(self._told())
        self.setAccessibleName(f"{self.path.stem}. {self.when.text()}")

    def _told(self) -> str:
        if not self.is_there:
            return tr("Not there any more")
        with contextlib.suppress(OSError):
            changed = QDateTime.fromSecsSinceEpoch(int(self.path.stat().st_mtime))
            day = QLocale(language_code()).toString(changed.date(), QLocale.FormatType.ShortFormat)
            return tr("Changed {day}", day=day)
        return ""

    def picture_size(self) -> QSize:
        """How large the picture is, in pixels of the window."""
        return QSize(self.minimumWidth() - 4, self.picture.height())


MOST_RECENT = 4
PICTURE_SHARE, LOWEST_PICTURE, HIGHEST_PICTURE = 0.46, 9, 22
"""How much of the height the big picture takes; its least and most, in lines."""


class StartPage(QScrollArea):
    """A robot that acts and a button that plays it; the person's projects; the examples.

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
        self.recent_cards: dict[Path, RecentCard] = {}
        self._unpainted: list[RecentCard] = []
        self._has_pictures = True
        self._painting = QTimer(self, interval=0)
        self._painting.timeout.connect(self._on_paint_next)
        files.recent_changed.connect(self._fill_recent)
        studio.look.theme_changed.connect(self._fill)
        studio.words_changed.connect(self._paint_again)
        self._fill()

    @property
    def cards(self) -> dict[Path, Card]:
        """The cards of the examples by file."""
        return self.gallery.cards

    @property
    def example_button(self) -> QPushButton:
        """The big button that plays the first example."""
        return self.big_picture.play_button

    def _fill(self) -> None:
        line = self.fontMetrics().height()
        inner = QWidget()
        inner.setObjectName("start")
        self.tour_offer = TourOffer(self._studio)
        self.tour_offer.accepted.connect(self.tour_requested)
        first = examples()[0].path
        self.big_picture = BigPicture(first.stem, self._studio.look)
        self.big_picture.pressed.connect(lambda: self.try_requested.emit(first))
        self._recent_heading = _heading("Go on with", line)
        self._recent = Flow(spacing=line)
        gallery = self.gallery = Gallery(self._studio)
        gallery.opened.connect(self._files.open_example)
        gallery.try_requested.connect(self.try_requested)
        gallery.focus_moved.connect(lambda widget: self.ensureWidgetVisible(widget, 0, 50))
        above = (self.big_picture, self._beginnings(line), self._recent_heading, self._recent)
        heading = _heading("Examples to try and change", line)
        self._box = in_column(*above, heading, gallery, 1, of=inner, spacing=line)
        self._fill_recent()
        self.setWidget(inner)
        self._fit()

    def _beginnings(self, line: int) -> Flow:
        theme = self._studio.look.theme
        row = Flow(spacing=line // 2)
        self.new_button = labelled(QPushButton(), text="Start empty")
        self.new_button.setIcon(icon("file-plus", theme))
        self.new_button.clicked.connect(self._files.new)
        self.open_button = labelled(QPushButton(), text="Open a project…")
        self.open_button.setIcon(icon("folder-open", theme))
        self.open_button.clicked.connect(self._files.choose)
        for widget in (self.new_button, self.open_button, self.tour_offer):
            row.addWidget(widget)
        return row

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put as many cards beside each other as there is room for."""
        super().resizeEvent(event)
        self._fit()

    def showEvent(self, event: QShowEvent) -> None:
        """Go on painting."""
        super().showEvent(event)
        self._painting.start()

    def _fit(self) -> None:
        # Much room at the sides, but not in a narrow window
        line = self.fontMetrics().height()
        margin = min(line * 2, max(line // 2, self.viewport().width() // 20))
        self._box.setContentsMargins(margin, line, margin, line * 2)
        wide = self.viewport().width() - 2 * margin
        high = round(self.viewport().height() * PICTURE_SHARE)
        self.big_picture.fit(wide, min(max(high, LOWEST_PICTURE * line), HIGHEST_PICTURE * line))
        self.gallery.show_in(wide)
        for card in self.recent_cards.values():
            card.set_width(self.gallery.card_width)
        self._paint_again()

    # What the person has worked on

    def _fill_recent(self) -> None:
        while (item := self._recent.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.hide()
                widget.deleteLater()
        self.recent_cards = {}
        recent = self._studio.settings.recent_files[:MOST_RECENT]
        self._recent_heading.setVisible(bool(recent))
        for path in recent:
            card = self.recent_cards[path] = RecentCard(path, self._studio.look)
            card.set_width(self.gallery.card_width)
            card.removed.connect(lambda path=path: self._remove(path))
            if card.is_there:
                card.clicked.connect(lambda path=path: self._files.open(path))
            self._recent.addWidget(card)
        self._paint_again()

    def _remove(self, path: Path) -> None:
        self._studio.settings.remove_recent(path)
        self._files.recent_changed.emit()

    def wait_with_pictures(self) -> None:
        """Paint no blocks before ``paint_pictures``, and let the robot stand: all that is behind
        the page has the computer meanwhile.
        """
        self._has_pictures = False

    def paint_pictures(self) -> None:
        """Paint them from now on, and let the robot act."""
        self._has_pictures = True
        self.big_picture.picture.act()
        self._painting.start()

    def _paint_again(self) -> None:
        self._unpainted = [card for card in self.recent_cards.values() if card.is_there]
        self._painting.start()

    def _on_paint_next(self) -> None:
        """Paint one picture at a time, so that the window is there at once."""
        if not self._unpainted or not self._has_pictures or not self.isVisible():
            self._painting.stop()
            return
        _paint_blocks(self._unpainted.pop(0), self._studio)


def _paint_blocks(card: RecentCard, studio: Studio) -> None:
    """Show the blocks of a project on its card; a file that is large or wrong has its icon."""
    from nep_studio.blocks.editor import Editor  # all of the blocks: after the first page
    from nep_studio.blocks.files import load
    from nep_studio.ui.canvas.block_pictures import picture_of
    from nep_studio.ui.workbench.workbench import block_font

    try:
        if card.path.stat().st_size > LARGEST_BYTES:
            return
        editor = Editor(load(card.path, studio.language), studio.language)
    except (OSError, BlocksError):
        return  # it is told when somebody opens it
    if not editor.project.pages["behaviour"]:
        return
    picture = picture_of(
        editor,
        studio.look.theme,
        block_font(studio),
        card.picture_size(),
        card.devicePixelRatioF(),
        is_mirrored=is_right_to_left(),
    )
    card.picture.setPixmap(picture)


LARGEST_BYTES = 400_000
"""What is larger would keep the window waiting."""


def _heading(words: str, line: int) -> QLabel:
    label = labelled(styled(ReadingLabel(), role="title"), text=words)
    label.setContentsMargins(0, line // 2, 0, 0)
    return label

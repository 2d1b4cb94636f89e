"""What the window shows while no project is open: begin, go on, or look at an example."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.files import load
from nep_studio.ui.app import Studio
from nep_studio.ui.documents_files import Files
from nep_studio.ui.main_window_workbench import block_font
from nep_studio.ui.pictures import picture_of
from nep_studio.ui.start_page_examples import (
    Card,
    example_files,
    example_sentence,
    example_title,
)
from nep_studio.ui.theme import application_icon, icon
from nep_studio.ui.words import is_right_to_left, tr

MOST_RECENT = 5


class StartPage(QScrollArea):
    """New, Open, the recent projects, and the examples with a picture of their blocks."""

    def __init__(self, studio: Studio, files: Files, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio, self._files = studio, files
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.cards: dict[Path, Card] = {}
        self.recent_buttons: dict[Path, QPushButton] = {}
        self._unpainted: list[Path] = []
        self._painting = QTimer(self, interval=0)
        self._painting.timeout.connect(self._on_paint_next)
        files.recent_changed.connect(self._on_recent_changed)
        studio.look.theme_changed.connect(self._on_theme_changed)
        self._fill()

    def _fill(self) -> None:
        line = self.fontMetrics().height()
        inner = QWidget()
        inner.setObjectName("start")
        box = QVBoxLayout(inner)
        box.setContentsMargins(line * 2, line * 2, line * 2, line * 2)
        box.setSpacing(line)
        box.addLayout(self._header(line))
        box.addLayout(self._beginnings())
        self._recent = QVBoxLayout()
        self._recent.setSpacing(line // 6)
        box.addLayout(self._recent)
        box.addWidget(_heading(tr("Examples to try and change"), line))
        self._grid = QGridLayout()
        self._grid.setSpacing(line)
        self._grid.setAlignment(Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignTop)
        box.addLayout(self._grid)
        box.addStretch(1)
        self._add_cards()
        self._fill_recent()
        self.setWidget(inner)
        self._place_cards()

    def _header(self, line: int) -> QHBoxLayout:
        row, sign = QHBoxLayout(), QLabel()
        side = line * 4
        sign.setPixmap(application_icon().pixmap(QSize(side, side), self.devicePixelRatioF()))
        row.addWidget(sign)
        words = QVBoxLayout()
        words.setSpacing(line // 4)
        title = QLabel("NEP Studio")
        title.setStyleSheet(f"font-size: {round(line * 1.7)}px; font-weight: 600;")
        words.addStretch(1)
        words.addWidget(title)
        about = QLabel(tr("Give a social robot its behaviour with blocks, without programming."))
        about.setProperty("role", "hint")
        about.setWordWrap(True)
        words.addWidget(about)
        words.addStretch(1)
        row.addSpacing(line)
        row.addLayout(words, 1)
        return row

    def _beginnings(self) -> QHBoxLayout:
        theme = self._studio.look.theme
        row = QHBoxLayout()
        self.new_button = QPushButton(tr("New project"))
        self.new_button.setProperty("kind", "primary")
        self.new_button.setIcon(icon("file-plus", theme.colour("accent_text")))
        self.new_button.clicked.connect(self._files.new)
        self.open_button = QPushButton(tr("Open a project…"))
        self.open_button.setIcon(icon("folder-open", theme))
        self.open_button.clicked.connect(self._files.choose)
        row.addWidget(self.new_button)
        row.addWidget(self.open_button)
        row.addStretch(1)
        return row

    def _add_cards(self) -> None:
        look = self._studio.look
        self.cards = {}
        for path in example_files():
            card = self.cards[path] = Card(example_title(path), example_sentence(path), look)
            card.clicked.connect(lambda path=path: self._files.open_example(path))
        self._unpainted = list(self.cards)
        self._painting.start()

    def _on_paint_next(self) -> None:
        """Paint one picture at a time, so that the window is there at once."""
        if not self._unpainted or not self.isVisible():
            self._painting.stop()
            return
        path = self._unpainted.pop(0)
        card, language = self.cards[path], self._studio.language
        try:
            editor = Editor(load(path, language), language)
        except BlocksError:
            return  # it is told when somebody opens it
        picture = picture_of(
            editor,
            self._studio.look.theme,
            block_font(self._studio),
            card.picture_size(),
            self.devicePixelRatioF(),
            is_mirrored=is_right_to_left(),
        )
        card.show_picture(picture)

    def showEvent(self, event: QShowEvent) -> None:
        """Go on painting."""
        super().showEvent(event)
        self._painting.start()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put as many cards beside each other as there is room for."""
        super().resizeEvent(event)
        self._place_cards()

    def _place_cards(self) -> None:
        if not self.cards:
            return
        cards, line = list(self.cards.values()), self.fontMetrics().height()
        room = self.viewport().width() - 4 * line
        columns = max(1, (room + line) // (cards[0].width() + line))
        for index, card in enumerate(cards):
            self._grid.addWidget(card, index // columns, index % columns)

    def _fill_recent(self) -> None:
        while (item := self._recent.takeAt(0)) is not None:
            if (widget := item.widget()) is not None:
                widget.deleteLater()
        self.recent_buttons = {}
        recent = self._studio.settings.recent_files[:MOST_RECENT]
        if recent:
            self._recent.addWidget(_heading(tr("Go on with"), self.fontMetrics().height()))
        for path in recent:
            self._recent.addWidget(self._recent_button(path), 0, Qt.AlignmentFlag.AlignLeading)

    def _recent_button(self, path: Path) -> QPushButton:
        is_there = path.is_file()
        words = f"{path.stem}   —   {_short(path.parent)}"
        button = QPushButton(words if is_there else tr("{name} (not there any more)", name=words))
        button.setProperty("kind", "quiet")
        button.setIcon(icon("file-text", self._studio.look.theme))
        button.setEnabled(is_there)
        button.setToolTip(str(path))
        button.clicked.connect(lambda: self._files.open(path))
        self.recent_buttons[path] = button
        return button

    def _on_recent_changed(self) -> None:
        self._fill_recent()

    def _on_theme_changed(self) -> None:
        self._fill()


def _heading(words: str, line: int) -> QLabel:
    label = QLabel(words)
    label.setProperty("role", "title")
    label.setContentsMargins(0, line // 2, 0, 0)
    return label


def _short(folder: Path) -> str:
    """A folder as a person calls it."""
    try:
        return f"~/{folder.relative_to(Path.home())}"
    except (ValueError, RuntimeError):
        return str(folder)

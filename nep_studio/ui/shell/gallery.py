"""The gallery of examples: cards, a search, and tags to choose from."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QFont,
    QFontMetrics,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QShowEvent,
)
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QWidget,
)

from faults import text_of
from nep_studio.project.examples import Example, examples
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.icons import icon, icon_room, paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint, styled
from nep_studio.ui.widgets.layouts import Flow, ReadingLabel, in_column, in_row
from nep_studio.ui.words import count_words, is_right_to_left, tr

from .acting import ActingPicture

# How the gallery says what an example needs, how hard and how long it is, and what it is about.

Feature = tuple[str, str]
"""What an example needs or takes: the name of an icon, and words."""

NEEDS = {
    "watch": "A watch, or the virtual one",
    "two_robots": "Two robots on the screen",
    "voice": "Somebody who answers",
    "people": "Somebody in front of it",
    "touch": "Somebody who touches it",
    "cues": "Somebody who gives cues",
}
DIFFICULTIES = {"first": "Begin here", "next": "Next step", "more": "For more"}
ICONS = {
    "watch": "watch",
    "two_robots": "users",
    "voice": "message-square-text",
    "people": "user",
    "touch": "hand",
    "cues": "flag",
    "first": "star",
    "next": "chevron-right",
    "more": "sparkles",
}
TAGS = {
    "gestures": "Gestures",
    "museum": "Museum",
    "robots": "Several robots",
    "speech": "Speech",
    "theatre": "Theatre",
    "lights": "Lights",
    "feelings": "Feelings",
    "movement": "Movement",
    "games": "Games",
    "values": "Counting and keeping",
    "sensors": "Sensors",
    "goals": "Goals",
    "states": "States",
    "own_blocks": "My blocks",
}
"""What a tag is called."""


def signs_of(example: Example) -> list[Feature]:
    """How hard an example is, what one needs for it, how long it takes, each with its icon."""
    hard = example.difficulty
    needs = [(ICONS[need], tr(NEEDS[need])) for need in example.needs if need in NEEDS]
    needed = needs or [("circle-check", tr("Needs nothing"))]
    return [(ICONS[hard], tr(DIFFICULTIES[hard])), *needed, _length(example)]


def search_text(example: Example) -> str:
    """All that an example can be found by, in the person's language and in English."""
    tags = [tr(TAGS.get(tag, tag)) for tag in example.tags]
    signs = [words for _, words in signs_of(example)]
    shown = [tr(words) for words in example.words()]
    return " ".join([*shown, *example.words(), *tags, *example.tags, *signs]).casefold()


def _length(example: Example) -> Feature:
    if not example.seconds:
        return "repeat", tr("Until you stop it")
    if example.seconds < 60:
        return "clock", tr("{seconds} seconds", seconds=round(example.seconds))
    return "clock", count_words(round(example.seconds / 60), "1 minute", "{n} minutes")


# The examples as cards: robots that act, what it is, what it needs, and what to do.

CARD_LINES, PICTURE_LINES = 17.0, 8.5
"""How wide a card is, and how high its picture, in lines of text."""

ARROWS = {
    Qt.Key.Key_Left: "left",
    Qt.Key.Key_Right: "right",
    Qt.Key.Key_Up: "up",
    Qt.Key.Key_Down: "down",
}


class Signs(QWidget):
    """Small icons with words under each other: what one needs, how long it takes."""

    def __init__(self, example: Example, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._example, self._look = example, look
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        follow_words(self, self._say)

    def _say(self) -> None:
        self._signs = signs_of(self._example)
        self.setAccessibleName(". ".join(words for _, words in self._signs))
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """A line for each."""
        metrics = self._metrics()
        wide = max((metrics.horizontalAdvance(words) for _, words in self._signs), default=0)
        return QSize(wide + 2 * metrics.height(), self._row(metrics) * len(self._signs))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the icons and words."""
        metrics, theme = self._metrics(), self._look.theme
        side, row = metrics.height() * 0.9, self._row(metrics)
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setFont(self._small_font())
            painter.setPen(theme.colour("muted"))
            for number, (name, words) in enumerate(self._signs):
                x = self.width() - side if is_mirrored else 0.0
                top = number * row + (row - side) / 2
                paint_icon(painter, QRectF(x, top, side, side), name, theme.colour("muted"))
                room = self.rect().adjusted(round(side * 1.5), 0, 0, 0)
                if is_mirrored:
                    room = self.rect().adjusted(0, 0, -round(side * 1.5), 0)
                room.setTop(number * row)
                room.setHeight(row)
                said = metrics.elidedText(words, Qt.TextElideMode.ElideRight, room.width())
                flags = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeading
                painter.drawText(room, flags, said)

    def _small_font(self) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(round(self.fontMetrics().height() * 0.74))
        return font

    def _metrics(self) -> QFontMetrics:
        return QFontMetrics(self._small_font())

    def _row(self, metrics: QFontMetrics) -> int:
        return round(metrics.height() * 1.25)


class PictureCard(QFrame):
    """A card that is chosen by a click or with the keyboard.

    ``moved_on`` asks for the card on another side: "left", "right", "up", "down".
    """

    clicked = Signal()
    moved_on = Signal(str)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        styled(self, kind="card")
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def set_width(self, width: int) -> None:
        """Be so wide, and as high as that needs."""
        if self.minimumWidth() != width:
            self.setFixedWidth(width)
            self.fit_height()

    def fit_height(self) -> None:
        """Be as high as the words need now."""
        if (layout := self.layout()) is not None:
            layout.invalidate()  # it would keep the height of other words
            high = layout.totalHeightForWidth(self.minimumWidth())
            self.setMinimumHeight(high if high > 0 else layout.totalSizeHint().height())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """A click."""
        is_inside = self.rect().contains(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and is_inside:
            self.clicked.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter and Space are a click; arrows go to the cards around."""
        key = Qt.Key(event.key())
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space):
            self.clicked.emit()
        elif key in ARROWS and event.modifiers() in (
            Qt.KeyboardModifier.NoModifier,
            Qt.KeyboardModifier.KeypadModifier,
        ):
            self.moved_on.emit(ARROWS[key])
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw a line around it when the mouse or the keyboard is there."""
        super().paintEvent(event)
        if not self.hasFocus() and not self.underMouse():
            return
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            width = max(2.0, self.fontMetrics().height() / 9)
            colour = self._look.theme.colour("focus" if self.hasFocus() else "accent")
            painter.setPen(QPen(colour, width))
            half, round_ = width / 2, self.fontMetrics().height() * 0.42
            inner = self.rect().toRectF().adjusted(half, half, -half, -half)
            painter.drawRoundedRect(inner, round_, round_)


class Card(PictureCard):
    """An example that can be opened, or tried at once; its robots act while it is looked at."""

    try_requested = Signal()

    def __init__(self, example: Example, look: Look, width: int, parent: QWidget) -> None:
        super().__init__(look, parent)
        self.example = example
        line = self.fontMetrics().height()
        self.picture = ActingPicture(example.path.stem, look, round_=line * 0.42)
        self.picture.setFixedHeight(round(line * PICTURE_LINES))
        self.signs = Signs(example, self._look)
        title = _label(example.title, "heading")
        font = title.font()
        font.setWeight(QFont.Weight.DemiBold)
        title.setFont(font)
        words = (title, _label(example.sentence, "hint"), self.signs, 1)
        margins, buttons = (line // 2, line // 4, line // 2, 0), self._buttons(example.title, line)
        inside = in_column(*words, buttons, margins=margins, spacing=line // 4)
        in_column(self.picture, (inside, 1), of=self, margins=(2, 2, 2, line // 2), spacing=0)
        self.setFixedWidth(width or round(line * CARD_LINES) + 4)
        follow_words(self, self._say)

    def _say(self) -> None:
        title, sentence = tr(self.example.title), tr(self.example.sentence)
        self.setAccessibleName(f"{title}. {sentence}")
        self.setAccessibleDescription(self.signs.accessibleName())
        self.setToolTip("\n".join(f"• {tr(each.words)}" for each in self.example.tries))
        self.fit_height()

    def _buttons(self, title: str, line: int) -> Flow:
        row = Flow(spacing=line // 3)
        row.setContentsMargins(0, line // 4, 0, 0)
        named = text_of(title)
        self.try_button = labelled(
            QPushButton(),
            text="Try on the simulator",
            name=text_of("Try “{example}” on the simulator", example=named),
        )
        self.try_button.setIcon(icon("play", self._look.theme))
        self.try_button.setIconSize(icon_room(line))
        self.try_button.clicked.connect(self.try_requested)
        self.open_button = labelled(
            QPushButton(), text="Open", name=text_of("Open “{example}”", example=named)
        )
        self.open_button.clicked.connect(self.clicked)
        for button in (self.try_button, self.open_button):
            button.setCursor(Qt.CursorShape.ArrowCursor)
            row.addWidget(button)
        return row

    def event(self, event: QEvent) -> bool:
        """Let the robots act while the pointer or the keyboard is here."""
        is_done = super().event(event)
        if event.type() in LOOKED_AT:
            self.picture.act(self.underMouse() or self.hasFocus())
        return is_done


LOOKED_AT = (
    *(QEvent.Type.Enter, QEvent.Type.Leave, QEvent.Type.HoverEnter, QEvent.Type.HoverLeave),
    *(QEvent.Type.FocusIn, QEvent.Type.FocusOut),
)
"""The events after which a card may be looked at or not any more."""


def _label(words: str, role: str) -> QLabel:
    label = labelled(styled(ReadingLabel(), role=role), text=words)
    label.setWordWrap(True)
    return label


FIRST_ROWS = 2
"""So many rows of cards are seen at first."""
FEWEST_WITH_TAG = 2
"""A tag of fewer examples is found by the search only."""


class SearchLine(QLineEdit):
    """Where a person types what an example is about; ``left_downwards`` goes to the cards."""

    left_downwards = Signal()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter and Down go on to the cards, Escape empties the line."""
        if event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.left_downwards.emit()
        elif event.key() == Qt.Key.Key_Escape and self.text():
            self.clear()
        else:
            super().keyPressEvent(event)


class Gallery(QWidget):
    """Cards of all examples. ``opened`` and ``try_requested`` give the file of one."""

    opened = Signal(Path)
    try_requested = Signal(Path)
    focus_moved = Signal(QWidget)

    def __init__(self, studio: Studio, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio = studio
        self._unbuilt = list(examples())
        self._cards: dict[Path, Card] = {}
        self._shown: list[Card] = []
        self._placed = 0
        """So many of the shown ones are in their places."""
        self.tag_buttons: dict[str, QPushButton] = {}
        self._columns = self._wide = 0
        self._building = QTimer(self, interval=0)
        self._building.timeout.connect(self._on_build_next)
        line = self.fontMetrics().height()
        box = in_column(
            self._search_row(line), self._tag_row(line), of=self, margins=0, spacing=line // 2
        )
        self.nothing = hint("No example is about this. Try fewer words.")
        self.nothing.hide()
        box.addWidget(self.nothing)
        self._grid = QGridLayout()
        self._grid.setSpacing(line)
        self._grid.setAlignment(Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignTop)
        box.addLayout(self._grid)

    @property
    def cards(self) -> dict[Path, Card]:
        """The cards of all examples by file."""
        while self._unbuilt:
            self._build_next()
        return self._cards

    @property
    def card_width(self) -> int:
        """How wide each card is."""
        return self._wide

    @property
    def is_complete(self) -> bool:
        """Whether all cards are made."""
        return not self._unbuilt

    @property
    def shown(self) -> list[Card]:
        """The cards that are about what is searched for."""
        return self._shown if self.cards else []

    def _search_row(self, line: int) -> QHBoxLayout:
        self.search = labelled(SearchLine(), placeholder="Find an example", name="Find an example")
        self.search.setClearButtonEnabled(True)
        self.search.addAction(
            icon("search", self._studio.look.theme), QLineEdit.ActionPosition.LeadingPosition
        )
        self.search.setMaximumWidth(line * 18)
        self.search.textChanged.connect(self._on_filter_changed)
        self.search.left_downwards.connect(self._on_left_search)
        return in_row(self.search, 1)

    def _tag_row(self, line: int) -> QWidget:
        row = QWidget()
        policy = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        policy.setHeightForWidth(True)
        row.setSizePolicy(policy)
        flow = Flow(row, spacing=line // 3)
        counts = Counter(tag for example in examples() for tag in example.tags)
        for tag in (tag for tag, count in counts.items() if count >= FEWEST_WITH_TAG):
            button = self.tag_buttons[tag] = labelled(QPushButton(), text=TAGS.get(tag, tag))
            button.setCheckable(True)
            button.clicked.connect(lambda _=False, tag=tag: self._on_tag_clicked(tag))
            flow.addWidget(button)
        return row

    def _build_next(self) -> None:
        """Make one more card; all at once would keep the window waiting.

        They come into their places together, first those that are seen first: to lay out and to
        paint the page for each takes longer than to make it.
        """
        example = self._unbuilt.pop(0)
        path = example.path
        card = self._cards[path] = Card(example, self._studio.look, self._wide, self)
        card.clicked.connect(lambda: self.opened.emit(path))
        card.try_requested.connect(lambda: self.try_requested.emit(path))
        card.moved_on.connect(lambda side: self._on_moved(card, side))
        self._shown.append(card)
        if self._columns and len(self._shown) in (FIRST_ROWS * self._columns, len(examples())):
            self._put_waiting()

    # Which cards, and where

    def show_in(self, width: int) -> None:
        """Put as many cards beside each other as there is room for."""
        line = self.fontMetrics().height()
        columns = max(1, (width + line) // (round(line * CARD_LINES) + line))
        self._wide = max((width + line) // columns - line, line * 8)
        for card in self._cards.values():
            card.set_width(self._wide)
        if columns != self._columns:
            self._columns = columns
            self._place()

    def _place(self) -> None:
        for card in self._cards.values():
            self._grid.removeWidget(card)
            card.setVisible(card in self._shown)
        self._placed = 0
        self._put_waiting()
        self.nothing.setVisible(not self._shown and not self._unbuilt)

    def _put_waiting(self) -> None:
        """Put the cards into their places that are shown, but not there yet."""
        for number in range(self._placed, len(self._shown)):
            card = self._shown[number]
            self._grid.addWidget(card, number // self._columns, number % self._columns)
            card.show()
        self._placed = len(self._shown)

    def _on_filter_changed(self) -> None:
        wanted = self.search.text().casefold().split()
        tags = {tag for tag, button in self.tag_buttons.items() if button.isChecked()}
        self._shown = [card for card in self.cards.values() if _fits(card.example, wanted, tags)]
        self._place()
        announce(self.search, count_words(len(self.shown), "1 example", "{n} examples"))

    def _on_tag_clicked(self, tag: str) -> None:
        """At most one tag is chosen; the chosen one clicked again is chosen no more."""
        for other, button in self.tag_buttons.items():
            button.setChecked(other == tag and button.isChecked())
        self._on_filter_changed()

    def _on_left_search(self) -> None:
        if self.shown:
            self._focus(self.shown[0])

    def _on_moved(self, card: Card, side: str) -> None:
        forward, down = -1 if is_right_to_left() else 1, self._columns
        steps = {"left": -forward, "right": forward, "up": -down, "down": down}
        to = self.shown.index(card) + steps[side]
        if 0 <= to < len(self.shown):
            self._focus(self.shown[to])
        elif side == "up":
            self.search.setFocus(Qt.FocusReason.BacktabFocusReason)
            self.focus_moved.emit(self.search)

    def _focus(self, card: Card) -> None:
        card.setFocus(Qt.FocusReason.TabFocusReason)
        self.focus_moved.emit(card)

    def showEvent(self, event: QShowEvent) -> None:
        """Go on making cards."""
        super().showEvent(event)
        self._building.start()

    def _on_build_next(self) -> None:
        """Make one card at a time, so that the window is there at once."""
        if self._unbuilt and self.isVisible():
            self._build_next()
        else:
            self._building.stop()


def _fits(example: Example, wanted: list[str], tags: set[str]) -> bool:
    """Whether an example has the chosen tag and all words that were typed."""
    if not tags <= set(example.tags):
        return False
    text = search_text(example)
    return all(word in text for word in wanted)

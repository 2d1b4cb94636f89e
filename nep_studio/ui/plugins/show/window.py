"""The full screen of a show: what is said, what somebody can do now, Run or Stop, nothing else."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QCloseEvent,
    QFont,
    QFontMetrics,
    QGuiApplication,
    QKeyEvent,
    QPainter,
    QPaintEvent,
    QPalette,
    QPen,
    QResizeEvent,
    QScreen,
)
from PySide6.QtWidgets import (
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QToolButton,
    QWidget,
)

from nep_studio.problems import Problem
from nep_studio.project.triggers import Cue
from nep_studio.settings import ShowOptions
from nep_studio.ui.cue_style import ICONS, invitation
from nep_studio.ui.labels import explained
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon, paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel, screen_around, styled
from nep_studio.ui.widgets.layouts import InLines, in_column, in_row
from nep_studio.ui.words import count_words, tr

from .leaving import HoldBar, Holding, PinQuestion, Pointing, StayingAwake
from .performance import Performance

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


# Words that are as large as the room allows, for people who stand far away.

MOST_INVITATIONS = 6
_FLAGS = Qt.TextFlag.TextWordWrap.value | Qt.AlignmentFlag.AlignCenter.value


class StageWords(InLines):
    """Lines that fill their room together, as large as they can be."""

    usual_lines = (20, 6)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.lines: list[str] = []
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def show_lines(self, lines: list[str]) -> None:
        """Show these."""
        self.lines = lines
        self.setAccessibleName(" ".join(lines))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the lines."""
        if not self.lines:
            return
        text = "\n".join(self.lines)
        with QPainter(self) as painter:
            painter.setFont(self._fitting(text, self.rect()))
            painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
            painter.drawText(self.rect(), _FLAGS, text)

    def _fitting(self, text: str, room: QRect) -> QFont:
        """The largest font in which the text fits."""
        least, most = 8, max(9, room.height() // 3)
        while least < most:
            middle = (least + most + 1) // 2
            metrics = QFontMetrics(_large_font(self, middle))
            needed = metrics.boundingRect(room, _FLAGS, text)
            fits = needed.height() <= room.height() and needed.width() <= room.width()
            least, most = (middle, most) if fits else (least, middle - 1)
        return _large_font(self, least)


class Invitations(InLines):
    """What somebody who stands before the robot can do now: a sign and words for each."""

    usual_lines = (20, 4)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.cues: list[Cue] = []
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    @property
    def lines(self) -> list[str]:
        """The words of all that is shown."""
        return [invitation(cue) for cue in self.cues[:MOST_INVITATIONS]]

    def show_cues(self, cues: list[Cue]) -> None:
        """Show these, the first ones where there are too many to be read."""
        self.cues = cues
        self.setAccessibleName(", ".join(self.lines))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint a card for each, beside each other while there is room."""
        cues, lines = self.cues[:MOST_INVITATIONS], self.lines
        if not cues:
            return
        columns = min(len(cues), 3 if self.width() > self.height() else 1)
        rows = -(-len(cues) // columns)
        gap = max(4, self.height() // 30)
        wide, high = self.width() / columns, self.height() / rows
        theme = self._look.theme
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            for number, (cue, words) in enumerate(zip(cues, lines, strict=True)):
                row, column = divmod(number, columns)
                there = min(columns, len(cues) - row * columns)
                left = (self.width() - there * wide) / 2 + column * wide
                if self.isRightToLeft():
                    left = self.width() - left - wide
                card = QRectF(left, row * high, wide, high).adjusted(gap, gap, -gap, -gap)
                painter.setPen(QPen(theme.colour("field_line"), max(1, gap // 4)))
                painter.setBrush(theme.colour("panel"))
                painter.drawRoundedRect(card, 2 * gap, 2 * gap)
                self._paint_words(painter, card.adjusted(3 * gap, gap, -2 * gap, -gap), cue, words)

    def _paint_words(self, painter: QPainter, room: QRectF, cue: Cue, words: str) -> None:
        side = min(room.height() * 0.5, room.width() * 0.2)
        is_mirrored = self.isRightToLeft()
        start = room.right() - side if is_mirrored else room.left()
        sign = QRectF(start, room.center().y() - side / 2, side, side)
        paint_icon(painter, sign, ICONS[cue.kind], self._look.theme.colour("accent"))
        beside = side * 1.3
        text = room.adjusted(0 if is_mirrored else beside, 0, -beside if is_mirrored else 0, 0)
        size, flags = room.height() * 0.34, _FLAGS
        while size > 9:
            metrics = QFontMetrics(_large_font(self, size))
            needed = metrics.boundingRect(text.toRect(), flags, words)
            if needed.height() <= text.height() and needed.width() <= text.width():
                break
            size *= 0.9
        painter.setFont(_large_font(self, size))
        painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
        painter.drawText(text, flags, words)


def _large_font(widget: QWidget, pixels: float) -> QFont:
    font = QFont(widget.font())
    font.setPixelSize(max(8, round(pixels)))
    font.setWeight(QFont.Weight.DemiBold)
    return font


# The calm page of a show that somebody must look after: what happened, and what to try.


class AttentionPage(QScrollArea):
    """Large words for who passes, a checklist for who can help."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, widgetResizable=True)
        self.setFrameShape(QScrollArea.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setStyleSheet("QScrollArea { background: transparent; }")
        self.headline, self.text = _words(), _words()
        inside = QWidget()
        inside.setObjectName("inside")
        inside.setStyleSheet("#inside { background: transparent; }")
        in_column(1, self.headline, self.text, 1, of=inside)
        self.setWidget(inside)
        self.viewport().setAutoFillBackground(False)

    def show_problem(self, problem: Problem | None, times: int) -> None:
        """Show a problem, and how often it was tried to go on."""
        if problem is None:
            self.text.clear()
            return
        tried = count_words(times, "It was begun again once.", "It was begun again {n} times.")
        steps = [*map(tr, problem.checklist), tr("Then press Run.")]
        told = ": ".join(tr(words) for words in (problem.title, problem.sentence) if words)
        boxes = (f"\N{WHITE SQUARE} {step}" for step in steps)
        lines = ["", told, *([tried] if times else []), "", *boxes]
        self.text.setText("\n".join(lines))
        self.headline.setText(tr("The show is having a rest."))
        pixels = max(14, self.window().height() // 28)
        self.headline.setStyleSheet(f"font-size: {2 * pixels}px; font-weight: 600;")
        self.text.setStyleSheet(f"font-size: {pixels}px;")


def _words() -> QLabel:
    middle = Qt.AlignmentFlag.AlignCenter
    return QLabel(textFormat=Qt.TextFormat.PlainText, wordWrap=True, alignment=middle)


BUTTON_PART, TITLE_PART, STATE_PART = 0.055, 0.05, 0.03
"""How large words are, as parts of the height of the screen."""

_SIGNS = {
    "ready": ("circle", "muted"),
    "opening": ("clock", "info"),
    "starting": ("clock", "info"),
    "playing": ("play", "success"),
    "stopping": ("square", "warning"),
    "waiting": ("refresh-cw", "info"),
    "attention": ("triangle-alert", "warning"),
}


class ShowWindow(QWidget):
    """Covers the screen until somebody leaves on purpose, which ``left`` tells."""

    left = Signal()

    def __init__(self, host: Host, performance: Performance, options: ShowOptions) -> None:
        super().__init__(None, Qt.WindowType.Window | Qt.WindowType.FramelessWindowHint)
        self._host, self.performance = host, performance
        self._may_close = False
        self.setObjectName("show")
        self.setAutoFillBackground(True)
        self.title = ElidedLabel()
        self.title.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.title.setTextFormat(Qt.TextFormat.PlainText)
        self.state_sign, self.state_words = QLabel(), QLabel(textFormat=Qt.TextFormat.PlainText)
        self.corner = explained(_corner_button(), "Leave: hold it for two seconds")
        self.cues_button = explained(_corner_button(), "Cues")
        self.cues_button.setCheckable(True)
        self.cues_button.setChecked(options.has_cues)
        self.words = StageWords()
        self.invitations = Invitations(host.services.look)
        self.attention = AttentionPage(self)
        self.middle = QStackedWidget()
        stage = QWidget()
        in_column((self.words, 3), (self.invitations, 2), of=stage, margins=0)
        self.middle.addWidget(stage)
        self.middle.addWidget(self.attention)
        self.run_button = _large_button(tr("Run"), "run")
        self.stop_button = _large_button(tr("Stop"), "stop")
        self.cues = host.ask("cues.make_large", self)
        self.cues.setVisible(options.has_cues)
        self.awake = StayingAwake()
        self.holding = Holding(self, self.corner)
        self.pointing = Pointing(self)
        self.hold_bar = HoldBar(self)
        self.pin = PinQuestion(host.services.settings.is_pin, self)
        self.head = QWidget()
        state = in_row(1, self.state_sign, self.state_words, 1)
        in_column(self.title, state, of=self.head, margins=0)
        for part in (self.head, self.corner, self.cues_button):
            policy = part.sizePolicy()
            policy.setRetainSizeWhenHidden(True)  # what is read stays where it is
            part.setSizePolicy(policy)
        top = in_row(self.cues_button, (self.head, 1), self.corner)
        buttons = in_row(1, (self.run_button, 2), (self.stop_button, 2), 1)
        self._box = in_column(top, (self.middle, 4), (self.cues, 5), buttons, of=self)
        self._connect()
        self._dress()
        self.refresh()

    def open(self) -> None:
        """Cover the screen that the window is on."""
        self.setGeometry(screen_around(self._host.widget))
        self.showFullScreen()
        self.activateWindow()
        self.run_button.setFocus()
        self.pointing.follow(self.windowHandle())
        self.pointing.seen()
        self.hold_bar.say_how()
        self.awake.begin()

    def leave(self) -> None:
        """End the show; what runs goes on in the studio's window."""
        self._may_close = True
        self.awake.end()
        self.close()
        self.left.emit()

    def refresh(self) -> None:
        """Show how the performance goes."""
        show = self.performance
        self.title.set_words(show.title)
        self.setWindowTitle(show.title or tr("Show"))
        needs_somebody = show.state == "attention"
        self.middle.setCurrentIndex(1 if needs_somebody else 0)
        self.attention.show_problem(show.problem if needs_somebody else None, show.restarts.total)
        self.run_button.setVisible(not show.is_running)
        self.run_button.setEnabled(show.state in ("ready", "attention"))
        self.stop_button.setVisible(show.is_running)
        words = self._state_text()
        if words != self.state_words.text():
            self.state_words.setText(words)
            announce(self, words)
        self._show_sign()
        self._show_lines()
        self._show_what_the_pointer_needs()

    def closeEvent(self, event: QCloseEvent) -> None:
        """Keys that close windows do not close a show; the end of the session does."""
        if self._may_close or _application().isSavingSession():
            super().closeEvent(event)
        else:
            event.ignore()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The keys of the cues work everywhere."""
        if event.isAutoRepeat() or not self.cues.press(event.text()):
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """All is measured by the screen, which may be another one now."""
        super().resizeEvent(event)
        self._dress()

    def _connect(self) -> None:
        self.performance.changed.connect(self.refresh)
        self.performance.told.connect(self._show_lines)
        self.run_button.clicked.connect(self.performance.run)
        self.stop_button.clicked.connect(self.performance.stop)
        self.holding.progress.connect(self.hold_bar.show_progress)
        self.holding.held.connect(self._on_held)
        self.corner.clicked.connect(self._on_corner_clicked)
        self.cues_button.toggled.connect(self.cues.setVisible)
        self.cues_button.toggled.connect(self._show_lines)
        self.pointing.changed.connect(self._show_what_the_pointer_needs)
        self.pin.right.connect(self.leave)
        self._host.services.look.theme_changed.connect(self._dress)
        application = _application()
        application.screenRemoved.connect(self._on_screens_changed)
        application.primaryScreenChanged.connect(self._on_screens_changed)

    def _state_text(self) -> str:
        show = self.performance
        again = count_words(show.restarts.total, "begun again once", "begun again {n} times")
        words = {
            "ready": tr("Ready"),
            "opening": tr("The project is being opened"),
            "starting": tr("It begins in a moment"),
            "playing": tr("On"),
            "stopping": tr("Stopping"),
            "waiting": tr("It begins again in {seconds} s", seconds=show.seconds_left),
            "attention": tr("Needs attention"),
        }[show.state]
        return f"{words} · {again}" if show.restarts.total else words

    def _show_sign(self) -> None:
        name, colour = _SIGNS[self.performance.state]
        side = self.state_words.fontMetrics().height()
        picture = icon(name, self._host.services.look.theme.colour(colour))
        self.state_sign.setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))

    def _show_lines(self) -> None:
        show = self.performance
        lines = show.said
        if not lines and show.state == "ready":
            lines = [tr("Press Run to begin.")]
        self.words.show_lines(lines)
        # the buttons of the cues say the same, and need the room
        self.invitations.setVisible(not self.cues_button.isChecked())
        self.invitations.show_cues(show.invited)

    def _show_what_the_pointer_needs(self) -> None:
        """A public sees only the play; who moves the mouse, or touches, how to lead it too."""
        is_there = self.pointing.is_there or self.holding.is_held
        self.head.setVisible(is_there or self.performance.state != "playing")
        self.corner.setVisible(is_there)
        self.cues_button.setVisible(is_there)

    def _on_corner_clicked(self) -> None:
        """Somebody did not know that it is to be held."""
        if not self.pin.isVisible():
            self.hold_bar.say_how()

    def _on_held(self) -> None:
        if self._host.services.settings.has_pin:
            self.pin.ask()
        else:
            self.leave()

    def _on_screens_changed(self, _screen: QScreen | None = None) -> None:
        """Cover the screen that is left, once the system has moved the window there."""
        if self.isVisible():
            QTimer.singleShot(0, self, self._cover)

    def _cover(self) -> None:
        if self.isVisible():
            self.setGeometry(screen_around(self))
            self.showFullScreen()

    def _dress(self) -> None:
        theme, height = self._host.services.look.theme, max(self.height(), 200)
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.Window, theme.colour("canvas"))
        palette.setColor(QPalette.ColorRole.WindowText, theme.colour("text"))
        palette.setColor(QPalette.ColorRole.PlaceholderText, theme.colour("muted"))
        self.setPalette(palette)
        _size(self.title, height * TITLE_PART)
        _size(self.state_words, height * STATE_PART)
        self.hold_bar.fit(max(11, round(height * STATE_PART)))
        side = round(height * TITLE_PART * 1.2)
        for corner, name in ((self.corner, "x"), (self.cues_button, "flag")):
            corner.setIcon(icon(name, theme))
            corner.setIconSize(QSize(side, side))
        gap = round(height * 0.02)
        self._box.setContentsMargins(2 * gap, gap, 2 * gap, 2 * gap)
        self._box.setSpacing(gap)
        for button, name, ink in (
            (self.run_button, "play", "run_text"),
            (self.stop_button, "square", "stop_text"),
        ):
            _size(button, height * BUTTON_PART)
            side = round(height * BUTTON_PART * 1.2)
            button.setIcon(icon(name, theme.colour(ink)))
            button.setIconSize(QSize(side, side))
            button.setMinimumHeight(round(height * BUTTON_PART * 2.4))
        self._show_sign()


def _application() -> QGuiApplication:
    application = QGuiApplication.instance()
    assert isinstance(application, QGuiApplication)
    return application


def _large_button(words: str, kind: str) -> QPushButton:
    # Qt leaves too little beside so large an icon
    button = styled(QPushButton(f"\N{EN SPACE}{words}"), kind=kind)
    button.setAccessibleName(words)
    return button


def _corner_button() -> QToolButton:
    button = QToolButton(autoRaise=True)
    button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return button


def _size(widget: QWidget, pixels: float) -> None:
    """Give a widget words of this height; a style sheet of the window sets the font otherwise."""
    widget.setStyleSheet(f"font-size: {max(9, round(pixels))}px; font-weight: 600;")

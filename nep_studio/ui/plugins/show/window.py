"""The full screen of a show: what is played, what happens now, Run and Stop, and nothing else."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QCloseEvent,
    QFont,
    QFontMetrics,
    QGuiApplication,
    QKeyEvent,
    QPainter,
    QPaintEvent,
    QPalette,
    QResizeEvent,
    QScreen,
)
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QWidget,
)

from nep_core.processes.process import program_command
from nep_studio.problems import Problem
from nep_studio.settings import ShowOptions
from nep_studio.support import startup
from nep_studio.support.startup import Place, StartupFile, startup_files
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import code_font
from nep_studio.ui.widgets.forms import ElidedLabel, plain_label, screen_around, styled
from nep_studio.ui.widgets.layouts import InLines, in_column, in_row
from nep_studio.ui.words import count_words, tr

from .leaving import HoldBar, Holding, PinQuestion, StayingAwake
from .performance import Performance

if TYPE_CHECKING:
    from nep_studio.ui.host import Host


# Words that are as large as the room allows, for people who stand far away.

_FLAGS = Qt.TextFlag.TextWordWrap.value | Qt.AlignmentFlag.AlignCenter.value


class StageWords(InLines):
    """A text that fills its room, with the lines before it, smaller, above."""

    usual_lines = (20, 8)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.lines: list[str] = []
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def show_lines(self, lines: list[str]) -> None:
        """Show these, the last one large."""
        self.lines = lines
        self.setAccessibleName(lines[-1] if lines else "")
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the lines."""
        if not self.lines:
            return
        *before, now = self.lines
        with QPainter(self) as painter:
            room = self.rect()
            small = self._font(room.height() / 14)
            height = QFontMetrics(small).lineSpacing()
            painter.setFont(small)
            painter.setPen(self.palette().color(QPalette.ColorRole.PlaceholderText))
            metrics = QFontMetrics(small)
            for number, line in enumerate(before):
                row = QRect(room.left(), room.top() + number * height, room.width(), height)
                shown = metrics.elidedText(line, Qt.TextElideMode.ElideRight, row.width())
                painter.drawText(row, Qt.AlignmentFlag.AlignCenter, shown)
            large = room.adjusted(0, len(before) * height, 0, 0)
            painter.setFont(self._fitting(now, large))
            painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
            painter.drawText(large, _FLAGS, now)

    def _fitting(self, text: str, room: QRect) -> QFont:
        """The largest font in which the text fits."""
        least, most = 8, max(9, room.height() // 3)
        while least < most:
            middle = (least + most + 1) // 2
            metrics = QFontMetrics(self._font(middle))
            needed = metrics.boundingRect(room, _FLAGS, text)
            fits = needed.height() <= room.height() and needed.width() <= room.width()
            least, most = (middle, most) if fits else (least, middle - 1)
        return self._font(least)

    def _font(self, pixels: float) -> QFont:
        font = QFont(self.font())
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
        self.words = StageWords()
        self.attention = AttentionPage(self)
        self.middle = QStackedWidget()
        self.middle.addWidget(self.words)
        self.middle.addWidget(self.attention)
        self.run_button = _large_button(tr("Run"), "run")
        self.stop_button = _large_button(tr("Stop"), "stop")
        self.cues = host.ask("cues.make_large", self) if options.has_cues else None
        self.awake = StayingAwake()
        self.holding = Holding(self, self.title)
        self.hold_bar = HoldBar(self)
        self.pin = PinQuestion(host.services.settings.is_pin, self)
        head = in_row(1, self.state_sign, self.state_words, 1)
        buttons = in_row(1, (self.run_button, 2), (self.stop_button, 2), 1)
        cues = [(self.cues, 5)] if self.cues is not None else []
        self._box = in_column(self.title, head, (self.middle, 3), *cues, buttons, of=self)
        self._connect()
        self._dress()
        self.refresh()

    def open(self) -> None:
        """Cover the screen that the window is on."""
        self.setGeometry(screen_around(self._host.widget))
        self.showFullScreen()
        self.activateWindow()
        self.run_button.setFocus()
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
        self.middle.setCurrentWidget(self.attention if needs_somebody else self.words)
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

    def closeEvent(self, event: QCloseEvent) -> None:
        """Keys that close windows do not close a show; the end of the session does."""
        if self._may_close or _application().isSavingSession():
            super().closeEvent(event)
        else:
            event.ignore()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """The keys of the cues work everywhere."""
        if self.cues is None or not self.cues.board.press(event.text()):
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
        lines = [f"{who} {what}" for who, what in show.lines]
        if not lines and show.state == "ready":
            lines = [tr("Press Run to begin.")]
        self.words.show_lines(lines)

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


def _size(widget: QWidget, pixels: float) -> None:
    """Give a widget words of this height; a style sheet of the window sets the font otherwise."""
    widget.setStyleSheet(f"font-size: {max(9, round(pixels))}px; font-weight: 600;")


# The dialog that lets a show start with the computer; it shows what is written, and where.


class StartupDialog(QDialog):
    """Writes nothing until its button is pressed, and takes away what it wrote."""

    def __init__(self, host: Host, place: Place | None = None) -> None:
        super().__init__(host.widget)
        self.setWindowTitle(tr("Start with the computer"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._host, self._place = host, place or Place.here()
        document = host.services.document
        self.project: Path | None = document.path if document is not None else None
        self.runs_at_once = QCheckBox(tr("Run at once, without anybody pressing Run"))
        self.runs_at_once.setChecked(True)
        self.has_cues = QCheckBox(tr("With the cue buttons, for an operator"))
        self.state = plain_label()
        self.text = QPlainTextEdit(readOnly=True, lineWrapMode=QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setAccessibleName(tr("What is written, and where"))
        self.text.setFont(code_font(self.font().pointSizeF()))
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.write_button = QPushButton(tr("Write these files"))
        self.remove_button = QPushButton(tr("Remove these files"))
        self.close_button = QPushButton(tr("Close"))
        self._lay_out()
        self.runs_at_once.toggled.connect(self.refresh)
        self.has_cues.toggled.connect(self.refresh)
        self.write_button.clicked.connect(lambda: self._attempt(startup.write))
        self.remove_button.clicked.connect(lambda: self._attempt(startup.remove))
        self.close_button.clicked.connect(self.accept)
        self.refresh()

    @property
    def files(self) -> list[StartupFile]:
        """What would be written now."""
        words = ["show", str(self.project or "PROJECT.nep")]
        words += ["--run"] if self.runs_at_once.isChecked() else []
        words += ["--cues"] if self.has_cues.isChecked() else []
        return startup_files(self._place, program_command(*words))

    def refresh(self) -> None:
        """Show what would be written, and what is there."""
        files = self.files
        self.text.setPlainText("\n\n".join(f"{file.path}\n\n{file.text}" for file in files))
        is_there = any(file.is_there for file in files)
        is_same = all(file.is_as_written for file in files)
        self.write_button.setEnabled(self.project is not None and not is_same)
        self.remove_button.setEnabled(is_there)
        if self.project is None:
            words = tr("Save the project first: the computer has to find it.")
        elif is_same:
            words = tr("The show starts with the computer, as it is written here.")
        elif is_there:
            words = tr("Another show starts with the computer now. These files would replace it.")
        else:
            words = tr("Nothing starts with the computer yet. These files would be written:")
        self.state.setText(words)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        about = tr(
            "The show starts when somebody logs in to this computer, and starts again if it "
            "ends by accident. To end it, leave the show and quit NEP Studio."
        )
        chosen = (QLabel(about, wordWrap=True), self.runs_at_once, self.has_cues, self.state)
        buttons = in_row(self.remove_button, 1, self.close_button, self.write_button)
        in_column(*chosen, (self.text, 1), buttons, of=self, margins=line)
        self.resize(line * 42, line * 34)

    def _attempt(self, do: Callable[[list[StartupFile]], None]) -> None:
        try:
            do(self.files)
        except OSError as error:
            self.refresh()
            reason = tr((error.strerror or str(error)).lower())
            self.state.setText(tr("That did not work. The computer says: {reason}.", reason=reason))
            return
        self.refresh()

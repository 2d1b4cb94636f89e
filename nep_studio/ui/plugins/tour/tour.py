"""The tour: its steps as data, and how it goes from one to the next, back again, and out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QApplication,
    QFrame,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QToolButton,
    QWidget,
)

from faults import text_of
from nep_studio import paths
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Block, Stack
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import styled
from nep_studio.ui.widgets.layouts import ReadingLabel, in_column, in_row
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.ui.documents import Document
    from nep_studio.ui.host import Host

# The steps of the tour as data: what is said, what is shown, and what a person does there.

FIRST_STEPS = paths.resources() / "tour" / "first_steps.nep"
"""The project of the tour: a “when” block that waits for others, and a robot on the screen."""

PROJECT = "First steps"
"""What that project is called."""

START, SAY = "event.started", "robot.say"


@dataclass(frozen=True)
class Step:
    """One step. ``target`` is the place in the window that is shown, empty where there is none.

    ``prepare`` lets it be seen. A step with ``is_done`` goes on by itself when that becomes true;
    ``do`` does it in place of a person who goes on without.
    """

    title: str
    text: str
    target: Callable[[Host], QRect]
    prepare: Callable[[Host], object] = lambda _host: None
    is_done: Callable[[Host], bool] | None = None
    do: Callable[[Host], object] = lambda _host: None


def steps() -> list[Step]:
    """The five steps in the language in use."""
    return [
        Step(
            tr("Here are the blocks"),
            tr("Each block is a sentence: something a robot does, or when it does it."),
            lambda host: place_of(host, host.workbench.helpers.palette),
            show_blocks,
        ),
        Step(
            tr("Drag a block"),
            tr("Drag “NAO says” to the page, and let it go under “when the program starts”."),
            _palette_and_page,
            _show_say,
            lambda host: say_block(host) is not None,
            add_say,
        ),
        Step(
            tr("Say it in your words"),
            tr("Click the white field of the new block, type a sentence, and press Enter."),
            _say_place,
            show_blocks,
            _has_own_words,
        ),
        Step(
            tr("Press Run"),
            tr("The program checks your blocks, starts the robot on the screen, and begins."),
            _run_button,
            is_done=_is_running,
        ),
        Step(
            tr("See it happen"),
            tr(
                "The block that runs glows, and NAO says your sentence. To know more of a block,"
                " click it and press F1."
            ),
            _say_place,
        ),
    ]


def place_of(host: Host, widget: QWidget | None) -> QRect:
    """Where a widget is in the window; empty when it is not to be seen."""
    if widget is None or not widget.isVisible():
        return QRect()
    return QRect(widget.mapTo(host.widget, QPoint(0, 0)), widget.size())


def started_stack(host: Host) -> Stack | None:
    """The stack that runs when the program starts."""
    project = host.workbench.canvas.editor.project
    stacks = project.stacks.values()
    return next((s for s in stacks if project.blocks[s.body[0]].type == START), None)


def say_block(host: Host) -> Block | None:
    """The first block in that stack by which a robot says something."""
    stack = started_stack(host)
    project = host.workbench.canvas.editor.project
    found = (project.blocks[block] for block in (stack.body if stack else ()))
    return next((block for block in found if block.type == SAY), None)


def show_blocks(host: Host) -> None:
    """Show the page and the palette, whatever was hidden."""
    workbench = host.workbench
    palette = workbench.helpers.palette
    workbench.panels.show(palette)
    palette.set_narrow(False)
    workbench.canvas.show_page("behaviour")


def add_say(host: Host) -> None:
    """Put the block there for a person who goes on without."""
    stack, canvas = started_stack(host), host.workbench.canvas
    if stack is not None and say_block(host) is None:
        canvas.attempt(lambda: canvas.editor.create(SAY, InStack(stack.id, 1)))


def _show_say(host: Host) -> None:
    show_blocks(host)
    host.workbench.canvas.sight.show_beginning()
    host.workbench.helpers.palette.open_drawer("robot")


def _palette_and_page(host: Host) -> QRect:
    workbench = host.workbench
    page = place_of(host, workbench.canvas)
    return place_of(host, workbench.helpers.palette).united(page)


def _say_place(host: Host) -> QRect:
    """Where the block is on the page; the page where it is out of sight."""
    canvas, block = host.workbench.canvas, say_block(host)
    page = place_of(host, canvas.viewport())
    rect = canvas.sight.view_rect_of(block.id) if block is not None else None
    if rect is None:
        return page
    seen = rect.toAlignedRect().translated(page.topLeft()).intersected(page)
    return seen if seen.height() >= rect.height() / 2 else page


def _has_own_words(host: Host) -> bool:
    canvas, block = host.workbench.canvas, say_block(host)
    if block is None or canvas.fields.widget is not None:
        return False
    usual = canvas.editor.language.definitions[SAY].beginning("text")
    return "text" in block.inputs or block.fields.get("text", usual) != usual


def _run_button(host: Host) -> QRect:
    run = host.actions["run"]
    buttons = host.widget.findChildren(QToolButton)
    return place_of(host, next((one for one in buttons if one.defaultAction() is run), None))


def _is_running(host: Host) -> bool:
    return host.services.runner.state != "idle"


# The bubble of the tour: what a step says, where one is, and the buttons to go on.

WIDE_LINES = 19.0
"""How wide it is, in lines of text, where the window has the room."""


class Dots(QWidget):
    """A dot for each step; the present one is filled."""

    def __init__(self, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self._number = self._count = 0

    def show_place(self, number: int, count: int) -> None:
        """Say which step of how many this is, from 0."""
        self._number, self._count = number, count
        labelled(self, name=text_of("Step {number} of {count}", number=number + 1, count=count))
        self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        """All dots in a row."""
        side = self.fontMetrics().height()
        return QSize(round(side * 0.8 * self._count), side)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the dots, the first where reading begins."""
        side = self.fontMetrics().height()
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        colour = self._look.theme.colour("accent")
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(colour, max(1.0, side / 11)))
            for number in range(self._count):
                x = (number + 0.5) * side * 0.8
                centre = QPoint(round(self.width() - x if is_mirrored else x), self.height() // 2)
                is_filled = number == self._number
                painter.setBrush(colour if is_filled else Qt.BrushStyle.NoBrush)
                radius = round(side * (0.27 if is_filled else 0.2))
                painter.drawEllipse(centre, radius, radius)


class Bubble(QFrame):
    """Says a step; ``forth``, ``back`` and ``left`` are its buttons and keys."""

    forth = Signal()
    back = Signal()
    left = Signal()

    def __init__(self, look: Look, window: QWidget) -> None:
        super().__init__(window)
        styled(self, kind="card").setAutoFillBackground(True)
        self._title, self._text = styled(ReadingLabel(), role="title"), ReadingLabel()
        for label in (self._title, self._text):
            label.setWordWrap(True)
        self._dots = Dots(look, self)
        self.next_button = styled(QPushButton(), kind="primary")
        self.back_button = labelled(QPushButton(), text="Back")
        self.leave_button = labelled(styled(QPushButton(), kind="quiet"), text="End the tour")
        line = self.fontMetrics().height()
        row = in_row(self.leave_button, 1, self.back_button, self.next_button, spacing=line // 3)
        parts, margins = (self._title, self._text, self._dots, row), (line, line * 3 // 4) * 2
        self._box = in_column(*parts, of=self, margins=margins, spacing=line // 2)
        self.next_button.clicked.connect(self.forth)
        self.back_button.clicked.connect(self.back)
        self.leave_button.clicked.connect(self.left)
        self.hide()

    def say(self, step: Step, number: int, count: int) -> None:
        """Show a step, ``number`` of ``count`` from 0."""
        self._title.setText(step.title)
        self._text.setText(step.text)
        self._dots.show_place(number, count)
        self.back_button.setEnabled(number > 0)
        labelled(self.next_button, text="Done" if number == count - 1 else "Next")
        self.leave_button.setVisible(number < count - 1)
        self.setAccessibleName(f"{self._dots.accessibleName()}. {step.title}. {step.text}")

    def sit_beside(self, place: QRect, room: QRect) -> None:
        """Take a place beside what is shown, wholly in the room; in its corner if need be."""
        line = self.fontMetrics().height()
        buttons = self._box.minimumSize().width()
        width = min(max(round(line * WIDE_LINES), buttons), room.width() - line)
        self.resize(width, self._box.totalHeightForWidth(width))
        inner = room.adjusted(line // 2, line // 2, -line // 2, -line // 2)
        self.move(self._best_place(place, inner, line).topLeft())

    def _best_place(self, place: QRect, inner: QRect, gap: int) -> QRect:
        size = self.size()
        corner = QRect(inner.bottomRight() - QPoint(size.width(), size.height()), size)
        if self.layoutDirection() == Qt.LayoutDirection.RightToLeft:
            corner.moveLeft(inner.left())
        if place.isEmpty():
            return corner
        middle = QRect(QPoint(0, 0), size)
        middle.moveCenter(place.center())
        sides = [
            middle.translated(0, place.bottom() + gap - middle.top()),
            middle.translated(place.right() + gap - middle.left(), 0),
            middle.translated(place.left() - gap - middle.right(), 0),
            middle.translated(0, place.top() - gap - middle.bottom()),
        ]
        pushed = [_pushed_into(side, inner) for side in sides]
        return next((side for side in pushed if not side.intersects(place)), corner)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc ends the tour."""
        if event.key() == Qt.Key.Key_Escape:
            self.left.emit()
        else:
            super().keyPressEvent(event)


def _pushed_into(rect: QRect, room: QRect) -> QRect:
    x = min(max(rect.x(), room.x()), max(room.x(), room.right() - rect.width()))
    y = min(max(rect.y(), room.y()), max(room.y(), room.bottom() - rect.height()))
    return QRect(QPoint(x, y), rect.size())


# The veil of the tour: it darkens the window but for the place that is shown.

DARKNESS = {False: 105, True: 165}
"""How dark the veil is, of 255, over a light and over a dark theme."""


class Veil(QWidget):
    """Lies over the whole window; the mouse goes through it everywhere."""

    def __init__(self, look: Look, window: QWidget) -> None:
        super().__init__(window)
        self._look = look
        self.hole = QRect()
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.hide()

    def show_hole(self, hole: QRect) -> None:
        """Show a place of the window; an empty one darkens all of it."""
        if hole != self.hole:
            self.hole = hole
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the veil, and a line around the place."""
        theme, line = self._look.theme, self.fontMetrics().height()
        path = QPainterPath()
        path.addRect(self.rect())
        round_ = line * 0.45
        place = self.hole.toRectF().adjusted(-3, -3, 3, 3) & self.rect().toRectF()
        if not self.hole.isEmpty():
            path.addRoundedRect(place, round_, round_)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.fillPath(path, QColor(0, 0, 0, DARKNESS[theme.is_dark]))
            if not self.hole.isEmpty():
                width = max(2.0, line / 7)
                painter.setPen(QPen(theme.colour("glow"), width))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                inner = place.adjusted(width / 2, width / 2, -width / 2, -width / 2)
                painter.drawRoundedRect(inner, round_, round_)


LOOK_MS = 100
"""How often it looks where things are now and whether they are done."""


class Tour(QObject):
    """Leads through the steps in a project of its own. ``ended`` comes however it ends."""

    ended = Signal()

    def __init__(self, host: Host) -> None:
        super().__init__(host.widget)
        self._host = host
        self._steps: list[Step] = []
        self._document: Document | None = None
        self.number = -1
        self._is_opening = self._was_done = False
        self._shown: tuple[QRect, QRect, int] | None = None
        look, over = host.services.look, host.widget
        self.veil, self.bubble = Veil(look, over), Bubble(look, over)
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._on_look)
        self.bubble.forth.connect(self.go_on)
        self.bubble.back.connect(self.go_back)
        self.bubble.left.connect(self.end)
        host.services.files.document_changed.connect(self._on_document_changed)
        look.theme_changed.connect(self._on_looks_changed)
        follow_words(self, self._on_looks_changed)

    @property
    def is_running(self) -> bool:
        """Whether a step is shown."""
        return self.number >= 0

    def start(self) -> None:
        """Open the project of the tour and begin; work that is not saved is asked about first."""
        self.end()
        self._is_opening = True
        self._host.services.files.open_example(FIRST_STEPS)

    def go_on(self) -> None:
        """Go to the next step; what this one asks for is done if nobody has."""
        step = self._steps[self.number]
        if step.is_done is not None and not step.is_done(self._host):
            step.do(self._host)
        self._go_to(self.number + 1)

    def go_back(self) -> None:
        """Go to the step before."""
        self._go_to(max(0, self.number - 1))

    def end(self) -> None:
        """Put everything away; it is not offered any more."""
        if not self.is_running:
            return
        self.number, self._document, self._shown = -1, None, None
        self._looking.stop()
        handle = self._host.widget.windowHandle()
        if handle is not None:
            handle.removeEventFilter(self)
        focus = QApplication.focusWidget()
        had_focus = focus is not None and self.bubble.isAncestorOf(focus)
        self.bubble.hide()
        self.veil.hide()
        if had_focus and self._host.workbench.isVisible():
            self._host.workbench.canvas.setFocus()
        self.ended.emit()

    def _begin(self) -> None:
        self._host.services.settings.tour_done = True
        self._host.ask("start_page.tour_taken")
        self._steps = steps()
        handle = self._host.widget.windowHandle()
        if handle is not None:
            handle.installEventFilter(self)
        self._go_to(0)
        self._looking.start()
        self.bubble.next_button.setFocus(Qt.FocusReason.OtherFocusReason)

    def _go_to(self, number: int) -> None:
        if number >= len(self._steps):
            self.end()
            return
        self.number = number
        step = self._steps[number]
        step.prepare(self._host)
        self._was_done = step.is_done is not None and step.is_done(self._host)
        self.bubble.say(step, number, len(self._steps))
        self._take_place()
        announce(self.bubble, self.bubble.accessibleName())

    def _take_place(self) -> None:
        """Lie over the window as it is now, above all that has come into it since."""
        room = self._host.widget.rect()
        place = self._steps[self.number].target(self._host).intersected(room)
        if self._shown != (place, room, self.number):
            self._shown = (place, QRect(room), self.number)
            self.veil.setGeometry(room)
            self.veil.show_hole(place)
            self.bubble.sit_beside(place, room)
        # What lies in a window, the lowest first; its dialogs are windows of their own
        window = self._host.widget
        parts = (part for part in window.children() if isinstance(part, QWidget))
        over = [part for part in parts if not part.isWindow()][-2:]
        if over != [self.veil, self.bubble] or self.bubble.isHidden():
            for part in (self.veil, self.bubble):
                part.show()
                part.raise_()

    def _on_look(self) -> None:
        """Follow what is shown, and go on when it has been done."""
        if not self._host.widget.isVisible():
            return
        self._take_place()
        done = self._steps[self.number].is_done
        if done is None:
            return
        is_done = done(self._host)
        if is_done and not self._was_done:
            self._go_to(self.number + 1)
        else:
            self._was_done = is_done

    def _on_document_changed(self, document: Document | None) -> None:
        """Begin when the project of the tour is there; another one ends the tour."""
        was_opening, self._is_opening = self._is_opening, False
        if was_opening and document is not None and document.project.name == PROJECT:
            self._document = document
            QTimer.singleShot(0, self, self._begin)
        elif document is not self._document:
            self.end()

    def _on_looks_changed(self) -> None:
        if self.is_running:
            self._steps, self._shown = steps(), None
            self.bubble.say(self._steps[self.number], self.number, len(self._steps))
            self._take_place()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Esc ends the tour from everywhere, unless something else in the window needs it."""
        is_press = event.type() == QEvent.Type.KeyPress
        is_escape = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if is_press and is_escape and self.is_running and not self._is_escape_needed():
            self.end()
            return True
        if event.type() == QEvent.Type.Resize and self.is_running:
            QTimer.singleShot(0, self, self._on_resized)
        return super().eventFilter(watched, event)

    def _on_resized(self) -> None:
        if self.is_running:
            self._take_place()

    def _is_escape_needed(self) -> bool:
        """Whether a menu, a field or a drag is open, which Esc ends first."""
        canvas = self._host.workbench.canvas
        return (
            QApplication.activePopupWidget() is not None
            or QApplication.activeModalWidget() is not None
            or isinstance(QApplication.focusWidget(), QLineEdit | QPlainTextEdit)
            or canvas.pointing.gesture is not None
            or canvas.fields.widget is not None
        )

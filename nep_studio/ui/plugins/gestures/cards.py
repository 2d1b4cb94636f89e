"""The cards of all gestures, below each other, and the row that makes a new one."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRectF, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QDragEnterEvent,
    QDragLeaveEvent,
    QDropEvent,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import (
    QAbstractButton,
    QFrame,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from faults import text_of
from nep_studio.blocks.operations.copying import Clip, clip_of
from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.blocks.program import PAGES
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.theme.icons import icon, paint_icon
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr
from nep_studio.ui.workbench.placing import insert_clip

from .gesture_controller import GestureController
from .project_gestures import Keeping
from .recording import TakeSession
from .samples import TAKES_MIME, Badges, TakePictures, TakesList, takes_in

# The block "when this gesture is made", to be dragged onto the canvas or put there by a click.

BLOCK = "event.gesture"
_WIDEST_LINES = 11


class GestureChip(QAbstractButton):
    """Looks like the beginning of the block. Only a press that stays a click adds it."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__()
        self._canvas = canvas
        self.gesture = ""
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Fixed)
        self.clicked.connect(self.add_block)

    def show_gesture(self, gesture: str, title: str) -> None:
        """Be the block of this gesture."""
        self.gesture = gesture
        words = tr("when {gesture}", gesture=title)
        if words != self.text():
            self.setText(words)
            labelled(
                self,
                tip=text_of("Drag it onto the page, or click to add it: {words}", words=words),
                name=text_of("Add the block “{words}”", words=words),
            )
            self.updateGeometry()

    def clip(self) -> Clip:
        """The block."""
        return clip_of(self._canvas.editor.language, BLOCK, gesture=self.gesture)

    def add_block(self) -> None:
        """Put the block on the page of behaviour, where one looks."""
        self._show_behaviour()
        insert_clip(self._canvas, self.clip())

    def _show_behaviour(self) -> None:
        canvas = self._canvas
        if canvas.editor.project.kind_of_page(canvas.page) != PAGES[0]:
            canvas.show_page(PAGES[0])

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a click or a drag."""
        if event.button() == Qt.MouseButton.LeftButton and self._canvas.isVisible():
            self._show_behaviour()
            place = event.globalPosition().toPoint()
            self._canvas.begin_external_drag(self.clip(), place, self)
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Where the page cannot be seen, what is dragged away is added as by a click."""
        super().mouseReleaseEvent(event)
        is_away = not self.rect().contains(event.position().toPoint())
        if is_away and event.button() == Qt.MouseButton.LeftButton and not self._canvas.isVisible():
            self.add_block()

    def sizeHint(self) -> QSize:
        """Room for its words; long names are cut."""
        metrics = self.fontMetrics()
        line = metrics.height()
        words = min(metrics.horizontalAdvance(self.text()), line * _WIDEST_LINES)
        return QSize(round(words + line * 2.2), round(line * 1.75))

    def minimumSizeHint(self) -> QSize:
        """A few letters."""
        line = self.fontMetrics().height()
        return QSize(line * 5, round(line * 1.75))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint a hat of the colour of events."""
        theme, line = self._canvas.look.theme, self.fontMetrics().height()
        colours = theme.block("events")
        rect = QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(theme.colour("focus") if self.hasFocus() else colours.line, 2))
            painter.setBrush(colours.fill)
            painter.drawPath(_hat(rect, line))
            is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
            side = line * 0.95
            x = rect.right() - side - line * 0.4 if is_mirrored else rect.left() + line * 0.4
            middle = rect.center().y() + line * 0.1
            paint_icon(painter, QRectF(x, middle - side / 2, side, side), "hand", colours.text)
            before, behind = (0.4, 1.6) if is_mirrored else (1.6, 0.4)
            room = rect.adjusted(line * before, line * 0.2, -line * behind, 0)
            mode = Qt.TextElideMode.ElideRight
            shown = self.fontMetrics().elidedText(self.text(), mode, round(room.width()))
            painter.setPen(colours.text)
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter, shown)


def _hat(rect: QRectF, line: float) -> QPainterPath:
    """A rounded rectangle with the low hump that blocks have which begin a stack."""
    hump, corner = line * 0.22, line * 0.25
    body = rect.adjusted(0, hump, 0, 0)
    path = QPainterPath()
    path.addRoundedRect(body, corner, corner)
    left, low, high = body.left(), body.top() + 1, rect.top()
    crest = QPainterPath(QPointF(left + corner, body.top() + corner))
    wide = min(line * 4, body.width() / 2)
    crest.lineTo(left + corner / 2, low)
    crest.cubicTo(
        left + wide * 0.3, high - hump, left + wide * 0.7, high - hump / 2, left + wide, low
    )
    crest.closeSubpath()
    return path.united(crest)


# The card of one gesture: its name, its block, what records it, and its takes.


class GestureCard(QFrame):
    """Shows a gesture; everything that is wanted of it is told by signals.

    One button records, that of the page: what it records is the card that was pressed last.
    ``menu_asked`` and ``take_menu_asked`` give a place of the screen; ``takes_dropped`` the ids of
    takes that are of this gesture from now on.
    """

    renamed = Signal(str)
    activated = Signal()
    menu_asked = Signal(QPoint)
    take_menu_asked = Signal(QPoint)
    takes_dropped = Signal(list)

    def __init__(
        self, name: str, controller: GestureController, canvas: Canvas, pictures: TakePictures
    ) -> None:
        super().__init__()
        self.name, self._controller = name, controller
        self._is_current = self._is_target = False
        self.title = QLineEdit(maxLength=60)
        self.count = QLabel()
        self.chip = GestureChip(canvas)
        self.menu = QToolButton()
        self.takes = TakesList(controller, pictures)
        self.setProperty("kind", "card")
        self.setAcceptDrops(True)
        line = self.fontMetrics().height()
        labelled(self.title, name="Name of the gesture")
        self.count.setProperty("role", "hint")
        explained(self.menu, "More")
        above = in_row((self.title, 1), self.count, self.menu)
        between = in_row(self.chip, 1)
        margins = (line // 2, line // 2, line // 2, line // 3)
        in_column(above, between, self.takes, of=self, margins=margins, spacing=line // 3)
        self._connect()
        self.dress()

    def _connect(self) -> None:
        self.title.editingFinished.connect(self._on_title_edited)
        self.title.installEventFilter(self)
        self.menu.clicked.connect(
            lambda: self.menu_asked.emit(self.menu.mapToGlobal(QPoint(0, self.menu.height())))
        )
        self.takes.menu_asked.connect(self.take_menu_asked)
        self.takes.current_changed.connect(self.activated)

    # What is shown

    def show_gesture(self, gesture: OwnGesture, badges: Mapping[str, str]) -> None:
        """Show the gesture as it is now."""
        if not self.title.hasFocus() or not self.title.isModified():
            self._show_title(gesture.title)
        self.chip.show_gesture(self.name, gesture.title)
        self.count.setText(count_words(len(gesture.takes), "1 take", "{n} takes"))
        self.setAccessibleName(gesture.title)
        labelled(self.takes, name=text_of("Takes of {gesture}", gesture=gesture.title))
        self.takes.show_takes(gesture.takes, badges)
        self.takes.setVisible(bool(gesture.takes))

    def show_current(self, is_current: bool) -> None:
        """Show whether this gesture is the one that is recorded."""
        if is_current != self._is_current:
            self._is_current = is_current
            self.update()

    def dress(self) -> None:
        """Take the theme."""
        theme, line = self._controller.look.theme, self.fontMetrics().height()
        self.menu.setIcon(icon("ellipsis", theme))
        self.menu.setIconSize(QSize(line, line))
        self.chip.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Mark the card that Space records, and the one that takes are dropped on."""
        super().paintEvent(event)
        if self._is_current or self._is_target:
            with QPainter(self) as painter:
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                colour = "focus" if self._is_target else "accent"
                painter.setPen(QPen(self._controller.look.theme.colour(colour), 2))
                corner = self.fontMetrics().height() * 0.42
                painter.drawRoundedRect(self.rect().adjusted(1, 1, -1, -1), corner, corner)

    def edit_title(self) -> None:
        """Let the name be typed."""
        self.title.setFocus(Qt.FocusReason.OtherFocusReason)
        self.title.selectAll()

    # What happens

    def _show_title(self, title: str) -> None:
        if title != self.title.text():
            self.title.setText(title)
            self.title.setCursorPosition(0)

    def _on_title_edited(self) -> None:
        text = self.title.text().strip()
        if not self.title.isModified():
            return
        self.title.setModified(False)
        if text:
            self.renamed.emit(text)
        gesture = self._controller.gestures.get(self.name)
        if gesture is not None:
            self._show_title(gesture.title)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose this gesture: it is recorded next."""
        super().mousePressEvent(event)
        self.activated.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Who is at the name means this gesture, too."""
        if event.type() == QEvent.Type.FocusIn:
            self.activated.emit()
        return super().eventFilter(watched, event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take the takes of other gestures."""
        if event.mimeData().hasFormat(TAKES_MIME):
            event.acceptProposedAction()
            self._is_target = True
            self.update()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """They went elsewhere."""
        self._is_target = False
        self.update()

    def dropEvent(self, event: QDropEvent) -> None:
        """Say that they are of this gesture."""
        self._is_target = False
        self.update()
        event.acceptProposedAction()
        self.takes_dropped.emit(list(takes_in(event.mimeData())))


class Cards(QScrollArea):
    """``record_asked`` and ``menu_asked`` give the name of a gesture, ``current_changed`` tells
    that Space records another one."""

    record_asked = Signal(str)
    menu_asked = Signal(str, QPoint)
    take_menu_asked = Signal(str, QPoint)
    current_changed = Signal(str)

    def __init__(
        self, controller: GestureController, keeping: Keeping, session: TakeSession, canvas: Canvas
    ) -> None:
        super().__init__()
        self._controller, self._keeping, self._session = controller, keeping, session
        self._canvas = canvas
        self._pictures, self._badges = TakePictures(controller), Badges(controller)
        self.cards: dict[str, GestureCard] = {}
        self.current = ""
        self.empty = QLabel(wordWrap=True)
        self.new_name = QLineEdit(maxLength=60)
        self.new_button = labelled(QPushButton(autoDefault=False), text="New gesture")
        self._soon = QTimer(self, singleShot=True, interval=0)
        self._soon.timeout.connect(self.refresh)
        self._lay_out()
        controller.changed.connect(self._soon.start)
        session.changed.connect(self._show_states)
        controller.look.theme_changed.connect(self._dress)
        self.new_button.clicked.connect(self.make_gesture)
        self.new_name.returnPressed.connect(self.make_gesture)
        self._dress()
        follow_words(self, self.refresh)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        labelled(self, name="Gestures")
        labelled(self.new_name, placeholder="Name of a new gesture", name="Name of a new gesture")
        self.empty.setProperty("role", "hint")
        new, inner = in_row((self.new_name, 1), self.new_button), QWidget()
        margins = (line // 2, line // 4, line // 2, line // 4)
        self._box = in_column(new, self.empty, 1, of=inner, margins=margins, spacing=line // 2)
        self.setWidget(inner)

    def sizeHint(self) -> QSize:
        """Room for two cards."""
        line = self.fontMetrics().height()
        return QSize(line * 24, line * 14)

    def minimumSizeHint(self) -> QSize:
        """One card can be used."""
        line = self.fontMetrics().height()
        return QSize(line * 12, line * 4)

    # What is shown

    def refresh(self) -> None:
        """Show the gestures as they are now; cards that stay are not made anew."""
        gestures = self._controller.gestures
        for name in [name for name in self.cards if name not in gestures]:
            card = self.cards.pop(name)
            self._box.removeWidget(card)
            card.hide()
            card.deleteLater()
        badges = self._badges.all()
        for place, (name, gesture) in enumerate(gestures.items()):
            card = self.cards.get(name) or self._make_card(name)
            if self._box.indexOf(card) != place:
                self._box.removeWidget(card)
                self._box.insertWidget(place, card)
            card.show_gesture(gesture, badges)
        self._box.update()
        self.cards = {name: self.cards[name] for name in gestures}
        has_project = self._controller.editor is not None
        self.new_name.setEnabled(has_project)
        self.new_button.setEnabled(has_project)
        self.empty.setVisible(not gestures)
        labelled(
            self.empty,
            text="A gesture is a movement that your program waits for, such as a wave. "
            "Give it a name here, then make it five times: the program learns it."
            if has_project
            else "Gestures belong to a project. Open one, or make a new one.",
        )
        if self.current not in gestures:
            self.choose(next(iter(gestures), ""))
        self._show_states()

    def choose(self, name: str) -> None:
        """Let Space record this gesture."""
        if name != self.current:
            self.current = name
            self._show_states()
            self.current_changed.emit(name)

    def make_gesture(self) -> None:
        """Make a gesture of the name that was typed; without one, ask for it."""
        title = self.new_name.text().strip()
        if not title:
            self.ask_for_name()
            return
        made = self._keeping.new_gesture(title)
        if made:
            self.new_name.clear()
            self.refresh()
            self.choose(made)
            self.show_card(made)

    def ask_for_name(self) -> None:
        """Give the keyboard to the name of a new gesture."""
        self.ensureWidgetVisible(self.new_name)
        self.new_name.setFocus(Qt.FocusReason.OtherFocusReason)

    def show_card(self, name: str) -> None:
        """Bring a card into view."""
        card = self.cards.get(name)
        if card is not None:
            self._box.activate()
            QTimer.singleShot(0, card, lambda: self.ensureWidgetVisible(card))

    def _make_card(self, name: str) -> GestureCard:
        card = self.cards[name] = GestureCard(name, self._controller, self._canvas, self._pictures)
        card.renamed.connect(lambda title: self._keeping.rename_gesture(name, title))
        card.activated.connect(lambda: self.choose(name))
        card.menu_asked.connect(lambda place: self.menu_asked.emit(name, place))
        card.take_menu_asked.connect(lambda place: self.take_menu_asked.emit(name, place))
        card.takes_dropped.connect(lambda ids: self._keeping.relabel_takes(ids, name))
        card.takes.opened.connect(self._on_opened)
        card.takes.delete_asked.connect(self._keeping.delete_takes)
        return card

    def _show_states(self) -> None:
        for name, card in self.cards.items():
            card.show_current(name == self.current)

    def _on_opened(self, take: str) -> None:
        self._controller.choose_take("" if take == self._controller.chosen_take else take)

    def _dress(self) -> None:
        self.new_button.setIcon(icon("plus", self._controller.look.theme))
        for card in self.cards.values():
            card.dress()

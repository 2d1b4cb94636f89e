"""Below the graph: what records, how far it is, and what came of it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QObject, QPoint, QSignalBlocker, QSize, Qt
from PySide6.QtWidgets import (
    QComboBox,
    QLabel,
    QMenu,
    QProgressBar,
    QPushButton,
    QSizePolicy,
    QToolButton,
    QWidget,
)

from nep_studio.blocks.own_gestures import WRISTS
from nep_studio.blocks.slots import why_not_name
from nep_studio.ui.labels import explained, follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import plain_label, quiet_button
from nep_studio.ui.widgets.layouts import FlowLayout, in_column, in_row
from nep_studio.ui.widgets.questions import Asking
from nep_studio.ui.words import tr

from .gesture_controller import GestureController
from .menus import show_below
from .project_gestures import Keeping
from .recording import TakeSession
from .strip import TakeView

# Who wears the sensor, and where: chosen here before something is recorded.


def wrist_words() -> dict[object, str]:
    """Where a sensor can be, in words."""
    return {"left": tr("Left wrist"), "right": tr("Right wrist"), "hand": tr("In the hand")}


class WearerBox(QObject):
    """A list of people with a menu, a list of wrists, and the sensor if there are several.

    ``who`` and ``where`` are the two widgets, which may stand apart.
    """

    def __init__(self, controller: GestureController, keeping: Keeping) -> None:
        super().__init__(controller)
        self._controller, self._keeping = controller, keeping
        self.asking: Asking | None = None
        self.who, self.where = QWidget(), QWidget()
        self.sign = QLabel()
        self.person, self.source = QComboBox(), QComboBox()
        self.wrist = Choices(wrist_words)
        self.more = QToolButton()
        self._lay_out()
        self.person.textActivated.connect(controller.set_wearer)
        self.wrist.activated.connect(lambda row: controller.set_wearer(wrist=WRISTS[row]))
        self.source.textActivated.connect(controller.use_source)
        self.more.clicked.connect(lambda: show_below(self.more, self.menu()))
        for signal in (controller.changed, controller.wearer_changed, controller.sources_changed):
            signal.connect(self.refresh)
        controller.look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self.refresh)

    def _lay_out(self) -> None:
        labelled(self.person, name="Who records", tip="Who records: each take belongs to a person")
        labelled(
            self.wrist,
            name="Where the watch or phone is",
            tip="Where the watch or phone is while it is recorded",
        )
        labelled(self.source, name="Which watch or phone")
        explained(self.more, "Change people")
        for box in (self.person, self.wrist, self.source):
            box.setSizeAdjustPolicy(
                QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
            )
            box.setMinimumContentsLength(9)
        people, places = (self.sign, self.person, self.more), (self.wrist, self.source)
        for outer, widgets in ((self.who, people), (self.where, places)):
            in_row(*widgets, of=outer, margins=0, spacing=outer.fontMetrics().height() // 3)

    def refresh(self) -> None:
        """Show who is there."""
        controller = self._controller
        _fill(self.person, controller.people, controller.person)
        with QSignalBlocker(self.wrist):
            self.wrist.setCurrentIndex(WRISTS.index(controller.wrist))
        in_use = controller.live.source if controller.live is not None else ""
        _fill(self.source, list(controller.streams), in_use)
        self.source.setVisible(len(controller.streams) > 1)

    # The menu

    def menu(self) -> QMenu:
        """New person, another name, delete."""
        menu, theme, person = QMenu(self.who), self._controller.look.theme, self._controller.person
        menu.addAction(icon("plus", theme), tr("New person…"), self._ask_for_new)
        words = tr("Another name for {person}…", person=person)
        menu.addAction(icon("pencil", theme), words, self._ask_for_name)
        words = tr("Delete {person} with all takes", person=person)
        delete = icon("trash-2", theme)
        menu.addAction(delete, words, lambda: self._keeping.delete_person(person))  # can be undone
        return menu

    def _ask_for_new(self) -> None:
        self._ask(tr("Name of the new person"), tr("Add"), self.add_person, "")

    def _ask_for_name(self) -> None:
        person = self._controller.person
        words = tr("Another name for {person}", person=person)
        self._ask(words, tr("Rename"), partial(self._keeping.rename_person, person), person)

    def add_person(self, name: str) -> None:
        """Record for somebody else from now on."""
        if why_not_name(name.strip()) is None:
            self._controller.set_wearer(name)

    def _ask(self, words: str, yes: str, answer: Callable[[str], object], name: str) -> None:
        self.asking = Asking(self.who, self._controller.look.theme, words, yes, answer, name=name)
        self.asking.show_at(self.person.mapToGlobal(QPoint(0, self.person.height())))

    def _dress(self) -> None:
        theme, line = self._controller.look.theme, self.who.fontMetrics().height()
        ratio = self.who.devicePixelRatioF()
        self.sign.setPixmap(icon("user", theme).pixmap(QSize(line, line), ratio))
        self.more.setIcon(icon("ellipsis", theme))


def _fill(box: QComboBox, entries: list[str], current: str) -> None:
    """Offer these, if they are others than before."""
    with QSignalBlocker(box):
        if [box.itemText(row) for row in range(box.count())] != entries:
            box.clear()
            box.addItems(entries)
        box.setCurrentIndex(max(0, box.findText(current)))


class RecordBar(QWidget):
    """One button that records and stops, beside it who is recorded and what goes on."""

    def __init__(
        self, controller: GestureController, keeping: Keeping, session: TakeSession, take: TakeView
    ) -> None:
        super().__init__()
        self._controller, self._session, self._take = controller, session, take
        self.gesture = ""
        self._told: Callable[[], str] = str
        self.button = labelled(QPushButton(), tip="Space")
        self.cancel = labelled(QPushButton(), text="Cancel")
        self.play, self.back = QToolButton(), quiet_button("Back to the live graph")
        self.everyday = labelled(
            QPushButton(),
            text="Everyday movement",
            tip="Record how you usually move: the program learns what is no gesture",
        )
        self.wearer = WearerBox(controller, keeping)
        self.wearer.setParent(self)
        self.words, self.progress = plain_label(), QProgressBar(minimum=0, maximum=100)
        self._lay_out()
        self.cancel.clicked.connect(session.cancel)
        self.play.clicked.connect(take.play)
        self.back.clicked.connect(lambda: controller.choose_take(""))
        for signal in (session.changed, controller.changed, take.changed, controller.take_chosen):
            signal.connect(self.refresh)
        controller.look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self._say)

    def _lay_out(self) -> None:
        for button in (self.button, self.cancel, self.everyday):
            button.setAutoDefault(False)
        self.words.setTextFormat(Qt.TextFormat.PlainText)
        self.words.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        labelled(self.progress, name="How much is recorded")
        line, wearer = self.fontMetrics().height(), (self.wearer.who, self.wearer.where)
        used = (self.button, self.cancel, self.play, self.back, *wearer, self.everyday)
        row = FlowLayout(spacing=line // 3, widgets=used)
        # The words come first: what came of it is seen without scrolling
        in_column(self.words, self.progress, row, of=self, margins=0, spacing=line // 4)

    def tell(self, told: Callable[[], str]) -> None:
        """Say what came of it, on the screen and to screen readers; again in other words."""
        self._told = told
        self._say()
        announce(self, self.words.text())

    def _say(self) -> None:
        self.words.setText(self._told())
        self.refresh()

    def set_gesture(self, name: str) -> None:
        """Record this gesture when the button is pressed."""
        self.gesture = name
        self.refresh()

    def refresh(self, _what: object = None) -> None:
        """Show what can be done now."""
        session, is_open = self._session, self._take.is_open
        is_everyday = session.state == "everyday"
        gesture = self._controller.gestures.get(self.gesture)
        self.button.setVisible(session.is_on or not is_open)
        self.button.setEnabled(session.is_on or gesture is not None)
        if session.is_on:
            self._show_button(tr("Stop"), "stop")
        elif gesture is not None:
            words = tr("Record “{gesture}”", gesture=_short(gesture.title))
            self._show_button(words, "primary")
        else:
            self._show_button(tr("Record"), "primary")
        self.cancel.setVisible(session.is_on)
        self.play.setVisible(is_open and not session.is_on)
        self.back.setVisible(is_open and not session.is_on)
        for widget in (self.wearer.who, self.wearer.where, self.everyday):
            widget.setVisible(not session.is_on and not is_open)
        self.everyday.setEnabled(self._controller.editor is not None)
        self.progress.setVisible(is_everyday)
        self.progress.setValue(round(session.share * 100))
        self._dress_play()
        self.words.setVisible(bool(self.words.text()))

    def _show_button(self, words: str, kind: str) -> None:
        if (words, kind) == (self.button.text(), self.button.property("kind")):
            return
        self.button.setText(words)
        if kind != self.button.property("kind"):
            self.button.setProperty("kind", kind)
            self.button.style().unpolish(self.button)
            self.button.style().polish(self.button)
            self._dress()

    def _dress(self) -> None:
        theme, is_on = self._controller.look.theme, self._session.is_on
        name, colour = ("square", "stop_text") if is_on else ("circle-dot", "accent_text")
        self.button.setIcon(icon(name, theme.colour(colour)))
        self.everyday.setIcon(icon("footprints", theme))
        self._dress_play()

    def _dress_play(self) -> None:
        is_playing = self._take.cursor_s is not None
        explained(self.play, "Stop playing" if is_playing else "Play the take")
        self.play.setIcon(icon("square" if is_playing else "play", self._controller.look.theme))


def _short(title: str) -> str:
    """A title that leaves room for others."""
    return title if len(title) <= 24 else title[:23] + "…"

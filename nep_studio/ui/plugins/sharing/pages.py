"""The page before a network is open: what opening means, and at which address."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QDateTime, QLocale, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QFont, QFontMetrics, QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFrame,
    QGridLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_core.networks import discovery
from nep_core.networks.security.keys import Computer, Keys
from nep_core.networks.security.opening import DOOR_PORT
from nep_studio.sharing import Refusal, Sharing
from nep_studio.ui.background import Job, Tell
from nep_studio.ui.messages import announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import (
    CopyLine,
    card_around,
    hint,
    labelled,
    quiet_button,
    styled,
)
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import count_words, language_code, tr

from . import joined_words
from .refusal_words import Place, refusal_sentence, refusal_steps


class ClosedPage(QWidget):
    """``look_again_asked``: this computer may be in a network by now."""

    look_again_asked = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.addresses = QComboBox()
        self.choice = labelled("This computer is", self.addresses)
        self.missing = hint(
            "This computer is in no network. Connect it to that of the other computers."
        )
        self.again = quiet_button("Look again")
        self.restart_told = words_label("")
        self.again.clicked.connect(self.look_again_asked)
        who = tr(
            "When you open the network, other computers can take part: their nodes,"
            " robots and watches talk with yours."
        )
        safely = tr(
            "Only computers on which somebody types a code from this window come in, and"
            " nobody else can read what is sent."
        )
        title = words_label(tr("Only this computer takes part now"), "title")
        said = (title, words_label(who), words_label(safely), self.choice, self.missing)
        again = (self.again, 0, Qt.AlignmentFlag.AlignLeading)
        gap = self.fontMetrics().height() * 2 // 3
        in_column(*said, again, self.restart_told, 1, of=self, margins=0, spacing=gap)

    def show_places(self, places: Sequence[Place], preferred: str = "") -> None:
        """Offer these; the first is the most likely one."""
        chosen = self.address or preferred
        self.addresses.clear()
        for place in places:
            self.addresses.addItem(place.words, place.address)
        self.addresses.setCurrentIndex(max(0, self.addresses.findData(chosen)))
        self.choice.setVisible(bool(places))
        self.missing.setVisible(not places)
        self.again.setVisible(not places)

    def show_running(self, nodes: int, *, is_program_running: bool) -> None:
        """Say what is started anew when the network is opened."""
        self.restart_told.setText(restart_words(nodes, is_program_running=is_program_running))
        self.restart_told.setVisible(bool(self.restart_told.text()))

    @property
    def address(self) -> str:
        """The address that is chosen; "" when there is none."""
        return self.addresses.currentData() or ""


def restart_words(nodes: int, *, is_program_running: bool) -> str:
    """What happens to what runs; nothing when nothing runs."""
    told = tr("The program is stopped for it; run it again afterwards.")
    begun = count_words(
        nodes, "1 node that runs is started anew.", "{n} nodes that run are started anew."
    )
    return " ".join(([told] if is_program_running else []) + ([begun] if nodes else []))


def words_label(words: str, role: str = "") -> QLabel:
    """Words over several lines."""
    return styled(QLabel(words, wordWrap=True, textFormat=Qt.TextFormat.PlainText), role=role)


# The page of a studio that takes part in the network of another computer.


class JoinedPage(QWidget):
    """Says what one can do there."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.title = words_label("", "title")
        used = tr("Nodes that you start here join there, and the robots there can be used here.")
        alone = tr("Each node needs a name of its own, and one program runs at a time.")
        said = (self.title, words_label(used), words_label(alone), 1)
        in_column(*said, of=self, margins=0, spacing=self.fontMetrics().height() * 2 // 3)

    def show_network(self, keys: Keys) -> None:
        """Say whose network it is."""
        self.title.setText(joined_words(keys))


# The page on which this computer joins the open network of another one.

SEARCH_S = 3.0
CODE_DIGITS = 6
ROWS = 3
ADDRESS = Qt.ItemDataRole.UserRole


class NetworkSearch(Job):
    """Open networks that are announced around this computer; ``found`` gives all of them."""

    found = Signal(list)

    def start(self, seconds: float) -> None:
        """Look for some seconds."""

        def work(_cancelled: threading.Event, tell: Tell) -> None:
            tell(discovery.find(seconds))

        self._start(work, self.found.emit)


class JoinPage(QWidget):
    """``changed`` tells that another address or code is written."""

    changed = Signal()

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.search = NetworkSearch(self)
        self.networks = QListWidget()
        self.told = hint("")
        self.progress = QProgressBar(textVisible=False, minimum=0, maximum=0)
        self.again = QPushButton(tr("Look again"), autoDefault=False)
        self.address = QLineEdit(placeholderText="192.168.1.5")
        self.code = QLineEdit(placeholderText="123 456")
        self.restart_told = words_label("")
        self._lay_out()
        self.search.found.connect(self._on_found)
        self.search.ended.connect(self._on_ended)
        self.again.clicked.connect(self.look)
        self.networks.currentItemChanged.connect(self._on_chosen)
        self.networks.itemClicked.connect(self._on_chosen)
        self.address.textChanged.connect(self.changed)
        self.code.textChanged.connect(self.changed)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.networks.setAccessibleName(tr("Open networks around here"))
        self.networks.setIconSize(QSize(round(line * 1.4), round(line * 1.4)))
        self.networks.setFixedHeight(round(line * 1.9) * ROWS)
        self.progress.setAccessibleName(tr("Looking for open networks…"))
        for field in (self.address, self.code):
            field.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        about = tr(
            "On the other computer choose “Open to other computers…” in the menu Robots."
            " It shows a code; type that one here."
        )
        again = (self.again, 0, Qt.AlignmentFlag.AlignLeading)
        title = words_label(tr("Join another computer"), "title")
        search = (title, words_label(about), self.networks, self.progress, self.told, again)
        address = labelled("Address of the other computer", self.address)
        code = labelled("Code", self.code)
        in_column(
            *search, address, code, self.restart_told, 1, of=self, margins=0, spacing=line // 2
        )

    def begin(self) -> None:
        """Look for networks, unless some have been found."""
        if not self.networks.count():
            self.look()

    def look(self) -> None:
        """Look for networks."""
        self.networks.clear()
        self.told.setText(tr("Looking for open networks…"))
        self.progress.show()
        self.again.setEnabled(False)
        self.search.start(SEARCH_S)

    @property
    def is_complete(self) -> bool:
        """Whether one may try to join."""
        digits = [letter for letter in self.code.text() if letter.isdigit()]
        return bool(self.address.text().strip()) and len(digits) == CODE_DIGITS

    def _on_found(self, found: list[discovery.Found]) -> None:
        for one in found:
            words = f"{one.computer}   {one.host}   {one.title}"
            item = QListWidgetItem(icon("monitor", self._look.theme), words)
            is_usual = one.door_port == DOOR_PORT
            item.setData(ADDRESS, one.host if is_usual else f"{one.host}:{one.door_port}")
            self.networks.addItem(item)
        if len(found) == 1 and not self.address.text():
            self.networks.setCurrentRow(0)

    def _on_ended(self, _problem: str) -> None:
        self.progress.hide()
        self.again.setEnabled(True)
        count = self.networks.count()
        nothing = tr("None was found. Type the address that the other computer shows.")
        words = count_words(count, "1 open network was found.", "{n} open networks were found.")
        self.told.setText(words if count else nothing)

    def _on_chosen(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self.address.setText(item.data(ADDRESS))
            self.code.setFocus()


# The computers that are let in, each with a button, and those that were refused.

MOST_REFUSALS = 4
"""So many are shown with what to do; the others are told in the messages."""


class ComputersList(QWidget):
    """``remove_asked`` gives the name of a computer."""

    remove_asked = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.buttons: dict[str, QPushButton] = {}
        self._shown: Sequence[Computer] | None = None
        self._box = in_column(of=self, margins=0)

    def show_computers(self, computers: Sequence[Computer]) -> None:
        """Show these."""
        if computers == self._shown:
            return
        self._shown, self.buttons = computers, {}
        _clear(self._box)
        if not computers:
            self._box.addWidget(hint("None yet. The code above lets one in."))
            return
        rows = QWidget()
        grid = QGridLayout(rows)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(0, 1)
        for number, computer in enumerate(computers):
            words = f"{computer.name}   {computer.address}   {_clock(computer.since)}"
            grid.addWidget(words_label(words), number, 0)
            button = self.buttons[computer.name] = QPushButton(tr("Remove"), autoDefault=False)
            button.setAccessibleName(tr("Remove “{name}”", name=computer.name))
            button.clicked.connect(lambda _=False, name=computer.name: self.remove_asked.emit(name))
            grid.addWidget(button, number, 1)
        self._box.addWidget(rows)


class RefusedList(QWidget):
    """Who knocked and was not let in, the newest first; hidden when nobody did."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.told: list[str] = []
        self._shown: Sequence[Refusal] | None = None
        self._box = in_column(of=self, margins=0)
        self.hide()

    def show_refusals(self, refusals: Sequence[Refusal], keys: Path) -> None:
        """Show these, with what to do."""
        if refusals == self._shown:
            return
        self._shown = refusals
        _clear(self._box)
        self.told = []
        self._box.addWidget(words_label(tr("Not let in"), "heading"))
        for refusal in refusals[:MOST_REFUSALS]:
            steps = (f"•  {step}" for step in refusal_steps(refusal, keys))
            first = f"{_clock(refusal.time_s)}   {refusal_sentence(refusal)}"
            self.told.append("\n".join([first, *steps]))
            label = words_label(self.told[-1])
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            self._box.addWidget(card_around(label, "warning"))
        self.setVisible(bool(refusals))


def _clock(time_s: float) -> str:
    """A time of today by the clock, another one with its day."""
    moment = QDateTime.fromSecsSinceEpoch(round(time_s))
    locale, short = QLocale(language_code()), QLocale.FormatType.ShortFormat
    is_today = moment.date() == QDateTime.currentDateTime().date()
    return locale.toString(moment.time() if is_today else moment, short)


def _clear(box: QVBoxLayout) -> None:
    while (item := box.takeAt(0)) is not None:
        widget = item.widget()
        if widget is not None:
            widget.hide()
            widget.deleteLater()


# The one-time code, large, with the time for which it still holds.

LOOK_MS = 500
TIMES_LARGER = 2.2


class CodeView(QFrame):
    """``is_over`` comes when the code is used, used up, or too old; a new one is asked for here."""

    is_over = Signal()

    def __init__(self, sharing: Sharing, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._sharing = sharing
        self._shown = ""
        self.line = CopyLine(look, tr("Copy the code"))
        self.line.text.setAccessibleName(tr("Code"))
        self.left = hint("")
        self.new_button = QPushButton(tr("New code"), autoDefault=False)
        font = QFont(self.font())
        font.setPixelSize(round(self.fontMetrics().height() * TIMES_LARGER * 0.75))
        font.setBold(True)
        self.line.text.setFont(font)
        high = round(QFontMetrics(font).height() * 1.15)
        self.line.text.setStyleSheet(f"min-height: {high}px")  # else the theme wins
        line = self.fontMetrics().height()
        again = (self.new_button, 0, Qt.AlignmentFlag.AlignLeading)
        margins = (line, line // 2, line, line // 2)
        in_column(self.line, self.left, again, of=styled(self, kind="card"), margins=margins)
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self.refresh)
        self.new_button.clicked.connect(sharing.new_code)
        sharing.changed.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the code that holds now, and how long it still does."""
        code = self._sharing.code
        text = code.text if code is not None else ""
        if text != self._shown:
            is_end = bool(self._shown)
            self._shown = text
            self.line.show_text(text)
            self.line.setEnabled(bool(text))
            announce(self, text)
            if is_end and not text:
                self.is_over.emit()
        if code is None:
            self.left.setText(tr("No code holds now. Make a new one for the next computer."))
            return
        left_s = max(0, round(code.left_s))
        clock = f"{left_s // 60}:{left_s % 60:02}"
        self.left.setText(tr("It is for one computer, and holds for {time} more.", time=clock))

    def showEvent(self, event: QShowEvent) -> None:
        """Count down."""
        super().showEvent(event)
        self.refresh()
        self._looking.start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Nobody looks."""
        super().hideEvent(event)
        self._looking.stop()


# The page of an open network: the code, who is let in, who was not.


class OpenPage(QWidget):
    """``begin_anew_asked``: connections of a removed computer are to end."""

    begin_anew_asked = Signal()

    def __init__(self, sharing: Sharing, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._sharing = sharing
        self.code = CodeView(sharing, look)
        self.command = CopyLine(look, tr("Copy"), is_long=True)
        self.command.text.setAccessibleName(tr("The command for a terminal"))
        self.found_by = words_label("")
        self.computers, self.refused = ComputersList(), RefusedList()
        self.removed = words_label("")
        self.anew_button = QPushButton(tr("Start everything anew"), autoDefault=False)
        self.keep = QCheckBox(tr("Open it again whenever NEP Studio starts"))
        self._lay_out()
        self.computers.remove_asked.connect(self._on_remove)
        self.anew_button.clicked.connect(self.begin_anew_asked)
        sharing.changed.connect(self.refresh)
        self.refresh()

    def _lay_out(self) -> None:
        about = tr(
            "On the other computer open this window too, choose “Join another computer…”"
            " there, and type this code:"
        )
        parts = (
            words_label(tr("The network is open"), "title"),
            words_label(about),
            self.code,
            self.found_by,
            hint("Where there is no NEP Studio, this does it in a terminal:"),
            self.command,
            words_label(tr("Computers that are let in"), "heading"),
            self.computers,
            self.removed,
            (self.anew_button, 0, Qt.AlignmentFlag.AlignLeading),
            self.refused,
            self.keep,
            1,
        )
        in_column(*parts, of=self, margins=0, spacing=self.fontMetrics().height() // 2)

    def refresh(self) -> None:
        """Show how it is now."""
        sharing = self._sharing
        if sharing.opening is None:
            self.clear_removed()
            return
        code = sharing.code
        found_by = tr("The address of this computer is {address}.", address=sharing.address)
        self.found_by.setText(found_by)
        self.command.show_text(f"nep pair {sharing.address} {code.text}" if code else "")
        self.command.setEnabled(code is not None)
        self.computers.show_computers(sharing.computers)
        self.refused.show_refusals(sharing.refusals.newest_first, sharing.key_path)

    def clear_removed(self) -> None:
        """Nothing is left of computers that were removed."""
        self.removed.hide()
        self.anew_button.hide()

    def _on_remove(self, name: str) -> None:
        self._sharing.remove(name)
        told = tr(
            "“{name}” comes in no more. What it is connected with now ends when everything"
            " is started anew.",
            name=name,
        )
        self.removed.setText(told)
        self.removed.show()
        self.anew_button.show()
        self.anew_button.setFocus()

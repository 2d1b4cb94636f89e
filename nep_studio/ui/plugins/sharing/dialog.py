"""The dialog that opens the network to other computers, or joins that of another one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QFrame,
    QPushButton,
    QScrollArea,
    QStackedWidget,
    QWidget,
)

from nep_core.errors import NepError
from nep_studio.settings import Settings
from nep_studio.sharing import Sharing
from nep_studio.ui.message_cards import MessageText
from nep_studio.ui.messages import Message, announce
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import fit_on_screen, room_around, styled
from nep_studio.ui.widgets.layouts import in_column, in_row, scrolled
from nep_studio.ui.words import tr

from .pages import ClosedPage, JoinedPage, JoinPage, OpenPage, restart_words, words_label
from .refusal_words import Place, own_places

PageName = Literal["closed", "busy", "open", "join", "joined"]

LINES_WIDE, LINES_HIGH = 32, 40
LEAST_WIDE, LEAST_HIGH = 20, 16


class SharingDialog(QDialog):
    """Asks; who shows it does it, since a running program is stopped first.

    ``open_asked`` gives an address, ``join_asked`` an address and a code.
    """

    open_asked = Signal(str)
    join_asked = Signal(str, str)
    close_asked = Signal()
    begin_anew_asked = Signal()

    def __init__(
        self,
        sharing: Sharing,
        runner: Runner,
        settings: Settings,
        look: Look,
        parent: QWidget | None = None,
        find_places: Callable[[], Sequence[Place]] = own_places,
    ) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Open to other computers"))
        self._sharing, self._runner, self._settings = sharing, runner, settings
        self._find_places = find_places
        self._is_joining = False
        self.closed_page, self.open_page = ClosedPage(), OpenPage(sharing, look)
        self.join_page, self.joined_page = JoinPage(look), JoinedPage()
        self.busy_page = words_label(tr("One moment: the network is started anew…"), "title")
        self.pages = QStackedWidget()
        self.areas: dict[PageName, QScrollArea] = {
            "closed": scrolled(self.closed_page),
            "busy": scrolled(self.busy_page),
            "open": scrolled(self.open_page),
            "join": scrolled(self.join_page),
            "joined": scrolled(self.joined_page),
        }
        for area in self.areas.values():
            self.pages.addWidget(area)
        self.problem = styled(QFrame(), kind="error")
        self.other_button = QPushButton(autoDefault=False)
        self.done_button = QPushButton(tr("Done"), autoDefault=False)
        self.main_button = styled(QPushButton(autoDefault=False), kind="primary")
        self._lay_out()
        self._connect()
        self.look_for_places()
        self.refresh()

    # Layout

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self._told = in_column(of=self.problem, margins=line // 2)
        self.problem.hide()
        foot = in_row(self.other_button, 1, self.done_button, self.main_button)
        in_column(self.problem, (self.pages, 1), foot, of=self, margins=line, spacing=line // 2)
        fit_on_screen(self, LINES_WIDE, LINES_HIGH)

    def minimumSizeHint(self) -> QSize:
        """What is of use; the pages scroll."""
        line, room = self.fontMetrics().height(), room_around(self.parentWidget()).size()
        wide = max(line * LEAST_WIDE, super().minimumSizeHint().width())
        return QSize(min(wide, room.width()), min(line * LEAST_HIGH, room.height()))

    def _connect(self) -> None:
        self.closed_page.look_again_asked.connect(self.look_for_places)
        self.open_page.begin_anew_asked.connect(self._on_begin_anew)
        self.open_page.keep.toggled.connect(self._on_keep)
        self.join_page.changed.connect(self.refresh)
        self.other_button.clicked.connect(self._on_other)
        self.done_button.clicked.connect(self.accept)
        self.main_button.clicked.connect(self._on_main)
        self._sharing.changed.connect(self.refresh)
        self._sharing.failed.connect(self.show_error)
        self._runner.state_changed.connect(self.refresh)
        self._runner.nodes_changed.connect(self.refresh)

    # What is shown

    @property
    def page(self) -> PageName:
        """The page that belongs to how the network is."""
        state = self._sharing.state
        return "join" if state == "closed" and self._is_joining else state

    def begin(self) -> None:
        """Show it; it does not hold up the window."""
        self.show()
        self.main_button.setFocus()

    def look_for_places(self) -> None:
        """Look at which addresses this computer has now."""
        self.closed_page.show_places(self._find_places(), self._settings.kept_open_at)
        self.refresh()

    def refresh(self) -> None:
        """Show how it is now."""
        page = self.page
        area = self.areas[page]
        is_new = self.pages.currentWidget() is not area
        self.pages.setCurrentWidget(area)
        nodes, is_running = len(self._runner.running), self._runner.state != "idle"
        self.closed_page.show_running(nodes, is_program_running=is_running)
        told = restart_words(nodes, is_program_running=is_running)
        self.join_page.restart_told.setText(told)
        self.join_page.restart_told.setVisible(bool(told))
        self.open_page.keep.setChecked(bool(self._settings.kept_open_at))
        if self._sharing.joined is not None:
            self.joined_page.show_network(self._sharing.joined)
        words: dict[PageName, tuple[str, str]] = {
            "closed": (tr("Open the network"), tr("Join another computer…")),
            "join": (tr("Join"), tr("Back")),
            "open": (tr("Close the network"), ""),
            "joined": (tr("Leave that network"), ""),
            "busy": ("", ""),
        }
        main, other = words[page]
        for button, said in ((self.main_button, main), (self.other_button, other)):
            button.setText(said)
            button.setVisible(bool(said))
        may_open = page != "closed" or bool(self.closed_page.address)
        self.main_button.setEnabled(may_open and (page != "join" or self.join_page.is_complete))
        if is_new:
            self._on_turned(page)

    def show_error(self, error: NepError) -> None:
        """Say what did not go, and what to try."""
        self._clear_problem()
        steps = tuple(map(tr, error.checklist))
        message = Message("error", tr(error.title), tr(error.sentence), steps, error.details)
        self._told.addWidget(MessageText(message))
        self.problem.show()
        announce(self, message.spoken)

    def _on_turned(self, page: PageName) -> None:
        """Another page: what belonged to the last one goes; the next one begins."""
        if page in ("open", "joined"):
            self._is_joining = False
            self.join_page.code.clear()
        if page in ("busy", "open", "joined"):
            self._clear_problem()
        if page == "join":
            self.join_page.begin()
            self.join_page.address.setFocus()
        elif page == "open":
            self.open_page.clear_removed()
            self.open_page.code.line.button.setFocus()
        elif self.main_button.isVisible():
            self.main_button.setFocus()

    def _clear_problem(self) -> None:
        self.problem.hide()
        for old in self.problem.findChildren(MessageText):
            old.setParent(None)
            old.deleteLater()

    # What is asked

    def _on_main(self) -> None:
        match self.page:
            case "closed":
                self.open_asked.emit(self.closed_page.address)
            case "join":
                self.join_asked.emit(self.join_page.address.text(), self.join_page.code.text())
            case "open" | "joined":
                self.close_asked.emit()

    def _on_other(self) -> None:
        self._is_joining = not self._is_joining
        self._clear_problem()
        self.refresh()

    def _on_begin_anew(self) -> None:
        self.open_page.clear_removed()
        self.begin_anew_asked.emit()

    def _on_keep(self, is_kept: bool) -> None:
        opening = self._sharing.opening
        if opening is not None:
            self._settings.kept_open_at = opening.host if is_kept else ""

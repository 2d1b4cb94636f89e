"""The settings of the program: each is in force at once, and Cancel undoes them."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, QSize, Qt, QTimer, QUrl, Signal
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QFormLayout,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QSlider,
    QSpinBox,
    QTabWidget,
    QWidget,
)

from faults import text_of
from nep_studio import __version__
from nep_studio.settings import (
    LARGEST_TEXT,
    MOST_RESTARTS,
    SMALLEST_TEXT,
    SYSTEM,
    FolderName,
    Settings,
)
from nep_studio.support import startup
from nep_studio.support.startup import Place
from nep_studio.support.updates import Newest, UpdateChoice, ask, is_usable
from nep_studio.ui.background import Background
from nep_studio.ui.labels import labelled, labelled_items
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.colours import load_theme, themes
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import ElidedLabel, hint, label_of, plain_label, room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import available_languages, tr

from .show_at_start import ShowAtStart

if TYPE_CHECKING:
    from .main_window import MainWindow


# The pages of the settings: look, folders, show mode, network.

TEXT_STEP = 5
"""Percent between two sizes of the text."""

PIN_LETTERS = 16

FOLDERS: dict[FolderName, str] = {
    "projects": "Projects",
    "recordings": "Recordings",
    "logs": "Logs of nodes",
}
FOLDER_BUTTONS = ("Open", "Change…", "Reset")


class LookPage(QWidget):
    """Language, theme, size of the text. ``size_chosen``: the knob has been let go."""

    size_chosen = Signal()

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self.language, self.theme = Choices(_languages), Choices(_themes)
        self.language.choose(settings.language)
        self.theme.choose(settings.theme)
        steps = [round(100 * s / TEXT_STEP) for s in (SMALLEST_TEXT, LARGEST_TEXT)]
        self.text_size = QSlider(Qt.Orientation.Horizontal)
        self.text_size.setPageStep(5)
        self.text_size.setRange(*steps)
        self.text_size.setValue(round(100 * settings.text_scale / TEXT_STEP))
        self.text_percent = QLabel()
        self.text_percent.setMinimumWidth(self.fontMetrics().horizontalAdvance("0000 %"))
        self._show_percent(self.text_size.value())
        half = self.fontMetrics().height() // 2
        size = in_row((self.text_size, 1), self.text_percent, spacing=half)
        form = _form(self)
        form.addRow(label_of("Language", self.language), self.language)
        form.addRow(label_of("Theme", self.theme), self.theme)
        form.addRow(label_of("Size of the text", self.text_size), size)
        form.addRow(
            "", hint("The window makes no sounds, and only the robots in it move by themselves.")
        )
        self.text_size.valueChanged.connect(self._show_percent)
        self.text_size.sliderReleased.connect(self.size_chosen)
        self.text_size.actionTriggered.connect(self._on_size_stepped)

    def _show_percent(self, steps: int) -> None:
        self.text_percent.setText(f"{steps * TEXT_STEP} %")

    def _on_size_stepped(self) -> None:
        """A key or a click beside the knob; while it is dragged, the window waits."""
        if not self.text_size.isSliderDown():
            self.text_size.setValue(self.text_size.sliderPosition())
            self.size_chosen.emit()


class FoldersPage(QWidget):
    """Where projects, recordings and logs are kept."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        self.paths = {name: ElidedLabel() for name in FOLDERS}
        self.reset_buttons: dict[FolderName, QPushButton] = {}
        grid = QGridLayout(self)
        line = self.fontMetrics().height()
        grid.setContentsMargins(line, line, line, line)
        grid.setVerticalSpacing(line // 2)
        grid.setColumnStretch(1, 1)
        for row, (name, title) in enumerate(FOLDERS.items()):
            grid.addWidget(labelled(QLabel(), text=title), row, 0)
            grid.addWidget(self.paths[name], row, 1)
            grid.addLayout(self._buttons(name, title), row, 2)
        below = hint("Another folder for logs is used when the network is started the next time.")
        grid.addWidget(below, len(FOLDERS), 0, 1, 3)
        grid.setRowStretch(len(FOLDERS) + 1, 1)
        self._refresh()

    def choose(self, name: FolderName, folder: Path | None) -> None:
        """Keep it there from now on; None: where it usually is."""
        self._settings.set_folder(name, folder)
        self._refresh()

    def _buttons(self, name: FolderName, title: str) -> QHBoxLayout:
        row = in_row(spacing=self.fontMetrics().height() // 3)  # a grid has none to pass on
        does = (self._on_open, self._on_change, lambda name: self.choose(name, None))
        for words, do in zip(FOLDER_BUTTONS, does, strict=True):
            named = text_of("{name}: {kind}", name=text_of(title), kind=text_of(words))
            button = labelled(QPushButton(autoDefault=False), text=words, name=named)
            button.clicked.connect(lambda _=False, do=do: do(name))
            row.addWidget(button)
        self.reset_buttons[name] = button
        return row

    def _refresh(self) -> None:
        for name in FOLDERS:
            folder = str(self._settings.folder_for(name))
            self.paths[name].set_words(folder)
            self.reset_buttons[name].setEnabled(self._settings.chosen_folder(name) is not None)

    def _on_open(self, name: FolderName) -> None:
        """Show it in the system's own file window; the nearest folder that is there."""
        folder = self._settings.folder_for(name)
        there = next(one for one in (folder, *folder.parents) if one.is_dir() or not one.name)
        QDesktopServices.openUrl(QUrl.fromLocalFile(str(there)))

    def _on_change(self, name: FolderName) -> None:
        folder, choose = self._settings.folder_for(name), partial(self.choose, name)
        ask_for_path(self, tr("Choose a folder"), folder, choose, "folder")


class ShowPage(QWidget):
    """How show mode goes, the PIN with which it is left, and whether it starts by itself."""

    def __init__(self, settings: Settings, place: Place, project: Path | None) -> None:
        super().__init__()
        self._settings = settings
        chosen = settings.show_options
        self.at_once = labelled(QCheckBox(), text="Run at once")
        self.again = labelled(QCheckBox(), text="Begin again when the program has ended")
        self.cues = labelled(QCheckBox(), text="Show the cue buttons, for an operator")
        self.restarts = QSpinBox(minimum=0, maximum=MOST_RESTARTS, value=chosen.restarts)
        self.pin = QLineEdit(echoMode=QLineEdit.EchoMode.Password)
        self.pin.setMinimumWidth(self.fontMetrics().averageCharWidth() * PIN_LETTERS)
        self.pin_button = QPushButton(autoDefault=False)
        half = self.fontMetrics().height() // 2
        pin = in_row((self.pin, 1), self.pin_button, spacing=half)
        rows = QWidget()
        form = _form(rows)
        form.setContentsMargins(0, 0, 0, 0)
        for box, is_on in (
            (self.at_once, chosen.runs_at_once),
            (self.again, chosen.again),
            (self.cues, chosen.has_cues),
        ):
            box.setChecked(is_on)
            form.addRow(box)
            box.toggled.connect(self._on_chosen)
        most = label_of("After errors in a row, begin again at most", self.restarts)
        form.addRow(most, self.restarts)
        form.addRow(label_of("PIN to leave", self.pin), pin)
        leaving = hint("To leave a show, hold Esc or the cross in its corner for two seconds.")
        self.at_start = ShowAtStart(place, project)
        line = self.fontMetrics().height()
        parts = (rows, leaving, self.at_start, 1)
        in_column(*parts, of=self, margins=line, spacing=line // 2)
        self.restarts.valueChanged.connect(self._on_chosen)
        self.pin.textChanged.connect(self._show_pin)
        self.pin_button.clicked.connect(self._on_pin)
        self._show_pin()

    def _on_chosen(self) -> None:
        self._settings.show_options = replace(
            self._settings.show_options,
            runs_at_once=self.at_once.isChecked(),
            again=self.again.isChecked(),
            has_cues=self.cues.isChecked(),
            restarts=self.restarts.value(),
        )

    def _show_pin(self) -> None:
        has_pin, is_new = self._settings.has_pin, bool(self.pin.text())
        is_set = is_new or not has_pin
        labelled(self.pin_button, text="Set the PIN" if is_set else "Without PIN")
        self.pin_button.setEnabled(is_new or has_pin)
        labelled(self.pin, placeholder="There is a PIN" if has_pin else "A new PIN")

    def _on_pin(self) -> None:
        self._settings.set_pin(self.pin.text())
        self.pin.clear()
        self._show_pin()


class NetworkPage(QWidget):
    """Who else may join the network of the studio."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self.original = labelled(QCheckBox(), text="Programs of the original NEP may join")
        self.original.setChecked(settings.lets_original_join)
        below = hint(
            "Programs of this computer only, by its ports 7000 and 50000. It counts when the"
            " network is started the next time."
        )
        form = _form(self)
        form.addRow(self.original)
        form.addRow(below)
        self.original.toggled.connect(lambda on: setattr(settings, "lets_original_join", on))


def _form(page: QWidget) -> QFormLayout:
    line = page.fontMetrics().height()
    form = QFormLayout(page)
    form.setContentsMargins(line, line, line, line)
    form.setVerticalSpacing(line // 2)
    form.setHorizontalSpacing(line)
    form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
    return form


def _languages() -> dict[str, str]:
    return {SYSTEM: tr("Like the computer's"), **available_languages()}


def _themes() -> dict[str, str]:
    return {SYSTEM: tr("Like the computer's"), **{n: tr(load_theme(n).title) for n in themes()}}


# Asks for the newest version in a thread of its own; the window never waits for the answer.

LONGEST_MS = 15_000
"""Longer nobody waits, however slowly somebody answers."""


class Asking(QObject):
    """One question at a time; ``answered`` gives the Newest, or None, in the window's thread."""

    answered = Signal(object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._number = 0
        self._background = Background(self)
        self._patience = QTimer(self, interval=LONGEST_MS, singleShot=True)
        self._patience.timeout.connect(lambda: self._on_heard(self._number, None))

    def begin(self, address: str) -> None:
        """Ask; at the end of the program nobody waits."""
        self.cancel()
        self._patience.start()
        tell = partial(self._on_heard, self._number)
        self._background.start(partial(ask, address), tell, name="updates")

    def cancel(self) -> None:
        """Want no answer any more."""
        self._number += 1
        self._patience.stop()

    def _on_heard(self, number: int, newest: Newest | None) -> None:
        if number == self._number:
            self.cancel()
            self.answered.emit(newest)


def ask_if_due(window: MainWindow) -> Asking | None:
    """Ask if the person wants that, and it was not asked today."""
    choice = UpdateChoice(window.settings)
    if not choice.is_due(time.time()):
        return None
    choice.note_asked()
    asking = Asking(window)
    asking.answered.connect(lambda newest: _tell(window, choice, newest))
    asking.begin(choice.address)
    return asking


def _tell(window: MainWindow, choice: UpdateChoice, newest: Newest | None) -> None:
    """Tell of a newer version, of each only once."""
    if newest is None or not newest.is_newer or newest.version == choice.announced:
        return
    choice.announced = newest.version
    title = tr("There is a new version of NEP Studio: {version}", version=newest.version)
    sentence = tr("You have {version}. Nothing changes unless you get it.", version=__version__)
    show = Answer(tr("Show its page"), lambda: show_page(newest.page))
    answers = (show,) if newest.page else ()
    message = Message("info", title, sentence, answers=answers, outlives_project=True)
    window.messages.tell(message)


def show_page(page: str) -> None:
    """Show a page in the person's browser."""
    QDesktopServices.openUrl(QUrl(page))


# The page of the settings about privacy: what the program never does, and updates if wanted.


class PrivacyPage(QWidget):
    """Updates are looked for only if a person wants that, at the address that stands here."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._choice = UpdateChoice(settings)
        self.check = labelled(
            QCheckBox(), text="Ask once a day which version of NEP Studio is the newest"
        )
        self.address = QLineEdit(self._choice.address, placeholderText="https://")
        self.ask_button = labelled(QPushButton(autoDefault=False), text="Ask now")
        self.state = plain_label()
        self.hint = hint(
            "NEP Studio tells its own version there, and nothing else. It never changes itself."
        )
        self.unknown = labelled(
            QLabel(wordWrap=True),
            text="New versions are where you got NEP Studio: it knows no address yet that tells of"
            " them. If you were given one, write it here.",
        )
        self._asking = Asking(self)
        line = self.fontMetrics().height()
        nothing_sent = labelled(
            QLabel(wordWrap=True),
            text="NEP Studio sends nothing by itself: projects, recordings and logs stay here.",
        )
        on_the_network = labelled(
            QLabel(wordWrap=True),
            text="What it does on the network is talking to your robots, watches and nodes.",
        )
        box = in_column(nothing_sent, on_the_network, of=self, margins=line)
        box.addSpacing(line // 2)
        asking = in_row(label_of("Address", self.address), (self.address, 1), self.ask_button)
        choice = in_column(self.check, self.unknown, asking, self.hint, self.state, 1)
        box.addLayout(choice)
        self.address.textEdited.connect(self._on_address_edited)
        self.check.toggled.connect(lambda is_on: setattr(self._choice, "is_wanted", is_on))
        self.ask_button.clicked.connect(self._on_ask)
        self._asking.answered.connect(self._on_answered)
        self._show()

    def _show(self) -> None:
        """Where no address is known, there is nothing to choose, and it says so."""
        has_address = is_usable(self.address.text().strip())
        with QSignalBlocker(self.check):
            self.check.setChecked(has_address and self._choice.is_wanted)
        for part in (self.check, self.ask_button, self.hint):
            part.setVisible(has_address)
        self.unknown.setVisible(not has_address)
        self.ask_button.setEnabled(has_address)
        labelled(self.state, text="")

    def _on_address_edited(self, words: str) -> None:
        self._asking.cancel()
        self._choice.address = words
        self._show()

    def _on_ask(self) -> None:
        self.ask_button.setEnabled(False)
        labelled(self.state, text="Asking…")
        self._choice.note_asked()
        self._asking.begin(self._choice.address)

    def _on_answered(self, newest: Newest | None) -> None:
        self.ask_button.setEnabled(True)
        if newest is None:
            labelled(
                self.state,
                text="No version is told there. Is the address right, and the internet there?",
            )
        elif newest.is_newer:
            labelled(
                self.state,
                text=text_of(
                    "There is a new version of NEP Studio: {version}", version=newest.version
                ),
            )
        else:
            labelled(self.state, text="This is the newest version.")


def _as_it_was(studio: Studio, place: Place) -> Callable[[], None]:
    """What puts all settings of the dialog back to what they are now."""
    settings, updates = studio.settings, UpdateChoice(studio.settings)
    language, theme, text_scale = settings.language, settings.theme, settings.text_scale
    folders = {name: settings.chosen_folder(name) for name in FOLDERS}
    show_options, lets_join = settings.show_options, settings.lets_original_join
    is_wanted, address = updates.is_wanted, updates.address
    put_startup_back = startup.as_it_is(place)

    def take_back() -> None:
        with contextlib.suppress(OSError):  # it could not be written before either
            put_startup_back()
        settings.show_options, settings.lets_original_join = show_options, lets_join
        updates.is_wanted, updates.address = is_wanted, address
        for name, folder in folders.items():
            settings.set_folder(name, folder)
        if settings.theme != theme:
            studio.choose_theme(theme)
        if settings.text_scale != text_scale:
            studio.choose_text_scale(text_scale)
        if settings.language != language:
            studio.choose_language(language)

    return take_back


LINES_AROUND = 8
"""So many lines of text of the screen are for what is around the pages: the buttons, the title."""


class PagesArea(QScrollArea):
    """As large as its pages; they scroll only where very large words have no room on the screen."""

    def __init__(self, pages: QWidget) -> None:
        super().__init__(widgetResizable=True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._pages = pages
        self.setWidget(pages)

    def minimumSizeHint(self) -> QSize:
        """What the pages need, as far as the screen has it."""
        needed = self._pages.minimumSizeHint().expandedTo(self._pages.minimumSize())
        most = room_around(self).height() - LINES_AROUND * self.fontMetrics().height()
        bar = self.verticalScrollBar().sizeHint().width() if needed.height() > most else 0
        return QSize(needed.width() + bar, min(needed.height(), most))

    def sizeHint(self) -> QSize:
        """What the pages would like."""
        least, wanted = self.minimumSizeHint(), self._pages.sizeHint()
        return QSize(max(wanted.width(), least.width()), least.height())


class SettingsDialog(QDialog):
    """Shows what is chosen, and takes what is chosen anew.

    ``project`` is the file of the project that is open, ``place`` the computer that it is on.
    """

    def __init__(
        self,
        studio: Studio,
        parent: QWidget,
        *,
        project: Path | None = None,
        place: Place | None = None,
    ) -> None:
        super().__init__(parent)
        place = place or Place.here()
        self._studio = studio
        self._take_back = _as_it_was(studio, place)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        labelled(self, window_title="Settings")
        self.reset_button = labelled(QPushButton(autoDefault=False), text="Put the panels back")
        self.cancel_button = labelled(QPushButton(autoDefault=False), text="Cancel")
        self.close_button = labelled(QPushButton(default=True), text="Done")
        self.pages = QTabWidget()
        line = self.fontMetrics().height()
        buttons = in_row(self.reset_button, 1, self.cancel_button, self.close_button)
        self._area = PagesArea(self.pages)
        in_column((self._area, 1), buttons, of=self, margins=line, spacing=line)
        self.setMinimumWidth(line * 34)
        settings = studio.settings
        look = LookPage(settings)
        self.language, self.theme = look.language, look.theme
        self.text_size = look.text_size
        self.language.activated.connect(lambda: studio.choose_language(self.language.currentData()))
        self.theme.activated.connect(lambda: studio.choose_theme(self.theme.currentData()))
        look.size_chosen.connect(self._on_size_chosen)
        self.folders = FoldersPage(settings)
        self.show_page = ShowPage(settings, place, project)
        self.network_page, self.privacy = NetworkPage(settings), PrivacyPage(settings)
        for page in (look, self.folders, self.show_page, self.network_page, self.privacy):
            self.pages.addTab(page, "")
        labelled_items(self.pages, "Look", "Folders", "Show mode", "Network", "Privacy")
        self.cancel_button.clicked.connect(self.reject)
        self.close_button.clicked.connect(self.accept)

    def event(self, event: QEvent) -> bool:
        """Give each page the height that its words need: Qt forgets those that are wrapped."""
        is_done = super().event(event)
        if event.type() in (QEvent.Type.LayoutRequest, QEvent.Type.Resize):
            width = self.pages.currentWidget().width()
            for page in (self.folders, self.show_page, self.network_page, self.privacy):
                if page.hasHeightForWidth():
                    page.setMinimumHeight(page.heightForWidth(width))
            needed = self.pages.minimumSizeHint().height()
            if self.pages.minimumHeight() != needed:
                self.pages.setMinimumHeight(needed)  # it tells nobody by itself
                self._area.updateGeometry()
        return is_done

    def reject(self) -> None:
        """Take back what was chosen since the dialog was opened."""
        super().reject()
        self._take_back()

    def _on_size_chosen(self) -> None:
        self._studio.choose_text_scale(self.text_size.value() * TEXT_STEP / 100)

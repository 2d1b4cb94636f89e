"""The menus of gestures, of takes and of the whole panel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QPoint
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QWidget

from nep_core.errors import RecordingError
from nep_studio.ui.messages import Message
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.forms import add_title
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import count_words, tr

from .cards import Cards
from .exchange import Imported, add_imported, read_csv, read_mcap, write_csv, write_mcap
from .gesture_controller import GestureController
from .project_gestures import Keeping

EVERYDAY_S = (30, 120)
Entry = tuple[str, str, Callable[[], object], bool]
"""Of a menu: sign, words, what it does, and whether it can be done now."""


class Menus:
    """Makes menus; ``cards`` has the gesture that is meant."""

    def __init__(self, controller: GestureController, keeping: Keeping, cards: Cards) -> None:
        self._controller, self._keeping, self._cards = controller, keeping, cards

    def of_gesture(self, name: str) -> QMenu:
        """What can be done with a gesture."""
        card = self._cards.cards[name]
        menu = QMenu(self._cards)
        self._add(menu, "circle-dot", tr("Record"), lambda: self._cards.record_asked.emit(name))
        words = tr("Add the block “{words}”", words=card.chip.text())
        self._add(menu, "blocks", words, card.chip.add_block)
        self._add(menu, "pencil", tr("Another name…"), card.edit_title)
        menu.addSeparator()
        words = tr("Delete the gesture with its takes")
        self._add(menu, "trash-2", words, lambda: self._keeping.delete_gesture(name))
        return menu

    def of_take(self, name: str) -> QMenu | None:
        """What can be done with the take at the keyboard; None when there is none."""
        card = self._cards.cards[name]
        ids = card.takes.chosen
        found = self._controller.find_take(ids[0]) if ids else None
        if found is None:
            return None
        take, menu = found[1], QMenu(self._cards)
        self._add(menu, "maximize", tr("Look at it"), lambda: self._controller.choose_take(take.id))
        is_out = take.left_out
        words = tr("Learn from it again") if is_out else tr("Do not learn from it")
        sign = "eye" if is_out else "eye-off"
        self._add(menu, sign, words, lambda: self._keeping.leave_out(ids, not is_out))
        others = {key: one.title for key, one in self._controller.gestures.items() if key != name}
        if others:
            add_title(menu, tr("It is a take of"))
            for key, title in others.items():
                words = title.replace("&", "&&")
                self._add(menu, "hand", words, partial(self._keeping.relabel_takes, ids, key))
        menu.addSeparator()
        words = tr("Delete the take")
        self._add(menu, "trash-2", words, lambda: self._keeping.delete_takes(ids))
        return menu

    def of_everyday(self, record: Callable[[float], object]) -> QMenu:
        """What records everyday movement, and what there is of it."""
        menu = QMenu(self._cards)
        for seconds in EVERYDAY_S:
            words = tr("Record {seconds} seconds", seconds=seconds)
            if seconds >= 60:
                words = tr("Record {minutes} minutes", minutes=seconds // 60)
            self._add(menu, "circle-dot", words, partial(record, float(seconds)))
        kept = {key: one for key, one in self._controller.recordings.items() if one.everyday}
        if kept:
            add_title(menu, tr("Delete a recording"))
        for key, one in kept.items():
            person, when = one.person or tr("Somebody"), one.recorded[:16].replace("T", " ")
            seconds = round(one.seconds)
            words = tr("{person}, {seconds} s, {when}", person=person, seconds=seconds, when=when)
            words = words.replace("&", "&&")
            self._add(menu, "trash-2", words, partial(self._keeping.delete_recording, key))
        return menu

    def of_panel(self, entries: list[Entry]) -> QMenu:
        """What can be done beside."""
        menu = QMenu(self._cards)
        for sign, words, do, is_possible in entries:
            self._add(menu, sign, words, do).setEnabled(is_possible)
        return menu

    def _add(self, menu: QMenu, sign: str, words: str, do: Callable[[], object]) -> QAction:
        action = menu.addAction(icon(sign, self._controller.look.theme), words)
        action.triggered.connect(lambda _is_on=False: do())
        return action


def show_menu(menu: QMenu | None, place: QPoint) -> None:
    """Show a menu at a place of the screen; it goes when it is closed."""
    if menu is not None:
        menu.aboutToHide.connect(menu.deleteLater)
        menu.popup(place)


def show_below(button: QWidget, menu: QMenu) -> None:
    """Show a menu below its button."""
    show_menu(menu, button.mapToGlobal(QPoint(0, button.height())))


# Asks for files and folders, imports and exports takes, and tells what came of it.

MCAP_SUFFIX = ".mcap"


class Exchange:
    """Takes from files, takes to files; the system's dialogs ask which."""

    def __init__(self, controller: GestureController, over: QWidget) -> None:
        self._controller, self._over = controller, over

    def entries(self) -> list[Entry]:
        """The entries of a menu."""
        is_open, has_some = self._controller.editor is not None, bool(self._controller.recordings)
        return [
            ("upload", tr("Import a file…"), self.ask_for_file, is_open),
            ("folder-open", tr("Import a folder of CSV files…"), self.ask_for_folder, is_open),
            ("download", tr("Export as CSV files…"), self.ask_to_export_csv, has_some),
            ("download", tr("Export as MCAP…"), self.ask_to_export_mcap, has_some),
        ]

    # What is asked for

    def ask_for_file(self) -> None:
        """Ask which file to import."""
        kinds = (tr("Recordings (*.csv *.mcap)"), tr("All files (*)"))
        title = tr("Import takes")
        ask_for_path(self._over, title, self._folder(), self.import_from, kinds=kinds)

    def ask_for_folder(self) -> None:
        """Ask which folder to import."""
        title = tr("Import a folder of CSV files")
        ask_for_path(self._over, title, self._folder(), self.import_from, "folder")

    def ask_to_export_csv(self) -> None:
        """Ask for the folder that the CSV files are to be in."""
        title = tr("Export CSV files into a folder")
        ask_for_path(self._over, title, self._folder(), self.export_csv, "folder")

    def ask_to_export_mcap(self) -> None:
        """Ask where the MCAP file is to be."""
        document = self._controller.files.document
        stem = document.title if document is not None else tr("gestures")
        suggested = self._folder() / f"{stem}{MCAP_SUFFIX}"
        kinds = (tr("MCAP files (*.mcap)"), tr("All files (*)"))
        ask_for_path(self._over, tr("Export"), suggested, self.export_mcap, "save", kinds)

    def _folder(self) -> Path:
        document = self._controller.files.document
        return document.folder if document is not None else Path.home()

    # What is done

    def import_from(self, path: Path) -> None:
        """Import a file or a folder, or say why not."""
        try:
            if path.suffix.lower() == MCAP_SUFFIX and not path.is_dir():
                imported, is_whole = read_mcap(path)
            else:
                imported, is_whole = read_csv(path), True
        except RecordingError as error:
            self._controller.messages.tell_error(error)
            return
        if add_imported(self._controller, imported):
            self._tell_imported(imported, is_whole)

    def export_csv(self, folder: Path) -> None:
        """Write CSV files into a folder, or say why not."""
        try:
            written = write_csv(folder, self._controller.gestures, self._controller.recordings)
        except RecordingError as error:
            self._controller.messages.tell_error(error)
            return
        self._confirm(count_words(len(written), "1 file was written.", "{n} files were written."))

    def export_mcap(self, path: Path) -> None:
        """Write an MCAP file, or say why not."""
        try:
            write_mcap(path, self._controller.gestures, self._controller.recordings)
        except RecordingError as error:
            self._controller.messages.tell_error(error)
            return
        self._confirm(tr("“{file}” was written.", file=path.name))

    def _tell_imported(self, imported: Sequence[Imported], is_whole: bool) -> None:
        takes = sum(len(one.takes) for one in imported)
        unmarked = sum(one.recording.everyday for one in imported)
        said = [count_words(takes, "1 take was imported.", "{n} takes were imported.")]
        if unmarked:
            words = count_words(
                unmarked,
                "1 recording without takes is kept as everyday movement.",
                "{n} recordings without takes are kept as everyday movement.",
            )
            said.append(words)
        if is_whole:
            self._confirm(" ".join(said))
            return
        said.append(tr("What is before its end was imported."))
        checklist = (tr("Copy or download the file once more, and import it again."),)
        title = tr("The file ends in the middle")
        self._controller.messages.tell(Message("warning", title, " ".join(said), checklist))

    def _confirm(self, words: str) -> None:
        self._controller.messages.tell(Message("success", words, passes=True))

"""Asks for files and folders, imports and exports takes, and tells what came of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from nep_core.errors import RecordingError
from nep_studio.ui.messages import Message
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.exchange_csv import read_csv, write_csv
from nep_studio.ui.trainer.exchange_mcap import read_mcap, write_mcap
from nep_studio.ui.trainer.exchange_parts import Imported, add_imported
from nep_studio.ui.words import count_words, tr

OnChosen = Callable[[Path], object]
MCAP_SUFFIX = ".mcap"


class GestureFiles:
    """Asks with the system's dialogs; nothing is called when the person thinks better of it."""

    def choose_file(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which file to import."""
        dialog = QFileDialog(parent, tr("Import takes"), str(folder))
        dialog.setNameFilters([tr("Recordings (*.csv *.mcap)"), tr("All files (*)")])
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        _open(dialog, on_chosen)

    def choose_folder(self, parent: QWidget, folder: Path, words: str, on_chosen: OnChosen) -> None:
        """Ask for a folder of CSV files; ``words`` says what for."""
        dialog = QFileDialog(parent, words, str(folder))
        dialog.setFileMode(QFileDialog.FileMode.Directory)
        dialog.setOption(QFileDialog.Option.ShowDirsOnly)
        _open(dialog, on_chosen)

    def choose_place(self, parent: QWidget, suggested: Path, on_chosen: OnChosen) -> None:
        """Ask where the MCAP file is to be."""
        dialog = QFileDialog(parent, tr("Export"), str(suggested.parent))
        dialog.setNameFilters([tr("MCAP files (*.mcap)"), tr("All files (*)")])
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(MCAP_SUFFIX.removeprefix("."))
        dialog.selectFile(suggested.name)
        _open(dialog, on_chosen)


class Exchange:
    """Takes from files, takes to files; ``files`` asks which."""

    def __init__(self, desk: TrainerDesk, over: QWidget) -> None:
        self._desk, self._over = desk, over
        self.files = GestureFiles()

    def entries(self) -> list[tuple[str, str, Callable[[], object], bool]]:
        """The entries of a menu: sign, words, what it does, whether it can be done now."""
        is_open, has_some = self._desk.editor is not None, bool(self._desk.recordings)
        return [
            ("upload", tr("Import a file…"), self.ask_for_file, is_open),
            ("folder-open", tr("Import a folder of CSV files…"), self.ask_for_folder, is_open),
            ("download", tr("Export as CSV files…"), self.ask_to_export_csv, has_some),
            ("download", tr("Export as MCAP…"), self.ask_to_export_mcap, has_some),
        ]

    # What is asked for

    def ask_for_file(self) -> None:
        """Ask which file to import."""
        self.files.choose_file(self._over, self._folder(), self.import_from)

    def ask_for_folder(self) -> None:
        """Ask which folder to import."""
        words = tr("Import a folder of CSV files")
        self.files.choose_folder(self._over, self._folder(), words, self.import_from)

    def ask_to_export_csv(self) -> None:
        """Ask for the folder that the CSV files are to be in."""
        words = tr("Export CSV files into a folder")
        self.files.choose_folder(self._over, self._folder(), words, self.export_csv)

    def ask_to_export_mcap(self) -> None:
        """Ask where the MCAP file is to be."""
        document = self._desk.files.document
        stem = document.title if document is not None else tr("gestures")
        suggested = self._folder() / f"{stem}{MCAP_SUFFIX}"
        self.files.choose_place(self._over, suggested, self.export_mcap)

    def _folder(self) -> Path:
        document = self._desk.files.document
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
            self._desk.messages.tell_error(error)
            return
        if add_imported(self._desk, imported):
            self._tell_imported(imported, is_whole)

    def export_csv(self, folder: Path) -> None:
        """Write CSV files into a folder, or say why not."""
        try:
            written = write_csv(folder, self._desk.gestures, self._desk.recordings)
        except RecordingError as error:
            self._desk.messages.tell_error(error)
            return
        self._confirm(count_words(len(written), "1 file was written.", "{n} files were written."))

    def export_mcap(self, path: Path) -> None:
        """Write an MCAP file, or say why not."""
        try:
            write_mcap(path, self._desk.gestures, self._desk.recordings)
        except RecordingError as error:
            self._desk.messages.tell_error(error)
            return
        self._confirm(tr("“{file}” was written.", file=path.name))

    def _tell_imported(self, imported: Sequence[Imported], is_whole: bool) -> None:
        takes = sum(len(one.takes) for one in imported)
        unmarked = sum(one.recording.everyday for one in imported)
        said = [count_words(takes, "1 take was imported.", "{n} takes were imported.")]
        if unmarked:
            said.append(
                count_words(
                    unmarked,
                    "1 recording without takes is kept as everyday movement.",
                    "{n} recordings without takes are kept as everyday movement.",
                )
            )
        if is_whole:
            self._confirm(" ".join(said))
            return
        said.append(tr("What is before its end was imported."))
        checklist = (tr("Copy or download the file once more, and import it again."),)
        title = tr("The file ends in the middle")
        self._desk.messages.tell(Message("warning", title, " ".join(said), checklist))

    def _confirm(self, words: str) -> None:
        self._desk.messages.tell(Message("success", words, passes=True))


def _open(dialog: QFileDialog, on_chosen: OnChosen) -> None:
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
    dialog.open()

"""Opens, saves and closes projects; nothing that is not saved goes without a question."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from faults.files import as_file_name
from nep_studio import settings
from nep_studio.blocks.errors import BlocksError, ProjectFileError
from nep_studio.problems import problem_of
from nep_studio.settings import Settings

from .messages import Answer, Message, Messages
from .words import language_code, tr

if TYPE_CHECKING:
    from nep_studio.blocks.language import Language
    from nep_studio.blocks.program import Project
    from nep_studio.project.journal import Recoverable

    from .documents import Document, Opening


# Lets a person choose where a project is, or is to be.

SUFFIX = ".nep"
PICTURES = (".png", ".svg")
"""The pictures that may have a project in them."""

OnChosen = Callable[[Path], object]


class FileChooser(Protocol):
    """Asks for a file; nothing is called when the person thinks better of it."""

    def choose_to_open(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which project to open."""

    def choose_to_save(self, parent: QWidget, suggested: Path, on_chosen: OnChosen) -> None:
        """Ask where to save a project."""


class SystemFileChooser:
    """Asks with the system's own dialog."""

    def choose_to_open(self, parent: QWidget, folder: Path, on_chosen: OnChosen) -> None:
        """Ask which project to open."""
        kinds = tr("Projects, and pictures with one (*.nep *.png *.svg)")
        dialog = _dialog(parent, tr("Open a project"), folder, kinds, on_chosen)
        dialog.setFileMode(QFileDialog.FileMode.ExistingFile)
        dialog.open()

    def choose_to_save(self, parent: QWidget, suggested: Path, on_chosen: OnChosen) -> None:
        """Ask where to save a project."""
        kinds, title = tr("NEP Studio projects (*.nep)"), tr("Save the project as")
        dialog = _dialog(parent, title, suggested.parent, kinds, on_chosen)
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix(SUFFIX.removeprefix("."))
        dialog.selectFile(suggested.name)
        dialog.open()


def _dialog(
    parent: QWidget, title: str, folder: Path, kinds: str, on_chosen: OnChosen
) -> QFileDialog:
    dialog = QFileDialog(parent, title, str(folder))
    dialog.setNameFilters([kinds, tr("All files (*)")])
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(lambda name: on_chosen(Path(name)))
    return dialog


Then = Callable[[], object]


class Files(QObject):
    """The files of one window: at most one project is open in it.

    ``document_changed`` gives the project that is open now, or None; ``opening_changed`` gives
    the Opening of a large file that takes its time, or None when it is over.
    """

    document_changed = Signal(object)
    opening_changed = Signal(object)
    recent_changed = Signal()

    def __init__(
        self,
        language: Callable[[], Language],
        settings: Settings,
        messages: Messages,
        chooser: FileChooser,
        window: QWidget,
    ) -> None:
        super().__init__(window)
        self._language, self._settings = language, settings
        self._messages, self._chooser, self._window = messages, chooser, window
        self._opening: Opening | None = None
        self._is_warned = False
        self._warning: Message | None = None
        self.document: Document | None = None
        self.openers: dict[str, OnChosen] = {}
        """Who opens what is no project, by the ending of its file."""

    # New, open, close

    def new(self) -> None:
        """Begin an empty project."""
        from .documents import new_document  # all of the blocks: not at a start

        self.guard(lambda: self._show(new_document(self._language(), self)))

    def choose(self) -> None:
        """Ask which project to open."""
        self._chooser.choose_to_open(self._window, self._settings.last_folder, self.open)

    def open(self, path: Path) -> None:
        """Open a project; one inside a picture opens as a copy. Packs of blocks have an opener."""
        opener = self.openers.get(path.suffix.lower())
        if opener is not None:
            opener(path.absolute())
            return
        on_opened = self._on_example_opened if path.suffix.lower() in PICTURES else self._on_opened
        self.guard(lambda: self._read(path.absolute(), on_opened))

    def open_example(self, path: Path, then: Then = lambda: None) -> None:
        """Open a copy of an example, in the language of the window; go on when it is open.

        It has no file until it is saved.
        """

        def show(path: Path, project: Project) -> None:
            from nep_studio.project.example_texts import translate

            translate(project, path.stem, self._language(), language_code())
            project.name = tr(project.name)
            self._on_example_opened(path, project)
            then()

        self.guard(lambda: self._read(path, show))

    def restore(self, work: Recoverable) -> None:
        """Open recovered work; it is not saved yet."""
        self.guard(lambda: self._show_restored(work))

    def close(self) -> None:
        """Close the project."""
        self.guard(lambda: self._show(None))

    def cancel_opening(self) -> None:
        """Stop reading a large file."""
        if self._opening is not None:
            self._opening.cancel()
            self._end_opening()

    def guard(self, then: Then) -> None:
        """Go on once the person has said what is to become of work that is not saved."""
        document = self.document
        if document is None or not document.is_modified:
            then()
            return
        title = tr("Save the changes to “{name}”?", name=document.title)
        answers = (
            Answer(tr("Save"), lambda: self.save(then), "primary"),
            Answer(tr("Don't save"), then),
            Answer(tr("Cancel"), lambda: None),
        )
        sentence = tr("If you don't save, what you have done since is lost.")
        self._messages.ask(Message("warning", title, sentence, answers=answers))

    # Save

    def save(self, then: Then = lambda: None) -> None:
        """Save the project in its file; go on when it is saved."""
        document = self.document
        if document is None:
            return
        if document.path is None:
            self.save_as(then)
        elif document.is_changed_by_others():
            path = document.path
            title = tr("“{name}” has been changed by another program.", name=path.name)
            sentence = tr("If you save here, what the other program has written is lost.")
            answers = (
                Answer(tr("Save as…"), lambda: self.save_as(then), "primary"),
                Answer(tr("Save here"), lambda: self._write(path, then)),
                Answer(tr("Cancel"), lambda: None),
            )
            self._messages.ask(Message("warning", title, sentence, answers=answers))
        else:
            self._write(document.path, then)

    def save_as(self, then: Then = lambda: None) -> None:
        """Ask where to save the project; go on when it is saved."""
        document = self.document
        if document is None:
            return
        name = as_file_name(document.title)
        suggested = document.path or self._settings.last_folder / f"{name}{SUFFIX}"

        def write(path: Path) -> None:
            self._write(path if path.suffix else path.with_name(path.name + SUFFIX), then)

        self._chooser.choose_to_save(self._window, suggested, write)

    def _write(self, path: Path, then: Then) -> None:
        document = self.document
        assert document is not None
        try:
            document.save(path)
        except ProjectFileError as error:
            other = Answer(tr("Save somewhere else…"), lambda: self.save_as(then), "primary")
            problem = replace(problem_of(error), title=tr("The project is not saved"))
            self._messages.tell_problem(problem, other)
            return
        self._remember(path)
        self._messages.confirm(tr("“{name}” is saved.", name=document.title))
        then()

    # Reading

    def _read(self, path: Path, on_opened: Callable[[Path, Project], None]) -> None:
        from .documents import Opening

        def on_read(project: Project) -> None:
            self._end_opening()
            on_opened(path, project)

        self.cancel_opening()
        opening = self._opening = Opening(path, self._language(), self)
        opening.opened.connect(on_read)
        opening.failed.connect(self._on_failed)
        opening.became_slow.connect(lambda: self.opening_changed.emit(opening))
        opening.start()

    def _on_opened(self, path: Path, project: Project) -> None:
        self._show(self._document(project, path))
        self._remember(path)

    def _on_example_opened(self, path: Path, project: Project) -> None:
        self._show(self._document(project))

    def _on_failed(self, error: BlocksError) -> None:
        self._end_opening()
        self._messages.tell_error(error)
        self.recent_changed.emit()

    def _show_restored(self, work: Recoverable) -> None:
        self._show(self._document(work.project, work.path, is_unsaved=True))
        work.discard()  # it is in the new document's journal now

    def _document(
        self, project: Project, path: Path | None = None, *, is_unsaved: bool = False
    ) -> Document:
        from nep_studio.blocks.editor import Editor

        from .documents import Document

        editor = Editor(project, self._language())
        return Document(editor, path, is_unsaved=is_unsaved, parent=self)

    def _show(self, document: Document | None) -> None:
        old, self.document = self.document, document
        self._take_warning_back()
        self.document_changed.emit(document)
        if document is not None:
            document.kept_changed.connect(self._on_kept_changed)
            if not document.is_kept and not self._is_warned:
                self._warn_of_loss()
        if old is not None:
            old.close()
            old.deleteLater()

    def _on_kept_changed(self) -> None:
        """The disk became full, or has room again."""
        self._take_warning_back()
        if self.document is not None and not self.document.is_kept:
            self._warn_of_loss()

    def _take_warning_back(self) -> None:
        if self._warning is not None:
            self._messages.withdraw(self._warning)
            self._warning = None

    def _warn_of_loss(self) -> None:
        """Say that nothing is kept between saves."""
        self._is_warned = True
        title = tr("Save often")
        sentence = tr(
            "The program cannot write into its own folder, so work that is not saved is lost"
            " if the computer stops."
        )
        may_write = tr("May this program write into {folder}?", folder=str(settings.user_folder()))
        steps = (tr("Is there room on the disk?"), may_write)
        save = Answer(tr("Save"), self.save, "primary")
        self._warning = Message("warning", title, sentence, steps, answers=(save,))
        self._messages.tell(self._warning)

    def _end_opening(self) -> None:
        if self._opening is not None:
            self._opening.deleteLater()
            self._opening = None
            self.opening_changed.emit(None)

    def _remember(self, path: Path) -> None:
        self._settings.add_recent(path)
        self.recent_changed.emit()

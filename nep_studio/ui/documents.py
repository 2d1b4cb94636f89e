"""A project that is open in a window: where its file is, and whether it is saved."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.program.kept import SUFFIX
from nep_studio import settings
from nep_studio.blocks import files
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.errors import BlocksError, ProjectFileError
from nep_studio.blocks.files import from_bytes, load
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.fixes import append_entry
from nep_studio.blocks.program import LANGUAGE, LANGUAGES, ROBOT_BLOCK, Block, Project
from nep_studio.project.journal import Journal
from nep_studio.project.picture_files import project_bytes_from
from nep_studio.project.trust import Authorship, Brought, Concern, shared_approvals
from nep_studio.run.gate import brought_by, shipped_keys

from .background import Background
from .document_files import PICTURES
from .edits import edits_of
from .words import language_code, tr

log = logging.getLogger(__name__)


FLUSH_MS = 1500
"""How often the journal goes to the disk: less than the two seconds that may be lost."""

Stamp = tuple[int, int]
"""When a file was changed, in ns, and its size: whether somebody else has written it."""


class Document(QObject):
    """An editor, its file and its journal. ``changed`` tells of its title and of being saved.

    ``kept_changed`` tells that the journal cannot be written any more, or can be again.
    """

    changed = Signal()
    kept_changed = Signal()

    def __init__(
        self,
        editor: Editor,
        path: Path | None = None,
        *,
        is_unsaved: bool = False,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(parent)
        self.editor, self.project = editor, editor.project
        self.path = path
        self.folder = path.parent if path is not None else Path.cwd()
        """Where the project's own files are."""
        self._is_open = True
        self._saved_position = -1 if is_unsaved else editor.history.position
        self._stamp = _stamp(path)
        self._journal = _journal(editor, path, is_unsaved)
        self._flush = QTimer(self, interval=FLUSH_MS)
        self._flush.timeout.connect(self.flush)
        self.authorship = Authorship(editor, shared_approvals(), self._brought_by, shipped_keys)
        """What of it the person has written, which needs nobody's approval."""
        self._edits = edits_of(editor)
        self._edits.edited.connect(self._on_edited)
        self._edits.settled.connect(self._look_at_journal)
        self._flush.start()  # until all is on the disk
        self.title = ""
        """The name of its file, or of the project when it has none yet."""
        self.is_modified = False
        """Whether it differs from what was saved last."""
        self._shown: object = None
        self._tell()
        self.is_kept = self._journal is not None and not self._journal.error
        """Whether a journal keeps what is not saved yet."""

    def is_changed_by_others(self) -> bool:
        """Whether the file on the disk is another one than we have read or written."""
        now = _stamp(self.path)
        return now is not None and now != self._stamp

    def save(self, path: Path) -> None:
        """Write the project to a file, which is its file from now on; raises ProjectFileError."""
        # A project without a name of its own is called like its file
        rename = RenameProject(path.stem)
        if self.project.name == new_name() and self.editor.why_not(rename) is None:
            self.editor.apply(rename)
        self.authorship.keep()
        files.save(self.project, path)
        self.editor.history.seal()
        self.path, self._stamp = path, _stamp(path)
        self._saved_position = self.editor.history.position
        if self._journal is not None:
            self._journal.saved(path)
            self._flush.start()
        self._tell()

    def flush(self) -> None:
        """Put the journal on the disk."""
        if self._journal is not None:
            self._journal.flush()
            self._look_at_journal()
        if self.is_kept:
            self._flush.stop()

    def close(self, *, keep: bool = False) -> None:
        """End; the journal goes, unless it is to be kept for the next start."""
        if not self._is_open:
            return
        self._is_open = False
        self.authorship.close()
        self._flush.stop()
        self._edits.edited.disconnect(self._on_edited)
        self._edits.settled.disconnect(self._look_at_journal)
        if self._journal is not None:
            self._journal.close(keep=keep)
            self._journal, self.is_kept = None, False

    @property
    def kept_file(self) -> Path | None:
        """Where its program keeps variables: beside the project, else with what is unsaved."""
        if self.path is not None:
            return self.path.with_suffix(SUFFIX)
        return self._journal.folder / f"program{SUFFIX}" if self._journal is not None else None

    def _brought_by(self, block: Block) -> Sequence[Concern | Brought]:
        return brought_by(block, self.project, self.editor.language, self.folder)

    def _on_edited(self) -> None:
        if not self._flush.isActive():
            self._flush.start()
        self._tell()

    def _look_at_journal(self) -> None:
        is_kept = self._journal is not None and not self._journal.error
        if is_kept != self.is_kept:
            self.is_kept = is_kept
            self.kept_changed.emit()

    def _tell(self) -> None:
        self.folder = self.path.parent if self.path is not None else Path.cwd()
        self.title = self.path.stem if self.path is not None else self.project.name
        self.is_modified = self.editor.history.position != self._saved_position
        shown = (self.path, self.title, self.is_modified)
        if shown != self._shown:
            self._shown = shown
            self.changed.emit()


def new_name() -> str:
    """What a project is called until it is saved."""
    return tr("My program")


def new_document(language: Language, parent: QObject | None = None) -> Document:
    """A project without a file that has a robot on the screen, and no program yet."""
    project = Project(new_name())
    # by an editor of its own: the robot is there from the beginning, and no undo takes it away
    robot = {"name": language.profile.title}
    append_entry(Editor(project, language), "robots", ROBOT_BLOCK, robot)
    if language_code() in LANGUAGES[1:]:  # its program tells values as the window does
        project.extra[LANGUAGE] = language_code()
    return Document(Editor(project, language), parent=parent)


def _journal(editor: Editor, path: Path | None, is_unsaved: bool) -> Journal | None:
    """The journal, or None where nothing can be written: the work goes on without."""
    try:
        return Journal(settings.journal_folder(), editor, path, unsaved=is_unsaved)
    except OSError as error:
        log.warning("There is no journal: %s", error)
        return None


def _stamp(path: Path | None) -> Stamp | None:
    try:
        found = path.stat() if path is not None else None
    except OSError:
        return None
    return (found.st_mtime_ns, found.st_size) if found is not None else None


# Reads a project from a file: a large one beside the window's work, so that nothing freezes.

LARGE_BYTES = 400_000
"""What is smaller is read in less than a tenth of a second."""

SLOW_MS = 500
"""After this time the person is shown that the file is being read, and can stop it."""


class Opening(QObject):
    """One file that is being read. Exactly one of ``opened`` and ``failed`` comes, or neither
    when it is cancelled."""

    opened = Signal(object)  # the Project
    failed = Signal(object)  # the BlocksError
    became_slow = Signal()

    def __init__(self, path: Path, language: Language, parent: QObject) -> None:
        super().__init__(parent)
        self.path = path
        self._language = language
        self._is_over = False
        self._slow = QTimer(self, singleShot=True, interval=SLOW_MS)
        self._slow.timeout.connect(self.became_slow)
        self._background = Background(self)

    def start(self) -> None:
        """Read it; a small file is there at once."""
        if not _is_large(self.path):
            self._on_read(_result(self.path, self._language))
            return
        self._slow.start()
        read = partial(_result, self.path, self._language)
        self._background.start(read, self._on_read, name="opening")

    def cancel(self) -> None:
        """Do not open it: what is still being read is forgotten."""
        self._end()

    def _on_read(self, result: Project | BlocksError) -> None:
        if self._is_over:
            return
        self._end()
        if isinstance(result, BlocksError):
            self.failed.emit(result)
        else:
            self.opened.emit(result)

    def _end(self) -> None:
        self._is_over = True
        self._slow.stop()


def _result(path: Path, language: Language) -> Project | BlocksError:
    try:
        return (
            _project_in_picture(path, language)
            if path.suffix.lower() in PICTURES
            else load(path, language)
        )
    except BlocksError as error:
        return error


def _project_in_picture(path: Path, language: Language) -> Project:
    """The project inside a picture that this program has made; raises ProjectFileError."""
    data = project_bytes_from(path)
    if data is None:
        raise ProjectFileError(
            "There is no project in the picture {name}.",
            checklist=("Choose a picture that was exported with the program inside.",),
            name=path.name,
        )
    return from_bytes(data, path.name, language)


def _is_large(path: Path) -> bool:
    try:
        return path.stat().st_size > LARGE_BYTES
    except OSError:
        return False

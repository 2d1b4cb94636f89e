"""The Python of the page that is shown, made again after each edit, before the next frame."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.launch import generate_launch
from nep_studio.blocks.generate.program import ProgramGenerator
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Changes

FRAME_MS = 16


class LiveCode(QObject):
    """Follows an editor; it works only while it is ``awake``, that is, while somebody looks.

    ``made`` gives the Code; ``refused`` the CodeRefused, when a block cannot become code.
    """

    made = Signal(object)
    refused = Signal(object)

    def __init__(self, editor: Editor, parent: QObject) -> None:
        super().__init__(parent)
        self._editor = editor
        self._generator: ProgramGenerator | None = None
        self._procedures = -1
        self._page = "behaviour"
        self._is_awake = False
        self._is_old = True
        self.code: Code | None = None
        self._next_frame = QTimer(self, singleShot=True, interval=FRAME_MS)
        self._next_frame.timeout.connect(self.make)
        editor.history.listen(self._on_changes)

    def set_editor(self, editor: Editor) -> None:
        """Follow another project."""
        self._editor.history.unlisten(self._on_changes)
        self._editor = editor
        self._generator = None
        editor.history.listen(self._on_changes)
        self._grow_old()

    def show_page(self, page: str) -> None:
        """Give the code of the kind of this page: the program, or what starts robots and nodes."""
        kind = self._editor.project.kind_of_page(page)
        if kind != self._page:
            self._page = kind
            self._grow_old()

    def use_language(self) -> None:
        """The editor speaks another language now."""
        self._generator = None
        self._grow_old()

    def set_awake(self, is_awake: bool) -> None:
        """Work only while somebody looks."""
        self._is_awake = is_awake
        if is_awake and self._is_old:
            self.make()

    def make(self) -> None:
        """Make the code now."""
        self._next_frame.stop()
        self._is_old = False
        try:
            self.code = self._writer()()
        except CodeRefused as refusal:
            self.code = None
            self.refused.emit(refusal)
            return
        self.made.emit(self.code)

    def _writer(self) -> Callable[[], Code]:
        editor = self._editor
        if self._page != "behaviour":
            return lambda: generate_launch(editor.project, editor.language)
        if self._generator is None or self._procedures != editor.project.procedure_revision:
            self._procedures = editor.project.procedure_revision
            self._generator = ProgramGenerator(editor.project, editor.language)
        return self._generator.generate

    def _on_changes(self, changes: Changes) -> None:
        self._grow_old()

    def _grow_old(self) -> None:
        self._is_old = True
        if self._is_awake:
            self._next_frame.start()

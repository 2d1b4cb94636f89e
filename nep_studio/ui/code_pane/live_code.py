"""The Python of the page that is shown, made again after each edit; a long one in slices."""

from __future__ import annotations

import math
from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.launch import generate_launch
from nep_studio.blocks.generate.program import ProgramGenerator
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Changes
from nep_studio.ui.problems.slices import SlicedCall

FRAME_MS = 16
SLICE_S = 0.008
"""How long the making may take of one frame of the screen."""

BETWEEN_SLICES_MS = 4


Rest = Callable[[], None]


class LiveCode(QObject):
    """Follows an editor; it works only while it is ``awake``, that is, while somebody looks.

    ``made`` gives the Code; ``refused`` the CodeRefused, when a block cannot become code;
    ``began`` says that it takes longer than one slice: what comes of it comes later.
    """

    began = Signal()
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
        self._next_frame.timeout.connect(self.start)
        self._call: SlicedCall[Code] | None = None
        self._next_slice = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next_slice.timeout.connect(self._on_next_slice)
        editor.history.listen(self._on_changes)

    def set_editor(self, editor: Editor) -> None:
        """Follow another project."""
        self._editor.history.unlisten(self._on_changes)
        self._editor = editor
        self._generator = self.code = None
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
        if not is_awake:
            self.cancel()
        if is_awake and self._is_old:
            self.start()

    def start(self) -> None:
        """Begin to make the code: most is made at once, a long one bit by bit."""
        self.cancel()
        self._is_old = False
        self._call = SlicedCall(self._writer())
        if self._call.run(SLICE_S):
            self._finish(self._call)
        else:
            self.began.emit()
            self._next_slice.start()

    def make(self) -> None:
        """Make the code now, however long it takes."""
        self.cancel()
        self._is_old = False
        call = self._call = SlicedCall(self._writer())
        call.run(math.inf)
        self._finish(call)

    def cancel(self) -> None:
        """Give up what is being made; it is old then."""
        self._next_frame.stop()
        self._next_slice.stop()
        if self._call is not None:
            self._call.cancel()
            self._call, self._is_old = None, True

    def _on_next_slice(self) -> None:
        call = self._call
        if call is None:
            return
        if call.run(SLICE_S):
            self._finish(call)
        else:
            self._next_slice.start()

    def _finish(self, call: SlicedCall[Code]) -> None:
        self._call = None
        try:
            self.code = call.result()
        except CodeRefused as refusal:
            self.code = None
            self.refused.emit(refusal)
            return
        self.made.emit(self.code)

    def _writer(self) -> Callable[[Rest], Code]:
        editor = self._editor
        if self._page != "behaviour":
            return lambda rest: generate_launch(editor.project, editor.language)
        if self._generator is None or self._procedures != editor.project.procedure_revision:
            self._procedures = editor.project.procedure_revision
            self._generator = ProgramGenerator(editor.project, editor.language)
        return self._generator.generate

    def _on_changes(self, changes: Changes) -> None:
        self._grow_old()

    def _grow_old(self) -> None:
        self.cancel()
        self._is_old = True
        if self._is_awake:
            self._next_frame.start()

"""Makes the Python of a program between frames: for thousands of blocks it takes a while."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import ProgramGenerator
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Changes
from nep_studio.ui.problems.slices import SlicedCall

SLICE_S = 0.008
BETWEEN_SLICES_MS = 1


class Preparation(QObject):
    """``done`` gives the code, ``refused`` the BlocksError that says why there is none.

    When the program is changed meanwhile, it begins again with what has changed.
    """

    done = Signal(object)
    refused = Signal(object)

    def __init__(self, editor: Editor, parent: QObject) -> None:
        super().__init__(parent)
        self._editor = editor
        self._generator = ProgramGenerator(editor.project, editor.language)
        self._next = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next.timeout.connect(self._on_next_slice)
        self._call = self._begin()
        editor.history.listen(self._on_changes)
        self._next.start()

    def cancel(self) -> None:
        """Give it up."""
        self._end()
        self._call.cancel()

    def _begin(self) -> SlicedCall[Code]:
        generator = self._generator

        def work(rest: Callable[[], None]) -> Code:
            return generator.generate(rest)

        return SlicedCall(work)

    def _end(self) -> None:
        self._next.stop()
        self._editor.history.unlisten(self._on_changes)
        self.deleteLater()

    def _on_changes(self, _changes: Changes) -> None:
        self._call.cancel()
        self._call = self._begin()

    def _on_next_slice(self) -> None:
        if not self._call.run(SLICE_S):
            self._next.start()
            return
        self._end()
        try:
            code = self._call.result()
        except BlocksError as error:
            self.refused.emit(error)
        else:
            self.done.emit(code)

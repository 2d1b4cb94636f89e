"""A canvas with one block, and what a person does with its fields."""

from __future__ import annotations

from kinds_language import kinds_language
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.program import Project
from nep_studio.blocks.slots import FieldValue
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.fields.field_edit import piece_of, view_rect_of
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.theme.look import text_font


class Desk:
    """One block on a canvas that is shown."""

    def __init__(self, qtbot, block_type: str, *, is_mirrored: bool = False, **fields) -> None:
        self.editor = Editor(Project("Test"), kinds_language())
        for name in ("score", "count"):
            self.editor.add_variable(name)
        page = self.editor.language.definitions[block_type].page
        self.block = self.editor.create(block_type, self.editor.new_stack(page, 40, 40))
        for key, value in fields.items():
            self.editor.apply(SetField(self.block, key, value))
        self.canvas = Canvas(
            self.editor, load_theme("light"), font=text_font(11), is_mirrored=is_mirrored
        )
        qtbot.addWidget(self.canvas)
        self.canvas.resize(700, 500)
        self.canvas.show_page(page)
        self.canvas.show()
        qtbot.waitExposed(self.canvas)
        self.canvas.sight.fit()
        self.steps = self.editor.history.steps

    @property
    def fields(self):
        return self.canvas.fields

    @property
    def widget(self):
        """The editor that is open."""
        return self.canvas.fields.widget

    def value(self, key: str, block: str = "") -> FieldValue | None:
        there = self.editor.project.blocks[block or self.block]
        return self.editor.language.definitions[there.type].value(there, key)

    def shown(self, key: str) -> str:
        """What the field shows on the canvas."""
        found = piece_of(self.canvas, self.block, key)
        assert found is not None
        return found[1].text

    def new_steps(self) -> int:
        """How many steps of undo there are since the beginning."""
        return self.editor.history.steps - self.steps

    def place(self, key: str, block: str = "") -> QPoint:
        rect = view_rect_of(self.canvas, block or self.block, key)
        assert rect is not None
        return rect.center().toPoint()

    def click(self, key: str, block: str = "") -> None:
        """Press the mouse where a field is."""
        QTest.mouseClick(
            self.canvas.viewport(),
            Qt.MouseButton.LeftButton,
            Qt.KeyboardModifier.NoModifier,
            self.place(key, block),
        )

    def click_elsewhere(self) -> None:
        viewport = self.canvas.viewport()
        corner = QPoint(viewport.width() - 3, viewport.height() - 3)
        QTest.mouseClick(
            viewport, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, corner
        )

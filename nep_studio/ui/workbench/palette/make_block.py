"""The dialog in which a person makes a block of their own: words, values, and how it looks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint, Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QLayout,
    QLineEdit,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import AddProcedure
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.procedures import DEFINE, procedure_of
from nep_studio.blocks.program import PAGES, Parameter, Procedure
from nep_studio.ui.canvas.block_pictures import BlockPicture
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.editing.menu import MenuEntry, MenuPlace
from nep_studio.ui.canvas.fields.field_edit import ReasonBubble
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import Asking
from nep_studio.ui.words import tr
from nep_studio.ui.workbench.placing import free_place

from .entries import Stock

if TYPE_CHECKING:
    from .palette import Palette


Parts = list[str | Parameter]
MakeBlock = Callable[[Sequence[str | Parameter], bool], object]

PREVIEWED = "preview"


def kinds() -> dict[str, str]:
    """What a value of an own block can be, in words."""
    return {
        "any": tr("any value"),
        "number": tr("a number"),
        "text": tr("a text"),
        "boolean": tr("yes or no"),
        "list": tr("a list"),
        "table": tr("a table"),
        "colour": tr("a colour"),
        "robot": tr("a robot"),
    }


class PartRow(QWidget):
    """One part of the sentence: words, or a value with its name and kind."""

    def __init__(self, dialog: MakeBlockDialog, parameter: str = "") -> None:
        super().__init__(dialog)
        self._parameter = parameter
        words = tr("Name of the value") if parameter else tr("Words of the block")
        self.name = QLineEdit(self)
        self.name.setPlaceholderText(words)
        self.name.setAccessibleName(words)
        self.name.textEdited.connect(dialog.update_preview)
        self.kind = QComboBox(self)
        self.kind.setAccessibleName(tr("What the value is"))
        for kind, label in kinds().items():
            self.kind.addItem(label, kind)
        self.kind.setVisible(bool(parameter))
        self.kind.currentIndexChanged.connect(dialog.update_preview)
        away = QToolButton(self)
        away.setIcon(icon("x", dialog.canvas.look.theme))
        away.setToolTip(tr("Take this part away"))
        away.setAccessibleName(tr("Take this part away"))
        away.clicked.connect(lambda: dialog.take_away(self))
        in_row((self.name, 1), self.kind, away, of=self, margins=0)
        for widget in (self.name, self.kind):
            widget.ensurePolished()  # before that the style sheet's sizes do not count
        self.setMinimumHeight(self.sizeHint().height())

    def show_part(self, part: str | Parameter) -> None:
        """Take the words, or the name and kind, of a part that there is already."""
        self.name.setText(part.name if isinstance(part, Parameter) else part)
        if isinstance(part, Parameter):
            self.kind.setCurrentIndex(self.kind.findData(part.kind))

    @property
    def part(self) -> str | Parameter:
        """What the row says."""
        text = self.name.text().strip()
        if not self._parameter:
            return text
        return Parameter(self._parameter, text, str(self.kind.currentData()))


class MakeBlockDialog(QDialog):
    """Puts an own block together, or changes one, and shows it as it will look."""

    def __init__(
        self, canvas: Canvas, make: MakeBlock, parent: QWidget, procedure: Procedure | None = None
    ) -> None:
        super().__init__(parent)
        self.canvas = canvas
        self._make = make
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._is_new = procedure is None
        self.setWindowTitle(tr("Make a block") if self._is_new else tr("Change the block"))
        self.rows: list[PartRow] = []
        self.picture = BlockPicture(canvas, self)
        self.reason = ReasonBubble(canvas.look.theme, self)
        self.gives_value = QCheckBox(tr("The block gives a value back"), self)
        self.gives_value.toggled.connect(self.update_preview)
        self._list = QVBoxLayout()
        self._arrange()
        if procedure is None:
            self.add_words()
        else:
            self.gives_value.setChecked(procedure.gives_value)
            for part in procedure.parts:
                row = self._add(PartRow(self, part.id if isinstance(part, Parameter) else ""))
                row.show_part(part)
            self.update_preview()
        self.rows[0].name.setFocus()

    def add_words(self) -> PartRow:
        """Add words to the sentence."""
        return self._add(PartRow(self))

    def add_value(self) -> PartRow:
        """Add a value to the sentence."""
        parameter = self.canvas.editor.new_parameter("", "any")
        return self._add(PartRow(self, parameter.id))

    def take_away(self, row: PartRow) -> None:
        """Take a part out of the sentence."""
        self.rows.remove(row)
        row.deleteLater()
        self.update_preview()

    @property
    def parts(self) -> Parts:
        """The sentence; empty words are left out."""
        return [row.part for row in self.rows if row.part]

    def update_preview(self) -> None:
        """Show the block as it is now."""
        procedure = Procedure(PREVIEWED, tuple(self.parts), self.gives_value.isChecked())
        self.reason.tell(None)
        is_ready = Editor.why_not(self.canvas.editor, AddProcedure(procedure, 0)) is None
        self.picture.show_call(procedure if is_ready else None)

    def accept(self) -> None:
        """Make the block, or say why it cannot be made."""
        try:
            self._make(self.parts, self.gives_value.isChecked())
        except EditRefused as refusal:
            self.reason.tell(refusal.sentence)
            return
        super().accept()

    def _add(self, row: PartRow) -> PartRow:
        self.rows.append(row)
        self._list.addWidget(row)
        row.name.setFocus()
        self.update_preview()
        return row

    def _arrange(self) -> None:
        told = QLabel(tr("Say in words what the block does. Values can stand between the words."))
        told.setWordWrap(True)
        words, value = QPushButton(tr("Add words")), QPushButton(tr("Add a value"))
        words.clicked.connect(lambda: self.add_words())
        value.clicked.connect(lambda: self.add_value())
        for button in (words, value):
            button.setAutoDefault(False)
        standard = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(standard.Ok | standard.Cancel)
        buttons.button(standard.Ok).setText(tr("Make") if self._is_new else tr("Change"))
        buttons.button(standard.Cancel).setText(tr("Cancel"))
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        sentence = (told, self.picture, self._list, in_row(words, value, 1))
        column = in_column(*sentence, self.gives_value, self.reason, 1, buttons, of=self)
        column.setSizeConstraint(QLayout.SizeConstraint.SetMinimumSize)  # grows with the rows
        self.resize(self.fontMetrics().averageCharWidth() * 60, self.sizeHint().height())


# Make variables and own blocks from the palette.


class Making(QObject):
    """Asks for what is needed, and makes it in one step."""

    def __init__(self, palette: Palette) -> None:
        super().__init__(palette)
        self._palette = palette
        self.asking: Asking | None = None
        self.dialog: MakeBlockDialog | None = None
        palette.canvas.menu_sections.append(self._section)

    def ask_for_variable(self) -> None:
        """Ask for the name of a new variable."""
        palette = self._palette
        words = tr("Name of the new variable")
        self.asking = Asking(
            palette, palette.canvas.look.theme, words, tr("Make"), self.make_variable, name=""
        )
        self.asking.show_at(palette.mapToGlobal(QPoint(palette.width() // 3, 60)))

    def make_variable(self, name: str) -> None:
        """Make a variable, and show its blocks; raises EditRefused."""
        self._palette.canvas.editor.add_variable(name.strip())
        self._palette.canvas.news.announced.emit(tr("variable {name} made", name=name.strip()))

    def ask_for_block(self) -> None:
        """Ask for the words and values of a new own block."""
        canvas = self._palette.canvas
        self.dialog = MakeBlockDialog(canvas, self.make_block, self._palette)
        self.dialog.open()

    def ask_to_change(self, procedure_id: str) -> None:
        """Ask for other words and values of an own block; all that use it follow, in one step."""
        canvas = self._palette.canvas

        def change(parts: Sequence[str | Parameter], gives_value: bool) -> None:
            canvas.editor.change_procedure(procedure_id, parts, gives_value=gives_value)

        procedure = canvas.editor.project.procedures[procedure_id]
        self.dialog = MakeBlockDialog(canvas, change, self._palette, procedure)
        self.dialog.open()

    def _section(self, canvas: CanvasHost, place: MenuPlace) -> list[MenuEntry]:
        """What the menu of an own block, of its header and its parameters offers besides."""
        block_type = place.hit.placed.box.type if place.hit is not None else ""
        procedure = procedure_of(block_type)
        if procedure not in canvas.editor.project.procedures:
            return []
        ask = MenuEntry(
            "change_block",
            tr("Change this own block…"),
            lambda: self.ask_to_change(procedure),
            "pencil",
        )
        if not block_type.startswith(DEFINE):
            return [ask]
        delete = MenuEntry(
            "delete_own_block",
            tr("Delete this own block with its definition"),
            lambda: canvas.attempt(lambda: canvas.editor.delete_procedure(procedure)),
            "trash-2",
        )
        return [ask, delete]

    def make_block(self, parts: Sequence[str | Parameter], gives_value: bool) -> None:
        """Make an own block with its header, where one looks; raises EditRefused."""
        canvas = self._palette.canvas
        editor = canvas.editor
        kind = editor.project.kind_of_page(canvas.page)
        page = canvas.page if kind == PAGES[0] else PAGES[0]
        canvas.show_page(page)
        hat = Stock(editor)
        where = free_place(canvas, hat.clip(hat.sample("event.started")))
        place = editor.new_stack(page, where.x(), where.y())
        procedure = editor.add_procedure(parts, gives_value=gives_value, place=place)
        header = editor.project.stacks[place.stack].body[0]
        assert editor.project.blocks[header].type == DEFINE + procedure
        canvas.selection.set([header])
        canvas.show_block(header)

"""The dialog in which a person makes a block of their own: words, values, and how it looks."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLabel,
    QLayout,
    QLineEdit,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import AddProcedure
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.program import Parameter, Procedure
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.fields.reason import ReasonBubble
from nep_studio.ui.theme import icon
from nep_studio.ui.words import tr

from .block_picture import BlockPicture

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
        away.setIcon(icon("x", dialog.canvas.theme))
        away.setToolTip(tr("Take this part away"))
        away.setAccessibleName(tr("Take this part away"))
        away.clicked.connect(lambda: dialog.take_away(self))
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.name, 1)
        row.addWidget(self.kind)
        row.addWidget(away)
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
        self,
        canvas: Canvas,
        make: MakeBlock,
        parent: QWidget,
        procedure: Procedure | None = None,
    ) -> None:
        super().__init__(parent)
        self.canvas = canvas
        self._make = make
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._is_new = procedure is None
        self.setWindowTitle(tr("Make a block") if self._is_new else tr("Change the block"))
        self.rows: list[PartRow] = []
        self.picture = BlockPicture(canvas, self)
        self.reason = ReasonBubble(canvas.theme, self)
        self.gives_value = QCheckBox(tr("The block gives a value back"), self)
        self.gives_value.toggled.connect(self.update_preview)
        self._list = QVBoxLayout()
        self._arrange()
        if procedure is None:
            self.add_words()
        else:
            self._fill(procedure)
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
        self.reason.tell("")
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

    def _fill(self, procedure: Procedure) -> None:
        self.gives_value.setChecked(procedure.gives_value)
        for part in procedure.parts:
            row = self._add(PartRow(self, part.id if isinstance(part, Parameter) else ""))
            row.show_part(part)
        self.update_preview()

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
        adding = QHBoxLayout()
        adding.addWidget(words)
        adding.addWidget(value)
        adding.addStretch(1)
        standard = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(standard.Ok | standard.Cancel)
        buttons.button(standard.Ok).setText(tr("Make") if self._is_new else tr("Change"))
        buttons.button(standard.Cancel).setText(tr("Cancel"))
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        column = QVBoxLayout(self)
        column.setSizeConstraint(QLayout.SizeConstraint.SetMinimumSize)  # grows with the rows
        for item in (told, self.picture, self._list, adding, self.gives_value, self.reason):
            if isinstance(item, QWidget):
                column.addWidget(item)
            else:
                column.addLayout(item)
        column.addStretch(1)
        column.addWidget(buttons)
        self.resize(self.fontMetrics().averageCharWidth() * 60, self.sizeHint().height())

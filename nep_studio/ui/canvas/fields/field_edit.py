"""One field while it is edited: what it held before, what it holds now, what does not fit."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QFrame, QLabel, QWidget

from faults import Text, Words
from nep_studio.blocks.definitions import Slot
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import ChangeProcedure, SetField
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.fixes import rename_robot
from nep_studio.blocks.procedures import changed, procedure_of
from nep_studio.blocks.program import Parameter, Procedure
from nep_studio.blocks.slots import FieldValue, why_not_name
from nep_studio.ui.canvas.layout.boxes import Piece
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import Placed
from nep_studio.ui.labels import labelled
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.widgets.forms import plain_label
from nep_studio.ui.widgets.layouts import in_row

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


class Editing(Protocol):
    """What an editor of a field needs: to set it, to put it back, to end."""

    block: str
    key: str
    slot: Slot

    @property
    def value(self) -> FieldValue | None:
        """What the field holds now."""

    def set(self, value: FieldValue) -> Text | None:
        """Hold another value; gives why it does not fit, and then nothing is changed."""

    def restore(self) -> None:
        """Make it as it was before the editing."""

    def end(self) -> None:
        """The editing is over; what follows is another step of undo."""


Attempt = Callable[[Callable[[], object]], bool]
"""Makes a change, and tells the person why not when it is refused."""


class FieldEdit:
    """Sets a field live; all of one editing is one step of undo."""

    def __init__(self, editor: Editor, block: str, key: str, slot: Slot) -> None:
        self.block, self.key, self.slot = block, key, slot
        self._editor = editor
        editor.history.seal()
        self._steps_before = editor.history.steps

    @property
    def value(self) -> FieldValue | None:
        """What the field holds, or its default; None when the block is gone."""
        block = self._editor.project.blocks.get(self.block)
        if block is None:
            return None
        return self._editor.language.definitions[block.type].value(block, self.key)

    def set(self, value: FieldValue) -> Text | None:
        """Hold another value; gives why it does not fit, and then nothing is changed."""
        if self.block not in self._editor.project.blocks:
            return Text("This block is not there any more.")
        now = self.value
        if now == value and type(now) is type(value):
            return None
        try:
            self._editor.apply(SetField(self.block, self.key, value))
        except EditRefused as refused:
            return refused.sentence
        return None

    def restore(self) -> None:
        """Take back what this editing changed, as if it had never been."""
        self._editor.history.drop(self._steps_before)

    def end(self) -> None:
        """What follows is another step of undo."""
        self._editor.history.seal()


class RobotNameEdit(FieldEdit):
    """Gives a robot another name as it is typed; when the editing ends, all that name it follow."""

    def __init__(self, editor: Editor, block: str, key: str, slot: Slot, attempt: Attempt) -> None:
        super().__init__(editor, block, key, slot)
        self._before, self._attempt = self.value, attempt

    def end(self) -> None:
        """Rename the robot everywhere, as one step; it keeps its name where that cannot be."""
        name = self.value
        if name is not None and name != self._before:
            self.restore()
            self._attempt(lambda: rename_robot(self._editor, self.block, str(name)))
        super().end()


class ParameterEdit:
    """Gives a parameter of an own block another name, when the editing ends."""

    def __init__(self, editor: Editor, block: str, key: str, slot: Slot, attempt: Attempt) -> None:
        self._attempt = attempt
        self.block, self.key, self.slot = block, key, slot
        self._editor = editor
        procedure_id = procedure_of(editor.project.blocks[block].type)
        self._procedure = editor.project.procedures[procedure_id]
        self._name = slot.label

    @property
    def value(self) -> FieldValue | None:
        """The name as it is typed so far."""
        return self._name

    def set(self, value: FieldValue) -> Text | None:
        """Take another name; gives why it cannot be one."""
        reason = why_not_name(value)
        if reason is None:
            reason = self._editor.why_not(ChangeProcedure(self._renamed(str(value))))
        if reason is None:
            self._name = str(value)
        return reason

    def restore(self) -> None:
        """Keep the name that it has."""
        self._name = self.slot.label

    def end(self) -> None:
        """Rename the parameter in the header, in the calls, and in the blocks that give it."""
        if self._name != self.slot.label:
            changed = self._renamed(self._name)
            self._attempt(
                lambda: self._editor.change_procedure(
                    changed.id, changed.parts, gives_value=changed.gives_value
                )
            )

    def _renamed(self, name: str) -> Procedure:
        parts = tuple(
            Parameter(part.id, name, part.kind)
            if isinstance(part, Parameter) and part.id == self.key
            else part
            for part in self._procedure.parts
        )
        return changed(self._procedure, parts, gives_value=self._procedure.gives_value)


# Says below a field why what is typed in it does not fit.


class ReasonBubble(QFrame):
    """An icon and a sentence in a red frame; hidden while there is no reason."""

    def __init__(self, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("reason")
        self._line = self.fontMetrics().height()
        error, text = theme.colour("error"), theme.colour("text").name()
        width = max(2, self._line // 9)
        self.setStyleSheet(
            f"#reason {{ background: {theme.colour('error_panel').name()};"
            f" border: {width}px solid {error.name()}; border-radius: {self._line // 3}px; }}"
            f"#reason QLabel {{ color: {text}; background: transparent; border: none; }}"
        )
        sign = QLabel(self)
        sign.setPixmap(icon_pixmap("circle-alert", error, self._line, self.devicePixelRatioF()))
        self.words = plain_label(parent=self)
        at_top = (sign, 0, Qt.AlignmentFlag.AlignTop)
        in_row(at_top, (self.words, 1), of=self, margins=self._line // 3)
        self.hide()

    @property
    def text(self) -> str:
        """The sentence that is shown, or nothing."""
        return self.words.text() if not self.isHidden() else ""

    def tell(self, words: Words | None) -> None:
        """Show a sentence; an empty one takes the bubble away."""
        reason = labelled(self.words, text=words or "").text()
        labelled(self, name=words or "")
        self.setVisible(bool(reason))
        if reason:
            widest = 16 * self._line
            needed = self.words.fontMetrics().horizontalAdvance(reason) + self._line
            self.words.setMinimumWidth(min(widest, needed))
            self.words.setMinimumHeight(self.words.heightForWidth(min(widest, needed)))
            self.adjustSize()


# Where the editor of a field goes: over the field, and a popup below it or above it.

SMALLEST_EDITOR_SCALE = 0.75
"""Zoomed out further, an editor is larger than its field: what is typed must be readable."""


def piece_of(canvas: CanvasHost, block: str, key: str) -> tuple[Placed, Piece] | None:
    """A block on the page and the piece that shows one of its fields, or None."""
    placed = canvas.page_layout.placed(block)
    if placed is None:
        return None
    fields = (p for p in placed.box.pieces if p.piece == "field" and p.key == key)
    piece = next(fields, None)
    return (placed, piece) if piece is not None else None


def page_rect_of(canvas: CanvasHost, block: str, key: str) -> Rect | None:
    """Where a field is on the page, or None when it cannot be seen there."""
    found = piece_of(canvas, block, key)
    if found is None:
        return None
    placed, piece = found
    return Rect(placed.x + piece.x, placed.y + piece.y, piece.width, piece.height)


def view_rect_of(canvas: CanvasHost, block: str, key: str) -> QRectF | None:
    """Where a field is in the viewport, or None."""
    rect = page_rect_of(canvas, block, key)
    return canvas.sight.camera.view_rect(rect) if rect is not None else None


def editor_scale(canvas: CanvasHost) -> float:
    """How large an editor is drawn."""
    return max(canvas.sight.camera.scale, SMALLEST_EDITOR_SCALE)


def editor_font(canvas: CanvasHost) -> QFont:
    """The font of the fields at the size in which an editor shows it."""
    font = QFont(canvas.look.block_font)
    font.setPointSizeF(font.pointSizeF() * editor_scale(canvas))
    return font


def beside(field: QRect, size: QSize, room: QRect, *, is_mirrored: bool, gap: int = 4) -> QPoint:
    """The corner of a popup of this size: below a field, above it where there is no room."""
    x = field.right() + 1 - size.width() if is_mirrored else field.left()
    y = field.bottom() + 1 + gap
    if y + size.height() > room.bottom():
        above = field.top() - gap - size.height()
        y = above if above >= room.top() else room.bottom() + 1 - size.height()
    x = min(x, room.right() + 1 - size.width())
    return QPoint(max(x, room.left()), max(y, room.top()))


# The style of the editors: that of their fields, in the colours of the theme.

_RADII = {"round": 11.0, "square": 4.0, "bracket": 4.0}


def line_style(canvas: CanvasHost, block: str, shape: str, *, is_wrong: bool) -> str:
    """The style of a line or a text that lies over a field of a block, in the field's colours."""
    theme, placed = canvas.look.theme, canvas.page_layout.placed(block)
    assert placed is not None  # an editor lies over what is seen
    colours = canvas.look.block_painter.look_of(placed.box)[0]
    scale = canvas.look.measures.unit * editor_scale(canvas)
    width = max(2, round(2.4 * scale))
    border = theme.colour("error" if is_wrong else "focus").name()
    return (
        "QLineEdit, QPlainTextEdit {"
        f" background: {colours.field.name()}; color: {colours.field_text.name()};"
        f" border: {width}px {'dashed' if is_wrong else 'solid'} {border};"
        f" border-radius: {round(_RADII.get(shape, 9.0) * scale)}px;"
        f" padding: 0 {round(2 * scale)}px; min-height: 0; margin: 0;"
        f" selection-background-color: {theme.colour('selection').name()};"
        f" selection-color: {theme.colour('selection_text').name()}; }}"
    )


def note_style(canvas: CanvasHost) -> str:
    """The style of the small text beside a number: what it comes to."""
    theme = canvas.look.theme
    return (
        f"QLabel {{ background: {theme.colour('tooltip').name()};"
        f" color: {theme.colour('tooltip_text').name()};"
        " padding: 2px 6px; border-radius: 4px; }"
    )

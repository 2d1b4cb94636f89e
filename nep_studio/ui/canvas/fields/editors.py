"""Opens the editor of a field over the canvas."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Protocol, cast

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QHelpEvent, QPixmap
from PySide6.QtWidgets import QToolTip, QWidget

from nep_studio.blocks.definitions import Slot
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.wrapping import add_part, move_part, remove_part, set_collapsed
from nep_studio.blocks.program import ROBOT_BLOCK, Project, split_slot
from nep_studio.ui.words import tr

from .angle import AnglePopup
from .choice import CHOSEN, ChoicePopup, GesturePopup
from .colour import ColourPopup
from .comments import Comments
from .field_edit import Editing, FieldEdit, ParameterEdit, RobotNameEdit, page_rect_of
from .line_editor import LineEditor, LinesEditor
from .naming import RobotPopup, VariablePopup
from .number import NUMBERS
from .popup import FieldPopup, FieldRing, give_back_focus
from .settings import SettingsPopup

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


# What the buttons inside blocks do: add and remove parts, unfold.

_BESIDE = 40.0
"""How far to the side of its block a part's blocks are put when the part goes."""


def add(canvas: CanvasHost, block: str, group: str) -> str:
    """Add a part at the end; gives the key of its first field, where there is one."""
    made: list[int] = []
    if not canvas.attempt(lambda: made.append(add_part(canvas.editor, block, group))):
        return ""
    canvas.news.announced.emit(tr("Added"))
    definition = canvas.editor.language.definitions[canvas.editor.project.blocks[block].type]
    keys = (
        f"{name}.{made[0]}"
        for name in definition.group_slots(group)
        if definition.slots[name].kind.typed
    )
    return next(keys, "")


def remove(canvas: CanvasHost, block: str, group: str, number: int) -> None:
    """Remove a part; blocks in it are put beside the block."""
    placed = canvas.page_layout.placed(block)
    side = _BESIDE * (-1 if canvas.look.measures.is_mirrored else 1)
    beside = None
    if placed is not None:
        edge = placed.x if canvas.look.measures.is_mirrored else placed.x + placed.box.width
        beside = (edge + side, placed.y)
    if canvas.attempt(lambda: remove_part(canvas.editor, block, group, number, beside)):
        canvas.news.announced.emit(tr("Removed"))


def move_part_of(canvas: CanvasHost, block: str, key: str, *, down: bool) -> str:
    """Move the part that a slot is in; gives the slot's key in its new place, or nothing."""
    name, number = split_slot(key)
    there = canvas.editor.project.blocks[block]
    definition = canvas.editor.language.definitions[there.type]
    group = definition.slots[name].group
    to = number + (1 if down else -1)
    if not group or not 1 <= to <= there.groups.get(group, 0):
        return ""
    if not canvas.attempt(lambda: move_part(canvas.editor, block, group, number, to)):
        return ""
    canvas.news.announced.emit(tr("Moved to place {n}", n=to))
    return f"{name}.{to}"


# What a field is called: for the screen reader, and as the tool tip of its place.


def slot_name(slot: Slot) -> str:
    """The name of a slot as words."""
    return slot.label or slot.name.replace("_", " ")


def title_of(slot: Slot) -> str:
    """A field by its name and kind, such as "seconds: a time in seconds"."""
    return tr("{name}: {kind}", name=tr(slot_name(slot)), kind=tr(slot.kind.noun))


def hint_of(slot: Slot) -> str:
    """What goes into a place, for the tool tip over it."""
    if slot.kind.name == "parameter":
        return tr("{name}. Drag it out to use it, press it to rename it.", name=slot.label)
    if slot.low is not None and slot.high is not None:
        ends = {"low": f"{slot.low:g}", "high": f"{slot.high:g}"}
        return tr("{title} from {low} to {high}", title=title_of(slot), **ends)
    if not slot.kind.typed:
        return tr("{title}. Put a block here.", title=title_of(slot))
    return title_of(slot)


# The order in which the fields of a stack follow each other: as they are read.

Place = tuple[str, str]
"""A block and the key of one of its fields."""


def fields_within(project: Project, language: Language, root: str) -> Iterator[Place]:
    """The fields of a block and of those inside it that can be seen and edited."""
    waiting: list[Place] = [(root, "")]
    while waiting:
        block_id, key = waiting.pop()
        if key:
            yield block_id, key
            continue
        block = project.blocks[block_id]
        definition = language.definitions.get(block.type)
        if block.collapsed or definition is None:
            continue
        found: list[Place] = []
        for slot_key, slot in definition.keys(block.groups):
            if slot_key in block.inputs:
                found.append((block.inputs[slot_key], ""))
            elif slot.kind.name == "body":
                found += [(child, "") for child in block.bodies.get(slot_key, ())]
            elif slot.kind.typed and not slot.kind.is_pressed:
                found.append((block_id, slot_key))
        waiting += reversed(found)


def field_after(
    project: Project, language: Language, place: Place, *, forward: bool
) -> Place | None:
    """The field that follows (or comes before) another in its stack, or None at the end."""
    top = place[0]
    while (parent := project.parents[top]).owner in project.blocks:
        top = parent.owner
    body = project.stacks[parent.owner].body
    at = body.index(top)
    near = list(fields_within(project, language, top))
    index = near.index(place) if place in near else -1 if forward else len(near)
    index += 1 if forward else -1
    if 0 <= index < len(near):
        return near[index]
    for root in body[at + 1 :] if forward else reversed(body[:at]):
        fields = list(fields_within(project, language, root))
        if fields:
            return fields[0 if forward else -1]
    return None


class OpenEditor(Protocol):
    """A widget that edits one field."""

    edit: Editing

    def show_editor(self) -> None:
        """Begin to edit."""

    def follow(self) -> None:
        """Stay at the field when the view moves or the block changes."""

    def dispose(self) -> None:
        """Go away; the value is kept or restored by others."""


EDITORS: dict[str, type] = {
    "lines": LinesEditor,
    **CHOSEN,
    "robot": RobotPopup,
    "variable": VariablePopup,
    "colour": ColourPopup,
    "angle": AnglePopup,
    **NUMBERS,
    "settings": SettingsPopup,
}
"""The editors of the kinds of slot; the others are typed in a line."""

MOST_RECENT_COLOURS = 6


PictureOf = Callable[[str, str, str, int], QPixmap | None]
"""Draws a choice: its table, its value, the block that it is of, and how large in pixels."""


class FieldEditors(QObject):
    """The editors of one canvas; one at most is open."""

    def __init__(self, canvas: CanvasHost) -> None:
        super().__init__(canvas.area)
        self.canvas = canvas
        self.recent_colours: list[str] = []
        self.picture_of: PictureOf = lambda table, value, block, side: None
        self.comments = Comments(canvas)
        self.widget: OpenEditor | None = None
        """The editor that is open."""
        self._left_comment = ""
        """The block whose comment the press has closed: its button does not open it again."""
        self._ring = FieldRing(self)
        canvas.news.page_changed.connect(self.close)

    @property
    def place(self) -> Place | None:
        """The block and field that are edited now."""
        return (self.widget.edit.block, self.widget.edit.key) if self.widget is not None else None

    def open(self, block: str, key: str, *, at_pointer: bool = False) -> bool:
        """Edit the field ``key`` of a block; False when it has no editor.

        One that was pressed is seen: the page stays as it is under the pointer.
        """
        self.close()
        edit = self.edit_of(block, key)
        if edit is None:
            return False
        if edit.slot.kind.is_pressed:
            edit.set(not edit.value)
            edit.end()
            self.canvas.news.announced.emit(tr("on") if edit.value else tr("off"))
            return True
        rect = page_rect_of(self.canvas, block, key)
        if rect is None:
            return False
        if not at_pointer:
            self.canvas.sight.show_rect(rect)
        self.widget = self._new(edit)
        self._listen(is_open=True)
        self.widget.show_editor()
        self.canvas.layers.update_page(rect.grown(4.0))
        return True

    def edit_of(self, block: str, key: str) -> Editing | None:
        """The editing of a field, or None where nothing can be edited."""
        editor = self.canvas.editor
        there = editor.project.blocks.get(block)
        definition = editor.language.definitions.get(there.type) if there is not None else None
        if there is None or definition is None or key in there.inputs:
            return None
        slot = definition.slot(key, there.groups)
        if slot is None:
            return None
        if slot.kind.name == "parameter":
            return ParameterEdit(editor, block, key, slot, self.canvas.attempt)
        if there.type == ROBOT_BLOCK and key == "name":
            return RobotNameEdit(editor, block, key, slot, self.canvas.attempt)
        return FieldEdit(editor, block, key, slot) if slot.kind.typed else None

    def open_comment(self, block: str) -> None:
        """Show the comment of a block, to read and to write."""
        self.comments.open(block)

    def press_button(self, block: str, action: str, group: str, number: int) -> None:
        """Do what a button inside a block says: add, remove, expand, comment."""
        self.close()
        if action == "add":
            add(self.canvas, block, group)
        elif action == "remove":
            remove(self.canvas, block, group, number)
        elif action == "expand":
            self.canvas.attempt(lambda: set_collapsed(self.canvas.editor, [block], False))
        elif action == "comment" and self._left_comment != block:
            self.comments.open(block)

    def close(self) -> None:
        """Keep what was typed, and take the editor away."""
        self._end(restore=False)

    def close_if(self, widget: OpenEditor) -> None:
        """Keep what was typed in an editor that lost the keyboard, if it is still the open one."""
        if widget is self.widget:
            self.close()

    def leave(self, widget: OpenEditor, reason: Qt.FocusReason) -> None:
        """The keyboard has left an editor: what was typed is kept.

        A press on the canvas takes the keyboard before it is told what was pressed, and closes the
        editor itself then: nothing may move under the pointer in between.
        """
        if reason == Qt.FocusReason.MouseFocusReason and self.canvas.area.hasFocus():
            QTimer.singleShot(0, self, lambda: self.close_if(widget))
        else:
            self.close_if(widget)

    def cancel(self) -> None:
        """Make the field as it was, and take the editor away."""
        self._end(restore=True)

    def go(self, *, forward: bool) -> None:
        """Keep what was typed, and edit the next field, or the one before."""
        place = self.place
        if place is None:
            return
        self.close()
        editor = self.canvas.editor
        while place is not None:
            place = field_after(editor.project, editor.language, place, forward=forward)
            if place is not None and self.open(*place):
                self.canvas.selection.set([place[0]], place[0])
                return

    def move_item(self, down: bool) -> None:
        """Move the part of the block in which the edited field is, and edit it there."""
        place = self.place
        if place is None:
            return
        self.close()
        key = move_part_of(self.canvas, *place, down=down)
        self.open(place[0], key or place[1])

    def use_words(self) -> None:
        """Tell in other words what is edited; what is typed in a line stays as it is."""
        if self.widget is None:
            return
        edit, editor = self.widget.edit, self.canvas.editor
        if isinstance(self.widget, FieldPopup):
            self.open(edit.block, edit.key)
            return
        block = editor.project.blocks[edit.block]
        slot = editor.language.definitions[block.type].slot(edit.key, block.groups)
        cast(QWidget, self.widget).setAccessibleName(title_of(slot or edit.slot))

    def take(self, event: QEvent) -> bool:
        """A press on the canvas ends a comment; resting over a field tells what it takes."""
        if event.type() == QEvent.Type.MouseButtonPress:
            bubble = self.comments.bubble
            self._left_comment = bubble.block if bubble is not None else ""
            self.comments.close()
        elif event.type() == QEvent.Type.ToolTip:
            return self._tell_tip(cast(QHelpEvent, event))
        elif event.type() == QEvent.Type.Hide:  # what is open would outlive the canvas
            self.close()
            self.comments.close()
        elif event.type() == QEvent.Type.Resize:
            self._follow()
        return False

    def _new(self, edit: Editing) -> OpenEditor:
        made, title = EDITORS.get(edit.slot.kind.name, LineEditor), title_of(edit.slot)
        language, block = self.canvas.editor.language, self.canvas.editor.project.blocks[edit.block]
        is_chosen_only = made in (ChoicePopup, GesturePopup)
        if is_chosen_only and not language.choices_of(edit.slot, block, edit.key):
            made = LineEditor
        return cast(OpenEditor, made(self, edit, title))

    def _listen(self, *, is_open: bool) -> None:
        """Follow the field while an editor is open, and show which one it is."""
        self.canvas.layers.show_overlay(self._ring, is_shown=is_open)
        for signal in (self.canvas.news.view_changed, self.canvas.news.layout_changed):
            if is_open:
                signal.connect(self._follow)
            else:
                signal.disconnect(self._follow)

    def _end(self, *, restore: bool) -> None:
        closing, self.widget = self.widget, None
        if closing is None:
            return
        self._listen(is_open=False)
        if restore:
            closing.edit.restore()
        self.canvas.attempt(closing.edit.end)
        if not restore and closing.edit.slot.kind.name == "colour":
            colour = str(closing.edit.value)
            recent = [c for c in self.recent_colours if c != colour]
            self.recent_colours = [colour, *recent][:MOST_RECENT_COLOURS]
        give_back_focus(self.canvas.area, cast(QWidget, closing))
        closing.dispose()
        rect = page_rect_of(self.canvas, closing.edit.block, closing.edit.key)
        if rect is not None:
            self.canvas.layers.update_page(rect.grown(4.0))

    def _follow(self) -> None:
        if self.widget is None:
            return
        edit = self.widget.edit
        if page_rect_of(self.canvas, edit.block, edit.key) is None:
            self.close()
        else:
            self.widget.follow()

    def _tell_tip(self, event: QHelpEvent) -> bool:
        hit = self.canvas.sight.hit(event.pos())
        editor = self.canvas.editor
        block = editor.project.blocks.get(hit.block) if hit is not None else None
        definition = editor.language.definitions.get(block.type) if block is not None else None
        if hit is None or hit.piece is None or block is None or definition is None:
            QToolTip.hideText()
            return False
        slot = definition.slot(hit.piece.key, block.groups)
        words = hint_of(slot) if slot is not None else _BUTTON_TIPS.get(hit.piece.kind, "")
        group = definition.groups.get(hit.piece.key) if hit.piece.kind == "add" else None
        told = tr(words) if words else ""
        if group is not None and group.in_words:
            told = tr("Add “{words}”", words=group.in_words)
        QToolTip.showText(event.globalPos(), told, self.canvas.area.viewport())
        return True


_BUTTON_TIPS = {
    "add": "Add a part",
    "remove": "Remove this part",
    "expand": "Show what is folded",
    "comment": "Show the comment",
}

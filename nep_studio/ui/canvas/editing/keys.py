"""What each key does on the canvas."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QKeyEvent

from nep_studio.blocks.program import Project
from nep_studio.ui.canvas.accessibility import described, position

from . import navigation
from .cargo import lift
from .carrying import KeyboardCarry, reading_order

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


# Walk from block to block with the keyboard; what is arrived at is selected, shown and told.

Direction = Callable[[Project, Sequence[str], str], str]
"""From a block to another one, given the stacks in the order of reading."""


class Walk:
    """The cursor of one canvas."""

    def __init__(self, canvas: CanvasHost) -> None:
        self._canvas = canvas
        self._anchor = ""

    def cursor(self) -> str:
        """The block that the keyboard is at, when the page shows it."""
        canvas = self._canvas
        cursor = canvas.selection.cursor
        if cursor in canvas.editor.project.blocks and canvas.page_layout.placed(cursor):
            return cursor
        return ""

    def _first(self) -> str:
        stacks = reading_order(self._canvas)
        return self._canvas.editor.project.stacks[stacks[0]].body[0] if stacks else ""

    def go(self, way: Direction) -> None:
        """Go one block further."""
        cursor, project = self.cursor(), self._canvas.editor.project
        if not cursor:
            self._arrive(self._first())
        else:
            self._arrive(way(project, reading_order(self._canvas), cursor))

    def sideways(self, step: int) -> None:
        """Go into the block (1, to the right) or out of it; the other way round when mirrored."""
        is_inward = (step > 0) != self._canvas.look.measures.is_mirrored
        way = navigation.inward if is_inward else navigation.outward
        cursor = self.cursor()
        self._arrive(way(self._canvas.editor.project, cursor) if cursor else self._first())

    def go_to_end(self, index: int) -> None:
        """Go to the first (0) or the last (-1) block of the stack."""
        cursor = self.cursor()
        if cursor:
            self._arrive(self._canvas.editor.project.stack_of(cursor).body[index])

    def go_to_stack(self, index: int) -> None:
        """Go to the first (0) or the last (-1) stack of the page."""
        stacks = reading_order(self._canvas)
        if stacks:
            self._arrive(self._canvas.editor.project.stacks[stacks[index]].body[0])

    def extend(self, way: Direction) -> None:
        """Stretch the selection from where it began to the next block."""
        canvas, cursor = self._canvas, self.cursor()
        if not cursor:
            return
        if len(canvas.selection.ids) <= 1 or self._anchor not in canvas.selection:
            self._anchor = navigation.statement_of(canvas.editor.project, cursor)
        stacks = reading_order(canvas)
        target = way(canvas.editor.project, stacks, cursor)
        blocks = navigation.between(canvas.editor.project, stacks, self._anchor, target)
        canvas.selection.set(blocks, target)
        canvas.show_block(target)

    def _arrive(self, block_id: str) -> None:
        canvas = self._canvas
        if not block_id:
            return
        canvas.selection.set([block_id])
        canvas.show_block(block_id)
        told = described(canvas.editor, block_id)
        canvas.news.announced.emit(f"{told}. {position(canvas.editor.project, block_id)}")


Key, Modifier = Qt.Key, Qt.KeyboardModifier
Press = tuple[Qt.Key, bool, bool, bool]
"""A key with Shift, Control and Alt, or without."""

Rule = Callable[[], object]


_PLAIN, _CONTROL = (False, False, False), (False, True, False)
_CARRYING_RULES: dict[Press, Callable[[KeyboardCarry, CanvasHost], None]] = {
    (Key.Key_Down, *_PLAIN): lambda carry, canvas: carry.step(canvas, 1),
    (Key.Key_Right, *_PLAIN): lambda carry, canvas: carry.step(canvas, 1),
    (Key.Key_Up, *_PLAIN): lambda carry, canvas: carry.step(canvas, -1),
    (Key.Key_Left, *_PLAIN): lambda carry, canvas: carry.step(canvas, -1),
    (Key.Key_Down, *_CONTROL): lambda carry, canvas: carry.shift(canvas, 0, 1),
    (Key.Key_Up, *_CONTROL): lambda carry, canvas: carry.shift(canvas, 0, -1),
    (Key.Key_Right, *_CONTROL): lambda carry, canvas: carry.shift(canvas, 1, 0),
    (Key.Key_Left, *_CONTROL): lambda carry, canvas: carry.shift(canvas, -1, 0),
    (Key.Key_Return, *_PLAIN): KeyboardCarry.drop,
    (Key.Key_Enter, *_PLAIN): KeyboardCarry.drop,
    (Key.Key_Space, *_PLAIN): KeyboardCarry.drop,
    (Key.Key_Escape, *_PLAIN): KeyboardCarry.cancel,
}


class Keyboard:
    """The keyboard of one canvas.

    Arrow keys go from block to block, Space picks one up, Enter edits. While blocks are carried
    the same keys go from place to place.
    """

    def __init__(self, canvas: CanvasHost) -> None:
        self._canvas = canvas
        self.walk = Walk(canvas)
        self.is_space_pressed = False
        """Whether the space bar is down and has only been pressed: the mouse pans with it too."""
        self.type_letter: Callable[[str], None] = lambda letter: None
        self._rules = self._resting_rules()

    def press(self, event: QKeyEvent) -> bool:
        """Do what a key means; False when it means nothing here."""
        if event.isAutoRepeat() and event.key() == Key.Key_Space:
            return True  # held down, it would pick up and put down in turns
        held = event.modifiers()
        press = (
            Key(event.key()),
            bool(held & Modifier.ShiftModifier),
            bool(held & Modifier.ControlModifier),
            bool(held & Modifier.AltModifier),
        )
        if isinstance(carry := self._canvas.pointing.gesture, KeyboardCarry):
            if press in _CARRYING_RULES:
                _CARRYING_RULES[press](carry, self._canvas)
            return True
        rule = self._rules.get(press)
        if rule == self._escape and self._is_at_rest:
            return False  # it may close what lies over the canvas
        if rule is not None:
            rule()
            return True
        # A letter begins a new block by its name
        held = event.modifiers() & ~(Modifier.ShiftModifier | Modifier.KeypadModifier)
        text = event.text()
        if held or not text or not text.isprintable() or text.isspace():
            return False
        self.type_letter("" if text == "/" else text)
        return True

    def pick_up(self, *, alone: bool = False) -> None:
        """Take the block at the cursor, or the selection, into the hand."""
        canvas = self._canvas
        cursor = canvas.selection.cursor
        if cursor in canvas.editor.project.blocks and canvas.pointing.gesture is None:
            canvas.pointing.gesture = KeyboardCarry(
                canvas, lift(canvas, cursor, alone=alone), cursor
            )

    def release_space(self) -> None:
        """Pick up, unless something else was done while the space bar was down."""
        if self.is_space_pressed:
            self.is_space_pressed = False
            self.pick_up()

    def _press_space(self) -> None:
        self.is_space_pressed = True

    def _resting_rules(self) -> dict[Press, Rule]:
        canvas, plain = self._canvas, _PLAIN
        walk = self.walk
        return {
            (Key.Key_Down, *plain): lambda: walk.go(navigation.below),
            (Key.Key_Up, *plain): lambda: walk.go(navigation.above),
            (Key.Key_Down, True, False, False): lambda: walk.extend(navigation.below),
            (Key.Key_Up, True, False, False): lambda: walk.extend(navigation.above),
            (Key.Key_Right, *plain): lambda: walk.sideways(1),
            (Key.Key_Left, *plain): lambda: walk.sideways(-1),
            (Key.Key_PageDown, *plain): lambda: walk.go(navigation.next_stack),
            (Key.Key_PageUp, *plain): lambda: walk.go(navigation.previous_stack),
            (Key.Key_Home, *plain): lambda: walk.go_to_end(0),
            (Key.Key_End, *plain): lambda: walk.go_to_end(-1),
            (Key.Key_Home, False, True, False): lambda: walk.go_to_stack(0),
            (Key.Key_End, False, True, False): lambda: walk.go_to_stack(-1),
            (Key.Key_Space, *plain): self._press_space,
            (Key.Key_Space, True, True, False): lambda: self.pick_up(alone=True),
            (Key.Key_Space, True, False, False): self._toggle,
            (Key.Key_Return, *plain): self._edit,
            (Key.Key_Enter, *plain): self._edit,
            (Key.Key_F2, *plain): self._edit,
            (Key.Key_F1, *plain): self._help,
            (Key.Key_Delete, *plain): canvas.commands.delete,
            (Key.Key_Backspace, *plain): canvas.commands.delete,
            (Key.Key_A, False, True, False): canvas.commands.select_all,
            (Key.Key_A, True, True, False): canvas.commands.select_stack,
            (Key.Key_D, False, True, False): canvas.commands.duplicate,
            (Key.Key_C, False, True, False): canvas.commands.copy,
            (Key.Key_X, False, True, False): canvas.commands.cut,
            (Key.Key_V, False, True, False): canvas.commands.paste,
            (Key.Key_Z, False, True, False): canvas.commands.undo,
            (Key.Key_Z, True, True, False): canvas.commands.redo,
            (Key.Key_Y, False, True, False): canvas.commands.redo,
            (Key.Key_E, False, True, False): lambda: canvas.commands.toggle("disabled"),
            (Key.Key_M, False, True, False): lambda: canvas.commands.toggle("collapsed"),
            (Key.Key_Menu, *plain): self._menu,
            (Key.Key_F10, True, False, False): self._menu,
            (Key.Key_Escape, *plain): self._escape,
        }

    def _edit(self) -> None:
        """Edit the first field of the block; unfold it when it is folded."""
        canvas, cursor = self._canvas, self.walk.cursor()
        placed = canvas.page_layout.placed(cursor) if cursor else None
        if placed is None:
            return
        if placed.box.is_collapsed:
            canvas.commands.toggle("collapsed")
            return
        field = next((piece for piece in placed.box.pieces if piece.piece == "field"), None)
        if field is not None:
            canvas.fields.open(cursor, field.key)
        else:
            canvas.news.block_opened.emit(cursor)

    def _help(self) -> None:
        """Ask for help about the block that the keyboard is at, when it is selected."""
        editor, cursor = self._canvas.editor, self._canvas.selection.cursor
        if cursor in self._canvas.selection and cursor in editor.project.blocks:
            definition = editor.language.definitions.get(editor.project.blocks[cursor].type)
            self._canvas.news.help_requested.emit(definition.help if definition else "")

    def _toggle(self) -> None:
        if cursor := self.walk.cursor():
            self._canvas.selection.toggle(cursor)

    def _menu(self) -> None:
        cursor = self.walk.cursor()
        rect = self._canvas.sight.view_rect_of(cursor) if cursor else None
        at = rect.topLeft().toPoint() + QPoint(12, 12) if rect is not None else QPoint(24, 24)
        self._canvas.news.menu_requested.emit(at)

    @property
    def _is_at_rest(self) -> bool:
        selection = self._canvas.selection
        return self._canvas.pointing.gesture is None and not (selection.ids or selection.cursor)

    def _escape(self) -> None:
        if self._canvas.pointing.gesture is not None:
            self._canvas.pointing.cancel()
        else:
            self._canvas.selection.clear()

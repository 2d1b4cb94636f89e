"""The canvas for those who do not see it: what each block is, where it is, what has happened."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject, QPoint, QRect
from PySide6.QtGui import (
    QAccessible,
    QAccessibleAnnouncementEvent,
    QAccessibleEvent,
    QAccessibleInterface,
    QWindow,
)
from PySide6.QtWidgets import QWidget

from nep_studio.blocks.code_text import hides_python
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from .host import CanvasHost

# A block in the words that a screen reader says.


def described(editor: Editor, block_id: str, problem: str = "") -> str:
    """A block's sentence, and what its looks say: "repeat 10 times, contains 3 blocks"."""
    project = editor.project
    block = project.blocks[block_id]
    parts = [sentence(project, editor.language, block_id)]
    if block.bodies:
        inside = sum(1 for chain in block.bodies.values() for _ in project.within(chain))
        parts.append(count_words(inside, "contains 1 block", "contains {n} blocks"))
    if block.collapsed:
        parts.append(tr("folded"))
        if hides_python(project, editor.language.definitions, block):
            parts.append(tr("Python inside"))
    if block.disabled:
        parts.append(tr("switched off"))
    if block.comment:
        parts.append(tr("comment: {comment}", comment=block.comment))
    if problem:
        parts.append(tr("problem: {problem}", problem=problem))
    return ", ".join(parts)


def position(project: Project, block_id: str) -> str:
    """Where a block is: "2 of 5", or "in a slot"."""
    chain = project.chain_of(project.parents[block_id])
    if chain is None or block_id not in chain:
        return tr("in a slot")
    return tr("{number} of {count}", number=chain.index(block_id) + 1, count=len(chain))


def level(project: Project, block_id: str) -> int:
    """How deep a block is: 1 for a block of a stack."""
    depth, owner = 0, block_id
    while owner in project.parents:
        owner, depth = project.parents[owner].owner, depth + 1
    return depth


# The canvas and its blocks as Qt's accessible interfaces, which screen readers ask.
#
# Qt takes "nothing" from several of these methods; the stubs of PySide6 do not say so, hence the
# ``type: ignore[override]``.


class PaintedInterface(QAccessibleInterface):
    """A widget that paints its items itself, in its ``face``: the widget, or its viewport."""

    def __init__(self, widget: QWidget, face: QWidget) -> None:
        super().__init__()
        self.widget, self._face = widget, face

    def isValid(self) -> bool:
        """Whether the widget is still there."""
        return True

    def object(self) -> QObject:
        """The widget."""
        return self.widget

    def window(self) -> QWindow:
        """The window it is in."""
        return self.widget.window().windowHandle()

    def setText(self, kind: QAccessible.Text, text: str) -> None:
        """A screen reader cannot rename it."""

    def rect(self) -> QRect:
        """Where it is on the screen."""
        return QRect(self._face.mapToGlobal(QPoint(0, 0)), self._face.size())

    def state(self) -> QAccessible.State:
        """Whether it has the keyboard."""
        state = QAccessible.State()
        state.focusable = True
        state.focused = self.widget.hasFocus()
        return state

    def parent(self) -> QAccessibleInterface | None:  # type: ignore[override]
        """The widget around it."""
        outer = self.widget.parentWidget()
        return QAccessible.queryAccessibleInterface(outer) if outer is not None else None


class ItemInterface(QAccessibleInterface):
    """An item that a widget paints; nothing is inside it, if it does not say otherwise."""

    def __init__(self, outer: PaintedInterface) -> None:
        super().__init__()
        self._outer = outer

    def object(self) -> QObject | None:  # type: ignore[override]
        """An item is no object of Qt."""
        return None

    def window(self) -> QWindow:
        """The window it is in."""
        return self._outer.window()

    def setText(self, kind: QAccessible.Text, text: str) -> None:
        """A screen reader cannot rename it."""

    def parent(self) -> QAccessibleInterface:
        """The widget that paints it."""
        return self._outer

    def childCount(self) -> int:
        """How many items are directly inside it."""
        return 0

    def child(self, index: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """One of them."""
        return None

    def indexOfChild(self, child: QAccessibleInterface) -> int:
        """The number of an item among those inside it."""
        return -1

    def childAt(self, x: int, y: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """What is inside it at a place of the screen."""
        return None


class CanvasInterface(PaintedInterface):
    """The canvas: a tree whose items are the blocks of the stacks in view."""

    def __init__(self, view: CanvasHost) -> None:
        super().__init__(view.area, view.area.viewport())
        self.view = view
        self._blocks: dict[str, BlockInterface] = {}

    def block(self, block_id: str) -> BlockInterface:
        """The interface of a block, always the same one."""
        if block_id not in self._blocks:
            self._blocks[block_id] = BlockInterface(self, block_id)
        return self._blocks[block_id]

    def forget_gone(self) -> None:
        """Drop the interfaces of blocks that are not there any more."""
        self._forget([i for i in self._blocks if i not in self.view.editor.project.blocks])

    def forget_all(self) -> None:
        """Drop all of them: Qt keeps pointers to them, and would follow these when it ends."""
        self._forget(list(self._blocks))

    def _forget(self, block_ids: list[str]) -> None:
        for block_id in block_ids:
            gone = self._blocks.pop(block_id)
            QAccessible.deleteAccessibleInterface(QAccessible.uniqueId(gone))

    def shown(self) -> list[str]:
        """The blocks of the stacks in view, from top to bottom."""
        layout = self.view.page_layout
        stacks = layout.near(self.view.sight.visible_page_rect())
        return [box.block for stack in stacks for box in layout.chains[stack].boxes if box.block]

    def role(self) -> QAccessible.Role:
        """A tree."""
        return QAccessible.Role.Tree

    def text(self, kind: QAccessible.Text) -> str:
        """Its name, and how to use it."""
        if kind == QAccessible.Text.Name:
            return self.view.area.accessibleName() or tr("Blocks")
        if kind == QAccessible.Text.Description:
            return tr("Use the arrow keys to go from block to block, and Enter to edit.")
        return ""

    def childCount(self) -> int:
        """How many blocks it has in view."""
        return len(self.shown())

    def child(self, index: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """One of them."""
        shown = self.shown()
        return self.block(shown[index]) if 0 <= index < len(shown) else None

    def indexOfChild(self, child: QAccessibleInterface) -> int:
        """The number of a block among those in view."""
        shown = self.shown()
        block_id = child.block_id if isinstance(child, BlockInterface) else ""
        return shown.index(block_id) if block_id in shown else -1

    def childAt(self, x: int, y: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """The block at a place of the screen."""
        hit = self.view.sight.hit(self.view.area.viewport().mapFromGlobal(QPoint(x, y)))
        return self.block(hit.block) if hit is not None else None

    def focusChild(self) -> QAccessibleInterface | None:  # type: ignore[override]
        """The block that the keyboard is at."""
        cursor = self.view.selection.cursor
        return self.block(cursor) if cursor in self.view.editor.project.blocks else None


class BlockInterface(ItemInterface):
    """One block: an item whose children are the blocks directly inside it."""

    def __init__(self, canvas: CanvasInterface, block_id: str) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self.block_id = block_id

    def isValid(self) -> bool:
        """Whether the block is still there."""
        return self.block_id in self._canvas.view.editor.project.blocks

    def role(self) -> QAccessible.Role:
        """An item of a tree."""
        return QAccessible.Role.TreeItem

    def text(self, kind: QAccessible.Text) -> str:
        """Its sentence with what is inside it; where it is."""
        view = self._canvas.view
        if not self.isValid():
            return ""
        if kind == QAccessible.Text.Name:
            problem = view.problems.problems.get(self.block_id)
            told = tr(problem.sentence) if problem is not None else ""
            return described(view.editor, self.block_id, told)
        if kind == QAccessible.Text.Description:
            project = view.editor.project
            depth = level(project, self.block_id)
            where = position(project, self.block_id)
            return tr("{position}, level {depth}", position=where, depth=depth)
        return ""

    def rect(self) -> QRect:
        """Where it is on the screen; nowhere when it is folded away."""
        view = self._canvas.view
        rect = view.sight.view_rect_of(self.block_id)
        if rect is None:
            return QRect()
        corner = view.area.viewport().mapToGlobal(rect.topLeft().toPoint())
        return QRect(corner, rect.size().toSize())

    def state(self) -> QAccessible.State:
        """Selected, at the keyboard, folded, switched off, out of view."""
        view = self._canvas.view
        state = QAccessible.State()
        block = view.editor.project.blocks.get(self.block_id)
        if block is None:
            state.invalid = True
            return state
        state.focusable = state.selectable = state.multiSelectable = True
        state.selected = self.block_id in view.selection
        state.focused = view.area.hasFocus() and view.selection.cursor == self.block_id
        state.expandable = bool(block.bodies)
        state.collapsed = block.collapsed
        state.expanded = bool(block.bodies) and not block.collapsed
        state.disabled = block.disabled
        rect = self.rect()
        state.invisible = rect.isEmpty()
        state.offscreen = not rect.intersects(self._canvas.rect())
        return state

    def parent(self) -> QAccessibleInterface:
        """The block around it, or the canvas."""
        project = self._canvas.view.editor.project
        parent = project.parents.get(self.block_id)
        if parent is not None and parent.owner in project.blocks:
            return self._canvas.block(parent.owner)
        return self._canvas

    def childCount(self) -> int:
        """How many blocks are directly inside it."""
        return len(self._children())

    def child(self, index: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """One of them."""
        children = self._children()
        return self._canvas.block(children[index]) if 0 <= index < len(children) else None

    def indexOfChild(self, child: QAccessibleInterface) -> int:
        """The number of a block among those inside it."""
        children = self._children()
        block_id = child.block_id if isinstance(child, BlockInterface) else ""
        return children.index(block_id) if block_id in children else -1

    def childAt(self, x: int, y: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """The block at a place of the screen, when it is inside this one."""
        found = self._canvas.childAt(x, y)
        return found if found is not self else None

    def _children(self) -> list[str]:
        block = self._canvas.view.editor.project.blocks.get(self.block_id)
        return list(block.children()) if block is not None and not block.collapsed else []


def focus_event(canvas: CanvasInterface) -> QAccessibleEvent | None:
    """What tells a screen reader that the keyboard is at another block."""
    focused = canvas.focusChild()
    return QAccessibleEvent(focused, QAccessible.Event.Focus) if focused is not None else None


# Give every canvas its accessible interface, and tell screen readers what happens on it.

_is_installed = False


def interface_of(view: CanvasHost) -> CanvasInterface:
    """The interface of a canvas, always the same one."""
    if not isinstance(view.accessible, CanvasInterface):
        made = CanvasInterface(view)
        view.accessible = made  # Qt holds it by pointer only: Python must keep it
        view.news.layout_changed.connect(made.forget_gone)
        view.area.destroyed.connect(lambda: made.forget_all())
    return view.accessible


def make_accessible(view: CanvasHost) -> None:
    """Let screen readers find the blocks of a canvas, and hear where the keyboard is."""
    global _is_installed
    if not _is_installed:
        QAccessible.installFactory(_factory)
        _is_installed = True
    view.selection.changed.connect(partial(_tell_focus, view))


def announce(view: CanvasHost, text: str) -> None:
    """Let a screen reader say something that has happened."""
    if QAccessible.isActive():
        QAccessible.updateAccessibility(QAccessibleAnnouncementEvent(view.area, text))


def _factory(class_name: str, item: QObject | None) -> QAccessibleInterface | None:
    return interface_of(cast("CanvasHost", item)) if class_name == "Canvas" else None


def _tell_focus(view: CanvasHost) -> None:
    if not QAccessible.isActive():
        return
    event = focus_event(interface_of(view))
    if event is not None:
        QAccessible.updateAccessibility(event)

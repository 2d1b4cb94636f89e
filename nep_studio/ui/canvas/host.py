"""What gestures, keyboard, field editors, overlays and screen readers may see of a canvas.

Everything inside this room takes a `CanvasHost`, or something smaller of it, such as its
`Selection`; only the window makes a `Canvas` and knows the widget.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QObject, QPoint, QPointF, Signal
from PySide6.QtWidgets import QAbstractScrollArea

from nep_studio.blocks.editor import Editor

from .layout.page import PageLayout
from .painting.painter import Look
from .selection import Selection

if TYPE_CHECKING:
    from .editing.commands import Commands
    from .editing.gesture import Gesture
    from .editing.marks import DragMarks
    from .painting.layers import Layers
    from .painting.notes import Notes
    from .painting.overlay import ProblemOverlay
    from .sight import Sight


class CanvasNews(QObject):
    """What happens on a canvas, for those around it.

    ``page_asked``: somebody wants to see a page, perhaps the one that is shown already;
    ``refused`` says in a sentence why something did not fit; ``announced`` is for screen readers;
    ``menu_requested`` gives a place in the viewport, ``page_double_clicked`` one of the page where
    no block is; ``blocks_deleted`` brings what was deleted,
    for the list of deleted blocks; ``delete_area_entered`` whether carried blocks are there now;
    ``uses_requested`` brings the Subject whose uses a person looks for, ``help_requested`` the
    name of a page of help.
    """

    page_asked = Signal()
    page_changed = Signal(str)
    resized = Signal()
    view_changed = Signal()
    layout_changed = Signal()
    refused = Signal(object)  # Words
    announced = Signal(str)
    menu_requested = Signal(QPoint)
    page_double_clicked = Signal(QPointF)
    problem_opened = Signal(str)
    block_opened = Signal(str)
    blocks_deleted = Signal(object)
    delete_area_entered = Signal(bool)
    uses_requested = Signal(object)
    help_requested = Signal(str)
    picture_requested = Signal()


class Fields(Protocol):
    """The editors of fields; one at most is open."""

    @property
    def place(self) -> tuple[str, str] | None:
        """The block and field that are edited now."""

    def open(self, block: str, key: str, *, at_pointer: bool = False) -> bool:
        """Edit a field, which may be one that was pressed; False when it has no editor."""

    def open_comment(self, block: str) -> None:
        """Show the comment of a block, to read and to write."""

    def press_button(self, block: str, action: str, group: str, number: int) -> None:
        """Do what a button inside a block says: add, remove, expand, comment."""

    def close(self) -> None:
        """Keep what was typed, and take the editor away."""


class Hand(Protocol):
    """The pointer over a canvas, and the gesture that is under way with it."""

    gesture: Gesture | None
    is_space_down: bool

    def begin(self, gesture: Gesture) -> None:
        """Let a gesture have the pointer from now on."""

    def cancel(self) -> None:
        """End what is under way as if it had not begun."""

    def take_over(self, view: QPointF) -> None:
        """Follow a pointer that was pressed elsewhere, such as in the palette."""

    def move_to(self, view: QPointF) -> None:
        """Bring the gesture to a point of the view."""

    def release_at(self, view: QPointF) -> None:
        """End the gesture at a point of the view."""

    def repeat(self) -> None:
        """Tell the gesture again where the pointer is: the page has moved under it."""

    def request_menu(self, place: QPoint) -> None:
        """Ask for the menu of what is at a place of the view; that becomes the selection."""


class CanvasHost(Protocol):
    """A page of blocks, as its helpers see it."""

    accessible: object
    """What screen readers see."""
    area: QAbstractScrollArea
    """The widget: for its viewport, its focus, and what is put over it."""
    editor: Editor
    """The program, and the one way to change it."""
    page_layout: PageLayout
    """What is where on the page that is shown."""
    look: Look
    """Theme, measures and fonts of the blocks."""
    selection: Selection
    """The selected blocks, and the one that the keyboard is at."""
    sight: Sight
    """Which part of the page is seen."""
    layers: Layers
    """What is painted: what rests, what lies over it, what is carried."""
    problems: ProblemOverlay
    """The blocks with a problem, each with its badge."""
    notes: Notes
    """The notes of the page."""
    marks: DragMarks
    """What is shown while blocks are carried."""
    commands: Commands
    """What menus and keys do with the selected blocks."""
    news: CanvasNews
    """Tells those around the canvas what has happened."""

    @property
    def fields(self) -> Fields:
        """The editors of fields."""

    @property
    def pointing(self) -> Hand:
        """The pointer, and the gesture under way."""

    def attempt(self, change: Callable[[], object]) -> bool:
        """Make a change; tell the person why not when the editor refuses it."""

    def show_block(self, block_id: str) -> None:
        """Scroll, and change the page, so that a block can be seen."""

"""What the tests of the canvas share: a canvas in a window, a mouse, and programs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QFont, QMouseEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.language import Language
from nep_studio.run.installation import load_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build

RESOURCES = Path(__file__).resolve().parents[3] / "resources"
LEFT = Qt.MouseButton.LeftButton
PLAIN = Qt.KeyboardModifier.NoModifier


@pytest.fixture(scope="session")
def language() -> Language:
    """The language of the product."""
    return load_language(RESOURCES / "blocks", RESOURCES / "robots/nao/robot.toml")


@dataclass
class Mouse:
    """A mouse over a canvas: its events reach the viewport as those of the system do."""

    canvas: Canvas
    held: Qt.MouseButton = Qt.MouseButton.NoButton
    modifiers: Qt.KeyboardModifier = PLAIN
    at: QPointF = field(default_factory=QPointF)

    def press(self, at: QPointF, button: Qt.MouseButton = LEFT, modifiers=PLAIN) -> None:
        self.held, self.modifiers, self.at = button, modifiers, at
        self._send(QEvent.Type.MouseButtonPress, button)

    def move(self, at: QPointF) -> None:
        self.at = at
        self._send(QEvent.Type.MouseMove, Qt.MouseButton.NoButton)

    def release(self) -> None:
        button, self.held = self.held, Qt.MouseButton.NoButton
        self._send(QEvent.Type.MouseButtonRelease, button)
        self.modifiers = PLAIN

    def click(self, at: QPointF, button: Qt.MouseButton = LEFT, modifiers=PLAIN) -> None:
        self.press(at, button, modifiers)
        self.release()

    def double_click(self, at: QPointF) -> None:
        self.click(at)
        self.held, self.at = LEFT, at
        self._send(QEvent.Type.MouseButtonDblClick, LEFT)
        self.release()

    def drag(self, start: QPointF, end: QPointF, modifiers=PLAIN, *, steps: int = 4) -> None:
        """Press, move in steps, and keep the button down."""
        self.press(start, LEFT, modifiers)
        for step in range(1, steps + 1):
            self.move(start + (end - start) * step / steps)

    def drop(self, start: QPointF, end: QPointF, modifiers=PLAIN) -> None:
        """Drag, and let go."""
        self.drag(start, end, modifiers)
        self.release()

    def _send(self, kind: QEvent.Type, button: Qt.MouseButton) -> None:
        viewport = self.canvas.viewport()
        place = QPointF(viewport.mapToGlobal(self.at.toPoint()))
        event = QMouseEvent(kind, self.at, place, button, self.held, self.modifiers)
        QApplication.sendEvent(viewport, event)


@dataclass
class Desk:
    """A canvas with its editor and its mouse, and where things are on it."""

    canvas: Canvas
    editor: Editor
    mouse: Mouse

    @property
    def file(self) -> bytes:
        """The program as it would be saved."""
        return to_bytes(self.editor.project)

    def body(self, number: int = 0) -> list[str]:
        """The blocks of a stack of the page."""
        return self.editor.project.pages[self.canvas.page][number].body

    def grip(self, block: str) -> QPointF:
        """A point of a block that is no field, in the view."""
        rect = self.canvas.sight.view_rect_of(block)
        assert rect is not None
        return rect.topLeft() + QPointF(5, 14)

    def corner(self, block: str) -> QPointF:
        """The upper left corner of a block in the view."""
        rect = self.canvas.sight.view_rect_of(block)
        assert rect is not None
        return rect.topLeft()

    def field(self, block: str, key: str) -> QPointF:
        """The middle of a field or a socket in the view."""
        placed = self.canvas.page_layout.placed(block)
        assert placed is not None
        piece = next(piece for piece in placed.box.pieces if piece.key == key)
        x = placed.x + piece.x + piece.width / 2
        return self.canvas.sight.camera.to_view(x, placed.y + piece.y + piece.height / 2)

    def carry(self, block: str, to: QPointF, modifiers=PLAIN) -> None:
        """Drag a block so that its upper left corner comes to a point of the view."""
        grip = self.grip(block)
        self.mouse.drag(grip, grip + to - self.corner(block), modifiers)

    def put(self, block: str, to: QPointF, modifiers=PLAIN) -> None:
        """Drag a block there and let go."""
        self.carry(block, to, modifiers)
        self.mouse.release()


@pytest.fixture
def show(qtbot: QtBot) -> Callable[..., Desk]:
    """Shows the program of an editor on a canvas in a window."""

    def shown(editor: Editor, *, is_mirrored: bool = False) -> Desk:
        font = QFont()
        font.setPointSizeF(11)
        canvas = Canvas(editor, load_theme("light"), font=font, is_mirrored=is_mirrored)
        qtbot.addWidget(canvas)
        canvas.resize(1000, 800)
        with qtbot.waitExposed(canvas):
            canvas.show()
        canvas.setFocus()
        if is_mirrored:
            canvas.sight.move_camera(-900, 0)
        return Desk(canvas, editor, Mouse(canvas))

    return shown


@pytest.fixture
def desk(show: Callable[..., Desk], language: Language) -> Callable[..., Desk]:
    """Makes a canvas that shows stacks of blocks."""

    def made(*stacks: list[B], is_mirrored: bool = False) -> Desk:
        return show(build(language, *stacks, variables=("times",)), is_mirrored=is_mirrored)

    return made

"""A person at the main window: hands on mouse, keyboard and screen, eyes on what is shown."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import (
    QAction,
    QContextMenuEvent,
    QInputMethodEvent,
    QPaintEvent,
    QPointingDevice,
    QWheelEvent,
)
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel, QMenu, QWidget
from pytestqt.qtbot import QtBot

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.program import Block, Project
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.workbench.palette.palette import Palette
from tests.blocks.block_building import B, build

LEFT, RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
PLAIN = Qt.KeyboardModifier.NoModifier
CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
ALT = Qt.KeyboardModifier.AltModifier
Key = Qt.Key


def say(text: str) -> B:
    """A robot that says something."""
    return B("robot.say", {"text": text})


def say_block(inside: B) -> B:
    """A robot that says what another block gives."""
    return B("robot.say", {}, {"text": inside})


def story() -> list[B]:
    """A stack of a hat and three sayings."""
    return [B("event.started"), say("one"), say("two"), say("three")]


class Person:
    """Works in one window; places are pixels of the canvas unless another widget is named."""

    def __init__(self, window: MainWindow, qtbot: QtBot) -> None:
        self.window, self.qtbot = window, qtbot

    # What there is

    @property
    def canvas(self) -> Canvas:
        return self.window.workbench.canvas

    @property
    def palette(self) -> Palette:
        return self.window.workbench.helpers.palette

    @property
    def editor(self) -> Editor:
        return self.window.files.document.editor

    @property
    def project(self) -> Project:
        return self.editor.project

    @property
    def file(self) -> bytes:
        """The program as it would be saved."""
        return to_bytes(self.project)

    def make(self, *stacks: list[B], page: str = "behaviour", **more) -> None:
        """Begin with these stacks, in view."""
        build(self.editor.language, *stacks, page=page, editor=self.editor, **more)
        self.look_at_corner()

    def look_at_corner(self) -> None:
        x = -20.0
        if self.canvas.look.measures.is_mirrored:
            x = 300 - self.canvas.viewport().width() / self.canvas.sight.camera.scale
        self.canvas.sight.move_camera(x, -20)

    def body(self, number: int = 0) -> list[str]:
        """The blocks of a stack of the page."""
        return self.project.pages[self.canvas.page][number].body

    def block(self, block_type: str, number: int = 0) -> Block:
        found = [each for each in self.project.blocks.values() if each.type == block_type]
        return found[number]

    def texts(self, number: int = 0) -> list[object]:
        """What the blocks of a stack say, the hat left out."""
        blocks = (self.project.blocks[block] for block in self.body(number))
        return [block.fields["text"] for block in blocks if "text" in block.fields]

    # Where it is

    def rect(self, block: str) -> QRectF:
        found = self.canvas.sight.view_rect_of(block)
        assert found is not None
        return found

    def corner(self, block: str) -> QPoint:
        """Where a block begins: its upper left corner, or the right one of a mirrored page."""
        rect = self.rect(block)
        is_mirrored = self.canvas.look.measures.is_mirrored
        return (rect.topRight() if is_mirrored else rect.topLeft()).toPoint()

    def foot(self, block: str) -> QPoint:
        """Where what follows a block begins."""
        return QPoint(self.corner(block).x(), round(self.rect(block).bottom()))

    def grip(self, block: str) -> QPoint:
        """A point of a block that is no field."""
        side = -5 if self.canvas.look.measures.is_mirrored else 5
        return self.corner(block) + QPoint(side, 14)

    def piece(self, block: str, key: str, *, kind: str = "", number: int = 0) -> QPoint:
        """The middle of a field, a socket or a button of a block."""
        placed = self.canvas.page_layout.placed(block)
        assert placed is not None
        piece = next(
            p
            for p in placed.box.pieces
            if p.key == key and kind in ("", p.kind) and number in (0, p.number)
        )
        x, y = placed.x + piece.x + piece.width / 2, placed.y + piece.y + piece.height / 2
        return self.canvas.sight.camera.to_view(x, y).toPoint()

    def mouth(self, block: str, key: str) -> QPoint:
        """The corner of the place in which what a block holds begins."""
        placed = self.canvas.page_layout.placed(block)
        assert placed is not None
        mouth = next(mouth for mouth in placed.box.mouths if mouth.key == key)
        return self.canvas.sight.camera.to_view(placed.x + mouth.x, placed.y + mouth.y).toPoint()

    def seen(self, colour: str, rect: QRectF) -> int:
        """How many pixels of a part of the canvas have a colour of the theme."""
        image = self.canvas.viewport().grab(rect.toAlignedRect()).toImage()
        wanted = self.canvas.look.theme.colour(colour).rgb()
        points = ((x, y) for x in range(image.width()) for y in range(image.height()))
        return sum(image.pixel(x, y) == wanted for x, y in points)

    def told(self) -> str:
        """All words of the messages in the window."""
        labels = self.window.message_area.findChildren(QLabel)
        return "\n".join(label.text() for label in labels if label.isVisible())

    # What the hands do

    def press(self, at: QPoint, held=PLAIN, widget: QWidget | None = None) -> None:
        QTest.mousePress(widget or self.canvas.viewport(), LEFT, held, at)

    def move(self, at: QPoint, widget: QWidget | None = None) -> None:
        QTest.mouseMove(widget or self.canvas.viewport(), at)

    def release(self, at: QPoint, widget: QWidget | None = None) -> None:
        QTest.mouseRelease(widget or self.canvas.viewport(), LEFT, PLAIN, at)

    def click(self, at: QPoint, held=PLAIN, widget: QWidget | None = None) -> None:
        QTest.mouseClick(widget or self.canvas.viewport(), LEFT, held, at)

    def drag(self, start: QPoint, end: QPoint, held=PLAIN, widget: QWidget | None = None) -> None:
        """Press, move, and keep the button down."""
        self.press(start, held, widget)
        for step in (0.1, 0.4, 0.7, 1.0):
            self.move(start + (end - start) * step, widget)

    def drop(self, start: QPoint, end: QPoint, held=PLAIN, widget: QWidget | None = None) -> None:
        self.drag(start, end, held, widget)
        self.release(end, widget)

    def carry(self, block: str, to: QPoint, held=PLAIN) -> QPoint:
        """Drag a block so that it would begin at a point; gives where the pointer is."""
        end = self.grip(block) + to - self.corner(block)
        self.drag(self.grip(block), end, held)
        return end

    def put(self, block: str, to: QPoint, held=PLAIN) -> None:
        self.release(self.carry(block, to, held))

    def select(self, *blocks: str) -> None:
        """Click the blocks, the second and further ones with Shift."""
        for number, block in enumerate(blocks):
            self.click(self.grip(block), SHIFT if number else PLAIN)

    def key(self, key: Qt.Key, held=PLAIN, widget: QWidget | None = None) -> None:
        QTest.keyClick(widget or self.canvas, key, held)

    def type(self, text: str, widget: QWidget | None = None) -> None:
        """Type; letters that are on no key come from an input method."""
        for letter in text:
            if letter.isascii():
                QTest.keyClicks(widget or self.canvas, letter)
            else:
                event = QInputMethodEvent()
                event.setCommitString(letter)
                QApplication.sendEvent(widget or self.canvas, event)

    def undo(self) -> bytes:
        """Press Ctrl+Z once; gives the program after that."""
        self.key(Key.Key_Z, CTRL)
        return self.file

    def redo(self) -> bytes:
        self.key(Key.Key_Y, CTRL)
        return self.file

    def wheel(self, notches: int, held=PLAIN, at: QPoint | None = None) -> None:
        """Turn the wheel: away is positive."""
        view = self.canvas.viewport()
        place = QPointF(at or view.rect().center())
        event = QWheelEvent(
            place,
            QPointF(view.mapToGlobal(place)),
            QPoint(),
            QPoint(0, 120 * notches),
            Qt.MouseButton.NoButton,
            held,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(view, event)

    def menu(self, at: QPoint) -> QMenu:
        """Click with the right button; gives the menu that opens."""
        view = self.canvas.viewport()
        QTest.mousePress(view, RIGHT, PLAIN, at)
        QTest.mouseRelease(view, RIGHT, PLAIN, at)
        reason = QContextMenuEvent.Reason.Mouse
        QApplication.sendEvent(view, QContextMenuEvent(reason, at, view.mapToGlobal(at)))
        assert self.canvas.menu is not None and self.canvas.menu.isVisible()
        return self.canvas.menu

    def choose(self, menu: QMenu, name: str) -> None:
        """Click an entry of a menu."""
        action = entry(menu, name)
        assert action.isEnabled(), name
        QTest.mouseClick(menu, LEFT, PLAIN, menu.actionGeometry(action).center())

    def from_palette(self, block_type: str, to: QPoint, *, is_corner: bool = False) -> None:
        """Drag a block out of the palette; where the mouse ends, or the corner of the block."""
        shelf = self.palette.shelf
        stock = shelf._stock.project
        types = [stock.blocks[e.sample].type if e.sample else "" for e in shelf.entries]
        shelf._go_to(types.index(block_type))
        rect = shelf.rect_of(types.index(block_type))
        start = QPoint(rect.center().x(), rect.top() + 12)
        if is_corner:
            to += start - rect.topLeft()
        end = shelf.viewport().mapFromGlobal(self.canvas.viewport().mapToGlobal(to))
        self.drop(start, end, widget=shelf.viewport())


def entry(menu: QMenu, name: str) -> QAction:
    return next(action for action in menu.actions() if action.objectName() == name)


class Fingers:
    """Fingers on a touch screen over the canvas."""

    def __init__(self, person: Person, screen: QPointingDevice) -> None:
        self._view, self._screen = person.canvas.viewport(), screen
        self._down = 0

    def to(self, *points: QPoint) -> None:
        """Put fingers down at these points, or move those that are down there."""
        touch = QTest.touchEvent(self._view, self._screen, False)
        for number, point in enumerate(points):
            put = touch.move if number < self._down else touch.press
            put(number, point, self._view)
        self._down = len(points)
        touch.commit()

    def up(self, *points: QPoint) -> None:
        """Lift them all."""
        touch = QTest.touchEvent(self._view, self._screen, False)
        for number, point in enumerate(points):
            touch.release(number, point, self._view)
        self._down = 0
        touch.commit()


class PaintedPixels(QObject):
    """Counts the pixels that a widget is asked to paint."""

    count = 0

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802 - Qt's name
        if isinstance(event, QPaintEvent):
            self.count += sum(rect.width() * rect.height() for rect in event.region())
        return False


def is_dragging(person: Person) -> bool:
    """Whether blocks are in the hand."""
    return person.canvas.layers.sprite is not None and person.canvas.pointing.gesture is not None

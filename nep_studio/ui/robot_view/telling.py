"""What a robot view says in words, and how it shows what is under the pointer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QRect, Qt
from PySide6.QtGui import QNativeGestureEvent, QPaintDevice, QPainter, QPen
from PySide6.QtWidgets import QGestureEvent, QPinchGesture

from nep_studio.ui.theme import Theme
from nep_studio.ui.words import tr

from .picking import Found
from .room import Room
from .scene import Marked

if TYPE_CHECKING:
    from .view import RobotView


def hovered(view: RobotView, found: Found) -> Marked:
    """What stands out under the pointer: what a press would take."""
    if found.part is not None and view.is_posing:
        return Marked(found.robot, link=found.part.link)
    if found.sensor and view.room.can_touch(found.robot):
        return Marked(found.robot, found.sensor)
    if found.thing and view.can_move_things:
        return Marked(thing=found.thing)
    return Marked()


def tip_words(view: RobotView, found: Found) -> str:
    """What a press would do."""
    if view.is_posing and found.part is not None:
        return tr("Drag to move")
    if found.sensor and view.room.can_touch(found.robot):
        return tr("Touch {part}", part=view.touch_names.get(found.sensor, found.sensor))
    if found.thing and view.can_move_things:
        return tr("Drag to move")
    return found.robot


def room_words(room: Room, touch_names: Mapping[str, str]) -> str:
    """All that is in the room, in sentences."""
    sentences = []
    for name in room.names:
        state = room.goal(name)
        if state is None:
            sentences.append(tr("{robot} is not there.", robot=name))
            continue
        sentences.append(f"{name}: {state.posture}." if state.posture else f"{name}.")
        if state.saying:
            sentences.append(tr("Says “{text}”", text=state.saying))
    marked = room.marked
    if marked.sensor:
        sentences.append(tr("Touch {part}", part=touch_names.get(marked.sensor, marked.sensor)))
    return " ".join(sentences)


@contextmanager
def painting(device: QPaintDevice) -> Iterator[QPainter]:
    """A painter that ends also when something goes wrong; one left open brings down Qt."""
    painter = QPainter(device)
    try:
        yield painter
    finally:
        painter.end()


def paint_focus(painter: QPainter, frame: QRect, theme: Theme) -> None:
    """Paint a frame: keys go to this view."""
    painter.setPen(QPen(theme.colour("focus"), 2.0))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRoundedRect(frame.toRectF().adjusted(1.5, 1.5, -1.5, -1.5), 4, 4)


def pinched(event: QEvent) -> float | None:
    """How much nearer two fingers on a pad or a screen want to come; None for other events."""
    if isinstance(event, QNativeGestureEvent):
        is_zoom = event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture
        return 1 + event.value() if is_zoom else None
    if event.type() == QEvent.Type.Gesture and isinstance(event, QGestureEvent):
        pinch = event.gesture(Qt.GestureType.PinchGesture)
        return pinch.scaleFactor() if isinstance(pinch, QPinchGesture) else None
    return None

"""The robot view: a small room with robots, which can be looked at from all sides and touched."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from PySide6.QtCore import QEvent, QPointF, QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import (
    QHelpEvent,
    QHideEvent,
    QImage,
    QKeyEvent,
    QMouseEvent,
    QNativeGestureEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QResizeEvent,
    QShowEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QGestureEvent, QPinchGesture, QSizePolicy, QToolTip

from faults.files import is_elsewhere
from nep_core.wire.messages import RobotState, Thing
from nep_studio import paths
from nep_studio.ui.labels import follow_words, labelled, plain_tip
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import InLines
from nep_studio.ui.words import tr

from .camera import PRESETS, Camera, Frame, Lens
from .drawing import Drawing, gl_bodies
from .figure import load_figure
from .gestures import Found, Gesture, ahead_of, at_face, begun, find_at, place_of_sensor, seeing_all
from .painter import ScenePainter
from .parts import VIEW_FILE
from .scene import ORIGIN, Base, Marked, Room, Scene, moved

# What a robot view says in words, and how it shows what is under the pointer.


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


def paint_focus(painter: QPainter, frame: QRect, theme: Theme) -> None:
    """Paint a frame: keys go to this view."""
    painter.setPen(QPen(theme.colour("focus"), 2.0))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRoundedRect(frame.toRectF().adjusted(1.5, 1.5, -1.5, -1.5), 4, 4)


PINCHES = (QEvent.Type.NativeGesture, QEvent.Type.Gesture)
"""The events of two fingers, and of other gestures."""


def pinched(event: QEvent) -> float | None:
    """How much nearer two fingers on a pad or a screen want to come; None for other events."""
    if isinstance(event, QNativeGestureEvent):
        is_zoom = event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture
        return 1 + event.value() if is_zoom else None
    if isinstance(event, QGestureEvent):
        pinch = event.gesture(Qt.GestureType.PinchGesture)
        return pinch.scaleFactor() if isinstance(pinch, QPinchGesture) else None
    return None


# Shows robots and things in a room; it is painted only when something changes.

FRAME_MS, SLOWEST_MS, PACE = 16, 66, 2.4
"""Between frames while something moves, or this many times as long as painting takes."""
WORDS_ABOVE, WORDS_BESIDE, MOST_WORDS = 3.4, 0.6, 0.27
"""So many lines are free over the heads, at most this share of the height."""
See = Callable[[Camera, Scene, Frame], Camera]
"""How a camera is moved so that it sees what is wanted."""
WIDE = 1.5
"""In a picture so much wider than high, words have room beside a head."""


def nao_folder() -> Path:
    """The folder of the robot that is shown where none is named."""
    return paths.resources() / "robots" / "nao"


@cache
def folder_of(model: str) -> Path:
    """The folder of a robot's model; NAO's where there is none that can be drawn.

    It is looked for once: robots tell their model thirty times a second.
    """
    if is_elsewhere(model):
        return nao_folder()
    folder = paths.resources() / "robots" / (model or "nao")  # a path of one's own stays as it is
    return folder if (folder / VIEW_FILE).is_file() else nao_folder()


class RoomPicture(InLines):
    """A room with robots, to look at.

    ``follows``: the camera goes along with a robot that is alone, and keeps seeing all robots,
    until a person chooses what to see, of which ``follows_changed`` tells. ``frames`` counts how
    often it was painted.
    """

    follows_changed = Signal(bool)
    usual_lines, least_lines = (18, 18), (8, 8)
    """Room for a robot that can be touched; one is known at the lesser size, too."""

    def __init__(
        self, look: Look, touch_names: Mapping[str, str] | None = None, drawing: Drawing = "auto"
    ) -> None:
        super().__init__()
        self.look, self.touch_names = look, touch_names or {}
        self.painter = ScenePainter(look.theme, gl_bodies(drawing))
        self.room = Room()
        self.camera = Camera()
        self.follows = True
        self.frames = 0
        self._told: dict[str, tuple[str, str] | None] = {}
        """What was said of each robot: posture and words; None: that it is not there."""
        self._cost_ms = 0.0
        self._timer = QTimer(self, interval=FRAME_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_frame)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        labelled(self, name="The robots' room")
        follow_words(self, self._describe)
        look.theme_changed.connect(self._on_theme_changed)

    # What is shown

    def show_robot(
        self,
        name: str,
        state: RobotState | None,
        folder: Path | None = None,
        *,
        can_touch: bool = True,
        start: Base = ORIGIN,
    ) -> None:
        """Show a robot as it is now; None: nothing is known, so it is pale where it was last."""
        figure = load_figure(folder or folder_of(state.model if state is not None else ""))
        is_new, is_seen = self.room.show_robot(
            name, figure, state, time.monotonic(), can_touch, start
        )
        if is_new and self.follows:
            self.fit()
        if is_seen:
            words = None if state is None else (state.posture, state.saying)
            if is_new or words != self._told.get(name):
                self._told[name] = words
                self._describe()
            # Paint soon, as often as it takes for the robots to come to where they are.
            if self.isVisible() and not self._timer.isActive():
                self._timer.start()

    def remove_robot(self, name: str) -> None:
        """Show a robot no more."""
        if self.room.remove_robot(name):
            self._describe()
            self.update()

    def show_things(self, things: Sequence[Thing]) -> None:
        """Show these things on the floor, and no others."""
        known = {thing.id for thing in self.room.things}
        if self.room.show_things(things):
            if self.follows and known != {thing.id for thing in things}:
                self.fit()
            self.update()

    def clear_paths(self) -> None:
        """Forget the ways that robots have walked."""
        self.room.clear_paths()
        self.update()

    def mark(self, marked: Marked) -> None:
        """Let a part, a limb or a thing stand out."""
        if self.room.mark(marked):
            self._describe()
            self.update()

    # Looking

    @property
    def lens(self) -> Lens:
        """The camera for the widget as large as it is."""
        return Lens(self.camera, self.width(), self.height(), self.devicePixelRatioF())

    def look_through(self, camera: Camera) -> None:
        """Look through another camera."""
        if camera != self.camera:
            self.camera = camera
            self.update()

    def look_from(self, preset: str) -> None:
        """Look from the front, side, back or top, or into the face, of the first robot."""
        yaw, pitch = PRESETS[preset]
        camera = replace(self.camera, yaw=ahead_of(self.room.scene()) + yaw, pitch=pitch)
        self.fit(camera, at_face if preset == "face" else seeing_all)

    def zoom(self, factor: float) -> None:
        """Come nearer by a factor."""
        self.stay()
        self.look_through(self.camera.zoomed(factor))

    def stay(self) -> None:
        """Follow robots no more: a person has chosen what to see."""
        if self.follows:
            self.follows = False
            self.follows_changed.emit(False)

    def fit(self, camera: Camera | None = None, see: See = seeing_all) -> None:
        """See all robots and what stands near, through this camera or another one."""
        if not self.follows:
            self.follows = True
            self.follows_changed.emit(True)
        # There is always room for words over the robots, so that nothing jumps.
        width, height, line = self.width(), self.height(), self.fontMetrics().height()
        lines = WORDS_ABOVE if width < WIDE * height else WORDS_BESIDE
        frame = Frame(width, height, min(lines * line, MOST_WORDS * height))
        self.look_through(see(camera or self.camera, self.room.scene(), frame))

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the room."""
        self.frames += 1
        start = time.perf_counter()
        with QPainter(self) as painter:
            self.painter.paint(painter, self.room.scene(), self.lens, self.font())
            if self.hasFocus():
                paint_focus(painter, self.rect(), self.look.theme)
        self._pace(1000 * (time.perf_counter() - start))

    def _pace(self, spent_ms: float) -> None:
        """Leave more than half of the time to others, however long painting takes."""
        self._cost_ms += (spent_ms - self._cost_ms) / 4
        interval = round(min(max(FRAME_MS, PACE * self._cost_ms), SLOWEST_MS))
        if abs(interval - self._timer.interval()) > 2:
            self._timer.setInterval(interval)

    def grab_picture(self, size: QSize) -> QImage:
        """The room as a picture of another size, without marks."""
        image = QImage(size, QImage.Format.Format_RGB32)
        with QPainter(image) as painter:
            self.paint_picture(painter, size)
        return image

    def paint_picture(self, painter: QPainter, size: QSize) -> None:
        """Paint the room as it is, without marks, on anything: also on a page of a PDF."""
        if not self.isVisible():
            self.room.step(math.inf)
        scene = replace(self.room.scene(), marked=Marked())
        lens = Lens(self.camera, size.width(), size.height())
        ScenePainter(self.look.theme).paint(painter, scene, lens, self.font())

    def _on_frame(self) -> None:
        robots = list(self.room.robots.values())
        alone = robots[0] if self.follows and len(robots) == 1 else None
        before = alone.shown.base if alone is not None else ORIGIN
        if not self.room.step(time.monotonic()):
            self._timer.stop()
        if alone is not None:
            now, (x, y, z) = alone.shown.base, self.camera.target
            there = (x + now[0] - before[0], y + now[1] - before[1], z)
            self.look_through(replace(self.camera, target=there))
        self.update()

    def _on_theme_changed(self) -> None:
        self.painter.use_theme(self.look.theme)
        self.update()

    def _describe(self) -> None:
        """Say in words what is seen, for those who do not see it."""
        sentences = []
        for name, robot in self.room.robots.items():
            if robot.is_pale:
                sentences.append(tr("{robot} is not there.", robot=name))
                continue
            state = robot.goal
            sentences.append(f"{name}: {state.posture}." if state.posture else f"{name}.")
            if state.saying:
                sentences.append(tr("Says “{text}”", text=state.saying))
        if sensor := self.room.marked.sensor:
            sentences.append(tr("Touch {part}", part=self.touch_names.get(sensor, sensor)))
        words = " ".join(sentences)
        if words != self.accessibleDescription():
            self.setAccessibleDescription(words)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep seeing all robots while nobody chose what to see."""
        if self.follows:
            self.fit()

    def showEvent(self, event: QShowEvent) -> None:
        """Go on from where the robots are now."""
        self.room.step(math.inf)

    def hideEvent(self, event: QHideEvent) -> None:
        """Do nothing while nobody looks."""
        self._timer.stop()


# The keys of a robot view: looking around, and touching without a mouse.

STEP_RAD = math.radians(8)
ZOOM = 1.15
ARROWS = {
    Qt.Key.Key_Left: (1, 0),
    Qt.Key.Key_Right: (-1, 0),
    Qt.Key.Key_Up: (0, 1),
    Qt.Key.Key_Down: (0, -1),
}
ZOOMS = {Qt.Key.Key_Plus: ZOOM, Qt.Key.Key_Equal: ZOOM, Qt.Key.Key_Minus: 1 / ZOOM}
PRESET_KEYS = {Qt.Key(Qt.Key.Key_1 + place): preset for place, preset in enumerate(PRESETS)}
TOUCHES = (Qt.Key.Key_Space, Qt.Key.Key_Return, Qt.Key.Key_Enter)


def key_pressed(view: RobotView, event: QKeyEvent) -> bool:
    """Do what a key says; whether it says anything."""
    key = Qt.Key(event.key())
    if key in ARROWS:
        right, up = ARROWS[key]
        view.look_through(view.camera.orbited(right * STEP_RAD, up * STEP_RAD))
    elif key in ZOOMS:
        view.zoom(ZOOMS[key])
    elif key in PRESET_KEYS:
        view.look_from(PRESET_KEYS[key])
    elif key == Qt.Key.Key_Home:
        view.fit()
    elif key in TOUCHES and view.room.marked.sensor:
        marked = view.room.marked
        if not event.isAutoRepeat():
            view.press(marked.robot, marked.sensor)
    elif key == Qt.Key.Key_Escape and view.room.marked != Marked():
        view.mark(Marked())
    else:
        return False
    return True


def key_released(view: RobotView, event: QKeyEvent) -> bool:
    """Let go of what a key touches; whether it did."""
    marked = view.room.marked
    if event.key() not in TOUCHES or event.isAutoRepeat() or not marked.is_pressed:
        return False
    view.release(marked.robot, marked.sensor)
    return True


def next_mark(view: RobotView, step: int) -> Marked | None:
    """The next thing to touch on the way of the Tab key; None past the last."""
    stops = [
        Marked(robot.name, sensor)
        for robot in view.room.scene().robots
        if view.room.can_touch(robot.name)
        for sensor in robot.figure.sensors
    ]
    now = Marked(view.room.marked.robot, view.room.marked.sensor)
    if not stops:
        return None
    number = stops.index(now) + step if now in stops else (0 if step > 0 else len(stops) - 1)
    return stops[number] if 0 <= number < len(stops) else None


WHEEL_STEP = 1.0015


class RobotView(RoomPicture):
    """Shows robots and things in a room.

    ``touched`` gives a robot, its sensor, and whether it is pressed or let go. ``thing_chosen``
    gives a thing's id ("" none), ``thing_moved`` also where on the floor it is dragged to (m).
    While ``is_posing``, ``limb_pressed`` and ``limb_dragged`` give a robot, a link, and the place
    (x, y, z m in the room) of the pointer; ``limb_released`` a robot and a link.
    """

    touched = Signal(str, str, bool)
    robot_chosen = Signal(str)
    thing_chosen = Signal(str)
    thing_moved = Signal(str, float, float)
    limb_pressed = Signal(str, str, tuple)
    limb_dragged = Signal(str, str, tuple)
    limb_released = Signal(str, str)

    def __init__(
        self, look: Look, touch_names: Mapping[str, str] | None = None, drawing: Drawing = "auto"
    ) -> None:
        super().__init__(look, touch_names, drawing)
        self.is_posing = False
        self.can_move_things = True
        self._gesture: Gesture | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.grabGesture(Qt.GestureType.PinchGesture)

    def move_thing(self, thing: str, x: float, y: float) -> None:
        """Put a thing somewhere else, and tell it."""
        self.show_things(moved(self.room.things, thing, x, y))
        self.thing_moved.emit(thing, x, y)

    def press(self, robot: str, sensor: str) -> None:
        """Touch a sensor of a robot."""
        self.mark(Marked(robot, sensor, is_pressed=True))
        self.touched.emit(robot, sensor, True)

    def release(self, robot: str, sensor: str) -> None:
        """Let go of a sensor."""
        self.mark(Marked(robot, sensor))
        self.touched.emit(robot, sensor, False)

    def found_at(self, at: QPointF) -> Found:
        """What is at a place of this widget."""
        scene = self.room.scene()
        return find_at(self.painter.bodies_of(scene, self.lens), scene, at)

    def place_of(self, robot: str, sensor: str) -> QPointF | None:
        """Where a sensor is in this widget."""
        scene = self.room.scene()
        return place_of_sensor(self.painter.bodies_of(scene, self.lens), scene, robot, sensor)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to look around, to touch, or to drag."""
        self._end_gesture()
        self._gesture = begun(self, event, self.found_at(event.position()))
        self.setCursor(self._gesture.cursor)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on, or show what could be touched."""
        if self._gesture is not None:
            self._gesture.move(event.position())
            return
        found = self.found_at(event.position())
        self.mark(hovered(self, found))
        is_hot = self.room.marked != Marked()
        shape = Qt.CursorShape.PointingHandCursor if is_hot else Qt.CursorShape.OpenHandCursor
        self.setCursor(shape)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        self._end_gesture()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """See all again; on a sensor it is a second touch."""
        found = self.found_at(event.position())
        if found == Found() and event.button() == Qt.MouseButton.LeftButton:
            self.fit()
        else:
            self.mousePressEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Come nearer or go away."""
        self.zoom(WHEEL_STEP ** event.angleDelta().y())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Look around and touch with keys."""
        if not key_pressed(self, event):
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        """Let go."""
        if not key_released(self, event):
            super().keyReleaseEvent(event)

    def focusNextPrevChild(self, is_next: bool) -> bool:
        """Let Tab go through what can be touched, then on to the next widget."""
        marked = next_mark(self, 1 if is_next else -1)
        self.mark(marked or Marked())
        return marked is not None or super().focusNextPrevChild(is_next)

    def event(self, event: QEvent) -> bool:
        """Tell what is under the pointer; zoom with two fingers; let go when the mouse leaves."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            words = tip_words(self, self.found_at(event.pos().toPointF()))
            QToolTip.showText(event.globalPos(), plain_tip(words), self)
            return True
        if event.type() in PINCHES and (factor := pinched(event)) is not None:
            self.zoom(factor)
            return True
        if event.type() == QEvent.Type.FocusOut or (
            event.type() == QEvent.Type.Leave and self._gesture is None
        ):
            self._let_go()
        return super().event(event)

    def hideEvent(self, event: QHideEvent) -> None:
        """Let go; do nothing while nobody looks."""
        self._let_go()
        super().hideEvent(event)

    def _let_go(self) -> None:
        """Touch nothing, whether with the mouse or with a key, and mark nothing."""
        self._end_gesture()
        marked = self.room.marked
        if marked.is_pressed:
            self.release(marked.robot, marked.sensor)
        self.mark(Marked())

    def _end_gesture(self) -> None:
        if self._gesture is not None:
            gesture, self._gesture = self._gesture, None
            gesture.end()
            self.setCursor(Qt.CursorShape.OpenHandCursor)

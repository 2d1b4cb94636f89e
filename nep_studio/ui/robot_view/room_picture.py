"""Shows robots and things in a room; it is painted only when something changes."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QSize, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QImage, QPainter, QPaintEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_core.messages import RobotState, Thing
from nep_studio import paths
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .camera import PRESETS, Camera, Frame, Lens
from .drawing import Drawing, gl_bodies
from .figure import load_figure
from .looking import ahead_of, at_face, at_floor_of, seeing_all
from .painter import ScenePainter
from .parts import VIEW_FILE
from .room import ORIGIN, Base, Room
from .scene import Marked
from .telling import paint_focus, painting, room_words

FRAME_MS, SLOWEST_MS, PACE = 16, 66, 2.4
"""Between frames while something moves, or this many times as long as painting takes."""
WORDS_ABOVE, WORDS_BESIDE, MOST_WORDS = 3.4, 0.6, 0.27
"""So many lines are free over the heads, at most this share of the height."""
WIDE = 1.5
"""In a picture so much wider than high, words have room beside a head."""


def nao_folder() -> Path:
    """The folder of the robot that is shown where none is named."""
    return paths.resources() / "robots" / "nao"


def folder_of(state: RobotState | None) -> Path:
    """The folder of the robot that a state is of; NAO's where there is none that can be drawn."""
    model = Path(state.model) if state is not None and state.model else nao_folder()
    folder = nao_folder().parent / model  # a path of one's own stays as it is
    return folder if (folder / VIEW_FILE).is_file() else nao_folder()


class RoomPicture(QWidget):
    """A room with robots, to look at.

    ``follows``: the camera goes along with a robot that is alone, and keeps seeing all robots,
    until a person chooses what to see. ``frames`` counts how often it was painted.
    """

    camera_changed = Signal()

    def __init__(
        self,
        look: Look,
        touch_names: Mapping[str, str] | None = None,
        drawing: Drawing = "auto",
    ) -> None:
        super().__init__()
        self.look, self.touch_names = look, touch_names or {}
        self.painter = ScenePainter(look.theme, gl_bodies(drawing))
        self.room = Room()
        self.camera = Camera()
        self.follows = True
        self.frames = 0
        self._cost_ms = 0.0
        self._timer = QTimer(self, interval=FRAME_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_frame)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setAccessibleName(tr("The robots' room"))
        look.theme_changed.connect(self._on_theme_changed)

    def sizeHint(self) -> QSize:
        """Room for a robot that can be touched."""
        line = self.fontMetrics().height()
        return QSize(line * 18, line * 18)

    def minimumSizeHint(self) -> QSize:
        """A robot is known at this size, too."""
        line = self.fontMetrics().height()
        return QSize(line * 8, line * 8)

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
        figure = load_figure(folder or folder_of(state))
        is_new, is_seen = self.room.show_robot(
            name, figure, state, time.monotonic(), can_touch, start
        )
        if is_new and self.follows:
            self.fit()
        if is_seen:
            self._describe()
            self._go_on()

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
            self.camera_changed.emit()
            self.update()

    def look_from(self, preset: str) -> None:
        """Look from the front, side, back or top, or into the face, of the first robot."""
        scene, (yaw, pitch) = self.room.scene(), PRESETS[preset]
        self.follows = True
        camera = replace(self.camera, yaw=ahead_of(scene) + yaw, pitch=pitch)
        see = at_face if preset == "face" else seeing_all
        self.look_through(see(camera, scene, self._frame()))

    def _frame(self) -> Frame:
        """Where in the widget robots are; there is always room for words, so that nothing jumps."""
        width, height, line = self.width(), self.height(), self.fontMetrics().height()
        lines = WORDS_ABOVE if width < WIDE * height else WORDS_BESIDE
        return Frame(width, height, min(lines * line, MOST_WORDS * height))

    def zoom(self, factor: float) -> None:
        """Come nearer by a factor."""
        self.follows = False
        self.look_through(self.camera.zoomed(factor))

    def fit(self) -> None:
        """See all robots and what stands near."""
        self.follows = True
        self.look_through(seeing_all(self.camera, self.room.scene(), self._frame()))

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the room."""
        self.frames += 1
        start = time.perf_counter()
        with painting(self) as painter:
            self.painter.paint(painter, self.room.scene(), self.lens, self.font())
            if self.hasFocus():
                paint_focus(painter, self.rect(), self.look.theme)
        self._pace(1000 * (time.perf_counter() - start))

    def grab_picture(self, size: QSize) -> QImage:
        """The room as a picture of another size, without marks."""
        image = QImage(size, QImage.Format.Format_RGB32)
        with painting(image) as painter:
            self.paint_picture(painter, size)
        return image

    def paint_picture(self, painter: QPainter, size: QSize) -> None:
        """Paint the room as it is, without marks, on anything: also on a page of a PDF."""
        if not self.isVisible():
            self.room.step(math.inf)
        scene = replace(self.room.scene(), marked=Marked())
        lens = Lens(self.camera, size.width(), size.height())
        ScenePainter(self.look.theme).paint(painter, scene, lens, self.font())

    def _pace(self, spent_ms: float) -> None:
        """Leave more than half of the time to others, however long painting takes."""
        self._cost_ms += (spent_ms - self._cost_ms) / 4
        interval = round(min(max(FRAME_MS, PACE * self._cost_ms), SLOWEST_MS))
        if abs(interval - self._timer.interval()) > 2:
            self._timer.setInterval(interval)

    def _go_on(self) -> None:
        """Paint soon, as often as it takes for the robots to come to where they are."""
        if self.isVisible() and not self._timer.isActive():
            self._timer.start()

    def _on_frame(self) -> None:
        before = at_floor_of(self.room.scene())
        if not self.room.step(time.monotonic()):
            self._timer.stop()
        if self.follows:
            now = at_floor_of(self.room.scene())
            self.look_through(self.camera.moved(now[0] - before[0], now[1] - before[1]))
        self.update()

    def _on_theme_changed(self) -> None:
        self.painter.use_theme(self.look.theme)
        self.update()

    def _describe(self) -> None:
        """Say in words what is seen, for those who do not see it."""
        words = room_words(self.room, self.touch_names)
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

"""The scene of the robots: all of them in one room, with tools, and things that can be moved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QPushButton, QSizePolicy

from nep_core.wire.messages import RobotState, Thing, ThingKind
from nep_studio.blocks.language import Language
from nep_studio.project.surroundings import moved, named, new_thing, turned
from nep_studio.ui.floor import Floor
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.speech import Sound
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import InLines, in_column
from nep_studio.ui.words import tr

from .card import touch_names
from .participants import ORIGIN, Base, RobotPlan
from .stage_tools import StageTools, ThingBar, thing_words

if TYPE_CHECKING:
    from nep_studio.ui.robot_view.view import RobotView


# Moves the chosen thing with keys, and notices when one that was dragged is put down.

STEP_M, SMALL_STEP_M = 0.1, 0.02
STEP_RAD = math.radians(15)
ARROWS = {
    Qt.Key.Key_Left: math.pi / 2,
    Qt.Key.Key_Right: -math.pi / 2,
    Qt.Key.Key_Up: 0.0,
    Qt.Key.Key_Down: math.pi,
}
"""Where keys move a thing, from the direction in which one looks."""
REMOVING = (Qt.Key.Key_Delete, Qt.Key.Key_Backspace)


TURNING = {Qt.Key.Key_Comma: STEP_RAD, Qt.Key.Key_Period: -STEP_RAD}
MEANT = (*ARROWS, *REMOVING, *TURNING, Qt.Key.Key_Escape)
"""The keys that are for the chosen thing."""


class StageKeys(QObject):
    """Watches a view: ``changed`` gives a thing as it is after a key, ``removed``, ``left``.

    ``put_down`` tells that a mouse button was let go.
    """

    changed = Signal(object)
    removed = Signal()
    left = Signal()
    put_down = Signal()

    def __init__(self, view: RobotView) -> None:
        super().__init__(view)
        self._view = view
        self.chosen: Thing | None = None
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take keys that are meant for the chosen thing."""
        if event.type() == QEvent.Type.MouseButtonRelease:
            QTimer.singleShot(0, self, self.put_down.emit)  # after the view has seen it
        if isinstance(event, QKeyEvent) and self._take(event):
            return True
        return super().eventFilter(watched, event)

    def _take(self, event: QKeyEvent) -> bool:
        """Take a key for the chosen thing; whether it is meant for that."""
        plain = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.KeypadModifier
        is_command = bool(event.modifiers() & ~plain)  # a shortcut of the window
        if self.chosen is None or event.key() not in MEANT or is_command:
            return False
        if event.type() == QEvent.Type.ShortcutOverride:
            event.accept()  # else Delete would delete blocks
        elif event.type() == QEvent.Type.KeyPress:
            self._press(self.chosen, event)
        return True

    def _press(self, thing: Thing, event: QKeyEvent) -> None:
        key, is_small = Qt.Key(event.key()), event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if key in ARROWS:
            way_m = SMALL_STEP_M if is_small else STEP_M
            angle = self._view.camera.yaw + math.pi + ARROWS[key]
            x, y, _ = thing.place
            x, y = x + way_m * math.cos(angle), y + way_m * math.sin(angle)
            self.changed.emit(moved(thing, x, y))
        elif key in TURNING:
            self.changed.emit(turned(thing, thing.heading + TURNING[key]))
        elif key in REMOVING:
            self.removed.emit()
        else:
            self.left.emit()


# Keeps robots in sight that fall or are put elsewhere, as long as nobody looks closer.

LOOK_MS = 600
Looking = tuple[float, float, float]


class Sight(QObject):
    """Looks now and then whether all that was seen is seen still; if not, all is seen again.

    What a person has zoomed into, or turned away from, stays as it is.
    """

    def __init__(self, view: RobotView) -> None:
        super().__init__(view)
        self._view = view
        self._seen_by: Looking | None = None
        self.soon = QTimer(self, singleShot=True, interval=LOOK_MS)
        self.soon.timeout.connect(self.look)

    def look(self) -> None:
        """See all again if a robot has left the picture by itself."""
        view = self._view
        if self._is_all_seen():
            self._seen_by = self._looking()
        elif view.follows and self._seen_by == self._looking():
            view.fit()
            self._seen_by = self._looking()

    def _looking(self) -> Looking:
        camera = self._view.camera
        return camera.yaw, camera.pitch, camera.distance

    def _is_all_seen(self) -> bool:
        view = self._view
        for robot in view.room.scene().robots:
            pixels = view.lens.project(robot.placed.corners())
            low, high = pixels.min(axis=0), pixels.max(axis=0)
            if min(low) < 0 or high[0] > view.width() or high[1] > view.height():
                return False
        return True


ASIDE_RAD = math.radians(65)


class RobotStage(InLines):
    """Shows robots and what stands around them; the view is made when it is first looked at.

    ``touched`` gives a robot, its sensor, and whether it is pressed or let go; ``chosen`` a robot.
    """

    touched = Signal(str, str, bool)
    chosen = Signal(str)
    usual_lines = (16, 18)
    """Room for a robot that stands."""

    def __init__(
        self, look: Look, floor: Floor, sound: Sound, language: Callable[[], Language]
    ) -> None:
        super().__init__()
        self._look, self.floor, self._sound = look, floor, sound
        self._language = language
        self._view: RobotView | None = None
        self._keys: StageKeys | None = None
        self._chosen_id = ""
        self._held: Thing | None = None
        self._sight: Sight | None = None
        self._shown: dict[str, tuple[RobotState | None, Base]] = {}
        self.tools = StageTools(look)
        self.thing_bar = ThingBar(look)
        self.invitation = labelled(QPushButton(), text="Place a person here")
        line = self.fontMetrics().height()
        self.invitation.setProperty("kind", "quiet")
        self.invitation.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        parts = self.tools, self.invitation, self.thing_bar
        self._box = in_column(*parts, of=self, margins=0, spacing=line // 5)
        self._connect()
        self._on_floor_changed()
        follow_words(self, self._tell_names)

    def _connect(self) -> None:
        tools, bar = self.tools, self.thing_bar
        tools.view_asked.connect(lambda preset: self.view.look_from(preset))
        tools.fit.triggered.connect(lambda: self.view.fit())
        tools.follow.toggled.connect(self._on_follow_switched)
        tools.place_asked.connect(self.place)
        tools.thing_asked.connect(self._on_thing_asked)
        tools.clear.triggered.connect(lambda: self.view.clear_paths())
        tools.sound.clicked.connect(self._sound.switch)
        self._sound.switched.connect(tools.show_sound)
        tools.show_sound(self._sound.is_on)
        self.invitation.clicked.connect(lambda: self.place("person"))
        bar.named.connect(lambda name: self._change(lambda thing: named(thing, name)))
        bar.turned.connect(self._on_turned)
        bar.remove.clicked.connect(self.remove)
        bar.close_button.clicked.connect(lambda: self.choose(""))
        self.floor.changed.connect(self._on_floor_changed)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Invite only where there is room for the words: the tool “Place” does the same."""
        super().resizeEvent(event)
        self._show_invitation()

    def _show_invitation(self) -> None:
        is_wanted = not self.floor.things and self.floor.has_room
        has_words = self.invitation.sizeHint().width() <= self.width()
        self.invitation.setVisible(is_wanted and has_words)

    def _tell_names(self) -> None:
        """Call the places that can be touched as they are called now."""
        if self._view is not None:
            self._view.touch_names = touch_names(self._language())

    @property
    def view(self) -> RobotView:
        """The view; numpy is loaded with it."""
        if self._view is None:
            from nep_studio.ui.robot_view.view import RobotView

            view = self._view = RobotView(self._look, touch_names(self._language()))
            view.setMinimumHeight(self.fontMetrics().height() * 6)
            self._box.insertWidget(1, view, 1)
            self._sight, keys = Sight(view), StageKeys(view)
            self._keys = keys
            view.touched.connect(self.touched)
            view.robot_chosen.connect(self.chosen)
            view.thing_chosen.connect(self.choose)
            view.thing_moved.connect(self._on_thing_moved)
            view.follows_changed.connect(self.tools.show_follow)
            keys.changed.connect(self.floor.change)
            keys.removed.connect(self.remove)
            keys.left.connect(lambda: self.choose(""))
            keys.put_down.connect(self._on_put_down)
            if self.floor.things:
                self._on_floor_changed()
        return self._view

    # Robots

    def show_robot(self, plan: RobotPlan, state: RobotState | None, start: Base) -> None:
        """Show a robot as it is; None: it is not there, and will begin at ``start``."""
        shown = (state, start)
        if self._shown.get(plan.name) != shown:
            self._shown[plan.name] = shown
            is_ours = not plan.is_real
            self.view.show_robot(plan.name, state, plan.folder, can_touch=is_ours, start=start)
            if self._sight is not None and not self._sight.soon.isActive():
                self._sight.soon.start()  # it may have moved

    def remove_robot(self, name: str) -> None:
        """Show a robot no more."""
        if self._shown.pop(name, None) is not None:
            self.view.remove_robot(name)

    # Things

    def place(self, kind: ThingKind) -> None:
        """Put a new thing before the first robot, and choose it."""
        if not self.floor.has_room:
            return
        base = next(iter(self._bases()), ORIGIN)
        thing = new_thing(kind, base, self.floor.things)
        self.floor.add(thing)
        self.choose(thing.id)
        self.view.setFocus()

    def _bases(self) -> list[Base]:
        """Where the robots are, or will begin."""
        return [state.base if state else start for state, start in self._shown.values()]

    def choose(self, thing_id: str) -> None:
        """Let a thing be the one that keys move and the bar tells of; "" is none."""
        self._chosen_id = thing_id
        self._on_floor_changed()

    def remove(self) -> None:
        """Take the chosen thing away."""
        thing_id, self._chosen_id = self._chosen_id, ""
        if thing_id:
            self.floor.remove(thing_id)
        self._on_floor_changed()

    def _change(self, how: Callable[[Thing], Thing]) -> None:
        thing = self.floor.find(self._chosen_id)
        if thing is not None:
            self.floor.change(how(thing))

    def _on_turned(self, degrees: int) -> None:
        self._change(lambda thing: turned(thing, thing.heading + math.radians(degrees)))

    def _on_thing_asked(self, thing_id: str) -> None:
        self.choose(thing_id)
        self.view.setFocus()

    def _on_thing_moved(self, thing_id: str, x: float, y: float) -> None:
        if thing := self.floor.find(thing_id):
            self._held = moved(thing, x, y)
            self.floor.hold(self._held)

    def _on_put_down(self) -> None:
        held, self._held = self._held, None
        if held is not None:
            self.floor.change(held, tr("move {thing}", thing=thing_words(held)))

    def _on_floor_changed(self) -> None:
        things = self.floor.things
        chosen = self.floor.find(self._chosen_id)
        if chosen is None:
            self._chosen_id = ""
        if self._keys is not None:
            self._keys.chosen = chosen
        self.thing_bar.show_thing(chosen)
        self.tools.show_things(things)
        self.tools.allow_placing(self.floor.has_room)
        self._show_invitation()
        if self._view is not None:
            view = self._view
            is_first = bool(things) and not view.room.things
            view.show_things(things)
            heading = next(iter(self._bases()), ORIGIN)[2]
            is_before = abs(math.remainder(view.camera.yaw - heading, math.tau)) < ASIDE_RAD
            if is_first and is_before:  # from aside no thing hides a robot
                view.look_through(replace(view.camera, yaw=heading + ASIDE_RAD))
                view.fit()

    def _on_follow_switched(self, is_on: bool) -> None:
        self.view.follows = is_on
        if is_on:
            self.view.fit()

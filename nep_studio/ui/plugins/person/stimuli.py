"""Does by hand what a person or the room would do: robots on the screen feel, see and hear it."""

from __future__ import annotations

import math
import uuid
from collections.abc import Callable, Collection, Mapping

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.wire import messages as m
from nep_core.wire.messages import RobotState, Thing, ThingKind
from nep_core.wire.states import TOUCHES
from nep_studio.blocks.program import ALL_ROBOTS
from nep_studio.project.surroundings import AHEAD_M, SIZES, named
from nep_studio.project.triggers import Kind, Occurrence, state_of
from nep_studio.run.plan import VIRTUAL_WATCH
from nep_studio.ui.floor import Floor
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.words import tr

ICONS: dict[Kind, str] = {
    "word": "message-square",
    "face": "user",
    "distance": "ruler",
    "touch": "hand",
    "gesture": "watch",
    "ball": "circle",
    "mark": "target",
    "sound": "volume-2",
    "emotion": "sparkles",
    "state": "eye",
    "sensor": "gauge",
    "joint": "rotate-ccw",
    "posture": "person-standing",
    "doing": "bot",
    "idle": "hourglass",
    "arm": "person-standing",
}
"""The sign of each kind."""


def words_of(occurrence: Occurrence) -> str:
    """What one does so that something happens, on a button: "Touch the head"."""
    about = occurrence.words or occurrence.value
    words = _words(occurrence, about)
    is_named = occurrence.robot not in (ALL_ROBOTS, "")
    return tr("{what} ({robot})", what=words, robot=occurrence.robot) if is_named else words


def _words(occurrence: Occurrence, about: str) -> str:
    match occurrence.kind:
        case "word":
            return tr("Say “{word}”", word=about or tr("hello"))
        case "face":
            return tr("{name} comes", name=about) if about else tr("Somebody comes")
        case "distance":
            return tr("Stand {distance}", distance=about)
        case "touch":
            return tr("Touch {part}", part=about)
        case "gesture":
            return tr("Make the gesture {gesture}", gesture=about)
        case "ball":
            return tr("Show the red ball")
        case "mark":
            return tr("Show the mark {number}", number=about) if about else tr("Show a mark")
        case "sound":
            return tr("Make a sound")
        case "emotion":
            return tr("Look {emotion}", emotion=about)
        case "arm" if occurrence.value == "raised":
            return tr("Raise the arm")
        case "arm" if occurrence.value == "level":
            return tr("Hold the arm level")
        case "arm":
            return tr("Let the arm hang")
    return _measured_words(occurrence, about)


def _measured_words(occurrence: Occurrence, about: str) -> str:
    amount = occurrence.amount
    match occurrence.kind:
        case "sensor" if amount is not None:
            return tr("{sensor}: {amount}", sensor=about, amount=f"{amount:g}")
        case "joint":
            return tr("Turn {joint}", joint=about)
        case "posture":
            return tr("Let it take the posture {posture}", posture=about)
        case "doing":
            return tr("Let it be {doing}", doing=about)
        case "idle":
            return tr("Do nothing for {seconds} s", seconds=f"{amount or 0:g}")
        case "state" if not occurrence.value:
            return tr("Touch the head, or do anything else")
    return about[:1].upper() + about[1:]


# Lets a person, a ball or a mark come before a robot, nearer or farther, and go again.

KINDS: dict[str, ThingKind] = {"face": "person", "ball": "ball", "mark": "mark"}
BESIDE_RAD = {"face": 0.0, "ball": -0.38, "mark": 0.38}
"""A ball and a mark come beside where a robot looks, so that a person does not hide them."""


class Visitors(QObject):
    """One of each may be there; ``changed`` tells that they came, went or moved."""

    changed = Signal()

    def __init__(self, floor: Floor, parent: QObject) -> None:
        super().__init__(parent)
        self._floor = floor
        self.states: dict[str, RobotState] = {}
        """How the robots are, as far as it is known: a visitor comes to where one looks."""
        floor.changed.connect(self.changed)

    def find(self, what: str) -> Thing | None:
        """The visitor of a kind, if it is there."""
        return self._floor.find(_id(what))

    def come(self, what: str, robot: str, name: str = "", way_m: float | None = None) -> None:
        """Let it come to where a robot looks, as far away as it was, or so many m."""
        before, kind = self.find(what), KINDS[what]
        if way_m is None:
            way_m = self.way_m(what, robot) if before is not None else AHEAD_M[kind]
        x, y, angle = self._before(robot, way_m, BESIDE_RAD[what])
        thing = Thing(
            id=_id(what),
            kind=kind,
            place=(x, y, 0.0),
            heading=math.remainder(angle + math.pi, math.tau),
            size=SIZES[kind],
            name=before.name if before is not None and not name else "",
        )
        self._floor.show(named(thing, name) if name else thing)

    def rename(self, what: str, name: str) -> None:
        """Give it another name, or number."""
        if (thing := self.find(what)) is not None:
            self._floor.show(named(thing, name))

    def go(self, what: str) -> None:
        """Let it go."""
        self._floor.hide(_id(what))

    def way_m(self, what: str, robot: str) -> float:
        """How far it is from a robot."""
        thing = self.find(what)
        if thing is None:
            return AHEAD_M[KINDS[what]]
        x, y, _ = self._base(robot)
        return math.hypot(thing.place[0] - x, thing.place[1] - y)

    def stand(self, what: str, robot: str, way_m: float) -> None:
        """Let it come closer or step back, along the line to the robot."""
        thing = self.find(what)
        if thing is None:
            return
        x, y, theta = self._base(robot)
        angle = math.atan2(thing.place[1] - y, thing.place[0] - x)
        if self.way_m(what, robot) < 1e-3:
            angle = theta
        place = x + way_m * math.cos(angle), y + way_m * math.sin(angle)
        rounded = (round(place[0], 3), round(place[1], 3), thing.place[2])
        self._floor.show(msgspec.structs.replace(thing, place=rounded))

    def _before(self, robot: str, way_m: float, beside_rad: float) -> tuple[float, float, float]:
        """The place that a robot looks at, so far away, and in which direction that is."""
        x, y, theta = self._base(robot)
        state = self.states.get(robot)
        angle = theta + beside_rad + (state.joints.get("HeadYaw", 0.0) if state else 0.0)
        return round(x + way_m * math.cos(angle), 3), round(y + way_m * math.sin(angle), 3), angle

    def _base(self, robot: str) -> tuple[float, float, float]:
        state = self.states.get(robot)
        return state.base if state is not None else (0.0, 0.0, 0.0)


def _id(what: str) -> str:
    return f"visitor_{what}"


SOURCE = "hand"
"""Who tells of a state that no robot has noticed."""

DISTANCES_M: Mapping[str, float] = {"close": 0.7, "middle": 1.5, "far": 2.6}
DOINGS: Mapping[str, tuple[str, dict[str, object]]] = {
    "speaking": ("say", {"text": "Hello"}),
    "moving": ("play", {"animation": "wave"}),
    "listening": ("listen", {"words": [], "seconds": 10}),
    "awake": ("wake_up", {}),
    "aware": ("awareness", {"on": True}),
    "breathing": ("breathing", {"on": True}),
}
"""What a robot is asked for so that it does this."""

SOUND_MS = 1500
"""So long a sound is heard."""
TOLD_BY_HAND = ("word", "face", "ball", "mark", "sound", "touch", "distance")
"""What a program can be told of without a robot that notices it."""


class Stimuli(QObject):
    """``told`` tells what was done, ``refused`` why it could not be, ``changed`` when that may be.

    ``robot`` is who notices what happens when a program does not name one.
    """

    told = Signal(str)
    refused = Signal(str)
    changed = Signal()

    def __init__(
        self,
        runner: Runner,
        visitors: Visitors,
        watch_gestures: Callable[[], Collection[str]],
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._runner, self.visitors = runner, visitors
        self._watch_gestures = watch_gestures
        self.robot = ""
        self.certainty = 1.0
        runner.connected.connect(self.changed)
        runner.disconnected.connect(self.changed)
        runner.state_changed.connect(self.changed)
        runner.nodes_changed.connect(self.changed)

    @property
    def robots(self) -> list[str]:
        """The robots of the project that are on the screen."""
        return [
            str(node.parameters.get("robot", node.name))
            for node in self._runner.planned()
            if node.node.startswith("action/") and node.parameters.get("driver") != "naoqi"
        ]

    @property
    def why_not(self) -> str:
        """Why nobody would notice anything now, "" when somebody would."""
        runner = self._runner
        if runner.is_connected and (runner.state in ("running", "paused") or self._is_there()):
            return ""
        if runner.state == "starting":
            return tr("The program is starting. It will notice you in a moment.")
        return tr("The program does not run, so that nobody would notice it.")

    @property
    def has_watch(self) -> bool:
        """Whether the watch on the screen is there to make gestures."""
        planned = {node.name for node in self._runner.planned() if node.node == VIRTUAL_WATCH}
        nodes = self._runner.board.nodes
        return any(name in nodes and nodes[name].is_there for name in planned)

    def noticing(self, occurrence: Occurrence) -> str:
        """The robot on the screen that notices something; "" when none is there."""
        wanted = self.robot if occurrence.robot in (ALL_ROBOTS, "") else occurrence.robot
        return wanted if self._is_there(wanted) else ""

    def begin(self, occurrence: Occurrence) -> bool:
        """Let something happen; what lasts goes on until ``end``."""
        if reason := self.why_not:
            self.refused.emit(reason)
            return False
        robot = self.noticing(occurrence)
        if occurrence.kind in ("gesture", "arm"):
            return self._movement(occurrence)
        if occurrence.kind in ("emotion", "state"):
            return self._tell(state_of(occurrence), SOURCE, occurrence)
        if not robot:
            # Tell the program what a robot would have noticed; what is measured cannot be told
            if occurrence.kind in TOLD_BY_HAND:
                source = SOURCE if occurrence.robot in (ALL_ROBOTS, "") else occurrence.robot
                return self._tell(state_of(occurrence), source, occurrence)
            named = occurrence.robot if occurrence.robot != ALL_ROBOTS else self.robot
            sentence = tr(
                "{robot} is not on this screen, so that this has to happen to the robot itself.",
                robot=named or tr("The robot"),
            )
            self.refused.emit(sentence)
            return False
        self._let(robot, occurrence)
        return True

    def end(self, occurrence: Occurrence) -> None:
        """Let go, or take away, what was begun."""
        robot = self.noticing(occurrence)
        if occurrence.kind == "touch" and robot:
            self._touch(robot, occurrence.value, 0.0)
        elif occurrence.kind in ("face", "ball", "mark", "distance"):
            self.visitors.go("face" if occurrence.kind == "distance" else occurrence.kind)
        elif occurrence.kind == "sound" and robot:
            self._sense(robot, "sound", 0.0)

    def turn_joint(self, joint: str, degrees: float, robot: str = "") -> bool:
        """Ask a robot to turn one joint."""
        return self._ask(robot, "move_joint", {"joint": joint, "degrees": degrees})

    def measure(self, sensor: str, value: float, robot: str = "") -> bool:
        """Let a sensor measure this: sonar in cm, battery in percent, as in programs."""
        is_share = sensor == "battery" or sensor.startswith("sonar")
        return self._sense(robot, sensor, value / 100.0 if is_share else value)

    def push(self, degrees: float, robot: str = "") -> bool:
        """Push a robot towards a direction, 0 is ahead, 90 to its left, so that it falls."""
        angle = math.radians(degrees)
        place = (math.cos(angle), math.sin(angle), 0.3)
        return self._sense(robot, "push", place=place)

    def make_sound(self, degrees: float, robot: str = "") -> bool:
        """Let a sound come from a direction, 0 is ahead, 90 from the left; it is short."""
        angle, robot = math.radians(degrees), robot or self.robot
        self._sense(robot, "sound", 0.0)
        QTimer.singleShot(SOUND_MS, self, lambda: self._sense(robot, "sound", 0.0))
        return self._sense(robot, "sound", place=(math.cos(angle), math.sin(angle), 0.5))

    def let_measure(self, robot: str = "") -> bool:
        """Let all sensors measure by themselves again."""
        return self._sense(robot, "usual")

    def take_posture(self, posture: str, robot: str = "") -> bool:
        """Ask a robot to take a posture."""
        return self._ask(robot, "do", {"posture": posture})

    # How things happen

    def _let(self, robot: str, occurrence: Occurrence) -> None:
        value, amount = occurrence.value, occurrence.amount
        match occurrence.kind:
            case "word":
                self._sense(robot, "word", name=value or "hello")
            case "touch":
                self._touch(robot, value, 1.0)
            case "face":
                self.visitors.come("face", robot, value)
            case "distance":
                self.visitors.come("face", robot, way_m=DISTANCES_M.get(value, 1.0))
            case "ball" | "mark":
                self.visitors.come(occurrence.kind, robot, value)
            case "sound":
                self.make_sound(30.0, robot)
            case "sensor":
                self.measure(value, amount if amount is not None else 20.0, robot)
            case "joint":
                self.turn_joint(value, amount if amount is not None else 20.0, robot)
            case "posture":
                self.take_posture(value, robot)
            case "doing":
                self._ask(robot, *DOINGS.get(value, ("wake_up", {})))
        self.told.emit(words_of(occurrence))

    def _touch(self, robot: str, part: str, value: float) -> None:
        """Touch the first sensor of a part: one finger touches one place."""
        self._sense(robot, TOUCHES.get(part, (part,))[0], value)

    def _movement(self, occurrence: Occurrence) -> bool:
        """Let the watch on the screen make it, or tell of it where no watch can."""
        is_arm = occurrence.kind == "arm"
        if self.has_watch and (is_arm or occurrence.value in self._watch_gestures()):
            movement = state_of(occurrence) if is_arm else occurrence.value
            is_sent = self._runner.send(m.GESTURE_REQUEST, m.GestureRequest(gesture=movement))
            words = words_of(occurrence) if is_arm else occurrence.words
            self.told.emit(tr("The watch moves: {gesture}", gesture=words))
            return is_sent
        return self._tell(state_of(occurrence), SOURCE, occurrence)

    def _tell(self, state: str, source: str, occurrence: Occurrence) -> bool:
        told = m.HumanBehavior(human_state=state, source=source, certainty=self.certainty)
        if not self._runner.send(m.HUMAN_BEHAVIOR, told):
            return False
        self.told.emit(tr("Told by hand: {what}", what=words_of(occurrence)))
        return True

    def _sense(
        self,
        robot: str,
        sense: str,
        value: float = 1.0,
        name: str = "",
        place: tuple[float, float, float] = (1.0, 0.0, 0.5),
    ) -> bool:
        request = m.SenseRequest(
            robot=robot or self.robot, sense=sense, value=value, name=name, place=place
        )
        return self._runner.send(m.SENSE_REQUEST, request)

    def _ask(self, robot: str, action: str, args: Mapping[str, object]) -> bool:
        robots, new_id = [robot or self.robot], uuid.uuid4().hex
        request = m.ActionRequest(id=new_id, robots=robots, action=action, args=dict(args))
        return self._runner.send(m.ACTION_REQUEST, request)

    def _is_there(self, robot: str = "") -> bool:
        """Whether a robot on the screen runs; any, when none is named."""
        nodes = self._runner.board.nodes
        names = [name for name in self.robots if robot in ("", name)]
        return any(name in nodes and nodes[name].is_there for name in names)

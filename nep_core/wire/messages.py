"""The messages that nodes exchange, as validated data.

A message travels as one JSON object (see frames.py). Keys that a receiver does not know are
ignored; a key that is missing, or of another type, is an error that names it.
Times are seconds since 1970 (``time.time()``), angles rad, lengths m, unless a name says else.
"""

from __future__ import annotations

import time
from typing import Any, Literal

import msgspec

from faults import MOST_STEPS, Fault, Words, heard, plain, text_of, verbatim

LONGEST_NAME = 100
"""So many letters the name of a node has at most."""

NODE_STATE = "/node_state"
IMU = "/imu"
HUMAN_BEHAVIOR = "/human_behavior"
ACTION_REQUEST = "/action_request"
ACTION_RESULT = "/action_result"
ROBOT_STATE = "/robot_state"
PROGRAM_STATE = "/program_state"
PROGRAM_CONTROL = "/program_control"
GESTURE_REQUEST = "/gesture_request"
SENSE_REQUEST = "/sense_request"
SURROUNDINGS = "/surroundings"
EXPECTED_WORDS = "/expected_words"

NodeType = Literal["sensory", "perceptual", "cognitive", "action"]
Working = Literal["starting", "ready", "running", "busy"]
Connection = Literal["connecting", "connected", "connection_failed", "disconnected"]
NodeEvent = Literal[Working, Connection, "alive", "warning", "stopped", "crashed"]
ActionState = Literal["accepted", "started", "done", "failed", "cancelled"]
RuleStep = Literal["rule_started", "rule_finished", "rule_failed"]
GoalStep = Literal[
    "goal_started", "goal_finished", "goal_stopped", "goal_interrupted", "goal_failed"
]
StateStep = Literal["state_entered"]
PlanTold = Literal["plan_made", "plan_step", "plan_step_failed", "plan_done"]
Pause = Literal["paused", "resumed"]
Course = Literal["started", "line", "value", "tree", "warning", "finished", "failed"]
ProgramEvent = Literal[Course, RuleStep, GoalStep, StateStep, PlanTold, Pause]

PROCESS_ENDED = "process_ended"
PROCESS_RESTARTS = "process_restarts"
PROCESS_STOPPED = "process_stopped"
"""Codes of what is told for a node that has ended, by who started it."""

DISPLACED = "displaced"
"""The code of an action that has made way for a more important one."""
REST = "rest_"
"""So begin the names of those values of a result that are arguments for the rest of the way."""

LONGEST_SOURCE = 60
"""So much of a sensor's name is told."""

ThingKind = Literal["person", "ball", "wall", "mark"]
Wrist = Literal["", "left", "right", "hand"]
ProgramCommand = Literal["start", "stop", "pause", "resume", "step", "set"]


class Described(msgspec.Struct, kw_only=True, omit_defaults=True):
    """Says what happened: in English, and as data for who tells it in another language, or asks.

    ``description`` is the whole sentence. ``code`` says in words joined by low lines what
    happened; ``text`` is the sentence with places, ``values`` fill them; ``checklist`` is what to
    try. The last four may be missing or be anything, for others write them too: ask ``fault``.
    """

    description: str = ""
    code: Any = ""
    text: Any = ""
    values: Any = {}
    checklist: Any = []

    @property
    def fault(self) -> Fault:
        """What happened; where only a description came, that, as it is."""
        if isinstance(self.text, str) and self.text:
            # The values of a program's state are those of its variables
            values = getattr(self, "text_values", self.values)
            sentence = heard({"text": self.text, "values": values})
        else:
            sentence = verbatim(self.description)
        steps = self.checklist if isinstance(self.checklist, list) else []
        code = self.code if isinstance(self.code, str) else ""
        return Fault(code, sentence, tuple(map(heard, steps[:MOST_STEPS])))


def described(fault: Fault) -> dict[str, Any]:
    """The keys of a message that says what happened."""
    return {
        "description": plain(fault.sentence),
        "code": fault.code,
        "text": fault.sentence.text,
        "values": fault.sentence.values,
        "checklist": [step if step.values else step.text for step in fault.checklist],
    }


class NodeState(Described, kw_only=True, omit_defaults=True):
    """How a node is doing (``/node_state``); ``alive`` is its heartbeat, once a second.

    ``measures`` are numbers by name that it measures about itself: ``rate_hz``, ``latency_ms``,
    ``load`` (a share of a core), ``certainty.karate``; they come at most twice a second.
    """

    node: str
    type: NodeType
    event: NodeEvent
    measures: dict[str, float] = {}
    pid: int = 0
    host: str = ""
    time: float = msgspec.field(default_factory=time.time)


class Imu(msgspec.Struct, kw_only=True, omit_defaults=True):
    """A batch of n samples of a watch or phone (``/imu``).

    ``t`` is n seconds on the sensor's own clock, rising; ``acc`` is n rows of 3 in m/s²;
    ``gyr`` is n rows of 3 in rad/s, or absent where the sensor has no gyroscope. ``wrist`` is
    where the sensor is worn, "hand" when it is held, "" when nobody said. ``person`` is which
    simulated person wears it, from 0; -1 when it is a real one.
    """

    source: str
    rate_hz: float
    t: list[float]
    acc: list[tuple[float, float, float]]
    gyr: list[tuple[float, float, float]] | None = None
    gravity_included: bool = True
    simulated: bool = False
    person: int = -1
    wrist: Wrist = ""

    @property
    def sender(self) -> Words:
        """What the source is called where people read it."""
        if self.person < 0:
            return self.source[:LONGEST_SOURCE]
        return text_of("simulated person {number}", number=self.person)


class HumanBehavior(msgspec.Struct, kw_only=True, omit_defaults=True):
    """What a person does (``/human_behavior``): ``gesture_karate``, ``touched_head``, any word."""

    human_state: str
    certainty: float = 1.0
    source: str = ""
    time: float = msgspec.field(default_factory=time.time)


class ActionRequest(msgspec.Struct, kw_only=True, omit_defaults=True):
    """What robots are asked to do (``/action_request``).

    The same ``id`` sent again asks how the action is doing: it is never played twice. What has a
    higher ``priority`` takes the limbs that it needs from what has a lower one; ``by`` is what the
    rule or goal that asks is called.
    """

    id: str
    robots: list[str]
    action: str
    args: dict[str, Any] = {}
    priority: int = 0
    by: str = ""


class ActionResult(Described, kw_only=True, omit_defaults=True):
    """How a requested action is going on one robot (``/action_result``).

    One that is "cancelled" with the ``code`` DISPLACED has made way for something more important;
    of a cancelled walk or turn, the values ``rest_forward_m``, ``rest_degrees`` and so on are the
    arguments for the rest of its way.
    """

    id: str
    robot: str
    state: ActionState
    time: float = msgspec.field(default_factory=time.time)


class RobotState(msgspec.Struct, kw_only=True, omit_defaults=True):
    """Where a robot's body is (``/robot_state``); 30 Hz while it moves, 1 Hz at rest.

    ``joints`` are rad by joint name (hands 0 to 1); ``base`` is x m, y m, theta rad on the floor;
    ``leds`` are 0xRRGGBB by group; ``battery`` is 0 to 1. ``sensors`` are numbers by name, in m,
    m/s², rad/s, kg and A, touch sensors 0 or 1. ``sees`` is where things are that it sees or hears
    ("face", "face_anna", "ball", "sound", "mark_64"): x, y, z m in front of, left of, above its
    feet. ``settings`` are how it is set: volume, language, awake, ... ``listening`` are the words
    that it waits for. ``torso`` is where the torso is above the floor: x, y, z m, and roll, pitch,
    yaw rad, turned about z, then y, then x; None when that is not known. ``fallen``: it lies there
    because it lost its balance. ``model`` is which robot it is: the name of its folder in
    resources/robots, or a path to one's own; "" is a NAO.
    """

    robot: str
    joints: dict[str, float]
    model: str = ""
    base: tuple[float, float, float] = (0.0, 0.0, 0.0)
    posture: str = ""
    leds: dict[str, int] = {}
    saying: str = ""
    moving: bool = False
    battery: float = 1.0
    sensors: dict[str, float] = {}
    sees: dict[str, tuple[float, float, float]] = {}
    settings: dict[str, bool | float | str] = {}
    listening: list[str] = []
    torso: tuple[float, float, float, float, float, float] | None = None
    fallen: bool = False
    time: float = msgspec.field(default_factory=time.time)


class PlannedStep(msgspec.Struct, frozen=True):
    """A step of a plan: the function of the program that is its task, and its values in order."""

    task: str
    values: list[str | int | float | bool] = []


class ProgramState(Described, kw_only=True, omit_defaults=True):
    """What the cognitive program is doing (``/program_state``).

    ``line`` is a line of the generated file, from 1; ``rule`` the state that a rule waits for,
    or the name of a goal, or the state of the program that is entered, by the state ``machine`` of
    this name, which is empty where there is one. A "line" event tells of
    all threads at once: ``lines`` are, by thread, the lines that it is in now, the outermost
    call first; one that is not there has ended. A "value" event tells the ``values`` that
    changed, by the name of the variable, as Python; what fills the places of ``text`` is in
    ``text_values`` here. "rule_failed" tells that a rule, a goal or a start ended with an
    error, "warning" what a person should look at; the program goes on.
    The events of a plan bring the whole ``plan``, and in ``rule`` what it shall reach, in words;
    "plan_step" and "plan_step_failed" tell which ``step`` of it runs or has failed, from 1.
    A "tree" event tells the ``nodes`` of the behaviour tree ``rule`` that changed, by their line:
    "idle", "running", "succeeded" or "failed".
    """

    program: str
    event: ProgramEvent
    line: int = 0
    lines: dict[str, list[int]] = {}
    values: dict[str, str] = {}
    nodes: dict[str, str] = {}
    text_values: Any = {}
    rule: str = ""
    machine: str = ""
    thread: str = ""
    plan: list[PlannedStep] = []
    step: int = 0
    time: float = msgspec.field(default_factory=time.time)


def told(fault: Fault | None) -> dict[str, Any]:
    """The keys of a ProgramState that says what happened: its values are those of variables."""
    keys = described(fault) if fault is not None else {}
    keys["text_values"] = keys.pop("values", {})
    return keys


class ProgramControl(msgspec.Struct, kw_only=True, omit_defaults=True):
    """What a running program is asked to do (``/program_control``).

    "step" runs one line more of the paused ``thread``, "" of every one that is paused. "set"
    says how the program is watched from now on: it pauses at the lines ``breakpoints``, and
    waits ``line_s`` seconds at each line, which is slow motion.
    """

    command: ProgramCommand
    program: str = ""
    thread: str = ""
    breakpoints: list[int] = []
    line_s: float = 0.0


class GestureRequest(msgspec.Struct, kw_only=True, omit_defaults=True):
    """Asks the virtual watch to make a gesture (``/gesture_request``); person -1 is anybody."""

    gesture: str
    person: int = -1


class SenseRequest(msgspec.Struct, kw_only=True, omit_defaults=True):
    """Lets a virtual robot feel, see or hear something (``/sense_request``).

    ``sense`` is a sensor ("head_front", "sonar_left", "battery"), which gets the ``value``; or
    "face", "ball", "sound" or "mark", there while ``value`` is above 0, at ``place`` (x, y, z m
    from its feet), a face or mark with a ``name``; or "word", with the ``name`` that was said. Or
    hands: "push" towards a ``place``; "place" puts it down there (x, y m, theta rad on the floor).
    "usual": all sensors measure by themselves again.
    """

    robot: str
    sense: str
    value: float = 1.0
    name: str = ""
    place: tuple[float, float, float] = (1.0, 0.0, 0.5)


class Thing(msgspec.Struct, kw_only=True, omit_defaults=True, frozen=True):
    """Something that stands on the floor near virtual robots.

    ``place`` is x, y m on the floor and z m, how high it is above it (a ball on a table);
    ``heading`` rad is where a person or a mark faces, and a wall's front. ``size`` is how wide,
    deep and high it is, m. ``name`` is a person's, or a mark's number.
    """

    id: str
    kind: ThingKind
    place: tuple[float, float, float]
    heading: float = 0.0
    size: tuple[float, float, float] = (0.4, 0.3, 1.7)
    name: str = ""


class Surroundings(msgspec.Struct, kw_only=True):
    """All that stands around virtual robots (``/surroundings``), each time that it changes.

    Robots notice by themselves what is near enough and in sight.
    """

    things: list[Thing]


class ExpectedWords(msgspec.Struct, kw_only=True):
    """The words that rules of a program wait for (``/expected_words``).

    Real robots hear only words that they listen for.
    """

    words: list[str]


BY_TOPIC: dict[str, type[msgspec.Struct]] = {
    NODE_STATE: NodeState,
    IMU: Imu,
    HUMAN_BEHAVIOR: HumanBehavior,
    ACTION_REQUEST: ActionRequest,
    ACTION_RESULT: ActionResult,
    ROBOT_STATE: RobotState,
    PROGRAM_STATE: ProgramState,
    PROGRAM_CONTROL: ProgramControl,
    GESTURE_REQUEST: GestureRequest,
    SENSE_REQUEST: SenseRequest,
    SURROUNDINGS: Surroundings,
    EXPECTED_WORDS: ExpectedWords,
}

LATCHED = frozenset({NODE_STATE, ROBOT_STATE, SURROUNDINGS, EXPECTED_WORDS})
"""Topics whose last message a late joiner gets."""

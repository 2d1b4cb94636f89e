"""A recording without hands: a countdown, then takes that are found by themselves and counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.wire.messages import GESTURE_REQUEST, GestureRequest
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import VIRTUAL_WATCH
from nep_studio.ui.words import count_words, tr
from nodes.perceptual.recognition.segments import Movement, PerformanceFinder
from nodes.sensory.arm.gestures import GESTURES, MAKES_GESTURE

from .curves import fault_words
from .gesture_controller import GestureController
from .live import Samples, joined

State = Literal["idle", "countdown", "takes", "everyday"]
Ending = Literal["complete", "stopped", "lost", "late"]
"""Why it ended: all takes are there, a person stopped it, the sensor fell silent, it grew long."""

WANTED_TAKES = 5
COUNTED_FROM = 3
COUNT_MS = 800
EARLY_S = 0.4
"""Who is quick begins a moment before the countdown ends; that is part of the recording."""
CALM_S = 1.0
"""So much rest is kept behind the last take."""
KNOWN_S = 3.0
"""From so long before the recording it is known what rest is."""
LONGEST_S = 120.0
LOOK_MS = 250
_REACHING_S = 0.3
"""A movement that goes on until a person stops the recording is that of reaching for the key."""


@dataclass(frozen=True)
class RecordingSession:
    """What was recorded: the samples, and the movements that were found in them."""

    gesture: str
    samples: Samples
    movements: tuple[Movement, ...]
    ending: Ending

    @property
    def takes(self) -> list[tuple[float, float]]:
        """Where the good movements are."""
        return [(one.start_s, one.end_s) for one in self.movements if not one.fault]

    @property
    def forgotten(self) -> list[tuple[float, float]]:
        """Where movements are that are neither takes nor rest."""
        return [(one.start_s, one.end_s) for one in self.movements if one.fault]


@dataclass
class _Run:
    """What is recorded now."""

    gesture: str
    source: str
    wanted: float
    finder: PerformanceFinder = field(default_factory=PerformanceFinder)
    editor: object = None
    parts: list[Samples] = field(default_factory=list)
    movements: list[Movement] = field(default_factory=list)
    start_s: float = 0.0

    @property
    def taken(self) -> int:
        """How many good takes there are."""
        return sum(not one.fault for one in self.movements)


class TakeSession(QObject):
    """Counts down, records, and ends by itself.

    ``changed``: its state, the count or the progress. ``movement_found`` gives a Movement, also
    one that does not count. ``ended`` gives the RecordingSession; ``everyday_ended`` the Samples.
    """

    changed = Signal()
    movement_found = Signal(object)
    ended = Signal(object)
    everyday_ended = Signal(object)

    def __init__(self, controller: GestureController, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._controller = controller
        self.state: State = "idle"
        self.count = 0
        """What the countdown says."""
        self._run = _Run("", "", 0)
        self._counting = QTimer(self, interval=COUNT_MS)
        self._counting.timeout.connect(self._on_counted)
        self.counts: Callable[[Movement], bool] = lambda _movement: True
        """Whether a movement may be a take: of a simulated person it is known."""
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._on_look)
        controller.heard.connect(self._on_heard)
        controller.changed.connect(self._on_project_changed)

    # What is going on

    @property
    def is_on(self) -> bool:
        """Whether something is recorded, or about to be."""
        return self.state != "idle"

    @property
    def gesture(self) -> str:
        """The gesture that is recorded; "" for everyday movement."""
        return self._run.gesture

    @property
    def wanted(self) -> int:
        """How many takes there are to be."""
        return round(self._run.wanted)

    @property
    def taken(self) -> int:
        """How many takes were found that count."""
        return self._run.taken

    @property
    def movements(self) -> list[Movement]:
        """All that was found."""
        return self._run.movements

    @property
    def start_s(self) -> float | None:
        """When the recording began, on the sensor's clock; None before it did."""
        return self._run.start_s if self.state in ("takes", "everyday") else None

    @property
    def is_moving(self) -> bool:
        """Whether a movement goes on."""
        return self.state == "takes" and self._run.finder.is_moving

    @property
    def share(self) -> float:
        """How much of the everyday recording is there."""
        live = self._controller.live
        if self.state != "everyday" or live is None or self._run.wanted <= 0:
            return 0.0
        return min(1.0, max(0.0, (live.last_t - self._run.start_s) / self._run.wanted))

    # What is asked

    def start(self, gesture: str, wanted: int = WANTED_TAKES) -> bool:
        """Record takes of a gesture after a countdown; False while no sensor is heard."""
        return self._begin(gesture, wanted)

    def start_everyday(self, seconds: float) -> bool:
        """Record everyday movement after a countdown; False while no sensor is heard."""
        return self._begin("", seconds)

    def stop(self) -> None:
        """End now; what is there is kept. A countdown is called off."""
        if self.state == "countdown":
            self._rest()
        elif self.state == "takes":
            self._end("stopped")
        elif self.state == "everyday":
            self._end_everyday()

    def cancel(self) -> None:
        """End now and keep nothing."""
        if self.is_on:
            self._rest()

    def skip_countdown(self) -> None:
        """Record at once."""
        if self.state == "countdown":
            self._go()

    # Within

    def _begin(self, gesture: str, wanted: float) -> bool:
        live = self._controller.live
        if self.is_on or live is None or not self._controller.is_hearing:
            return False
        self._run = _Run(gesture, live.source, wanted, editor=self._controller.editor)
        self.state, self.count = "countdown", COUNTED_FROM
        self._counting.start()
        self._looking.start()
        self.changed.emit()
        return True

    def _on_counted(self) -> None:
        self.count -= 1
        if self.count > 0:
            self.changed.emit()
        else:
            self._go()

    def _go(self) -> None:
        """Record from now on, and from a moment before."""
        self._counting.stop()
        live, run = self._controller.live, self._run
        if live is None:
            self._rest()
            return
        is_everyday = not run.gesture
        run.start_s = live.last_t if is_everyday else live.last_t - EARLY_S
        before = live.last(KNOWN_S)
        self.state = "everyday" if is_everyday else "takes"
        if not is_everyday and len(before):
            run.parts.append(before.between(run.start_s, live.last_t))
            self._note(run.finder.hear(before.t, before.acc, before.gyr))
        self.changed.emit()

    def _on_heard(self, samples: Samples) -> None:
        if self.state not in ("takes", "everyday") or self._is_another():
            return
        run = self._run
        run.parts.append(samples)
        if self.state == "everyday":
            self.changed.emit()
            if samples.t[-1] - run.start_s >= run.wanted:
                self._end_everyday()
            return
        self._note(run.finder.hear(samples.t, samples.acc, samples.gyr))
        if self.state == "takes" and samples.t[-1] - run.start_s > LONGEST_S:
            self._end("late")

    def _note(self, found: list[Movement]) -> None:
        """Count what was found; the last take that is wanted ends the recording."""
        run = self._run
        for movement in found:
            if movement.start_s < run.start_s or run.taken >= run.wanted:
                continue
            if not self.counts(movement):
                continue
            run.movements.append(movement)
            self.movement_found.emit(movement)
            self.changed.emit()
        if run.taken >= run.wanted:
            self._end("complete")

    def _on_project_changed(self) -> None:
        """What is recorded for a project is nothing for another one."""
        if self._controller.editor is not self._run.editor:
            self.cancel()

    def _is_another(self) -> bool:
        return self._controller.live is None or self._controller.live.source != self._run.source

    def _on_look(self) -> None:
        """End when the sensor has fallen silent; what is there is kept."""
        if self._controller.is_hearing and not self._is_another():
            return
        if self.state == "takes":
            self._end("lost")
        elif self.state == "everyday":
            self._end_everyday()
        else:
            run = self._run
            self._rest()
            self.ended.emit(RecordingSession(run.gesture, Samples.none(), (), "lost"))

    def _end(self, ending: Ending) -> None:
        run, samples = self._run, joined(self._run.parts)
        last_s = float(samples.t[-1]) if len(samples) else 0.0
        for movement in run.finder.finish():
            is_reaching = movement.end_s > last_s - _REACHING_S
            is_counted = movement.start_s >= run.start_s and run.taken < run.wanted
            if is_counted and not is_reaching and self.counts(movement):
                run.movements.append(movement)
                self.movement_found.emit(movement)
            elif is_reaching:
                last_s = min(last_s, movement.start_s)
        ends = [one.end_s + CALM_S for one in run.movements]
        samples = samples.between(run.start_s, min(last_s, max(ends, default=last_s)))
        self._rest()
        self.ended.emit(RecordingSession(run.gesture, samples, tuple(run.movements), ending))

    def _end_everyday(self) -> None:
        samples = joined(self._run.parts)
        self._rest()
        self.everyday_ended.emit(samples)

    def _rest(self) -> None:
        self._counting.stop()
        self._looking.stop()
        self.state, self.count = "idle", 0
        self.changed.emit()


# What came of a recording, in words.


def session_words(session: RecordingSession) -> str:
    """How many takes there are now, and why others do not count."""
    count = len(session.takes)
    said = [count_words(count, "1 take is kept.", "{n} takes are kept.")] if count else []
    for fault, times in Counter(one.fault for one in session.movements if one.fault).items():
        words = count_words(
            times,
            "1 movement does not count: {reason}.",
            "{n} movements do not count: {reason}.",
            reason=fault_words(fault),
        )
        said.append(words)
    if session.ending == "lost":
        said.insert(0, tr("The watch or phone fell silent, so the recording ended."))
    elif session.ending == "late":
        said.insert(0, tr("The recording ended after two minutes."))
    if not count and session.ending != "lost":
        said.append(tr("No take was found. Rest, make the movement clearly, and rest again."))
    return " ".join(said)


def everyday_words(samples: Samples, is_kept: bool) -> str:
    """How much everyday movement is kept."""
    if not is_kept:
        return tr("Nothing was recorded: the watch or phone is silent.")
    return tr("{seconds} s of everyday movement are kept.", seconds=round(samples.seconds))


# Lets the simulated person make the gesture that is recorded, so that nobody needs a watch.

SIMULATED_LOOK_MS = 200
REST_S = 0.2
BEGUN_S = 3.0
"""After so long a movement that was asked for is over, if it began at once; in 3 s of rest the
watch would go on with gestures of its own."""
LATE_S = 0.3
"""So much later than the movement it may be heard what it is."""


class SimulatedWearer(QObject):
    """Asks for a movement at each rest of a recording, as long as it hears the virtual watch."""

    def __init__(self, controller: GestureController, session: TakeSession) -> None:
        super().__init__(session)
        self._controller, self._session = controller, session
        self._asked_s = self._moved_s = 0.0
        self._made: list[float] = []
        self._looking = QTimer(self, interval=SIMULATED_LOOK_MS)
        self._looking.timeout.connect(self._look)
        session.counts = self._counts
        session.changed.connect(self._on_session_changed)

    @property
    def is_there(self) -> bool:
        """Whether what is heard is a simulated person, who does as they are asked."""
        live = self._controller.live
        return live is not None and live.simulated and self._watch is not None

    def movement_for(self, gesture: str) -> str:
        """What the person makes for a gesture: that of this name, else one that is free."""
        own = self._controller.gestures
        known = list(GESTURES)
        if gesture in known or gesture not in own:
            return gesture
        free = [name for name in known if name not in own] or known
        return free[own[gesture].number % len(free)]

    @property
    def _watch(self) -> NodeStatus | None:
        runner = self._controller.runner
        planned = [node.name for node in runner.planned() if node.node == VIRTUAL_WATCH]
        nodes = runner.board.nodes
        return next(
            (nodes[name] for name in planned if name in nodes and nodes[name].is_there), None
        )

    def _counts(self, movement: Movement) -> bool:
        """Whether the person said to make the gesture then; of real people nobody knows."""
        if not self._looking.isActive():
            return True
        start_s, end_s = movement.start_s, movement.end_s + LATE_S
        return any(start_s + LATE_S < made_s < end_s for made_s in self._made)

    def _on_session_changed(self) -> None:
        is_asked = self._session.state == "takes" and self.is_there
        if is_asked and not self._looking.isActive():
            self._asked_s = self._moved_s = 0.0
            self._made = []
            self._looking.start()
            self._look()
        elif not is_asked:
            self._looking.stop()

    def _look(self) -> None:
        """Note what the person makes, and ask once it is over."""
        now_s, live, watch = self._controller.now(), self._controller.live, self._watch
        movement = self.movement_for(self._session.gesture)
        if live is None or watch is None:
            return
        told = watch.fault
        if told.code == MAKES_GESTURE and told.values.get("gesture") == movement:
            self._made.append(live.last_t)
        if self._session.is_moving:
            self._moved_s = now_s
        elif now_s - self._moved_s >= REST_S and now_s - self._asked_s >= BEGUN_S:
            self._asked_s = now_s
            self._controller.runner.send(GESTURE_REQUEST, GestureRequest(gesture=movement))

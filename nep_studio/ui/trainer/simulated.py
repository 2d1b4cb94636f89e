"""Lets the simulated person make the gesture that is recorded, so that nobody needs a watch."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer

from nep_core.messages import GESTURE_REQUEST, GestureRequest
from nep_studio.node_board import NodeStatus
from nep_studio.plan import VIRTUAL_WATCH
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.session import TakeSession
from nodes.perceptual.recognition.segments import Movement
from nodes.sensory.arm.gestures import GESTURES

LOOK_MS = 200
REST_S = 0.2
BEGUN_S = 3.0
"""After so long a movement that was asked for is over, if it began at once; in 3 s of rest the
watch would go on with gestures of its own."""
LATE_S = 0.3
"""So much later than the movement it may be heard what it is."""
MADE = "makes the gesture {} "
"""What the virtual watch tells while a gesture is made."""


class SimulatedWearer(QObject):
    """Asks for a movement at each rest of a recording, as long as it hears the virtual watch."""

    def __init__(self, desk: TrainerDesk, session: TakeSession) -> None:
        super().__init__(session)
        self._desk, self._session = desk, session
        self._asked_s = self._moved_s = 0.0
        self._made: list[float] = []
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._look)
        session.counts = self._counts
        session.changed.connect(self._on_session_changed)

    @property
    def is_there(self) -> bool:
        """Whether what is heard is a simulated person, who does as they are asked."""
        live = self._desk.live
        return live is not None and live.simulated and self._watch is not None

    def movement_for(self, gesture: str) -> str:
        """What the person makes for a gesture: that of this name, else one that is free."""
        own = self._desk.gestures
        known = list(GESTURES)
        if gesture in known or gesture not in own:
            return gesture
        free = [name for name in known if name not in own] or known
        return free[own[gesture].number % len(free)]

    @property
    def _watch(self) -> NodeStatus | None:
        runner = self._desk.runner
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
        now_s, live, watch = self._desk.now(), self._desk.live, self._watch
        movement = self.movement_for(self._session.gesture)
        if live is None or watch is None:
            return
        if watch.description.startswith(MADE.format(movement)):
            self._made.append(live.last_t)
        if self._session.is_moving:
            self._moved_s = now_s
        elif now_s - self._moved_s >= REST_S and now_s - self._asked_s >= BEGUN_S:
            self._asked_s = now_s
            self._desk.runner.send(GESTURE_REQUEST, GestureRequest(gesture=movement))

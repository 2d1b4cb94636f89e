"""Lets the simulated person make the gesture that is recorded, so that nobody needs a watch."""

from __future__ import annotations

from PySide6.QtCore import QObject, QTimer

from nep_core.messages import GESTURE_REQUEST, GestureRequest
from nep_studio.plan import VIRTUAL_WATCH
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.session import TakeSession
from nodes.sensory.arm.gestures import GESTURES

LOOK_MS = 200
REST_S = 1.6
"""Takes need a rest between them; after 3 s the watch would go on with gestures of its own."""
BEGUN_S = 2.5
"""After so long a movement that was asked for has begun."""


class SimulatedWearer(QObject):
    """Asks for a movement at each rest of a recording, as long as it hears the virtual watch."""

    def __init__(self, desk: TrainerDesk, session: TakeSession) -> None:
        super().__init__(session)
        self._desk, self._session = desk, session
        self._asked_s = self._moved_s = 0.0
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._look)
        session.changed.connect(self._on_session_changed)

    @property
    def is_there(self) -> bool:
        """Whether what is heard is a simulated person, who does as they are asked."""
        live, runner = self._desk.live, self._desk.runner
        if live is None or not live.simulated:
            return False
        planned = [node.name for node in runner.planned() if node.node == VIRTUAL_WATCH]
        nodes = runner.board.nodes
        return any(name in nodes and nodes[name].is_there for name in planned)

    def movement_for(self, gesture: str) -> str:
        """What the person makes for a gesture: that of this name, else one that is free."""
        own = self._desk.gestures
        known = list(GESTURES)
        if gesture in known or gesture not in own:
            return gesture
        free = [name for name in known if name not in own] or known
        return free[own[gesture].number % len(free)]

    def _on_session_changed(self) -> None:
        is_asked = self._session.state == "takes" and self.is_there
        if is_asked and not self._looking.isActive():
            self._asked_s = self._moved_s = 0.0
            self._looking.start()
            self._look()
        elif not is_asked:
            self._looking.stop()

    def _look(self) -> None:
        """Ask once the person has rested."""
        now_s = self._desk.now()
        if self._session.is_moving:
            self._moved_s = now_s
        elif now_s - self._moved_s >= REST_S and now_s - self._asked_s >= BEGUN_S:
            self._asked_s = now_s
            movement = self.movement_for(self._session.gesture)
            self._desk.runner.send(GESTURE_REQUEST, GestureRequest(gesture=movement))

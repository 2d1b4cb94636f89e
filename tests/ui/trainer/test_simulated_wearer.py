"""The simulated person makes what is recorded; its other movements are no takes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QObject

from faults import Fault, fault_of
from nep_core.wire.messages import Imu, NodeState, described
from nep_studio.run.plan import VIRTUAL_WATCH, PlannedNode
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.page import TrainerPage
from nep_studio.ui.running.runner import Heard, Runner
from nodes.perceptual.recognition.segments import Movement
from nodes.sensory.arm.gestures import MAKES_GESTURE

pytestmark = pytest.mark.long


class AskedRunner(Runner):
    """Plans a virtual watch, and notes which gestures it is asked for."""

    def __init__(self, owner: QObject, logs: Path) -> None:
        super().__init__(lambda: [PlannedNode(VIRTUAL_WATCH, "watch", {})], owner, logs=logs)
        self.asked: list[str] = []

    def send(self, topic: str, message: object) -> bool:
        self.asked.append(message.gesture)
        return True

    def tell(self, told: Fault) -> None:
        """What the virtual watch would tell."""
        state = NodeState(node="watch", type="sensory", event="running", pid=7, **described(told))
        self.board.update(state)


@pytest.fixture
def asked(page: TrainerPage, desk: GestureController, tmp_path: Path) -> AskedRunner:
    """The simulated person rests, and is heard."""
    made = AskedRunner(desk.parent(), tmp_path / "logs")
    desk.runner.close()
    desk.runner = made
    made.tell(fault_of("goes on with everyday movement"))
    t = np.arange(100) / 50.0
    message = Imu(
        source="simulated person 100",
        rate_hz=50.0,
        t=t.tolist(),
        acc=[[0.0, 0.0, 9.8]] * len(t),
        simulated=True,
    )
    desk.hear([Heard(desk.now(), message, "watch")])
    return made


def test_the_simulated_person_is_asked_for_the_gesture_that_is_recorded(
    page: TrainerPage, asked: AskedRunner
) -> None:
    name = page.keeping.new_gesture("karate")

    page.record(name)
    assert page.bar.words.text() == "The simulated person makes the movement karate."
    assert not asked.asked
    page.session.skip_countdown()

    assert asked.asked == ["karate"]
    page.session.cancel()


def test_for_a_name_that_it_does_not_know_it_makes_a_movement_that_is_free(
    page: TrainerPage, asked: AskedRunner
) -> None:
    page.keeping.new_gesture("batting")
    name = page.keeping.new_gesture("Wave")

    made = page.simulated.movement_for(name)

    assert made in ("hand_up", "karate", "katana", "strech_up")
    assert page.simulated.movement_for(name) == made


def test_what_it_does_between_the_gestures_is_no_take(
    page: TrainerPage, desk: GestureController, asked: AskedRunner
) -> None:
    page.record(page.keeping.new_gesture("karate"))
    page.session.skip_countdown()
    now_s = desk.live.last_t
    during = Movement(now_s - 1.0, now_s + 1.0, 1.0)

    assert not page.session.counts(during)

    asked.tell(fault_of("macht die Geste {gesture}", code=MAKES_GESTURE, gesture="karate"))
    page.simulated._look()
    assert page.session.counts(during)
    assert not page.session.counts(Movement(now_s + 2.0, now_s + 3.0, 1.0))
    page.session.cancel()
    assert page.session.counts(Movement(now_s + 2.0, now_s + 3.0, 1.0))

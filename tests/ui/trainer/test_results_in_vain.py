"""What a training learned, but the project cannot or does not want to have."""

from __future__ import annotations

from msgspec.structs import replace
from pytestqt.qtbot import QtBot

from nep_studio.blocks.own_gestures import keep_gesture
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from tests.ui.trainer.results_controller import desk, look
from tests.ui.trainer.test_results_training import LEARNS, MakeTraining, make_training, recorded

__all__ = ["desk", "look", "make_training", "recorded"]


def test_a_step_that_is_undone_while_it_trains_can_be_redone(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot
) -> None:
    training = make_training("    pass\n")
    karate = recorded.gestures["karate"]
    fewer = keep_gesture("karate", replace(karate, takes=karate.takes[:-1]))
    recorded.change("delete a take", [fewer])
    training.train()
    qtbot.waitUntil(lambda: training._is_asked)

    recorded.editor.history.undo()
    recorded.refresh()

    assert not training.is_training
    assert recorded.editor.history.redo_label == "delete a take"


def test_what_is_too_large_for_the_project_is_not_told_as_learned(
    recorded: GestureController, make_training: MakeTraining, qtbot: QtBot
) -> None:
    training = make_training(LEARNS.replace('b"a model"', "bytes(7_000_000)"))

    with qtbot.assertNotEmitted(training.trained):
        training.train()
        qtbot.waitUntil(lambda: not training.is_training)

    assert recorded.recogniser is None

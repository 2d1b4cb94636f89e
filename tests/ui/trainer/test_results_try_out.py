"""Trying gestures out: simulated movement through a real recogniser, as from a sensor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import Imu
from nep_studio.blocks.own_gestures import OwnGesture, keep_gesture, keep_recogniser
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.plugins.gestures.results.band import band_of, in_words
from nep_studio.ui.plugins.gestures.results.certainties import Certainties, CertaintyHistory
from nep_studio.ui.plugins.gestures.results.training import Training
from nep_studio.ui.plugins.gestures.results.try_out import TryOut
from nep_studio.ui.running.runner import Heard
from nodes.recordings import Recording
from nodes.sensory.arm.people import perform
from tests.ui.trainer.results_controller import desk, look
from tests.ui.trainer.results_material import samples_of, spans_of
from tests.ui.trainer.results_model import GESTURES, small_model, small_recogniser

pytestmark = pytest.mark.long

__all__ = ["desk", "look"]

Play = Callable[..., None]


@pytest.fixture
def trained(desk: GestureController) -> GestureController:
    """The desk of a project that has learned two gestures."""
    edits = [
        keep_gesture(name, OwnGesture(name.capitalize(), at)) for at, name in enumerate(GESTURES)
    ]
    desk.change("train the gestures", [*edits, keep_recogniser(small_recogniser())])
    return desk


@pytest.fixture
def play(desk: GestureController) -> Play:
    """Lets the desk hear a recording, in batches of a tenth of a second."""

    def do(recording: Recording, begin_s: float = 0.0) -> None:
        edges = [*range(0, len(recording.t), 5), len(recording.t)]
        for first, end in pairwise(edges):
            part = slice(first, end)
            message = Imu(
                source="watch",
                rate_hz=50.0,
                t=(recording.t[part] + begin_s).tolist(),
                acc=recording.acc[part].tolist(),
                gyr=recording.gyr[part].tolist(),
            )
            desk.hear([Heard(0.0, message, "node")])

    return do


@pytest.fixture
def try_out(
    desk: GestureController, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> Iterator[TryOut]:
    """What flashes is not over before a busy computer has looked at it."""
    monkeypatch.setattr("nep_studio.ui.plugins.gestures.results.try_out.FLASH_MS", 60_000)
    training = Training(desk, command=lambda: ["/no/such/program"])
    made = TryOut(desk, training)
    qtbot.addWidget(made)
    made.resize(400, 900)
    made.show()
    yield made
    made.hide()
    training.close()


@pytest.fixture
def tried(trained: GestureController, try_out: TryOut, play: Play, qtbot: QtBot) -> TryOut:
    """Somebody has made the gesture karate."""
    qtbot.waitUntil(lambda: try_out.model is not None)
    with qtbot.waitSignal(try_out.recognised):
        play(perform("karate", 0, 77))
    return try_out


def test_nothing_trained_says_what_to_do(try_out: TryOut) -> None:
    assert try_out.said.text() == "Nothing to try out yet"
    assert "train" in try_out.steps.text()
    assert not try_out.live.isVisible()


def test_a_trained_project_waits_for_a_sensor(
    trained: GestureController, try_out: TryOut, qtbot: QtBot
) -> None:
    qtbot.waitUntil(lambda: list(try_out.bars) == GESTURES)

    assert try_out.said.text() == "No movement is heard"
    assert not try_out.corrections.isEnabled()


def test_a_gesture_that_is_made_flashes_and_is_on_the_timeline(tried: TryOut) -> None:
    assert tried.said.text() == "Karate"
    assert tried.bars["karate"].is_flashing
    assert [one.gesture for one in tried.history.triggers] == ["karate"]
    assert tried.timeline.accessibleDescription() == "1 gesture would count as made"
    assert tried.band.band.gesture == "karate"
    assert "Karate" in tried.band.sentence.text()


def test_a_mark_that_is_dragged_shows_its_effect_at_once_and_is_one_step(
    tried: TryOut, trained: GestureController, qtbot: QtBot
) -> None:
    bar, groove = tried.bars["karate"], tried.bars["karate"].groove()
    steps = trained.editor.history.steps
    newest = Certainties(tried.history.now_s + 9, np.array([0.8, 0.0]), np.array([1.0, 1.0]))
    tried.history.add(newest)
    for later in (9.1, 9.2, 9.3):
        nothing = Certainties(tried.history.now_s + later, np.zeros(2), np.array([1.0, 1.0]))
        tried.history.add(nothing)
    before = len(tried.history.triggers)

    def at(share: float) -> QPoint:
        x = groove.left() + groove.width() * share
        return QPoint(round(x), round(groove.center().y()))

    qtbot.mousePress(bar, Qt.MouseButton.LeftButton, pos=at(0.75))
    qtbot.mouseMove(bar, at(0.85))
    qtbot.mouseMove(bar, at(0.9))
    assert len(tried.history.triggers) == before - 1
    assert tried.meaning.text().startswith("Karate: Caught ")
    assert trained.editor.history.steps == steps
    qtbot.mouseRelease(bar, Qt.MouseButton.LeftButton, pos=at(0.9))

    assert abs(trained.gestures["karate"].certainty - 0.9) <= 0.02
    assert trained.editor.history.steps == steps + 1
    assert trained.editor.history.undo_label == "set a recognition point"
    trained.editor.history.undo()
    trained.refresh()
    assert bar.value() == 75


def test_keys_move_the_point_and_steps_that_follow_each_other_are_one(
    tried: TryOut, trained: GestureController, qtbot: QtBot
) -> None:
    bar = tried.bars["katana"]
    steps = trained.editor.history.steps

    for _ in range(3):
        qtbot.keyClick(bar, Qt.Key.Key_Right)
    assert tried.tuning.point("katana") == 0.78
    qtbot.waitUntil(lambda: trained.gestures["katana"].certainty == 0.78)

    assert trained.editor.history.steps == steps + 1


def test_what_was_missed_becomes_a_take_and_nothing_else_of_it_is_learned(
    tried: TryOut, trained: GestureController
) -> None:
    tried.corrections.fill_menu()
    [_, katana] = tried.corrections.menu.actions()

    katana.trigger()

    [take] = trained.gestures["katana"].takes
    recording = trained.recordings[take.recording]
    assert 0.3 < take.end_s - take.start_s < 3.0
    assert recording.forgotten[0][0] == 0.0
    assert not recording.everyday
    assert trained.editor.history.undo_label == "add what was missed"


def test_a_false_alarm_becomes_everyday_movement(tried: TryOut, trained: GestureController) -> None:
    trigger = tried.history.triggers[-1]

    tried.corrections.false_alarm.click()

    [recording] = trained.recordings.values()
    assert recording.everyday
    assert recording.seconds >= trigger.t_end - trigger.t_start


def test_a_new_recogniser_looks_at_the_last_half_minute_too(
    tried: TryOut, trained: GestureController, qtbot: QtBot
) -> None:
    before = tried.history

    tried.tuning.use_method("gmr")

    qtbot.waitUntil(lambda: tried.history is not before and len(tried.history.kept) > 10)


def test_nobody_listens_while_nobody_looks(tried: TryOut) -> None:
    tried.hide()

    assert not tried.listening.is_listening


def test_a_damaged_recogniser_is_told(
    trained: GestureController, try_out: TryOut, qtbot: QtBot
) -> None:
    from msgspec.structs import replace

    trained.change("train", [keep_recogniser(replace(small_recogniser(), file="bm9uZQ=="))])

    qtbot.waitUntil(lambda: try_out.problem is not None)

    assert "not a gesture model" in try_out.said.text()
    assert try_out.steps.text()


def looks_with(*certainties: tuple[float, float]) -> CertaintyHistory:
    """Looks at two gestures, a tenth of a second apart."""
    found = CertaintyHistory(small_model().gestures)
    for at, pair in enumerate(certainties):
        found.add(Certainties(10 + at / 10, np.array(pair), np.array([1.0, 1.0])))
    return found


def test_triggers_follow_the_points_over_what_is_kept() -> None:
    history = looks_with((0.2, 0.1), (0.8, 0.1), (0.3, 0.1), (0.1, 0.1), (0.1, 0.0))

    found = [[one.gesture for one in history.triggers]]
    for point in (0.9, 0.5):
        history.set_points({"karate": point, "katana": 0.75})
        found.append([one.gesture for one in history.triggers])

    assert found == [["karate"], [], ["karate"]]


def test_looks_older_than_half_a_minute_are_forgotten() -> None:
    history = looks_with((0.2, 0.1), (0.9, 0.1), (0.3, 0.1), (0.1, 0.1))

    history.add(Certainties(60.0, np.array([0.0, 0.0]), np.array([1.0, 1.0])))

    assert len(history.kept) == 1
    assert not history.triggers
    assert history.best("karate", 0.0).certainty == 0.0


def test_the_band_holds_a_take_of_its_gesture_better_than_one_of_another() -> None:
    shares = {}
    for made in GESTURES:
        recording = perform(made, 0, 5)
        [(_, start_s, end_s)] = spans_of(recording)
        movement = samples_of(recording).between(start_s, end_s)
        band = band_of(small_model(), "karate", movement, gravity_included=True)
        shares[made] = band.share_inside
        assert band.kinds == ("body", "gravity")
        assert len(band.columns("gravity")) == 3
        assert "%" in in_words(band, "Karate")

    assert shares["karate"] > shares["katana"] + 0.1


def test_without_a_movement_the_band_alone_is_shown() -> None:
    band = band_of(small_model(), "katana", None, gravity_included=True)

    assert band.live is None
    assert "Make the gesture" in in_words(band, "Katana")

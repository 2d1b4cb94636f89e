"""The node of a watch that is being connected: told of, stopped, kept, or put back."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from nep_core.errors import NodeStartError
from nep_core.processes.launcher import LaunchedNode
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.plugins.watches.dialog import Plan
from tests.ui.watches.watch_stage import (
    Open,
    RecordingRunner,
    choose,
    choose_other,
    open_dialog,
    press,
    runner,
    settles_at_once,
)

pytestmark = pytest.mark.long

__all__ = ["open_dialog", "runner", "settles_at_once"]


def test_a_node_that_cannot_start_is_told_with_what_to_try(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)

    sentence = "UDP port 8085 cannot be opened: address already in use."
    runner.node_failed.emit("watch", NodeStartError(sentence, checklist=("Choose another port.",)))

    assert dialog.page.live.dot.state == "failed"
    assert dialog.page.live.sentence.text() == sentence
    assert "Choose another port." in dialog.page.live.advice.text()
    assert not dialog.use_button.isEnabled()


def test_a_watch_whose_node_ends_is_told_and_is_well_again_when_it_is_back(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")

    runner.tell("crashed", "something broke")
    assert dialog.page.live.title.text() == "“watch” has ended unexpectedly"
    assert dialog.page.live.sentence.text() == "something broke"

    runner.tell("ready", pid=9)
    assert dialog.trial.state == "listening"


def test_closing_it_stops_the_watch_that_is_not_used(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)
    runner.tell("ready")

    press(qtbot, dialog.close_button)
    runner.tell("stopped")

    assert runner.asked[-1] == ("stop", "watch")
    assert "watch" not in runner.board.nodes  # it was only tried


def test_closed_while_the_node_starts_it_is_stopped_as_soon_as_it_is_there(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "udp", qtbot)

    dialog.close()
    assert [verb for verb, _ in runner.asked] == ["start"]
    runner.tell("ready")

    assert runner.asked[-1] == ("stop", "watch")


def test_looking_at_the_watch_in_use_does_not_disturb_it(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    settings = {"through": "phone_page", "port": 8443, "listen_on": "network", "token": "old"}
    runner.local.planned["watch"] = PlannedNode("sensory/smartwatch", "watch", settings)
    runner.local.launcher.nodes["watch"] = LaunchedNode("watch", None, [])
    runner.tell("connected", pid=3)

    dialog = open_dialog(Plan("watch", settings))
    qtbot.waitUntil(lambda: dialog.trial.state == "listening")
    dialog.close()

    assert runner.asked == []


def test_a_watch_that_ran_before_comes_back_when_another_is_not_used(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    before = PlannedNode("sensory/smartwatch", "watch", {"through": "tcp", "port": 8086})
    runner.local.planned["watch"] = before
    runner.local.launcher.nodes["watch"] = LaunchedNode("watch", None, [])
    runner.tell("connected", pid=3)
    dialog = open_dialog(Plan("watch", before.parameters))
    assert dialog.page.connector.name == "tcp"  # what is used is shown at once
    choose_other(dialog, "udp", qtbot)
    runner.tell("ready", pid=8)
    assert runner.launches[-1].parameters["through"] == "udp"

    press(qtbot, dialog.close_button)

    assert runner.asked[-1] == ("start", before)
    assert runner.told_elsewhere == set()


def test_a_program_that_runs_with_the_watch_keeps_it_when_the_dialog_is_closed(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    dialog = open_dialog()
    choose(dialog, "virtual_watch", qtbot)
    runner.tell("ready")
    runner.planned = lambda: runner.launches
    runner.state = "running"

    press(qtbot, dialog.close_button)

    assert ("stop", "watch") not in runner.asked
    assert "watch" not in runner.told_elsewhere
    runner.state = "idle"


def test_a_dialog_that_is_opened_again_goes_on_with_the_node_that_is_starting(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    first = open_dialog()
    choose(first, "udp", qtbot)
    press(qtbot, first.close_button)

    second = open_dialog()
    choose(second, "udp", qtbot)
    runner.tell("ready")

    assert second.trial.state in ("starting", "listening")
    assert ("stop", "watch") not in runner.asked


def test_a_dialog_that_is_opened_again_and_closed_stops_what_the_first_one_started(
    open_dialog: Open, runner: RecordingRunner, qtbot: QtBot
) -> None:
    first = open_dialog()
    choose(first, "udp", qtbot)
    press(qtbot, first.close_button)

    press(qtbot, open_dialog().close_button)
    runner.tell("ready")

    assert runner.asked[-1] == ("stop", "watch")

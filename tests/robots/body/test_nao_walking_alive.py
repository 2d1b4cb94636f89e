"""A walk that is driven by hand stops by itself when nobody asks for it any more."""

from __future__ import annotations

from nao_stage import Stage

from robots.body.driver import ActionRequest


def test_a_driven_walk_goes_on_while_it_is_asked_for_and_stops_soon_after() -> None:
    stage = Stage()
    stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)
    for _ in range(6):
        stage.pass_time(0.4)
        stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)
        assert "w cancelled" not in stage.told

    stage.pass_time(1.0)

    assert stage.told.count("w accepted") == 1
    assert "w cancelled" in stage.told


def test_a_walk_without_patience_goes_on_alone() -> None:
    stage = Stage()
    stage.ask("w", "walk_freely", forward=0.5)

    stage.pass_time(5.0)

    assert "w cancelled" not in stage.told


def test_a_driven_walk_that_another_one_follows_is_forgotten() -> None:
    stage = Stage()
    stage.ask("w", "walk_freely", forward=0.5, unless_asked_s=0.5)
    stage.pass_time(0.2)
    stage.ask("v", "walk_freely", turn=0.5, unless_asked_s=0.5)
    stage.pass_time(0.4)

    again = ActionRequest(id="w", robots=["NAO"], action="walk_freely", args={"forward": 0.5})
    assert [result.state for result in stage.actor.request(again)] == ["done"]

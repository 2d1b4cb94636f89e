"""The publish and subscribe benchmark measures what it says, with every side that is here."""

from __future__ import annotations

import pytest

from benchmarks import pubsub
from benchmarks._pubsub_sides import known_sides


def test_every_side_can_be_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pubsub, "PINGS", 20)
    sides = [side for side in known_sides() if side != "nep"]

    p50_us, p99_us = pubsub._pings(100, sides)

    assert {"raw", "ours"} <= set(sides)
    assert all(0 < p50_us[side] <= p99_us[side] for side in sides)


def test_a_burst_of_ours_arrives_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pubsub, "BURST", 50)

    assert pubsub._burst("ours", 100) == 100


def test_ours_is_compared_with_each_side_and_the_goal_is_about_raw() -> None:
    rounds = [{"raw": 100.0, "ours": 90.0, "zenoh": 45.0}, {"raw": 100.0, "ours": 80.0}]

    against_raw, against_zenoh = pubsub._compared("x", "messages/s", rounds, ("at least", 0.85))

    assert (against_raw["ratio"], against_raw["ok"]) == (0.85, True)
    assert (against_zenoh["ratio"], against_zenoh.get("ok")) == (2.0, None)

"""Requests that no joint can follow: they fail with a sentence, and the robot lives on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from nao_stage import Stage

from robots.body.animations import Animation, Animations
from robots.body.keyframes import Keyframes, Track
from robots.body.limbs import Limb

NAN = math.nan
HANDLES = [[NAN] * 4]


@pytest.mark.parametrize(
    ("action", "args"),
    [
        ("set_angles", {"angles": {"HeadYaw": NAN}}),
        ("reach_angles", {"angles": {"HeadYaw": NAN}}),
        ("reach_angles", {"angles": {"HeadYaw": 0.1}, "speed": 1e-300}),
        ("move_joint", {"joint": "HeadYaw", "degrees": 10, "speed": 1e-300}),
        ("move_through", {"tracks": {"HeadYaw": {"times": [1.0], "keys": [NAN]}}}),
        ("move_through", {"tracks": {"HeadYaw": {"times": [NAN], "keys": [0.1]}}}),
        ("move_through", {"tracks": {"HeadYaw": {"times": [1e308], "keys": [0.1]}}}),
        ("move_through", {"tracks": {"HeadYaw": {"times": [1.0], "keys": [0.1, 0.2]}}}),
        ("move_through", {"tracks": {"HeadYaw": {"times": [1.0, 1.0], "keys": [0.1, 0.2]}}}),
        (
            "move_through",
            {"tracks": {"HeadYaw": {"times": [1.0], "keys": [0.1], "handles": HANDLES}}},
        ),
        (
            "move_through",
            {"tracks": {"HeadYaw": {"times": [1.0], "keys": [0.1], "handles": []}}},
        ),
    ],
)
def test_what_no_joint_can_follow_is_refused_and_the_next_request_is_done(
    action: str, args: dict[str, Any]
) -> None:
    stage = Stage()

    refused = stage.do(action, **args)
    done = stage.do("look", yaw_deg=10)

    assert refused.state == "failed" and refused.description
    assert done.state == "done"
    assert np.isfinite(stage.robot.angles).all()


@pytest.mark.parametrize("stretch", [1.0, 10.0])
def test_an_animation_that_lasts_too_long_fails_before_it_is_planned(stretch: float) -> None:
    stage = Stage()
    hour = Keyframes({"HeadYaw": Track((3600.0,), (0.5,))})
    long = Animation("long", "Long", "", "animation", "", "", hour, frozenset({Limb.HEAD}))
    stage.robot.animations = Animations({"long": long})

    result = stage.do("play", animation="long", stretch=stretch)

    assert result.state == "failed"
    assert "At most 600 s are possible" in result.description

"""The view draws each robot as its folder says."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from nep_core.wire.messages import RobotState
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.view import RobotView, folder_of, nao_folder

PEPPER = nao_folder().parent / "pepper"
TOUCHED = {"head_front", "head_middle", "head_rear", "hand_left", "hand_right", "chest_button"}


def standing(model: str) -> RobotState:
    figure = load_figure(PEPPER)
    joints = dict(zip(figure.body.names, figure.body.posture_angles("Stand").tolist(), strict=True))
    return RobotState(robot="Lisa", joints=joints, posture="Stand", model=model)


def test_a_state_names_the_folder_that_its_robot_is_drawn_from(tmp_path: Path) -> None:
    own = tmp_path / "own"
    shutil.copytree(PEPPER, own)

    assert folder_of("") == nao_folder()
    assert folder_of("pepper") == PEPPER
    assert folder_of(str(own)) == own
    assert folder_of("zora") == nao_folder()


def test_pepper_stands_on_its_wheels_as_high_as_it_is() -> None:
    corners = load_figure(PEPPER).pose(standing("pepper")).corners()

    assert corners[:, 2].min() == pytest.approx(0.0, abs=0.004)
    assert corners[:, 2].max() == pytest.approx(1.21, abs=0.02)


def test_pepper_can_be_touched_where_nao_can() -> None:
    assert set(load_figure(PEPPER).sensors) >= TOUCHED


def test_the_view_shows_pepper_when_its_state_says_so(view: RobotView) -> None:
    view.show_robot("Lisa", standing("pepper"))

    (shown,) = view.room.scene().robots
    assert shown.figure is load_figure(PEPPER)

"""One kind of robot as it looks, posed as a state says: where each of its parts is in the room."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from nep_core.errors import NodeStartError
from nep_core.messages import RobotState
from nodes.action.naobody.body import load_body
from nodes.action.naobody.skeleton import UPRIGHT, Skeleton, TorsoPose
from nodes.action.naobody.skeleton import rotation as turned_by

from .parts import VIEW_FILE, Shaped, all_parts, read_view, rotation
from .placed import UP, Assembly, Placed

Array = NDArray[np.float64]


class RobotFigure:
    """A robot's folder: its body with the joints, and its look with the parts."""

    def __init__(self, folder: Path) -> None:
        self.body = load_body(folder)
        self.skeleton = Skeleton(self.body)
        view = read_view(folder / VIEW_FILE)
        self.colours, self.head, self.top_m = view.colours, view.head, view.top_m
        shaped = list(all_parts(view))
        _check_links(folder, shaped, self.skeleton.links)
        self.assembly = Assembly.of(shaped)
        self.parts = self.assembly.parts
        self.sensors = tuple(dict.fromkeys(p.sensor for p in self.parts if p.sensor))
        self._at = np.array([one.at for one in shaped])
        self._turn = np.array([one.turn for one in shaped])
        self._link_names = tuple(dict.fromkeys(part.link for part in self.parts))
        self._link = np.array([self._link_names.index(part.link) for part in self.parts])
        self._hinges = _Hinges(shaped)
        self._resting = lru_cache(maxsize=4)(self._rest)

    def pose(self, state: RobotState) -> Placed:
        """Place all parts; on its feet, or its lowest point, where the torso is not told."""
        angles = self.angles(state.joints)
        frames = dict(self.skeleton.frames(angles))
        torso = self._torso(state)
        links = {name: torso @ frame for name, frame in frames.items()}
        if state.torso is None:
            self._drop(links, state)
        return self._placed(links, state.joints)

    def angles(self, joints: Mapping[str, float]) -> Array:
        """The angles of a state in the body's joint order."""
        return np.array([joints.get(name, 0.0) for name in self.body.names])

    def _torso(self, state: RobotState) -> Array:
        """The torso's frame; one that is not told lies or stands as its posture does."""
        told = state.torso
        if told is None:
            told = self._resting(tuple(self.angles(state.joints)), state.base, state.posture)
        x, y, z, roll, pitch, yaw = told
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = turned_by(roll, pitch, yaw), (x, y, z)
        return frame

    def _rest(
        self, angles: tuple[float, ...], base: tuple[float, float, float], posture: str
    ) -> TorsoPose:
        known = self.body.postures.get(posture)
        down = UPRIGHT if known is None else known.down
        return self.skeleton.torso_over_floor(np.array(angles), base, down)

    def _drop(self, links: dict[str, Array], state: RobotState) -> None:
        """Let the robot down until its lowest point is on the floor."""
        placed = self._placed(links, state.joints)
        lowest = float(placed.farthest(-UP)[:, 2].min())
        for name, frame in links.items():
            links[name] = frame.copy()
            links[name][2, 3] -= lowest

    def _placed(self, links: Mapping[str, Array], joints: Mapping[str, float]) -> Placed:
        frames = np.stack([links[name] for name in self._link_names])[self._link]
        at, turn = self._hinges.opened(self._at, self._turn, joints)
        origins = frames[:, :3, 3] + np.einsum("pij,pj->pi", frames[:, :3, :3], at)
        turns = frames[:, :3, :3] @ turn
        return Placed(self.assembly, origins, turns, links)


def _check_links(folder: Path, shaped: Sequence[Shaped], links: Sequence[str]) -> None:
    wrong = [one.part for one in shaped if one.part.link not in links]
    if wrong:
        raise NodeStartError(
            f"The robot in {folder} has no link {wrong[0].link} for its part {wrong[0].name}.",
            checklist=(f"Name a link of body.json in {VIEW_FILE}: {', '.join(links)}.",),
        )


class _Hinges:
    """The parts that joints outside of the skeleton turn, such as fingers."""

    def __init__(self, shaped: list[Shaped]) -> None:
        self._found = [(i, s.part.hinge) for i, s in enumerate(shaped) if s.part.hinge is not None]

    def opened(self, at: Array, turn: Array, joints: Mapping[str, float]) -> tuple[Array, Array]:
        """The places and turns of all parts, with these turned as far as their joints are open."""
        if not self._found:
            return at, turn
        at, turn = at.copy(), turn.copy()
        for part, hinge in self._found:
            opened = joints.get(hinge.joint, 0.5)
            degrees = hinge.closed_deg + (hinge.open_deg - hinge.closed_deg) * opened
            spin, about = rotation(np.array(hinge.axis), math.radians(degrees)), np.array(hinge.at)
            at[part] = about + spin @ (at[part] - about)
            turn[part] = spin @ turn[part]
        return at, turn


@cache
def load_figure(folder: Path) -> RobotFigure:
    """The figure of a robot's folder, read once. Raises NodeStartError when it cannot be used."""
    return RobotFigure(folder)

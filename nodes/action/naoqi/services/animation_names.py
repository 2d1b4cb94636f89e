"""Finds the animations of this program that stand for those of a real NAO, by NAOqi's paths."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec

from nep_core.errors import NodeStartError
from nodes.action.naobody.animations import Animations
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naoqi.server import CallFailed

TABLE = "naoqi_animations.toml"
OURS = "animations/Stand/NEP"
"""Where our animations are that have no name in NAOqi."""
POSTURES = {"sitting": "Sit"}
PATH = re.compile(r"(?:animations/)?(?:(?:Stand|Sit|SitOnPod)/)?(.+?)(?:_\d+)?")


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    animations: dict[str, str]
    tags: dict[str, list[str]]


class AnimationNames:
    """The paths and tags of animations, with the names that the robot knows them by."""

    def __init__(self, animations: dict[str, str], tags: dict[str, list[str]]) -> None:
        self._animations = animations
        self.tags = {tag: [f"animations/Stand/{path}_1" for path in tags[tag]] for tag in tags}

    @property
    def targets(self) -> list[str]:
        """The robot's animations that stand for others."""
        return list(self._animations.values())

    def paths(self, known: Animations) -> list[str]:
        """Return all paths that a robot can play, in alphabetical order."""
        names = known.names()
        named = [f"animations/Stand/{p}_1" for p, n in self._animations.items() if n in names]
        return sorted([*named, *(f"{OURS}/{name}" for name in names)])

    def name_of(self, path: str, robot: VirtualRobot) -> str:
        """Return the robot's name of an animation. Raises CallFailed when there is no such one."""
        posture = POSTURES.get(robot.family, "Stand")
        plain = path.strip().replace("[posture]", posture).replace("[robot]", "Nao")
        found = PATH.fullmatch(plain.removesuffix("/.").strip("/"))
        known = robot.animations.names()
        key = found.group(1) if found else ""
        name = self._animations.get(key, key.rpartition("/")[2])
        if name not in known:
            raise CallFailed(f"There is no animation “{path}”.")
        return name

    def with_tag(self, tag: str) -> list[str]:
        """Return the paths with a tag. Raises CallFailed when there are none."""
        if not self.tags.get(tag):
            raise CallFailed(f"No animation has the tag “{tag}”.")
        return self.tags[tag]


def load_animation_names(folder: Path) -> AnimationNames:
    """Read the table in a robot's folder; without one, only our own names are known."""
    path = folder / TABLE
    if not path.exists():
        return AnimationNames({}, {})
    try:
        table = msgspec.toml.decode(path.read_bytes(), type=_Table)
    except (OSError, msgspec.DecodeError) as error:
        raise NodeStartError(
            f"The table of NAOqi's animations, {path}, cannot be read.",
            checklist=("Install NEP Studio again: this file comes with it.",),
            details=str(error),
        ) from error
    return AnimationNames(table.animations, table.tags)

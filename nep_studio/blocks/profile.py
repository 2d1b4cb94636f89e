"""A robot profile: the choices that a kind of robot gives to blocks, read from robot.toml."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from .definition_files import read_choices, read_toml
from .errors import DefinitionError


@dataclass(frozen=True, slots=True)
class RobotProfile:
    """What a kind of robot can do.

    ``node`` is the action node that plays it; ``choices`` are tables of value and label;
    ``standing`` are the postures from which the robot can walk.
    """

    name: str
    title: str
    node: str
    choices: Mapping[str, Mapping[str, str]] = field(repr=False)
    standing: frozenset[str]


def load_profile(path: Path) -> RobotProfile:
    """Read a robot.toml, or raise DefinitionError, which names the file."""
    data = read_toml(path)
    names = [data.get(key) for key in ("name", "title", "node")]
    if not all(isinstance(name, str) and name for name in names):
        raise DefinitionError(f"The file {path.name} needs a name, a title and a node.")
    choices = read_choices(path, data.get("choices", {}))
    postures = data.get("choices", {}).get("postures", {})
    standing = frozenset(
        value
        for value, entry in postures.items()
        if isinstance(entry, dict) and entry.get("stands") is True
    )
    return RobotProfile(data["name"], data["title"], data["node"], choices, standing)


def drivers_beside(path: Path, profile: RobotProfile) -> dict[str, Mapping[str, str]]:
    """The table of drivers with those of the robots in the folders beside a robot's own.

    So a folder with another robot adds it to the Robots page. Raises DefinitionError.
    """
    own = profile.choices.get("drivers")
    if own is None or path.parent.name != profile.name:
        return {}
    drivers = dict(own)
    for other in sorted(path.parent.parent.glob("*/robot.toml")):
        for driver, label in load_profile(other).choices.get("drivers", {}).items():
            drivers.setdefault(driver, label)
    return {"drivers": drivers}

"""ALAnimationPlayer and ALBehaviorManager: movements with a path, such as Gestures/Hey_1."""

from __future__ import annotations

import random
import re
from pathlib import Path
from typing import Any

import msgspec

from faults.files import read_toml
from robots.body.animations import Animations
from robots.body.pose import VirtualRobot
from robots.errors import FilesUnusable
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method, signal

from .module import Module, always

# Finds the animations of this program that stand for those of a real NAO, by NAOqi's paths.

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
        self.animations = animations
        self.tags = {tag: [f"animations/Stand/{path}_1" for path in tags[tag]] for tag in tags}

    def paths(self, known: Animations) -> list[str]:
        """Return all paths that a robot can play, in alphabetical order."""
        names = known.names()
        named = [f"animations/Stand/{p}_1" for p, n in self.animations.items() if n in names]
        return sorted([*named, *(f"{OURS}/{name}" for name in names)])

    def name_of(self, path: str, robot: VirtualRobot) -> str:
        """Return the robot's name of an animation. Raises CallFailed when there is no such one."""
        posture = POSTURES.get(robot.family, "Stand")
        plain = path.strip().replace("[posture]", posture).replace("[robot]", "Nao")
        found = PATH.fullmatch(plain.removesuffix("/.").strip("/"))
        known = robot.animations.names()
        key = found.group(1) if found else ""
        name = self.animations.get(key, key.rpartition("/")[2])
        if name not in known:
            raise CallFailed("There is no animation “{path}”.", path=path)
        return name

    def with_tag(self, tag: str) -> list[str]:
        """Return the paths with a tag. Raises CallFailed when there are none."""
        if not self.tags.get(tag):
            raise CallFailed("No animation has the tag “{tag}”.", tag=tag)
        return self.tags[tag]


def load_animation_names(folder: Path) -> AnimationNames:
    """Read the table in a robot's folder; without one, only our own names are known."""
    path = folder / TABLE
    if not path.exists():
        return AnimationNames({}, {})
    try:
        table = msgspec.convert(read_toml(path), _Table)
    except (OSError, ValueError, RecursionError) as error:
        raise FilesUnusable(
            "The table of NAOqi's animations, {path}, cannot be read.",
            checklist=("Install NEP Studio again: this file comes with it.",),
            details=str(error),
            path=path,
        ) from error
    return AnimationNames(table.animations, table.tags)


class ALAnimationPlayer(Module):
    """Plays animations by their path, or one of those with a tag."""

    def __init__(self, robot: ServedRobot, names: AnimationNames) -> None:
        super().__init__(robot)
        self._names = names
        self._chance = random.Random(robot.name)

    @method("run::v(s)")
    def run(self, path: str) -> Any:
        """Play an animation; wait until it ends."""
        return self._do("play", animation=self._names.name_of(path, self._robot.robot))

    @method("runTag::v(s)", "runTag::v(ss)")
    def run_tag(self, tag: str, posture: str = "") -> Any:
        """Play one of the animations with a tag."""
        return self.run(self._chance.choice(self._names.with_tag(tag)))

    @method("addTagForAnimations::v({s[s]})")
    def add_tag_for_animations(self, tags: dict[str, list[str]]) -> None:
        """Give animations more tags."""
        for tag, paths in tags.items():
            self._names.tags.setdefault(tag, []).extend(paths)

    @method("reset::v()")
    def reset(self) -> None:
        """Stop animations."""
        self._robot.stop(lambda command: type(command.action).__name__ == "Play")


class ALBehaviorManager(Module):
    """The programs that are installed on a robot: here its animations, by the same paths."""

    behavior_started = signal("behaviorStarted::(s)")
    behavior_stopped = signal("behaviorStopped::(s)")

    def __init__(self, robot: ServedRobot, names: AnimationNames) -> None:
        super().__init__(robot)
        self._names = names
        self._running: dict[str, str] = {}
        self._defaults: list[str] = []

    @method("startBehavior::v(s)")
    def start_behavior(self, path: str) -> None:
        """Begin to play a behavior."""
        self.run_behavior(path)

    @method("runBehavior::v(s)")
    def run_behavior(self, path: str) -> Any:
        """Play a behavior; wait until it ends."""
        if path in self._running:
            raise CallFailed("“{path}” is already running.", path=path)
        name = self._names.name_of(path, self._robot.robot)
        self._running[path] = name
        self.behavior_started.emit(path)
        return self._do("play", animation=name, then=lambda: self._end(path))

    @method("stopBehavior::v(s)")
    def stop_behavior(self, path: str) -> None:
        """Stop a behavior, if it is played."""
        if name := self._running.get(path):
            self._robot.stop(lambda command: getattr(command.action, "animation", None) == name)

    @method("stopAllBehaviors::v()")
    def stop_all_behaviors(self) -> None:
        """Stop all behaviors."""
        for path in list(self._running):
            self.stop_behavior(path)

    @method("isBehaviorInstalled::b(s)", "preloadBehavior::b(s)", "isBehaviorPresent::b(s)")
    def is_behavior_installed(self, path: str) -> bool:
        """Return whether there is such a behavior."""
        try:
            self._names.name_of(path, self._robot.robot)
        except CallFailed:
            return False
        return True

    is_behavior_running = method("isBehaviorRunning::b(s)", "isBehaviorLoaded::b(s)")(
        lambda self, path: path in self._running
    )

    @method(
        "getInstalledBehaviors::[s]()", "getBehaviorNames::[s]()", "getSystemBehaviorNames::[s]()"
    )
    def installed_behaviors(self) -> list[str]:
        """Return all behaviors."""
        return self._names.paths(self._robot.robot.animations)

    # The behaviors that did not come with the robot: there are none
    user_behavior_names = always([], "getUserBehaviorNames::[s]()")
    running_behaviors = method("getRunningBehaviors::[s]()", "getLoadedBehaviors::[s]()")(
        lambda self: list(self._running)
    )

    behaviors_by_tag = method("getBehaviorsByTag::[s](s)")(
        lambda self, tag: list(self._names.tags.get(tag, []))
    )
    tag_list = method("getTagList::[s]()")(lambda self: sorted(self._names.tags))

    behavior_tags = method("getBehaviorTags::[s](s)")(
        lambda self, path: [tag for tag, paths in self._names.tags.items() if path in paths]
    )
    default_behaviors = method("getDefaultBehaviors::[s]()")(lambda self: list(self._defaults))

    @method("addDefaultBehavior::v(s)")
    def add_default_behavior(self, path: str) -> None:
        """Remember a behavior that begins when the robot is switched on."""
        self._defaults.append(path)

    @method("removeDefaultBehavior::v(s)")
    def remove_default_behavior(self, path: str) -> None:
        """Forget a behavior that begins when the robot is switched on."""
        self._defaults = [one for one in self._defaults if one != path]

    def _end(self, path: str) -> None:
        if self._running.pop(path, None) is not None:
            self.behavior_stopped.emit(path)

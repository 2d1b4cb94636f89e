"""The animations that a project brings, beside those that its robot knows."""

from __future__ import annotations

from pathlib import Path

from nep_core.errors import NodeStartError
from nodes.action.naobody.animations import Animation, Animations, load_animation
from nodes.action.naobody.body import Body


def with_own(known: Animations, folder: str, body: Body) -> tuple[Animations, list[str]]:
    """Return a robot's animations with those of a folder, and why some of them are left out.

    An own one takes the place of a known one of the same name. What cannot be read, or was made
    for a robot with other joints, is left out: the robot can do all else. "" is no folder.
    """
    found: dict[str, Animation] = {name: known.get(name) for name in known.names()}
    problems = []
    for path in sorted(Path(folder).glob("*.toml")) if folder else ():
        try:
            found[path.stem] = load_animation(path, body)
        except NodeStartError as error:
            problems.append(error.sentence)
    return Animations(found), problems

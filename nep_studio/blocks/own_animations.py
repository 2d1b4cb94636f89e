"""The animations of a project: movements that were made for it, which its blocks then offer.

Each is kept in the project's file under a key of its own, so that each has a line there and a step
of undo. Which joints a robot has, and how far they go, only its node knows.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable, Container, Iterator, Mapping
from itertools import pairwise
from typing import Literal, TypeVar, get_args

import msgspec

from faults import Text, text_of

from .edits.content import ANIMATION, SetExtra
from .file_text import in_words
from .program import Project
from .slots import why_not_name, why_not_text

# Names under which a project keeps what was made for it: its motions and its gestures.

KEPT_NAME = re.compile(r"[a-z][a-z0-9_]{0,39}")
DEVICES = frozenset(
    ("con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10)))
)
"""No file can be called so on Windows, and much of what is kept becomes a file of its name."""


def free_kept_name(title: str, kind: str, taken: Container[str]) -> str:
    """A name for something with this title, which none of the others has.

    ``kind`` (one word) begins the names of titles that have no letter to begin with.
    """
    bare = unicodedata.normalize("NFKD", title.casefold().replace("ß", "ss"))
    letters = "".join(c for c in bare if not unicodedata.combining(c))
    name = re.sub(r"[^a-z0-9]+", "_", letters).strip("_")[:32].strip("_")
    name = name if name[:1].isalpha() else f"{kind}_{name}"[:32].rstrip("_")
    number, found = 2, name
    while found in taken or found in DEVICES:
        found, number = f"{name}_{number}", number + 1
    return found


AnimationKind = Literal["animation", "animal", "gesture"]
Handle = tuple[float, float, float, float]
"""A Bezier key's two handles: time (s) and angle (rad) before the key, time and angle after it."""

PREFIX = ANIMATION

SHORTEST_STEP_S = 0.01
MOST_JOINTS = 100
MOST_KEYS = 2000
LONGEST_S = 600.0
LARGEST_ANGLE = 10.0
KINDS = get_args(AnimationKind)
TABLES: dict[AnimationKind, tuple[str, ...]] = {
    "animation": ("animations",),
    "animal": ("animals", "animations"),
    "gesture": ("say_gestures", "animations"),
}
"""The tables of choices in which each kind is offered: everything can be played."""


class JointKeys(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """What one joint does: times (s, rising, the first above 0), angles (rad), Bezier handles."""

    times: tuple[float, ...]
    keys: tuple[float, ...]
    handles: tuple[Handle, ...] | None = None


class OwnAnimation(msgspec.Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """A movement; ``starts_from`` is the posture it begins in, empty when it goes with any."""

    title: str
    joints: dict[str, JointKeys]
    kind: AnimationKind = "animation"
    description: str = ""
    starts_from: str = ""
    says: str = ""

    @property
    def duration_s(self) -> float:
        """When the last key is reached."""
        return max((joint.times[-1] for joint in self.joints.values()), default=0.0)


Kept = TypeVar("Kept")


def kept(
    project: Project,
    prefix: str,
    kind: type[Kept],
    why_not: Callable[[str, object], Text | None],
) -> dict[str, Kept]:
    """What a project keeps under keys with a prefix, by the rest of the key; no faulty ones."""
    named = {
        key.removeprefix(prefix): value
        for key, value in project.extra.items()
        if key.startswith(prefix)
    }
    fit = {name: value for name, value in named.items() if why_not(name, value) is None}
    return {name: msgspec.convert(value, kind) for name, value in fit.items()}


def own_animations(project: Project) -> dict[str, OwnAnimation]:
    """The animations of a project by name."""
    return kept(project, PREFIX, OwnAnimation, why_not_animation)


def keep(name: str, animation: OwnAnimation | None) -> SetExtra:
    """The edit that keeps an animation under a name; None takes it away."""
    value = None if animation is None else msgspec.to_builtins(animation)
    return SetExtra(PREFIX + name, value)


def why_not_animation(name: str, value: object) -> Text | None:
    """Why this cannot be an animation of a project, as a sentence, or None when it can."""
    if not KEPT_NAME.fullmatch(name) or name in DEVICES:
        return Text(
            "its name may have small letters, digits and _ in it, and begins with a letter."
        )
    try:
        animation = msgspec.convert(value, OwnAnimation)
    except msgspec.ValidationError as error:
        return in_words(error)
    return next(_reasons(animation), None)


def _reasons(animation: OwnAnimation) -> Iterator[Text]:
    if (reason := why_not_name(animation.title)) is not None:
        yield text_of("its title: {reason}", reason=reason)
    for text in (animation.description, animation.starts_from, animation.says):
        if (reason := why_not_text(text)) is not None:
            yield reason
    if not 0 < len(animation.joints) <= MOST_JOINTS:
        yield text_of("it must move 1 to {most_joints} joints.", most_joints=MOST_JOINTS)
    for name, joint in animation.joints.items():
        if (reason := why_not_keys(joint)) is not None:
            yield text_of("{name}: {reason}", name=name[:40], reason=reason)


def why_not_keys(joint: JointKeys) -> Text | None:
    """Why a joint cannot do this, as a sentence, or None when it can."""
    handles = joint.handles if joint.handles is not None else ((0.0,) * 4,) * len(joint.keys)
    if not len(joint.times) == len(joint.keys) == len(handles):
        return text_of(
            "{count} times and {count_2} handles for {count_3} keys.",
            count=len(joint.times),
            count_2=len(handles),
            count_3=len(joint.keys),
        )
    if not 0 < len(joint.keys) <= MOST_KEYS:
        return text_of("it must have 1 to {most_keys} keys.", most_keys=MOST_KEYS)
    numbers = (*joint.times, *joint.keys, *(n for handle in handles for n in handle))
    if not all(map(math.isfinite, numbers)):
        return Text("each number must be finite.")
    if joint.times[-1] > LONGEST_S or any(abs(key) > LARGEST_ANGLE for key in joint.keys):
        return text_of(
            "it lasts {longest_s} s at most, with angles up to {largest_angle} rad.",
            longest_s=f"{LONGEST_S:g}",
            largest_angle=f"{LARGEST_ANGLE:g}",
        )
    times = (0.0, *joint.times)
    if any(late - early < SHORTEST_STEP_S - 1e-9 for early, late in pairwise(times)):
        return text_of(
            "each key must be at least {shortest_step_s} s later than the one before it.",
            shortest_step_s=SHORTEST_STEP_S,
        )
    return None


def free_name(title: str, taken: Container[str]) -> str:
    """A name for an animation with this title, which none of the others has."""
    return free_kept_name(title, "motion", taken)


def choices_with(
    choices: Mapping[str, Mapping[str, str]], project: Project
) -> dict[str, Mapping[str, str]]:
    """Tables of choices with the project's animations after those that every project has."""
    found = dict(choices)
    for name, animation in own_animations(project).items():
        for table in TABLES[animation.kind]:
            if choices.get(table):  # an absent table means that any value passes
                found[table] = {**found[table], name: animation.title}
    return found

"""A project's animations as files, which the nodes of its robots read."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from nep_core.places import cache_folder
from nep_studio.blocks.own_animations import JointKeys, OwnAnimation, own_animations
from nep_studio.blocks.program import Project

FOLDER = "animations"


@dataclass(frozen=True)
class AnimationFiles:
    """A folder and the text of each file that must be in it, by file name.

    The same animations are always in the same folder, so that a robot that has them need not be
    started again; other ones are in another folder.
    """

    folder: Path
    texts: Mapping[str, str] = field(default_factory=dict)

    def moved(self, folder: Path) -> AnimationFiles:
        """The same in another folder."""
        return replace(self, folder=folder)

    def write(self) -> None:
        """Write those files that are not there. Raises OSError."""
        self.folder.mkdir(parents=True, exist_ok=True)
        for name, text in self.texts.items():
            path = self.folder / name
            if not path.is_file():
                part = path.with_suffix(f".{os.getpid()}.part")
                part.write_text(text, encoding="utf-8")
                part.replace(path)  # at once: another window may write the same one


def animation_files(project: Project) -> AnimationFiles | None:
    """The files of a project's animations; None when it has none."""
    texts = {f"{name}.toml": to_toml(one) for name, one in own_animations(project).items()}
    if not texts:
        return None
    digest = hashlib.sha256(msgspec.json.encode(sorted(texts.items()))).hexdigest()[:16]
    return AnimationFiles(cache_folder() / FOLDER / digest, texts)


def to_toml(animation: OwnAnimation) -> str:
    """An animation as the text of a file such as those of the shipped animations."""
    texts = ("title", "description", "kind", "starts_from", "says")
    required = ("title", "description", "kind")
    head = [
        f"{name} = {_text(getattr(animation, name))}"
        for name in texts
        if getattr(animation, name) or name in required
    ]
    joints = [_joint(name, joint) for name, joint in animation.joints.items()]
    return "\n".join([*head, *joints])


def _joint(name: str, joint: JointKeys) -> str:
    bare = name if name.isascii() and name.isidentifier() else _text(name)
    lines = [
        "",
        f"[joints.{bare}]",
        f"times = {_row(joint.times)}",
        f"keys = {_row(joint.keys)}",
    ]
    if joint.handles is not None:
        lines.append(f"handles = [{', '.join(map(_row, joint.handles))}]")
    return "\n".join([*lines, ""])


def _row(numbers: tuple[float, ...]) -> str:
    return f"[{', '.join(repr(round(float(number), 5)) for number in numbers)}]"


def _text(text: str) -> str:
    # JSON's texts are TOML's too, but for a control character that TOML wants to be escaped
    return msgspec.json.encode(text).decode().replace("\x7f", "\\u007f")

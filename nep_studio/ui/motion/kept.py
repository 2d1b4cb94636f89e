"""The motions of the project that is open, and those that come with the robot."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from nep_studio.blocks.edits import SetField
from nep_studio.blocks.operations.animations import (
    Use,
    animation_uses,
    delete_animation,
    keep_animation,
    rename_animation,
)
from nep_studio.blocks.own_animations import (
    AnimationKind,
    JointKeys,
    OwnAnimation,
    own_animations,
)
from nodes.action.naobody.animations import Animation, load_animation
from nodes.action.naobody.body import Body
from nodes.action.naobody.keyframes import Handle, Keyframes

if TYPE_CHECKING:
    from nep_studio.blocks.editor import Editor
    from nep_studio.ui.documents_files import Files

DIGITS = 5
TABLES: Mapping[AnimationKind, str] = {
    "animation": "animations",
    "animal": "animals",
    "gesture": "say_gestures",
}


class KeptMotions:
    """What can be opened, and where it is saved."""

    def __init__(self, files: Files, folder: Path, body: Body) -> None:
        self._files, self._folder, self._body = files, folder / "animations", body

    @property
    def editor(self) -> Editor | None:
        """The editor of the project that is open, if one is."""
        return self._files.document.editor if self._files.document is not None else None

    def own(self) -> dict[str, OwnAnimation]:
        """The motions that the project keeps, by name."""
        return own_animations(self.editor.project) if self.editor is not None else {}

    def shipped(self, kind: AnimationKind) -> dict[str, str]:
        """The titles of the motions of a kind that come with the robot, by name."""
        if self.editor is None:
            return {}
        own, table = self.own(), self.editor.language.choices.get(TABLES[kind], {})
        return {
            name: words
            for name, words in sorted(table.items(), key=lambda item: item[1].casefold())
            if name not in own and (self._folder / f"{name}.toml").is_file()
        }

    def load(self, name: str) -> OwnAnimation:
        """A motion that comes with the robot; raises NodeStartError."""
        animation = as_own(load_animation(self._folder / f"{name}.toml", self._body))
        titles = [self.shipped(kind).get(name) for kind in TABLES]
        return replace(animation, title=next(filter(None, titles), animation.title))

    def save(self, motion: OwnAnimation, name: str, use: Use | None = None) -> str:
        """Keep a motion in the project; gives its name. Raises EditRefused.

        With another title it gets another name, in the blocks that play it too. The block of
        ``use`` plays it from now on.
        """
        editor = self.editor
        assert editor is not None
        known = self.own().get(name)
        with editor.transaction("keep a motion"):
            if known is not None and known.title != motion.title:
                name = rename_animation(editor, name, motion.title)
            name = keep_animation(editor, motion, name if known is not None else "")
            if use is not None and use.block in editor.project.blocks:
                editor.apply(SetField(use.block, use.slot, name))
        return name

    def uses(self, name: str) -> int:
        """How many blocks of the project play a motion."""
        return len(animation_uses(self.editor, name)) if self.editor is not None else 0

    def delete(self, name: str) -> None:
        """Take a motion out of the project."""
        if self.editor is not None and name in self.own():
            delete_animation(self.editor, name)


def as_own(animation: Animation) -> OwnAnimation:
    """A motion that comes with the robot, as one that a project can keep."""
    return OwnAnimation(
        animation.title,
        joints_of(animation.keyframes),
        animation.kind,
        animation.description,
        animation.starts_from,
        animation.says,
    )


def joints_of(keyframes: Keyframes) -> dict[str, JointKeys]:
    """Keyframes as a project keeps them: to a hundredth of a millisecond and of a mrad."""
    return {
        name: JointKeys(
            _rounded(track.times),
            _rounded(track.keys),
            tuple(_handle(handle) for handle in track.handles) if track.handles else None,
        )
        for name, track in keyframes.tracks.items()
    }


def _rounded(numbers: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(number, DIGITS) for number in numbers)


def _handle(handle: Handle) -> Handle:
    a, b, c, d = _rounded(handle)
    return (a, b, c, d)

"""Keeps, renames and deletes the animations of a project, with the blocks that play them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from msgspec.structs import replace

from nep_studio.blocks.edits.content import SetField

from ..editor import Editor
from ..errors import EditRefused
from ..language import Language
from ..own_animations import (
    TABLES,
    OwnAnimation,
    free_name,
    keep,
    own_animations,
    why_not_animation,
)
from ..program import Block, Project

_TABLES = frozenset(table for tables in TABLES.values() for table in tables)


class Use(NamedTuple):
    """A block that names an animation, and in which field."""

    block: str
    slot: str


def animation_uses(editor: Editor, name: str) -> list[Use]:
    """The blocks that play an animation, in the order of their making."""
    blocks = editor.project.blocks.values()
    return [use for use, used in _uses_in(blocks, editor.language) if used == name]


def use_of(editor: Editor, block_id: str) -> Use | None:
    """The field in which a block names an animation, or None when it has none."""
    uses = _uses_in([editor.project.blocks[block_id]], editor.language)
    return next((use for use, _ in uses), None)


def keep_animation(editor: Editor, animation: OwnAnimation, name: str = "") -> str:
    """Keep an animation, under its name or a new one; gives the name. Raises EditRefused."""
    name = name or new_name(editor, animation.title)
    if (reason := why_not_animation(name, animation)) is not None:
        raise EditRefused(
            "This motion cannot be kept: {reason}",
            checklist=("Give it a name and at least one pose, then keep it again.",),
            reason=reason,
        )
    editor.apply(keep(name, animation), "keep a motion")
    return name


def rename_animation(editor: Editor, name: str, title: str) -> str:
    """Give an animation another title, and the name that goes with it; its uses follow."""
    animation = _known(editor, name)
    new = free_name(title, _taken(editor) - {name})
    with editor.transaction("rename a motion"):
        uses = animation_uses(editor, name)
        keep_animation(editor, replace(animation, title=title), new)
        if new != name:
            for use in uses:
                editor.apply(SetField(use.block, use.slot, new))
            editor.apply(keep(name, None))
    return new


def delete_animation(editor: Editor, name: str) -> None:
    """Delete an animation. Blocks that play it stay, and a check tells of them."""
    _known(editor, name)
    editor.apply(keep(name, None), "delete a motion")


def take_along(target: Project, source: Project, language: Language) -> None:
    """Give a project of copied blocks the animations that they name, from where they were."""
    used = {name for _, name in _uses_in(target.blocks.values(), language)}
    for name, animation in own_animations(source).items():
        if name in used:
            keep(name, animation).apply(target)


def bring_animations(editor: Editor, source: Project) -> None:
    """Keep the animations that come with blocks; one that has the name already stays."""
    taken = _taken(editor)
    for name, animation in own_animations(source).items():
        if name not in taken:
            editor.apply(keep(name, animation))


def new_name(editor: Editor, title: str) -> str:
    """A name for a new animation with this title."""
    return free_name(title, _taken(editor))


def _known(editor: Editor, name: str) -> OwnAnimation:
    animation = own_animations(editor.project).get(name)
    if animation is None:
        raise EditRefused(
            "This project has no motion “{name}”.",
            checklist=("Open the list of motions, and choose one of those.",),
            name=name,
        )
    return animation


def _taken(editor: Editor) -> set[str]:
    tables = editor.language.choices
    names = {name for table in _TABLES for name in tables.get(table, ())}
    return names | own_animations(editor.project).keys()


def _uses_in(blocks: Iterable[Block], language: Language) -> Iterator[tuple[Use, object]]:
    """Each field of blocks that names an animation, and the name in it."""
    for block in blocks:
        definition = language.definitions.get(block.type)
        if definition is None:
            continue
        for key, slot in definition.keys(block.groups):
            if slot.table in _TABLES:
                yield Use(block.id, key), definition.value(block, key)

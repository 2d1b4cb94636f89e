"""Own blocks out of a project into a pack, out of a pack into a project, and newer ones there."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from msgspec.structs import replace

from ..editor import Editor
from ..edits.content import ChangeProcedure
from ..edits.placing import DeleteBlocks
from ..errors import EditRefused, PackError
from ..language import Language
from ..packs import About, Pack, pack_of
from ..places import procedure_uses
from ..procedures import header_of, parameters, procedure_of, title
from ..program import PAGES, Origin, Procedure, Project, Stack
from .copying import (
    STEP,
    Clip,
    Names,
    bring_definitions,
    copy,
    lowest,
    renamed_type,
)

# Out of a project.


def needed(project: Project, chosen: Iterable[str]) -> list[str]:
    """Own blocks, and those that their definitions call, in the order of the project."""
    found, waiting = set[str](), list(chosen)
    while waiting:
        own = waiting.pop()
        if own not in found and own in project.procedures:
            found.add(own)
            waiting += {procedure_of(block.type) for block in project.within(_stack(project, own))}
    return [own for own in project.procedures if own in found]


def _stack(project: Project, procedure: str) -> list[str]:
    """The blocks of the definition of an own block; none where it has no header."""
    header = header_of(project, procedure)
    return list(project.stack_of(header).body) if header else []


def packed(
    project: Project, language: Language, chosen: Iterable[str], about: About, name: str
) -> Pack:
    """A pack of own blocks with all that they need; raises PackError.

    Blocks that were in an earlier version of the pack have the id there that they had in it.
    """
    chosen = list(chosen)
    every = needed(project, chosen)
    for own in every:
        if not header_of(project, own):
            raise PackError(
                "“{own_block}” has no “define” block: nothing says what it does.",
                checklist=("Put its “define” block onto a page, or take its uses out.",),
                own_block=title(project.procedures[own]),
            )
    ids = _ids_in_pack(project, every, about.id)
    made = Project(name)
    for own in every:
        stack = Stack(f"s_{ids[own]}", STEP, _below(made), _stack(project, own))
        _add(made, copy(project, language, stack.body).project, stack)
    _call_otherwise(made, ids)
    offers = tuple(ids[own] for own in chosen)
    return pack_of(made, replace(about, offers=offers), language)


def _below(project: Project) -> float:
    return lowest(project, PAGES[0])


def _add(made: Project, clip: Project, stack: Stack) -> None:
    """Put a definition with what it names into a pack; ids are those of the project it is from."""
    made.blocks |= clip.blocks
    made.parents |= clip.parents
    for first in stack.body:
        made.parents[first] = made.parents[first]._replace(owner=stack.id)
    made.stacks[stack.id] = stack
    made.pages[PAGES[0]].append(stack)
    known = {variable.id for variable in made.variables}
    made.variables += [one for one in clip.variables if one.id not in known]
    made.procedures |= clip.procedures
    made.extra |= clip.extra


def _ids_in_pack(project: Project, every: list[str], pack: str) -> dict[str, str]:
    """The ids of own blocks in a pack by those in the project."""
    origins = {own: project.procedures[own].origin for own in every}
    ids: dict[str, str] = {}
    for own, origin in origins.items():
        if origin is not None and origin.pack == pack and origin.block not in ids.values():
            ids[own] = origin.block
    for own in every:
        number, free = 2, own
        while own not in ids and free in ids.values():
            free, number = f"{own[:50]}_{number}", number + 1
        ids.setdefault(own, free)
    return ids


def _call_otherwise(made: Project, ids: Mapping[str, str]) -> None:
    """Give the own blocks of a pack their ids there; they come from nowhere."""
    names = Names(procedures=dict(ids))
    for block in made.blocks.values():
        block.type = renamed_type(block.type, names)
    made.procedures = {
        ids[own]: replace(made.procedures[own], id=ids[own], origin=None) for own in ids
    }
    made.touch_procedures()


def mark(editor: Editor, pack: Pack, chosen: Iterable[str]) -> None:
    """Let own blocks of a project say that they are in a pack that was made of them."""
    project = editor.project
    every = needed(project, chosen)
    for own, block in _ids_in_pack(project, every, pack.about.id).items():
        procedure = project.procedures[own]
        is_free = procedure.origin is None or procedure.origin.pack == pack.about.id
        if is_free or block in pack.about.offers:
            origin = Origin(pack.about.id, block, pack.about.version, pack.title)
            editor.apply(ChangeProcedure(replace(procedure, origin=origin)))


# Into a project.


def definitions_in(pack: Pack, language: Language, blocks: Iterable[str]) -> Clip:
    """The definitions of some blocks of a pack, with those that they need."""
    source = pack.project
    ids = [block for own in needed(source, blocks) for block in _stack(source, own)]
    clip = copy(source, language.of(source), ids)
    project = clip.project
    project.procedures = {
        own: pack.from_here(procedure) for own, procedure in project.procedures.items()
    }
    project.touch_procedures()
    return clip


# A newer version in the place of the one that a project has.


@dataclass(frozen=True)
class Updated:
    """What an update did: the own blocks that are new now, and those that are in it no more.

    ``to_look_at`` are the calls that lost a value or have a new place: a person decides.
    """

    blocks: tuple[str, ...]
    to_look_at: tuple[str, ...]
    left: tuple[str, ...]


def copies(project: Project, pack: Pack) -> list[Procedure]:
    """The own blocks of a project that are copies of another version of what is in a pack."""
    return [
        own
        for own in project.procedures.values()
        if own.origin is not None
        and own.origin.pack == pack.about.id
        and own.origin.version < pack.about.version
    ]


def is_outdated(project: Project, pack: Pack) -> bool:
    """Whether a project has older copies of blocks of a pack, which an update would renew."""
    known = pack.project.procedures
    return any(
        own.origin is not None and own.origin.block in known for own in copies(project, pack)
    )


def update(editor: Editor, pack: Pack) -> Updated:
    """Let the copies in a project be as this version of their pack has them, as one step.

    Calls keep their values where the parameters still are; raises EditRefused.
    """
    project, known = editor.project, pack.project.procedures
    old = [(own, own.origin.block) for own in copies(project, pack) if own.origin is not None]
    renewed = [(own, known[block]) for own, block in old if block in known]
    if not renewed:
        raise EditRefused(
            "This project has no older blocks of “{pack}”.",
            checklist=("Choose another pack in the palette.",),
            pack=pack.title,
        )
    with editor.transaction("update blocks of a pack"):
        places = {own.id: _take_definition(editor, own.id) for own, _ in renewed}
        to_look_at = [call for own, new in renewed for call in _renew(editor, own, new, pack)]
        where = {new.id: places[own.id] for own, new in renewed}
        bring_definitions(editor, definitions_in(pack, editor.language, where), where)
    left = tuple(title(own) for own, block in old if block not in known)
    calls = tuple(call for call in dict.fromkeys(to_look_at) if call in project.blocks)
    return Updated(tuple(own.id for own, _ in renewed), calls, left)


def _take_definition(editor: Editor, procedure: str) -> tuple[str, float, float] | None:
    """Delete the definition of an own block; gives its page and place."""
    project = editor.project
    header = header_of(project, procedure)
    if not header:
        return None
    stack = project.stack_of(header)
    place = project.page_of(header), stack.x, stack.y
    editor.apply(DeleteBlocks(header, len(stack.body)))
    return place


def _renew(editor: Editor, own: Procedure, new: Procedure, pack: Pack) -> list[str]:
    """Let an own block be the new one; gives the calls that a person should look at."""
    changed = replace(pack.from_here(new), id=own.id)
    had = {parameter.id: parameter.kind for parameter in parameters(own)}
    has = {parameter.id: parameter.kind for parameter in parameters(changed)}
    calls = procedure_uses(editor.project, own.id)
    is_other = had != has or own.gives_value != changed.gives_value
    editor.replace_procedure(changed)
    return calls if is_other else []

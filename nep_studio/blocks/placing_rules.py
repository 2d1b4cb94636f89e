"""Why blocks cannot be put into a place: what is above and below, the slot, the page."""

from __future__ import annotations

from .connections import why_no_body, why_not_below, why_not_chained, why_not_plugged
from .definitions import Definition
from .edits import CreateBlocks, MoveBlocks
from .fitting import why_not_block
from .language import Language
from .places import InBody, InInput, InStack, NewStack, Place
from .procedures import DEFINE
from .program import FARTHEST, Block, Project


def is_near(x: float, y: float) -> bool:
    """Whether a place is near enough to the page's corner."""
    return abs(x) <= FARTHEST and abs(y) <= FARTHEST


def why_not_move(edit: MoveBlocks, project: Project, language: Language) -> str | None:
    """Why blocks cannot be moved."""
    if edit.first not in project.blocks:
        return "This block is not there any more."
    chain = project.chain_of(project.parents[edit.first]) or [edit.first]
    start = chain.index(edit.first) if edit.first in chain else 0
    roots = [project.blocks[i] for i in chain[start : start + edit.count]]
    return _why_not_here(roots or [project.blocks[edit.first]], edit.place, project, language)


def why_not_create(edit: CreateBlocks, project: Project, language: Language) -> str | None:
    """Why blocks cannot be made."""
    by_id = {block.id: block for block in edit.blocks}
    inside = [child for block in edit.blocks for child in block.children()]
    if not edit.roots or not by_id.keys() >= {*inside, *edit.roots}:
        return "These blocks are not complete."
    for block in edit.blocks:
        if (reason := why_not_block(block, by_id, language)) is not None:
            return reason
        if block.type.startswith(DEFINE) and _is_there(block.type, project):
            return "This block is defined already: a block has one definition."
    return _why_not_here([by_id[root] for root in edit.roots], edit.place, project, language)


def _is_there(block_type: str, project: Project) -> bool:
    return any(project.blocks[s.body[0]].type == block_type for s in project.stacks.values())


def _why_not_here(
    roots: list[Block], place: Place, project: Project, language: Language
) -> str | None:
    """Why these blocks cannot be put, one after the other, into a place."""
    if isinstance(place, NewStack) and not is_near(place.x, place.y):
        return "This is too far outside the page."
    if isinstance(place, InInput | InBody):
        owner = project.blocks.get(place.block)
        if owner is None:
            return "This block is not there any more."
        if isinstance(place, InInput):
            return why_not_plugged(owner, place.slot, roots[0], language.definitions)
        if (reason := why_no_body(owner, place.slot, language.definitions)) is not None:
            return reason
    return _why_not_page(roots, place, project, language) or _why_not_between(
        roots, place, project, language
    )


def _why_not_between(
    roots: list[Block], place: Place, project: Project, language: Language
) -> str | None:
    """Why these blocks cannot be between those that are above and below a place."""

    def definition(block: Block) -> Definition | None:
        return language.definitions.get(block.type)

    above, below = _neighbours({block.id for block in roots}, place, project)
    is_top = above is None and not isinstance(place, InBody)
    reason = why_not_chained(definition(roots[0]), first_in_stack=is_top)
    if reason is None and above is not None:
        reason = why_not_below(definition(above))
    if reason is None and below is not None:
        reason = why_not_below(definition(roots[-1])) or why_not_chained(
            definition(below), first_in_stack=False
        )
    return reason


def _why_not_page(
    roots: list[Block], place: Place, project: Project, language: Language
) -> str | None:
    if isinstance(place, NewStack):
        page = place.page
    elif isinstance(place, InStack) and place.stack in project.stacks:
        page = project.page_of(place.stack)
    elif isinstance(place, InBody) and place.block in project.blocks:
        page = project.page_of(project.stack_of(place.block).id)
    else:
        return None
    for block in roots:
        definition = language.definitions.get(block.type)
        if definition is not None and definition.page != project.kind_of_page(page):
            return f"This block belongs on the page {definition.page.title()}."
    return None


def _neighbours(
    moved: set[str], place: Place, project: Project
) -> tuple[Block | None, Block | None]:
    """The blocks that will be directly above and below a place."""
    if isinstance(place, InStack) and place.stack in project.stacks:
        chain = project.stacks[place.stack].body
    elif isinstance(place, InBody) and place.block in project.blocks:
        chain = project.blocks[place.block].bodies.get(place.slot, [])
    else:
        return None, None
    left = chain if moved.isdisjoint(chain) else [i for i in chain if i not in moved]
    above = project.blocks[left[place.index - 1]] if 0 < place.index <= len(left) else None
    below = project.blocks[left[place.index]] if 0 <= place.index < len(left) else None
    return above, below

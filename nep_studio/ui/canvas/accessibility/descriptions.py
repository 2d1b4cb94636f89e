"""A block in the words that a screen reader says."""

from __future__ import annotations

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence
from nep_studio.ui.words import count_words, tr


def described(editor: Editor, block_id: str, problem: str = "") -> str:
    """A block's sentence, and what its looks say: "repeat 10 times, contains 3 blocks"."""
    project = editor.project
    block = project.blocks[block_id]
    parts = [sentence(project, editor.language, block_id)]
    if block.bodies:
        inside = sum(1 for chain in block.bodies.values() for _ in project.within(chain))
        parts.append(count_words(inside, "contains 1 block", "contains {n} blocks"))
    if block.collapsed:
        parts.append(tr("folded"))
    if block.disabled:
        parts.append(tr("switched off"))
    if block.comment:
        parts.append(tr("comment: {comment}", comment=block.comment))
    if problem:
        parts.append(tr("problem: {problem}", problem=problem))
    return ", ".join(parts)


def position(project: Project, block_id: str) -> str:
    """Where a block is: "2 of 5", or "in a slot"."""
    chain = project.chain_of(project.parents[block_id])
    if chain is None or block_id not in chain:
        return tr("in a slot")
    return tr("{number} of {count}", number=chain.index(block_id) + 1, count=len(chain))


def level(project: Project, block_id: str) -> int:
    """How deep a block is: 1 for a block of a stack."""
    depth, owner = 0, block_id
    while owner in project.parents:
        owner, depth = project.parents[owner].owner, depth + 1
    return depth

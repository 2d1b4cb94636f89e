"""The sentence of a suggested block, and where in it the typed words are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..from_python.made import Made, blocks_of
from ..language import Language
from ..operations.finding import folded
from ..program import Parent, Project, Variable
from ..text import sentence


def label_of(
    made: Made, language: Language, project: Project, new_variables: Mapping[str, str]
) -> str:
    """What the block will say."""
    shown = Project(project.name)
    shown.variables = [*project.variables]
    shown.variables += [Variable(new, name) for new, name in new_variables.items()]
    roots, blocks = blocks_of(shown, language, [made])
    shown.blocks = {block.id: block for block in blocks}
    shown.parents = {root: Parent("s0") for root in roots}
    return sentence(shown, language, roots[0])


def spans_in(label: str, matched: Sequence[str]) -> tuple[tuple[int, int], ...]:
    """Where the matched words stand in a label, in its order and without overlaps."""
    plain = folded(label)
    if len(plain) != len(label):
        return ()  # letters that fold into two: no places can be told
    spans: list[tuple[int, int]] = []
    for word in matched:
        start = _place(plain, folded(word), spans)
        if start >= 0:
            spans.append((start, start + len(folded(word))))
    return tuple(sorted(spans))


def _place(plain: str, word: str, taken: Sequence[tuple[int, int]]) -> int:
    """The first place of a word, at the beginning of a word where there is one."""
    start = plain.find(word) if word else -1
    best = -1
    while start >= 0:
        is_free = all(start >= end or start + len(word) <= begin for begin, end in taken)
        if is_free and (start == 0 or not plain[start - 1].isalnum()):
            return start
        if is_free and best < 0:
            best = start
        start = plain.find(word, start + 1)
    return best

"""Make the block of a suggestion in the program, as one step."""

from __future__ import annotations

from ..definitions import Definition
from ..editor import Editor
from ..edits import AddVariable, CreateBlocks
from ..from_python.made import blocks_of
from ..operations.copying import Clip, clip_of
from ..operations.moving import Point, create_and_drop, why_not_create
from ..places import NewStack, Place
from .suggesting import Fits, Suggestion


def create(
    editor: Editor,
    suggestion: Suggestion,
    place: Place,
    *,
    wrap: bool = False,
    beside: Point | None = None,
) -> str:
    """Make the block of a suggestion in a place, as ``create_and_drop`` does; gives its id."""
    with editor.transaction("add blocks"):
        clip = clip_of_suggestion(editor, suggestion)
        return create_and_drop(editor, clip, place, wrap=wrap, beside=beside)[0]


def clip_of_suggestion(editor: Editor, suggestion: Suggestion) -> Clip:
    """A clip of the block of a suggestion, to be shown or to be put into a place."""
    clip = Clip()
    project = clip.project
    for variable in editor.project.variables:
        AddVariable(variable.id, variable.name, len(project.variables)).apply(project)
    names = {variable.name for variable in editor.project.variables}
    for new, name in suggestion.new_variables.items():
        if name not in names:
            AddVariable(new, name, len(project.variables)).apply(project)
    for procedure in editor.project.procedures.values():
        project.procedures[procedure.id] = procedure
    project.touch_procedures()
    roots, blocks = blocks_of(project, editor.language, [suggestion.made])
    page = editor.language.definitions[suggestion.block_type].page
    place = NewStack(page, project.new_id("s"), 0, 0, 0)
    CreateBlocks(roots, blocks, place).apply(project)
    return clip


def fitting(editor: Editor, place: Place) -> Fits:
    """A filter for suggestions: the blocks that can be put into a place."""
    known: dict[str, bool] = {}

    def fits(definition: Definition) -> bool:
        if definition.id not in known:
            clip = clip_of(editor.language, definition.id)
            known[definition.id] = why_not_create(editor, clip, place) is None
        return known[definition.id]

    return fits

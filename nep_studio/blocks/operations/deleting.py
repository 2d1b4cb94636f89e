"""Delete blocks; what was deleted is given back, for the list of deleted blocks."""

from __future__ import annotations

from collections.abc import Iterable

from ..editor import Editor
from ..edits import DeleteBlocks
from .copying import Clip, copy
from .selection import require_runs


def delete(editor: Editor, ids: Iterable[str]) -> Clip:
    """Delete blocks with all that is inside them; chains close up. Gives what was deleted."""
    ids = list(ids)
    chosen = require_runs(editor.project, ids)
    deleted = copy(editor.project, editor.language, ids)
    with editor.transaction("delete blocks"):
        for run in chosen:
            editor.apply(DeleteBlocks(run.first, run.count))
    return deleted

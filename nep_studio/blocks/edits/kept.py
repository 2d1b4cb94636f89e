"""An edit of what a project keeps besides its program, such as the cues of its operator."""

from __future__ import annotations

from typing import Any, ClassVar

import msgspec

from ..file_text import is_deeper
from ..program import Project

FILE_KEYS = frozenset(
    (
        "format",
        "version",
        "name",
        "pages",
        "blocks",
        "variables",
        "procedures",
        "notes",
        "page_order",
    )
)
"""The keys of the program itself, which nothing else may be kept under."""

LONGEST_KEY = 64
LARGEST_BYTES = 200_000
ANIMATION = "animation_"
"""What the keys of the project's animations begin with: a dance has many numbers."""
GESTURE = "gesture_"
RECORDING = "recording_"
RECOGNISER = "recogniser"
"""The keys of what the project knows of gestures: gestures, recordings, and what was learned."""
_LARGEST_OF = {
    ANIMATION: 1_000_000,
    GESTURE: 1_000_000,
    RECORDING: 12_000_000,
    RECOGNISER: 8_000_000,
}
DEEPEST = 20


class SetExtra(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """Keep a JSON value under a key of the project's file; None takes it away.

    Programs that do not know the key save it as it was.
    """

    label: ClassVar[str] = "change what the project keeps"
    key: str
    value: Any = None

    def apply(self, project: Project) -> SetExtra:
        """Keep the value."""
        old = SetExtra(self.key, project.extra.get(self.key))
        if self.value is None:
            project.extra.pop(self.key, None)
        else:
            project.extra[self.key] = self.value
        project.touch_extra()
        project.changes.kept.add(self.key)
        return old


def why_not_extra(key: str, value: object) -> str | None:
    """Why a value cannot be kept under a key, or None when it can."""
    if key in FILE_KEYS or not key.isidentifier() or len(key) > LONGEST_KEY:
        return "Nothing can be kept under this name."
    try:
        size = len(msgspec.json.encode(value))
    except (TypeError, ValueError, RecursionError, UnicodeEncodeError):
        return "This cannot be written into the project's file."
    sizes = (most for prefix, most in _LARGEST_OF.items() if key.startswith(prefix))
    if size > next(sizes, LARGEST_BYTES) or is_deeper(value, DEEPEST):
        return "This is too much to be kept in the project's file."
    return None

"""The edits that change a program. Each is data, and applying it gives the edit that undoes it.

An edit checks that the program stays one (ids that exist, a free place, no block inside itself)
and raises EditRefused before anything has changed. Whether blocks *belong* together is asked by
editor.py. All edits can be written as JSON: a journal of them is a crash-safe autosave.
"""

from __future__ import annotations

from functools import reduce
from operator import or_
from typing import Any

from . import content, placing, project
from .edit import Edit

ANY_EDIT: Any = reduce(or_, Edit.__subclasses__())
"""All kinds of edits, to read one from JSON."""

__all__ = ["ANY_EDIT", "Edit", "content", "placing", "project"]

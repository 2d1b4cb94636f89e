"""What every edit is: data that changes a program, and gives the edit that undoes it."""

from __future__ import annotations

from typing import ClassVar

import msgspec

from nep_studio.blocks.program import Project


class Edit(msgspec.Struct, tag_field="edit", frozen=True, tag=True):
    """One change of a program; in JSON its class is named as "edit"."""

    label: ClassVar[str]
    """What it does, for the name of a step that can be undone."""

    def apply(self, project: Project) -> Edit:
        """Change the program; the edit that undoes it. Raises EditRefused, with nothing changed."""
        raise NotImplementedError

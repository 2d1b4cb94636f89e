"""Where the files are that the nodes read: robots, animations, models, sample recordings."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from nep_core.errors import NodeStartError

OVERRIDE = "NEP_RESOURCES"


def resource_folder() -> Path:
    """Return the folder of resources of this checkout, wheel or frozen program.

    The environment variable ``NEP_RESOURCES`` goes first. Raises NodeStartError when none is there.
    """
    for folder in _candidates():
        if folder.is_dir():
            return folder
    tried = ", ".join(str(folder) for folder in _candidates())
    raise NodeStartError(
        "The files that come with NEP Studio (its resources folder) are not where they should be.",
        checklist=(
            "Install NEP Studio again.",
            "If you moved that folder yourself, put its place in the variable {override}.",
        ),
        details=f"Looked in: {tried}",
        override=OVERRIDE,
    )


def _candidates() -> list[Path]:
    override = os.environ.get(OVERRIDE)
    if override:
        return [Path(override)]
    frozen = getattr(sys, "_MEIPASS", None)
    if frozen:
        return [Path(frozen) / "resources"]
    # The wheel goes first: beside an installed package, "resources" could be anybody's.
    root = Path(__file__).resolve().parent.parent
    return [root / "nep_studio" / "resources", root / "resources"]

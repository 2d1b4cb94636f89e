"""Where the studio's own files are: in a checkout, in an installed wheel, or frozen."""

from __future__ import annotations

import sys
from pathlib import Path


def resources() -> Path:
    """Blocks, robots, gestures, examples."""
    frozen = getattr(sys, "_MEIPASS", None)
    beside = (Path(frozen) if frozen else Path(__file__).resolve().parent.parent) / "resources"
    return beside if beside.is_dir() else Path(__file__).resolve().parent / "resources"


def examples() -> Path:
    """The example projects."""
    return resources() / "examples"


# Where the documentation that comes with the program lies: pages for a browser.

ENGLISH, FIRST = "en", "index.html"


def documentation_folder() -> Path:
    """In a frozen program beside its resources, else where tools/build_site.py puts it."""
    frozen = getattr(sys, "_MEIPASS", None)
    if frozen:
        return Path(frozen) / "documentation"
    return Path(__file__).resolve().parent.parent / "build" / "site"


def first_page(language: str) -> Path | None:
    """The page to begin with in a language, else in English; None where there are no pages."""
    folder = documentation_folder()
    own = folder if language == ENGLISH else folder / language
    return next((each / FIRST for each in (own, folder) if (each / FIRST).is_file()), None)

"""Everything with a widget: the window, the canvas, the panels."""

from __future__ import annotations

import builtins
import importlib


def _import_qt() -> None:
    """Import Qt, and let it not look into every module that is imported after it.

    PySide6 puts an import function of its own in place, which reads the source of each module to
    see whether it may use ``__feature__`` switches. We use none, and it is a tenth of the start.
    """
    plain_import = builtins.__import__
    importlib.import_module("PySide6.QtCore")
    builtins.__import__ = plain_import


_import_qt()

"""Everything with a widget: the window, the canvas, the panels.

``shell`` is the window and alone knows it, ``canvas`` the blocks, ``workbench`` what stands around
them, ``running`` a run as it is seen, ``plugins`` what can be left out, ``widgets`` and ``theme``
what all of them use. What is true without a screen goes to ``blocks``, ``project`` or ``run``;
words are made here, in the language of the person, by ``tr``.
"""

from __future__ import annotations

import builtins
import importlib


def _import_qt() -> None:
    """Import Qt, and let it not look into every module that is imported after it.

    WORKAROUND for https://github.com/napari/napari/issues/8584: PySide6 puts an import function of
    its own in place, which reads the source of each module to see whether it may use the switches
    of ``__feature__``. We use none, and it takes 80 ms of CPU of a start (PySide6 6.11). Where Qt
    was imported before us, nothing changes. The function may go once PySide6 does this no more.
    """
    plain_import = builtins.__import__
    importlib.import_module("PySide6.QtCore")
    builtins.__import__ = plain_import


_import_qt()

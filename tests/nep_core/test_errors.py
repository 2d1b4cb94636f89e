"""Errors say what to try, wherever they are shown."""

from __future__ import annotations

import traceback

from nep_core.errors import MasterNotFound


def test_a_traceback_of_somebodys_script_shows_what_to_try():
    error = MasterNotFound("No master answers.", checklist=("Start one: nep master", "Wait."))

    shown = "".join(traceback.format_exception(error))

    assert shown.endswith("No master answers.\n  [ ] Start one: nep master\n  [ ] Wait.\n")

"""What went wrong in a user's program, in plain words, with its line and what to try."""

from __future__ import annotations

import re
import traceback
from collections.abc import Mapping
from dataclasses import dataclass

from nep_core.errors import NepError
from nodes.cognitive.failing_line import kind_of_type, values_at
from nodes.cognitive.failure_sentences import OTHER, SENTENCES, Told


class ProgramFailed(NepError):
    """The user's program ended with an error."""

    title = "The program stopped with an error"


@dataclass(frozen=True)
class Failure:
    """What happened, and what to try in order."""

    sentence: str
    checklist: tuple[str, ...] = ()


def failure_of(error: BaseException) -> Failure:
    """What a person should read about an error of a program."""
    if isinstance(error, NepError):
        return Failure(error.sentence, error.checklist)
    values = values_at(error)
    fitting = (_filled(told, error, values) for told in (*SENTENCES, OTHER))
    return next(failure for failure in fitting if failure is not None)


def _filled(told: Told, error: BaseException, values: Mapping[str, str]) -> Failure | None:
    """A sentence with its values; None when it is of another error, or a value is not known."""
    said = re.search(told.pattern, _words(error)) if isinstance(error, told.error) else None
    if said is None:
        return None
    known = {"error": type(error).__name__, "said": _words(error).rstrip(".")}
    known |= {**values, **_groups(said), **_of_name(error)}
    try:
        return Failure(told.sentence.format_map(known), told.steps)
    except KeyError:
        return None


def _words(error: BaseException) -> str:
    """What Python says about an error, on one line."""
    if isinstance(error, SyntaxError):
        return error.msg
    if isinstance(error, SystemExit):
        return str(error.code)
    return " ".join(str(error).split()) or type(error).__name__


def _groups(said: re.Match[str]) -> dict[str, str]:
    """The values in what Python says; names of its types become words."""
    found = {name: text for name, text in said.groupdict().items() if text is not None}
    return {
        name: kind_of_type(text) if name in ("noun", "result") else text
        for name, text in found.items()
    }


def _of_name(error: BaseException) -> dict[str, str]:
    if isinstance(error, NameError) and error.name:
        return {"name": error.name}
    return {}


def line_of(error: BaseException, file: str) -> int:
    """The line of ``file`` in which the error happened, from 1; 0 when it was elsewhere."""
    if isinstance(error, SyntaxError) and error.filename == file:
        return error.lineno or 0
    lines = [
        frame.lineno or 0
        for frame in traceback.extract_tb(error.__traceback__)
        if frame.filename == file
    ]
    return lines[-1] if lines else 0

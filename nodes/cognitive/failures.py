"""What went wrong in a user's program, in plain words and with its line."""

from __future__ import annotations

import re
import traceback

from nep_core.errors import NepError


class ProgramFailed(NepError):
    """The user's program ended with an error."""

    title = "The program stopped with an error"


def describe(error: BaseException) -> str:
    """One sentence that says what happened, for the errors that blocks can cause."""
    match error:
        case NepError():
            return error.sentence
        case ZeroDivisionError():
            return "A number was divided by zero."
        case NameError():
            return f'Something called "{_name_in(error)}" was used before it had a value.'
        case SystemExit():
            return f"The program ended itself with: {error.code}."
        case SyntaxError():
            return f"The program is not Python that can run: {error.msg}."
        case OverflowError():
            return "A number became too large."
        case RecursionError():
            return "The program called itself too many times."
        case TypeError():
            return f"Texts and numbers were mixed where only one kind fits ({error})."
        case ValueError():
            return f"A value did not fit: {error}."
        case _:
            return f"{type(error).__name__}: {error}"


def _name_in(error: NameError) -> str:
    quoted = re.search(r"'(\w+)'", str(error))
    return error.name or (quoted[1] if quoted else "a variable")


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

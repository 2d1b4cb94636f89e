"""The variables that a whole program shares, as attributes of one object."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

SHARED_OBJECTS = ("program", "kept")
"""What the objects are called in a program whose attributes are its variables."""


class Variables:
    """The variables of a program: ``program = Variables(score=0)``, then ``program.score += 1``.

    Each holds whatever was put there last, of any kind.
    """

    def __init__(self, /, **first: object) -> None:
        self.__dict__.update(first)

    def __repr__(self) -> str:
        held = ", ".join(f"{name}={value!r}" for name, value in self.__dict__.items())
        return f"{type(self).__name__}({held})"

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...
        def __setattr__(self, name: str, value: Any) -> None: ...


def variables_in(held: object) -> dict[str, object]:
    """The variables that such an object holds, read without running any code; {} of another."""
    return held.__dict__ if isinstance(held, Variables) else {}

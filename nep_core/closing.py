"""What is closed at the end of a ``with`` statement."""

from __future__ import annotations

from typing import Self


class Closing:
    """Gives a class that has ``close`` the ``with`` statement."""

    def close(self) -> None:
        """End."""
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

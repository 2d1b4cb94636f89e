"""What the tests of fields share."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from field_desk import Desk
from PySide6.QtWidgets import QApplication


@pytest.fixture
def controller_of(qtbot) -> Iterator[Callable[..., Desk]]:
    """Makes desks; whatever was left open on them is closed at the end."""
    desks: list[Desk] = []

    def make(block_type: str, **fields) -> Desk:
        desks.append(Desk(qtbot, block_type, **fields))
        return desks[-1]

    yield make
    for desk in desks:
        desk.fields.close()
        desk.fields.comments.close()
    QApplication.processEvents()

"""Lets the stories begin before all other tests: no worker is to be left with one at the end."""

from __future__ import annotations

from pathlib import Path

import pytest

STORIES = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the stories first; all else stays in its order."""
    items.sort(key=lambda item: STORIES not in item.path.parents)

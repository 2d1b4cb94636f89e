"""The rows of the table of benchmarks, from what each of them says of itself."""

from __future__ import annotations

import ast
from pathlib import Path

from benchmarks.__main__ import FOLDER, benchmark_names


def benchmark_rows() -> str:
    """A row for each benchmark: its name, and what it measures."""
    return "\n".join(
        f"| `{name}` | {_told(FOLDER / f'{name}.py')} |" for name in benchmark_names(FOLDER)
    )


def _told(path: Path) -> str:
    """The first line of a module's docstring; it is read without running the module."""
    told = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return told.splitlines()[0].replace("|", "\\|")

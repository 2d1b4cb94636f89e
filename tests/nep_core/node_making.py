"""Writes small nodes for tests."""

from __future__ import annotations

from pathlib import Path


def write_node(
    folder: Path, name: str, code: str, *, type_: str = "sensory", manifest: str = ""
) -> None:
    """A node with these lines as its ``run`` function."""
    place = folder / type_
    place.mkdir(parents=True, exist_ok=True)
    text = f'type = "{type_}"\nname = "{name}"\ntitle = "T"\ndescription = "D"\n{manifest}'
    (place / f"{name}.toml").write_text(text, encoding="utf-8")
    lines = "".join(f"    {line}\n" for line in code.strip().splitlines())
    head = "import os, sys, time, subprocess\nfrom nep_core.errors import NepError\n"
    source = f"{head}def run(node, **settings):\n{lines}"
    (place / f"{name}.py").write_text(source, encoding="utf-8")

"""Which files become pages, where they lie on the site, and how its contents are ordered."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
GUIDE = DOCS / "guide"

START, HOW_TO, DEVELOPERS = "start", "how-to", "developers"
GROUPS = {
    START: "Begin here",
    HOW_TO: "How to",
    "problems": "Problems",
    "blocks": "Blocks",
    "nodes": "Nodes",
    "messages": "Messages",
    "commands": "Commands",
    DEVELOPERS: "For robot developers",
}
"""The groups of the contents, in their order; those of the help have its titles."""

GUIDES = ("index", "install", "first-program", "teachers", "museums", "developers", "benchmarks")
FOR_DEVELOPERS = (
    "first_node",
    "command_line",
    "wire",
    "languages",
    "transports",
    "open_network",
    "original_nep",
    "robot_blocks",
    "naoqi_services",
    "sensors",
    "imu_profiles",
    "gesture_models",
    "gestures",
    "language",
    "benchmarks",
    "canvas",
)
"""The order of the pages for developers; those that are not named here come behind these."""

BESIDE = {
    ROOT / "examples" / "README.md": "developers/languages.html",
    ROOT / "CONTRIBUTING.md": "developers/contributing.html",
    ROOT / "GLOSSARY.md": "developers/glossary.html",
    ROOT / "CHANGELOG.md": "whats-new.html",
}
"""Files beside docs that are pages too."""

MADE_OF = {
    ROOT / "resources" / "help" / "en": "how-to/index.html",
    ROOT / "resources" / "blocks": "blocks/index.html",
    ROOT / "nodes": "nodes/index.html",
    ROOT / "nep_core" / "wire" / "messages.py": "messages.html",
    ROOT / "nep_studio" / "__main__.py": "commands.html",
}
"""What pages are made of that nobody writes: a link to it leads to the page."""


def sources() -> dict[Path, str]:
    """Every file in Markdown that becomes a page, with its path on the site, in their order."""
    found = dict(_guides())
    others = {path: f"developers/{path.stem}.html" for path in sorted(DOCS.glob("*.md"))}
    others[DOCS / "study.md"] = "study.html"
    others[GUIDE / "benchmarks.md"] = "developers/benchmarks.html"
    return found | dict(sorted((others | BESIDE).items(), key=lambda item: _rank(item[1])))


def group_of(path: str) -> str:
    """The group of the contents to which a page in Markdown belongs."""
    return DEVELOPERS if path.startswith(DEVELOPERS) else START


def _guides() -> Iterator[tuple[Path, str]]:
    for name in GUIDES[:-1]:
        yield GUIDE / f"{name}.md", f"{name}.html"


def _rank(path: str) -> tuple[bool, int, str]:
    """Beginning pages first, then those that have a place, then the others by name."""
    name = Path(path).stem
    place = FOR_DEVELOPERS.index(name) if name in FOR_DEVELOPERS else len(FOR_DEVELOPERS)
    return path.startswith(DEVELOPERS), place, name

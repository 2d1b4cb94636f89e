"""Plays the newcomer's story on a virtual screen and keeps a picture of each of its steps.

    .venv/bin/python tools/story_images.py              those of the pages, into docs/images
    .venv/bin/python tools/story_images.py FOLDER       into another folder

The robot moves and the watch measures while the pictures are taken, so no two runs give exactly
the same: a test plays the story, but does not compare them.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.virtual_display import virtual_display

STORY = "tests/stories/test_window_story.py"
SHOWN = ("story-3-impressive", "story-6-what-is-missing")
"""Those that the documentation shows; all are kept in another folder."""


def main() -> int:
    """Play the story; the exit code of the test."""
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images"
    with virtual_display() as display, tempfile.TemporaryDirectory() as raw:
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:xdist", STORY]
        code = subprocess.call(command, cwd=ROOT, env={**display, "NEP_STORY_IMAGES": raw})
        if code == 0:
            _keep(Path(raw), target)
    return code


def _keep(raw: Path, target: Path) -> None:
    """Write the pictures small."""
    from PySide6.QtGui import QImage

    from tools.image_files import write_small

    target.mkdir(parents=True, exist_ok=True)
    is_docs = target == ROOT / "docs" / "images"
    for picture in sorted(raw.glob("*.png")):
        if is_docs and picture.stem not in SHOWN:
            continue
        size = write_small(QImage(str(picture)), target / picture.name)
        print(f"{picture.stem}: {size}")


if __name__ == "__main__":
    sys.exit(main())

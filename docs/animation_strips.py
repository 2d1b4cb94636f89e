"""Makes film strips of animations and a sheet of the postures, in light and dark.

    .venv/bin/python docs/animation_strips.py                  into docs/images
    .venv/bin/python docs/animation_strips.py --check          compare, change nothing
    .venv/bin/python docs/animation_strips.py --folder FOLDER bow wave    strips of these

The virtual robot plays each animation on a clock of its own; the pictures are what its view shows.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
ANIMATIONS = ("wave", "karate", "elephant", "gorilla", "disco", "laugh")
THEMES = ("light", "dark")

os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))


def main() -> int:
    """Make or compare the pictures; the exit code is 1 when one is out of date."""
    options = _parsed()
    from image_files import difference, write_small
    from image_robot_strips import Strips
    from PySide6.QtWidgets import QApplication

    app = QApplication([])
    out_of_date = False
    for theme in THEMES:
        strips = Strips(ROOT / "resources" / "robots" / options.robot, theme)
        pictures = {"animations": strips.animations(options.names or ANIMATIONS)}
        if not options.names:
            pictures["postures"] = strips.postures()
        for name, image in pictures.items():
            path = options.folder / f"{name}-{theme}.png"
            reason = difference(image, path) if options.check else write_small(image, path)
            out_of_date = out_of_date or bool(options.check and reason)
            sys.stdout.write(f"{path.stem:24} {reason or 'as it was'}\n")
    app.quit()
    return int(out_of_date)


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these animations")
    parser.add_argument("--robot", default="nao", help="the folder of the robot")
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    parser.add_argument("--folder", type=Path, default=IMAGES, help="where the pictures are")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())

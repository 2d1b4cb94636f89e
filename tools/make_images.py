"""Makes the pictures of the documentation, or says which of them are out of date.

    .venv/bin/python tools/make_images.py                    all of them, into docs/images
    .venv/bin/python tools/make_images.py window-light       some of them
    .venv/bin/python tools/make_images.py --check            compare, change nothing
    .venv/bin/python tools/make_images.py --sheet FOLDER     the examples in every look and language

The window is drawn without a screen, always in the same size, with the fonts that come with the
program and with settings of its own, so that a picture changes only when the program does.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tools.image_window import Stage

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
LARGE = "2"
"""The factor of a screen with small pixels."""

SCREEN = {
    "name": "screen",
    "x": 0,
    "y": 0,
    "width": 3840,
    "height": 2400,
    "logicalDpi": 96,
    "logicalBaseDpi": 96,
    "dpr": 1,
}

for variable in ("QT_SCALE_FACTOR", "QT_FONT_DPI", "QT_STYLE_OVERRIDE"):
    if variable != "QT_SCALE_FACTOR" or "--child" not in sys.argv:
        os.environ.pop(variable, None)
os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en"}
sys.path.insert(0, str(ROOT))


def main() -> int:
    """Make or compare the pictures; the exit code is 1 when one is out of date."""
    options = _parsed()
    with tempfile.TemporaryDirectory(prefix="nep-images-") as home:
        screen = Path(home) / "screen.json"
        screen.write_text(json.dumps({"screens": [SCREEN]}), encoding="utf-8")
        os.environ["QT_QPA_PLATFORM"] = f"offscreen:configfile={screen}"
        os.environ["NEP_STUDIO_FOLDER"] = home
        from tools.image_window import Stage  # Qt reads the environment when it is loaded

        stage = Stage(Path(home))
        if options.sheet is not None:
            return _make_sheets(stage, options)
        return _make(stage, options)


def _make(stage: Stage, options: argparse.Namespace) -> int:
    from tools.image_files import difference, write_small
    from tools.image_scenes import LARGE_SCENES, SCENES

    unknown = [name for name in options.names if name not in SCENES]
    if unknown:
        _tell(f"There is no picture {unknown[0]}. There are: {', '.join(SCENES)}.")
        return 2
    names = options.names or list(SCENES)
    large = [] if options.child else [name for name in names if name in LARGE_SCENES]
    out_of_date = []
    for name in (name for name in names if name not in large):
        image, path = SCENES[name](stage), options.folder / f"{name}.png"
        reason = difference(image, path) if options.check else write_small(image, path)
        _tell(f"{name:24} {reason or 'as it was'}")
        out_of_date += [name] if options.check and reason else []
    return _again_large(large, options) or int(bool(out_of_date))


def _make_sheets(stage: Stage, options: argparse.Namespace) -> int:
    from tools.image_window import make_sheets

    make_sheets(stage, options.sheet, "200" if options.child else "100", _tell)
    return 0 if options.child else _again_large(["--sheet", str(options.sheet)], options)


def _again_large(arguments: list[str], options: argparse.Namespace) -> int:
    """Make pictures for a screen with small pixels, in a process of its own."""
    if not arguments:
        return 0
    command = [sys.executable, __file__, "--child", "--folder", str(options.folder)]
    command += ["--check"] if options.check else []
    environment = os.environ | {"QT_SCALE_FACTOR": LARGE}
    return subprocess.run([*command, *arguments], env=environment, check=False).returncode


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these pictures")
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    parser.add_argument("--sheet", type=Path, metavar="FOLDER", help="all looks of the examples")
    parser.add_argument("--folder", type=Path, default=IMAGES, help="where the pictures are")
    parser.add_argument("--child", action="store_true", help=argparse.SUPPRESS)
    return parser.parse_args()


def _tell(words: str) -> None:
    sys.stdout.write(words + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())

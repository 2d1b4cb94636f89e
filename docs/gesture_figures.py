"""Makes the pictures and the tables of docs/gestures.md from what the gesture benchmark found.

.venv/bin/python -m benchmarks.gestures --json docs/gestures.json     measure
.venv/bin/python docs/gesture_figures.py                              draw, and fill in
.venv/bin/python docs/gesture_figures.py --check                      compare, change nothing
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "gestures.md"
BEGIN, END = "<!-- tables: docs/gesture_figures.py -->", "<!-- end of tables -->"

os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path[:0] = [str(ROOT), str(ROOT / "docs")]


def main(arguments: list[str]) -> int:
    """Make or compare pictures and tables; the exit code is 1 when one is out of date."""
    options = _parsed(arguments)
    from gesture_tables import tables
    from image_files import difference, write_small
    from image_gestures import confusion_picture, spotting_picture
    from PySide6.QtGui import QGuiApplication

    app = QGuiApplication.instance() or QGuiApplication([])
    data = json.loads(options.data.read_text(encoding="utf-8"))
    people = "people" if not data["simulated"] else "simulated people"
    pictures = {
        "gestures-confusion": confusion_picture(
            data["simulated_figure"], "SIMULATED people: five of them make each gesture ten times"
        ),
        "gestures-spotting": spotting_picture(
            [one for one in data["scores"] if not one["sensor"]],
            f"{len(data['people'])} {people}, {len(data['gestures'])} gestures:"
            " found in the stream",
        ),
    }
    is_right = True
    for name, image in pictures.items():
        path = options.folder / f"{name}.png"
        reason = difference(image, path) if options.check else write_small(image, path)
        is_right = is_right and not (options.check and reason)
        sys.stdout.write(f"{name:24} {reason or 'as it was'}\n")
    is_right = _fill_in(options.page, tables(data), is_check=options.check) and is_right
    del app
    return int(not is_right)


def _fill_in(page: Path, words: str, *, is_check: bool) -> bool:
    """Put the tables between their marks; tells whether they were right or are now."""
    old = page.read_text(encoding="utf-8")
    before, _, rest = old.partition(BEGIN)
    _, _, after = rest.partition(END)
    new = f"{before}{BEGIN}\n{words}\n{END}{after}"
    if is_check:
        sys.stdout.write(f"{page.name:24} {'as it was' if new == old else 'out of date'}\n")
        return new == old
    page.write_text(new, encoding="utf-8")
    return True


def _parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    parser.add_argument("--data", type=Path, default=ROOT / "docs" / "gestures.json")
    parser.add_argument("--page", type=Path, default=PAGE)
    parser.add_argument("--folder", type=Path, default=ROOT / "docs" / "images")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

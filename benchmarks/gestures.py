"""How many gestures are recognised, and how often something else is taken for one.

    python3 dev.py bench gestures                                    ../shared/data and simulated
    python -m benchmarks.gestures FOLDER [--everyday FOLDER]         any folder of the same form

A folder has files ``person_gesture.csv`` with the columns t_s, ax, ay, az, if there is a gyroscope
gx, gy, gz, and gesture (1 while it is made). For every person: a model of the first 1, 2, 3 and 5
repetitions of each gesture is run on the rest of the same stream; then a model of all the other
people. Everyday movement of people, who make no gesture, tells false triggers. The certainty that
fires is always 0.75; the references (the paper's matching as its code does it, and the nearest
example by dynamic time warping) are shown at the threshold that suits them best here.

``NEP_GESTURES`` and ``NEP_EVERYDAY`` in the environment name folders for ``dev.py bench`` too;
``NEP_GESTURES_QUICK=1`` measures 5 examples and other people only, without references.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks._gesture_folder import DATA, Folder, read_gesture_folder
from benchmarks._gesture_report import as_data, rows_of
from benchmarks._gesture_scores import Score
from benchmarks._gesture_simulated import paper_figure
from benchmarks._gesture_trials import hold_trials, plan_trials
from nep_core.errors import RecordingError

LIMIT_S = 5400
"""Every person's recordings are learned and recognised many times over."""
EXAMPLES = (1, 2, 3, 5)
QUICK_EXAMPLES = (5,)

Row = dict[str, Any]


@dataclass(frozen=True)
class Results:
    """All scores: of the people of a folder, and of simulated people who make five gestures."""

    folder: Folder | None
    scores: list[Score]
    figure: list[Score]
    notes: tuple[str, ...]


def run() -> list[Row]:
    """All figures; a row says so where the real recordings are not there."""
    own, everyday = os.environ.get("NEP_GESTURES"), os.environ.get("NEP_EVERYDAY")
    is_quick = os.environ.get("NEP_GESTURES_QUICK", "") not in ("", "0")
    if own:
        return rows_of_results(measure(Path(own), everyday, is_quick=is_quick))
    figure = [] if is_quick else paper_figure()
    if not (DATA / "uhh_gestures").is_dir():
        skipped = "gestures of real people: skipped, there is no ../shared/data"
        results = Results(None, [], figure, ())
        return [{"name": skipped, "value": None, "unit": ""}, *rows_of_results(results)]
    return rows_of_results(measure(DATA / "uhh_gestures", everyday, figure, is_quick=is_quick))


def measure(
    folder: Path,
    everyday: str | None = None,
    figure: Sequence[Score] = (),
    *,
    is_quick: bool = False,
    workers: int = 0,
) -> Results:
    """Hold all trials that a folder allows; RecordingError when it allows none."""
    found = read_gesture_folder(folder, Path(everyday) if everyday else None)
    trials, notes = plan_trials(found, QUICK_EXAMPLES if is_quick else EXAMPLES, is_quick=is_quick)
    if not trials:
        raise RecordingError(
            f"{folder} has too few takes to learn from some and be tested on others.",
            checklist=(
                "Each gesture is made at least twice by a person, or by two people.",
                *found.notes,
                *notes,
            ),
        )
    scores = hold_trials(trials, workers)
    return Results(found, scores, list(figure), (*found.notes, *notes))


def rows_of_results(results: Results) -> list[Row]:
    """The figures for people."""
    return rows_of(results.folder, results.scores, results.figure, results.notes)


def main(arguments: list[str]) -> int:
    """Measure a folder; exit code 1 when a goal was missed, 2 when it cannot be measured."""
    asked = _parser().parse_args(arguments)
    is_own = asked.folder is not None
    folder = asked.folder or DATA / "uhh_gestures"
    try:
        figure = [] if is_own or asked.quick else paper_figure()
        results = measure(folder, asked.everyday, figure, is_quick=asked.quick)
    except RecordingError as error:
        sys.stderr.write(f"{error.sentence}\n")
        sys.stderr.writelines(f"  [ ] {step}\n" for step in error.checklist)
        return 2
    if asked.json:
        data = as_data(results.folder, results.scores, results.figure, results.notes)
        text = json.dumps(data, indent=1, ensure_ascii=False)
        asked.json.write_text(f"{text}\n", encoding="utf-8")
    return _tell(rows_of_results(results))


def _tell(rows: Sequence[Row]) -> int:
    from benchmarks.__main__ import complete, table_row

    figures = [complete(row) for row in rows]
    sys.stdout.writelines(f"{table_row(figure)}\n" for figure in figures)
    return 0 if all(figure["ok"] for figure in figures) else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.gestures",
        description="Measures how well gestures of people are recognised.",
    )
    parser.add_argument(
        "folder", type=Path, nargs="?", help="recordings person_gesture.csv; else ../shared/data"
    )
    parser.add_argument("--everyday", metavar="FOLDER", help="recordings without any gesture")
    parser.add_argument("--quick", action="store_true", help="5 examples only, no references")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write everything for programs")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

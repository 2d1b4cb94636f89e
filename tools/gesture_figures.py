"""Makes the pictures and the tables of docs/gestures.md from what the gesture benchmark found.

.venv/bin/python -m benchmarks.gestures --json docs/gestures.json     measure
.venv/bin/python tools/gesture_figures.py                              draw, and fill in
.venv/bin/python tools/gesture_figures.py --check                      compare, change nothing
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "gestures.md"
BEGIN, END = "<!-- tables: tools/gesture_figures.py -->", "<!-- end of tables -->"

os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QGuiApplication, QImage, QPainter, QPen

from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.theme.look import text_font


def main(arguments: list[str]) -> int:
    """Make or compare pictures and tables; the exit code is 1 when one is out of date."""
    options = _parsed(arguments)
    from tools.image_files import difference, write_small

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


Score = Mapping[str, Any]

TRIALS = {
    "personal, 1 example": "own, 1 example",
    "personal, 2 examples": "own, 2 examples",
    "personal, 3 examples": "own, 3 examples",
    "personal, 5 examples": "own, 5 examples",
    "other people": "other people's",
}
GOALS = {
    "personal, 3 examples": "0.90",
    "personal, 5 examples": "0.95",
    "other people": "0.85",
}


def tables(data: Mapping[str, Any]) -> str:
    """All tables, with a heading each."""
    scores: Sequence[Score] = data["scores"]
    parts = [
        _people(data),
        "### In the continuous stream",
        "\n".join(_spotting(scores)),
        "### Cut-out gestures, told apart",
        "\n".join(_cut_out(scores)),
        "### With a worse sensor (own, 5 examples; learned from the whole one), F1",
        "\n".join(_sensors(scores)),
        "### Five gestures of simulated people",
        "\n".join(_simulated(data["simulated_figure"])),
    ]
    return "\n\n".join(parts)


def _people(data: Mapping[str, Any]) -> str:
    kind = "simulated people" if data["simulated"] else "people"
    idle = data["everyday_s"] / 60
    return (
        f"`{data['folder']}`: {len(data['people'])} {kind}, {len(data['gestures'])} gestures; "
        f"{idle:.1f} minutes of other people's everyday movement."
    )


def _spotting(scores: Sequence[Score]) -> Iterator[str]:
    yield (
        "| model | method | F1 | goal | recall | precision | false triggers a minute | fires at |"
        " F1 with at most 0.1 of them |"
    )
    yield "|---|---|---|---|---|---|---|---|---|"
    for trial, words in TRIALS.items():
        for one in scores:
            if one["trial"] == trial and not one["sensor"] and one["made"]:
                goal = GOALS.get(trial, "")
                yield (
                    f"| {words} | {one['method']} | {one['f1']:.3f} | {goal} |"
                    f" {one['recall']:.3f} | {one['precision']:.3f} |"
                    f" {_number(one['false_a_minute'], 2)} | {one['threshold']:g} |"
                    f" {_number(one['f1_when_calm'], 3)} |"
                )


def _cut_out(scores: Sequence[Score]) -> Iterator[str]:
    plain = [one for one in scores if not one["sensor"] and one["told_apart"] is not None]
    trials = [trial for trial in TRIALS if any(one["trial"] == trial for one in plain)]
    yield "| method | " + " | ".join(TRIALS[trial] for trial in trials) + " |"
    yield "|---|" + "---|" * len(trials)
    for method in dict.fromkeys(one["method"] for one in plain):
        own = {one["trial"]: one["told_apart"] for one in plain if one["method"] == method}
        yield f"| {method} | " + " | ".join(_number(own.get(one), 3) for one in trials) + " |"


def _sensors(scores: Sequence[Score]) -> Iterator[str]:
    worse = [one for one in scores if one["sensor"] and one["made"]]
    sensors = list(dict.fromkeys(one["sensor"] for one in worse))
    yield "| method | " + " | ".join(sensors) + " |"
    yield "|---|" + "---|" * len(sensors)
    for method in dict.fromkeys(one["method"] for one in worse):
        own = {one["sensor"]: one["f1"] for one in worse if one["method"] == method}
        yield f"| {method} | " + " | ".join(_number(own.get(one), 3) for one in sensors) + " |"


def _simulated(scores: Sequence[Score]) -> Iterator[str]:
    yield (
        "| method | recall | precision | F1 | false triggers a minute, plain | with signs |"
        " recall on a left wrist that nobody told of |"
    )
    yield "|---|---|---|---|---|---|---|"
    for one in (one for one in scores if one["pairs"] and not one["sensor"]):
        false = {
            other["sensor"]: other["false_a_minute"]
            for other in scores
            if other["method"] == one["method"]
        }
        left = [
            other["recall"]
            for other in scores
            if other["method"] == one["method"] and other["sensor"] == "left wrist"
        ]
        plain = false.get("simulated everyday", false.get(""))
        yield (
            f"| {one['method']} | {one['recall']:.3f} | {one['precision']:.3f} | {one['f1']:.3f} |"
            f" {_number(plain, 2)} | {_number(false.get('simulated lively'), 2)} |"
            f" {_number(left[0] if left else None, 3)} |"
        )


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


SCALE = 2
CELL = 50.0
NAMES_WIDE, HEAD_HIGH, GAP = 92.0, 92.0, 26.0
CHART = QRectF(64, 62, 560, 270)
CHART_SIZE = (880, 392)
COLOURS = ("accent", "warning", "info", "error", "success")
NOTHING = ""


class Drawing:
    """A light picture at twice its size, to be written on."""

    def __init__(self, width: float, height: float) -> None:
        self._theme = load_theme("light")
        self.image = QImage(round(width * SCALE), round(height * SCALE), QImage.Format.Format_RGB32)
        self.image.fill(self.colour("menu"))
        self.painter = QPainter(self.image)
        self.painter.scale(SCALE, SCALE)
        self.painter.setRenderHint(QPainter.RenderHint.Antialiasing)

    def colour(self, name: str) -> QColor:
        """A colour of the light theme."""
        return QColor(self._theme.colour(name))

    def write(
        self,
        box: QRectF,
        text: str,
        *,
        size: float = 10.0,
        bold: bool = False,
        colour: str = "text",
        align: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignCenter,
    ) -> None:
        """Words in a box; ``size`` in pixels of the picture before it is scaled."""
        font = text_font(10, QFont.Weight.DemiBold if bold else QFont.Weight.Normal)
        font.setPixelSize(round(size * 1.3))
        self.painter.setFont(font)
        self.painter.setPen(self.colour(colour))
        self.painter.drawText(box, align | Qt.AlignmentFlag.AlignVCenter, text)

    def done(self) -> QImage:
        """The picture, finished."""
        self.painter.end()
        return self.image


def confusion_picture(scores: Sequence[Score], title: str) -> QImage:
    """A square of counts for each method: rows are what was made, columns what was recognised."""
    scores = [score for score in scores if score["pairs"] and not score["sensor"]]
    names = sorted({made for score in scores for made, _, _ in score["pairs"]} - {NOTHING})
    side = (len(names) + 1) * CELL
    width = len(scores) * (NAMES_WIDE + side + GAP) + GAP
    drawing = Drawing(width, HEAD_HIGH + side + 46)
    drawing.write(QRectF(GAP, 8, width, 26), title, size=13, bold=True, align=_LEFT)
    words = "rows: what was made; columns: what was recognised; darker: more often"
    box = QRectF(GAP, HEAD_HIGH + side + 8, width, 20)
    drawing.write(box, words, size=9.5, colour="muted", align=_LEFT)
    for number, score in enumerate(scores):
        at = QPointF(GAP + number * (NAMES_WIDE + side + GAP), HEAD_HIGH)
        _square(drawing, at, score, names)
    return drawing.done()


def spotting_picture(scores: Sequence[Score], title: str) -> QImage:
    """F1 by the number of examples, and for other people, one line a method."""
    drawing = Drawing(*CHART_SIZE)
    box = QRectF(CHART.left() - 40, 8, CHART_SIZE[0], 26)
    drawing.write(box, title, size=13, bold=True, align=_LEFT)
    trials = [name for name in _TRIALS if any(one["trial"] == name for one in scores)]
    _axes(drawing, trials)
    methods = list(dict.fromkeys(one["method"] for one in scores))
    for number, method in enumerate(methods):
        points = {
            one["trial"]: one["f1"] for one in scores if one["method"] == method and one["made"]
        }
        _line(drawing, trials, points, COLOURS[number % len(COLOURS)])
        _key(drawing, number, method, COLOURS[number % len(COLOURS)])
    return drawing.done()


def _square(drawing: Drawing, at: QPointF, score: Score, names: Sequence[str]) -> None:
    counts = {(made, found): count for made, found, count in score["pairs"]}
    left = at.x() + NAMES_WIDE
    head = f"{score['method']}: {score['recall']:.0%} recognised"
    box = QRectF(at.x(), at.y() - 56, 400, 22)
    drawing.write(box, head, size=11.5, bold=True, align=_LEFT)
    made = {name: sum(n for (one, _), n in counts.items() if one == name) for name in names}
    for column, found in enumerate([*names, NOTHING]):
        box = QRectF(left + column * CELL - 8, at.y() - 26, CELL + 16, 22)
        drawing.write(box, found or "missed", size=8.5, colour="muted")
    for row, name in enumerate([*names, NOTHING]):
        top = at.y() + row * CELL
        box = QRectF(at.x(), top, NAMES_WIDE - 8, CELL)
        drawing.write(box, name or "nothing", size=10, align=_RIGHT)
        for column, found in enumerate([*names, NOTHING]):
            if name or found:
                cell = QRectF(left + column * CELL, top, CELL, CELL)
                count = counts.get((name, found), 0)
                share = count / made[name] if name else min(1.0, count / max(made.values()))
                _cell(drawing, cell, count, share, is_right=name == found)


def _cell(drawing: Drawing, box: QRectF, count: int, share: float, *, is_right: bool) -> None:
    fill = drawing.colour("success" if is_right else "error")
    fill.setAlphaF(0.9 * share**0.7 if count else 0.0)
    inner = box.adjusted(1, 1, -1, -1)
    drawing.painter.fillRect(inner, drawing.colour("panel"))
    drawing.painter.fillRect(inner, fill)
    if count:
        colour = "accent_text" if share > 0.55 else "text"
        drawing.write(box, str(count), size=11, bold=is_right, colour=colour)


def _axes(drawing: Drawing, trials: Sequence[str]) -> None:
    painter = drawing.painter
    for tenth in range(0, 11, 2):
        y = _height(tenth / 10)
        painter.setPen(QPen(drawing.colour("line"), 1))
        painter.drawLine(QPointF(CHART.left(), y), QPointF(CHART.right(), y))
        box = QRectF(CHART.left() - 46, y - 10, 38, 20)
        drawing.write(box, f"{tenth / 10:.1f}", size=9.5, colour="muted", align=_RIGHT)
    for number, trial in enumerate(trials):
        x = _across(number, len(trials))
        box = QRectF(x - 60, CHART.bottom() + 6, 120, 20)
        drawing.write(box, trial.removeprefix("personal, "), size=10)
        if trial in _GOALS:
            painter.setPen(QPen(drawing.colour("text"), 2))
            y = _height(_GOALS[trial])
            painter.drawLine(QPointF(x - 22, y), QPointF(x + 22, y))
    note = "F1 in the continuous stream; short black lines: goals; references at their best"
    box = QRectF(CHART.left(), CHART.bottom() + 28, 700, 20)
    drawing.write(box, note, size=9.5, colour="muted", align=_LEFT)


def _line(
    drawing: Drawing, trials: Sequence[str], points: Mapping[str, float], colour: str
) -> None:
    painter = drawing.painter
    before: QPointF | None = None
    for number, trial in enumerate(trials):
        if trial not in points:
            continue
        point = QPointF(_across(number, len(trials)), _height(points[trial]))
        painter.setPen(QPen(drawing.colour(colour), 2.5))
        if before is not None and trial.startswith("personal"):
            painter.drawLine(before, point)
        painter.setBrush(drawing.colour(colour))
        painter.drawEllipse(point, 4.5, 4.5)
        before = point


def _key(drawing: Drawing, number: int, method: str, colour: str) -> None:
    y = CHART.top() + 14 + 26 * number
    drawing.painter.setPen(QPen(drawing.colour(colour), 2.5))
    drawing.painter.setBrush(drawing.colour(colour))
    drawing.painter.drawEllipse(QPointF(CHART.right() + 28, y), 4.5, 4.5)
    box = QRectF(CHART.right() + 42, y - 12, 200, 24)
    drawing.write(box, method, size=11, align=_LEFT)


def _across(number: int, count: int) -> float:
    return CHART.left() + CHART.width() * (number + 0.5) / count


def _height(value: float) -> float:
    return CHART.bottom() - CHART.height() * value


_LEFT, _RIGHT = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
_GOALS = {"personal, 3 examples": 0.90, "personal, 5 examples": 0.95, "other people": 0.85}
_TRIALS = (
    "personal, 1 example",
    "personal, 2 examples",
    "personal, 3 examples",
    "personal, 5 examples",
    "other people",
)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

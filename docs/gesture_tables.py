"""The tables of docs/gestures.md, from what the gesture benchmark found."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

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

"""``nep-studio train``: a folder of labelled recordings becomes a gesture model."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from nep_core.cli import steps_of
from nep_core.errors import NepError, RecordingError
from nodes.perceptual.recognition.model import METHODS, Model

from .dataset import EVERYDAY, Material, everybodys_movement, learn, read_material
from .model import SUFFIX, check_writable, write_model
from .training import advice, in_words


def main(arguments: list[str]) -> int:
    """Train; exit code 0 when the model is written, 1 when it cannot be, 2 for wrong input."""
    asked = _parser().parse_args(arguments)
    methods = METHODS if asked.method == "both" else (asked.method,)
    try:
        _check_goal(asked.output, asked.replace)
        material = read_material(asked.directory, asked.everyday)
        has_own_everyday = bool(material.everyday)
        if not has_own_everyday:
            material = material.with_everyday(everybodys_movement())
        model = _train(material, methods)
    except RecordingError as error:
        return _tell_error(error, 2)
    try:
        write_model(asked.output, model)
    except NepError as error:
        return _tell_error(error, 1)
    print("\n".join(_report(asked.output, model, has_own_everyday)))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="nep-studio train",
        description="Makes a gesture model from recordings in which the gestures are marked.",
    )
    parser.add_argument("directory", type=Path, help="a folder of recordings (CSV files)")
    parser.add_argument(
        "-o", "--output", type=Path, required=True, help=f"the model to write (*{SUFFIX})"
    )
    parser.add_argument(
        "--replace", action="store_true", help="write over the model if it is already there"
    )
    parser.add_argument(
        "--method", choices=(*METHODS, "both"), default="both", help="how it will recognise"
    )
    parser.add_argument(
        "--everyday",
        type=Path,
        metavar="DIRECTORY",
        help="recordings of movement without gestures; without it, those of the folder"
        f" {EVERYDAY} in DIRECTORY, and without these, simulated people give some",
    )
    return parser


def _check_goal(output: Path, replaces: bool) -> None:
    if output.suffix != SUFFIX:
        raise RecordingError(
            "{output} would not be known as a gesture model.",
            checklist=("Give it a name that ends with {suffix}, such as mine{suffix_2}.",),
            output=output,
            suffix=SUFFIX,
            suffix_2=SUFFIX,
        )
    if not output.parent.is_dir():
        raise RecordingError(
            "The folder {parent} is not there.",
            checklist=("Make it, or choose another.",),
            parent=output.parent,
        )
    check_writable(output)
    if output.is_dir():
        raise RecordingError(
            "{output} is a folder.",
            checklist=("Choose another name for the model.",),
            output=output,
        )
    if output.exists() and not replaces:
        raise RecordingError(
            "{output} is already there, and would be lost.",
            checklist=("Choose another name.", "Or add --replace to write over it."),
            output=output,
        )


def _train(material: Material, methods: Sequence[str]) -> Model:
    for remark in material.remarks:
        print(remark)
    started_s = time.monotonic()
    model = learn(material, methods, tell=print)
    print(f"Trained in {time.monotonic() - started_s:.1f} s on {model.trained_on}.")
    return model


def _report(output: Path, model: Model, has_own_everyday: bool) -> list[str]:
    lines = [""]
    for method, report in model.report.items():
        lines += [*in_words(method, report), ""]
    lines += advice(next(iter(model.report.values())), has_own_everyday)
    return [*lines, f"The model is in {output}."]


def _tell_error(error: NepError, code: int) -> int:
    print("\n".join([str(error), *steps_of(error)]), file=sys.stderr)
    return code

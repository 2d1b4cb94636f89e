"""The recogniser that comes with the program, as a project keeps it: tests need not train one."""

from __future__ import annotations

from base64 import b64encode
from functools import cache
from pathlib import Path

from nep_studio.blocks.own_gestures import OwnRecogniser
from nodes.perceptual.recognition.model import Model
from nodes.perceptual.recognition.model_file import read_model
from nodes.resources import resource_folder

GESTURES = ["karate", "katana"]
"""Those that the tests' projects have; the recogniser knows more."""


def _path() -> Path:
    return resource_folder() / "gestures" / "paper.gestures"


@cache
def shipped_model() -> Model:
    return read_model(_path())


@cache
def shipped_recogniser() -> OwnRecogniser:
    model = shipped_model()
    text = b64encode(_path().read_bytes()).decode("ascii")
    return OwnRecogniser("then", model.names, text, dict(model.report))

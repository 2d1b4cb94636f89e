"""A small recogniser of two simulated gestures, learned once for all tests of the try-out."""

from __future__ import annotations

from base64 import b64encode
from dataclasses import replace
from functools import cache

from nep_studio.blocks.own_gestures import OwnRecogniser
from nodes.perceptual.recognition.model import Model, model_bytes
from nodes.perceptual.recognition.training import train
from nodes.sensory.arm.people import simulate_everyday
from tests.ui.trainer.results_material import session

GESTURES = ["karate", "katana"]


@cache
def small_model() -> Model:
    """Learned without rotation, which is quicker."""
    takes, everyday = session(GESTURES, 4), simulate_everyday(1, 20.0)
    return train([replace(takes, gyr=None)], [replace(everyday, gyr=None)])


@cache
def small_recogniser() -> OwnRecogniser:
    model = small_model()
    text = b64encode(model_bytes(model)).decode("ascii")
    return OwnRecogniser("then", model.names, text, dict(model.report))

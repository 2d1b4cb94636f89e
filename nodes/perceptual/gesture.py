"""Turns the movement of a watch or phone into the names of the gestures made."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path

from nep_core.errors import RecordingError
from nep_core.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, Imu
from nep_core.node import Node
from nodes.perceptual.recognition.model import Model
from nodes.perceptual.recognition.model_file import read_model
from nodes.perceptual.recognition.peaks import Detection
from nodes.perceptual.recognition.spotting import Spotter
from nodes.resources import resource_folder

_MOST_SENSORS = 8
_SILENCE_S = 0.3
"""After so long the movement of a sensor has ended: a gesture that waits for a better one fires."""


def run(node: Node, *, model: str, gesture: str, method: str, certainty: float) -> None:
    """Publish ``gesture_<name>`` on ``/human_behavior``, once for each gesture made.

    Raises RecordingError when the model cannot be used or does not know the gesture.
    """
    path = Path(model) if model else resource_folder() / "gestures" / "paper.gestures"
    ears = _Ears(node, read_model(path), method, gesture, certainty)
    movement = node.subscriber(IMU, Imu)
    publisher = node.publisher(HUMAN_BEHAVIOR)
    node.ready(f"recognises {gesture or ', '.join(ears.model.names)}")
    while not node.stopping:
        batch = movement.receive(timeout_s=_SILENCE_S)
        found = ears.hear(batch) if batch else []
        for one in found + ears.end_of_silent():
            publisher.send(_message(node, one))


def _message(node: Node, found: Detection) -> HumanBehavior:
    return HumanBehavior(
        human_state=f"gesture_{found.gesture}",
        certainty=round(found.certainty, 3),
        source=node.name,
    )


class _Ears:
    """A spotter for each sensor that is heard; what a sensor lacks is told once."""

    def __init__(
        self, node: Node, model: Model, method: str, gesture: str, certainty: float
    ) -> None:
        self.model = model
        self._node = node
        self._make_spotter = partial(
            Spotter,
            model,
            method=method,
            gestures=[gesture] if gesture else [],
            trigger=certainty,
        )
        self._make_spotter()  # what the model lacks is told at the start
        self._spotters: dict[tuple[str, bool, bool], Spotter | None] = {}
        self._heard_s: dict[tuple[str, bool, bool], float] = {}

    def hear(self, batch: Imu) -> list[Detection]:
        """The gestures that end in a batch of samples."""
        sensor = (batch.source, batch.gravity_included, batch.gyr is not None)
        if sensor not in self._spotters:
            self._forget_oldest()
            self._spotters[sensor] = self._listen_to(batch)
        spotter = self._spotters[sensor]
        counts = {len(batch.t), len(batch.acc), len(batch.t if batch.gyr is None else batch.gyr)}
        if spotter is None or counts == {0}:
            return []
        if len(counts) > 1:
            self._spotters[sensor] = None
            self._node.warn(f"{batch.source} sends times and samples that do not belong together")
            return []
        self._heard_s[sensor] = time.monotonic()
        return spotter.push(batch.t, batch.acc, batch.gyr)

    def end_of_silent(self) -> list[Detection]:
        """What the sensors that have just fallen silent ended with."""
        before_s = time.monotonic() - _SILENCE_S
        silent = [sensor for sensor, heard_s in self._heard_s.items() if heard_s < before_s]
        found: list[Detection] = []
        for sensor in silent:
            del self._heard_s[sensor]
            spotter = self._spotters.get(sensor)
            found += spotter.flush() if spotter else []
        return found

    def _listen_to(self, batch: Imu) -> Spotter | None:
        gyroscope = batch.gyr is not None
        try:
            spotter = self._make_spotter(gravity_included=batch.gravity_included)
            spotter.listen(gyroscope)
        except RecordingError as error:
            self._node.warn(" ".join([error.sentence, *error.checklist]))
            return None
        if gyroscope:
            self._node.state("running", f"listens to {batch.source}")
        else:
            self._node.state("running", f"listens to {batch.source}, which sends no rotation")
        return spotter

    def _forget_oldest(self) -> None:
        if len(self._spotters) >= _MOST_SENSORS:
            del self._spotters[next(iter(self._spotters))]

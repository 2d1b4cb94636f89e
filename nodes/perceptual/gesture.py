"""Turns the movement of a watch or phone into the names of the gestures made."""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path

from faults import Text
from nep_core.errors import ParameterError, RecordingError
from nep_core.processes.node import Node
from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, Imu
from nodes.perceptual.recognition.model import Model, with_triggers
from nodes.perceptual.recognition.spotting import Spotter
from nodes.resources import resource_folder

from .recognition.features import Detection
from .recognition.model import read_model
from .recognition.sensor_input import Audience, Measures, SensorInput, Worn

_SILENCE_S = 0.3
"""After so long the movement of a sensor has ended: a gesture that waits for a better one fires."""

_Sensor = tuple[str, bool, bool, str]
"""Its source, whether its acceleration has gravity, whether it sends rotation, its wrist."""


def run(
    node: Node,
    *,
    model: str,
    gesture: str,
    method: str,
    certainty: float,
    certainties: str,
    worn: Worn,
) -> None:
    """Publish ``gesture_<name>`` on ``/human_behavior``, once for each gesture made.

    Raises RecordingError when the model cannot be used or does not know the gesture, and
    ParameterError when the certainties cannot be read.

    ``node`` is this node; ``model`` a file ("": the paper's); ``gesture`` the names, with commas
    between them ("": all); ``method`` the recogniser; ``certainty`` the one from which a gesture
    counts, 0 to 1 (0: as learned), ``certainties`` that of some gestures; ``worn`` is how the
    watch sits.
    """
    path = Path(model) if model else resource_folder() / "gestures" / "paper.gestures"
    known = read_model(path)
    names = read_names(gesture) or list(known.names)
    triggers = dict.fromkeys(known.names, certainty) if certainty else {}
    known = with_triggers(known, triggers | read_certainties(certainties))
    measures = Measures(node, names)
    make_spotter = partial(Spotter, known, method=method, gestures=names, trigger=known.triggers)
    ears = _Ears(node, known, make_spotter, worn, measures)
    movement = node.subscriber(IMU, Imu)
    publisher = node.publisher(HUMAN_BEHAVIOR)
    node.ready("recognises {names}", names=", ".join(names))
    while not node.stopping:
        batch = movement.receive(timeout_s=_SILENCE_S)
        measures.arrived(movement.header.time_ns if batch and movement.header else None)
        for one in (ears.hear(batch) if batch else []) + ears.end_of_silent():
            behaviour = HumanBehavior(
                human_state=f"gesture_{one.gesture}",
                certainty=round(one.certainty, 3),
                source=node.name,
            )
            publisher.send(behaviour)
            measures.triggered(one, batch)
        measures.tell()


def read_names(text: str) -> list[str]:
    """The gestures of a text such as ``karate, katana``, each once."""
    return list(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))


def read_certainties(text: str) -> dict[str, float]:
    """The certainties of a text such as ``karate 0.6, katana 0.8``; ParameterError names a part."""
    found = {}
    for part in text.split(","):
        if not part.strip():
            continue
        name, _, certainty = part.strip().rpartition(" ")
        try:
            found[name.strip()] = float(certainty)
        except ValueError:
            name = ""
        if not name.strip():
            raise ParameterError(
                'The certainties have "{strip}", which is not a gesture and its certainty.',
                checklist=("Write them with commas between them: karate 0.6, katana 0.8.",),
                strip=part.strip(),
            )
    return found


class _Ears:
    """An ear for each sensor that is heard; what a sensor lacks is told once."""

    def __init__(
        self,
        node: Node,
        model: Model,
        make_spotter: partial[Spotter],
        worn: Worn,
        measures: Measures,
    ) -> None:
        self._node, self._model, self._make_spotter = node, model, make_spotter
        self._worn, self._measures = worn, measures
        make_spotter(gravity_included=True)  # what the model lacks is told at the start
        self._ears: dict[_Sensor, SensorInput | None] = {}
        self._audience = Audience(node, self._forget)
        self._waiting: set[_Sensor] = set()

    def hear(self, batch: Imu) -> list[Detection]:
        """The gestures that end in a batch of samples."""
        sensor = (batch.source, batch.gravity_included, batch.gyr is not None, batch.wrist)
        if not self._audience.has(batch):
            return []
        if sensor not in self._ears:
            self._ears[sensor] = self._listen_to(batch)
        ear = self._ears[sensor]
        counts = {len(batch.t), len(batch.acc), len(batch.t if batch.gyr is None else batch.gyr)}
        if ear is None or counts == {0}:
            return []
        if len(counts) > 1:
            self._ears[sensor] = None
            self._node.warn(
                "{source} sends times and samples that do not belong together", source=batch.sender
            )
            return []
        self._waiting.add(sensor)
        found = ear.hear(batch)
        self._measures.heard(ear.certainties)
        return found

    def end_of_silent(self) -> list[Detection]:
        """What the sensors that have just fallen silent ended with."""
        before_s = time.monotonic() - _SILENCE_S
        found: list[Detection] = []
        for sensor in [one for one in self._waiting if self._audience.heard_s[one[0]] < before_s]:
            self._waiting.remove(sensor)
            ear = self._ears[sensor]
            found += ear.flush() if ear else []
        return found

    def _listen_to(self, batch: Imu) -> SensorInput | None:
        make = partial(self._make_spotter, gravity_included=batch.gravity_included)
        node, source = self._node, batch.sender
        try:
            ear = SensorInput(batch, self._model, make, self._worn, self._remark, node.warn)
        except RecordingError as error:
            node.warn(error.fault)
            return None
        node.state(
            "running",
            "listens to {source}"
            if batch.gyr is not None
            else "listens to {source}, which sends no rotation",
            source=source,
        )
        return ear

    def _remark(self, sentence: Text) -> None:
        self._node.state("running", sentence)

    def _forget(self, source: str) -> None:
        self._ears = {sensor: ear for sensor, ear in self._ears.items() if sensor[0] != source}
        self._waiting = {sensor for sensor in self._waiting if sensor[0] != source}

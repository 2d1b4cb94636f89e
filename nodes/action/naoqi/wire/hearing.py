"""Who hears one signal of the other side: the robot tells a connection once, it tells all."""

from __future__ import annotations

import itertools
import logging
from typing import Any

from .decoding import ObjectSource, Reader, read_value, reader_of
from .errors import BadFrame
from .frames import DYNAMIC_PAYLOAD, Frame
from .metaobject import Signature
from .service import Heard

log = logging.getLogger(__name__)


class Hearing:
    """All who hear one signal. ``owner`` is the object that has the signal: it is kept alive."""

    def __init__(self, signal: Signature, link: int, owner: ObjectSource) -> None:
        self.link = link
        self._signal = signal
        self._owner = owner
        self._numbers = itertools.count(1)
        self._hearers: dict[int, Heard] = {}

    def add(self, heard: Heard) -> int:
        """One more hears it; return the number to remove it with."""
        number = next(self._numbers)
        self._hearers[number] = heard
        return number

    def remove(self, number: int) -> bool:
        """One less hears it; True when this was the last."""
        return self._hearers.pop(number, None) is not None and not self._hearers

    def take(self, frame: Frame) -> None:
        """Tell everybody of an event."""
        is_dynamic = bool(frame.flags & DYNAMIC_PAYLOAD)
        type_text = "m" if is_dynamic else self._signal.parameters
        try:
            values = read_value(reader_of(type_text), Reader(frame.payload, self._owner))
        except BadFrame as problem:
            log.warning("an event of %s could not be read: %s", self._signal, problem.sentence)
            return
        several = tuple(values) if isinstance(values, list | tuple) else (values,)
        for heard in list(self._hearers.values()):
            self._tell(heard, several)

    def _tell(self, heard: Heard, values: tuple[Any, ...]) -> None:
        try:
            heard(*values)
        except Exception:
            log.exception("who hears %s failed", self._signal)

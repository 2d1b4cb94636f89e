"""Programs that send as phones and watches do, over real sockets, by the apps' documented formats.

``python -m tests.nodes.sensory.senders sensor_logger http://127.0.0.1:8000/data recording.csv``
plays one from a process of its own. Sources of the formats: nodes/sensory/reading.py and
nodes/sensory/connectors/.
"""

from __future__ import annotations

import argparse
import http.client
import json
import socket
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np

from nodes.recordings import Recording, read_recording

EPOCH_NS = 1_698_501_144_000_000_000
G_M_S2 = 9.80665

Row = tuple[float, tuple[float, float, float], tuple[float, float, float] | None]


def rows(recording: Recording) -> Iterator[Row]:
    """Times in s, accelerations, and rotation rates where there are any."""
    acc, gyr = recording.acc.tolist(), None if recording.gyr is None else recording.gyr.tolist()
    for at, t in enumerate(recording.t.tolist()):
        yield t, tuple(acc[at]), None if gyr is None else tuple(gyr[at])


def resting(seconds: float, rate_hz: float = 100.0) -> Recording:
    """A sensor that lies on a table, to be sent between movements."""
    t = np.arange(round(seconds * rate_hz)) / rate_hz
    acc = np.tile([0.0, 0.0, G_M_S2], (len(t), 1))
    return Recording("rest", t, acc, np.zeros_like(acc), None, gravity_included=True)


class Sender:
    """Sends batches of a recording in its own time, or faster, until it is stopped."""

    def __init__(self) -> None:
        self._stopped = threading.Event()
        self._thread: threading.Thread | None = None
        self._switched_on_s: float | None = None
        self._last_t = -1.0

    def play(self, recording: Recording, speed: float, period_s: float) -> Iterator[list[Row]]:
        """The rows of each period of the recording, at the moment that they end.

        A second recording comes later on the sender's clock, by the time that passed since.
        """
        began_s, batch, end_s = time.monotonic(), [], period_s
        since_s = self._since_switched_on_s(began_s, speed)
        for t, acc, gyr in rows(recording):
            while t >= end_s:
                if self._stopped.wait(max(0.0, began_s + end_s / speed - time.monotonic())):
                    return
                yield batch
                batch, end_s = [], end_s + period_s
            self._last_t = since_s + t
            batch.append((self._last_t, acc, gyr))
        if batch:
            yield batch

    def _since_switched_on_s(self, now_s: float, speed: float) -> float:
        if self._switched_on_s is None:
            self._switched_on_s = now_s
            return 0.0
        return max((now_s - self._switched_on_s) * speed, self._last_t + 0.01)

    def send(self, recording: Recording, speed: float = 1.0) -> None:
        """Send all of a recording; returns when it was sent."""
        raise NotImplementedError

    def start(self, recording: Recording, speed: float = 1.0) -> None:
        """Send in a thread."""
        self._thread = threading.Thread(target=self.send, args=(recording, speed), daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Send no more."""
        self._stopped.set()
        if self._thread is not None:
            self._thread.join(5)

    def __enter__(self) -> Sender:
        return self

    def __exit__(self, *_error: object) -> None:
        self.stop()


class SensorLogger(Sender):
    """Pushes by HTTP as the app Sensor Logger does; ``watch`` sends an Apple Watch's motion.

    ``standardised``: its setting "Standardise Units & Frames", which makes iPhones count as
    Android does.
    """

    def __init__(
        self,
        url: str,
        *,
        watch: bool = False,
        standardised: bool = True,
        period_s: float = 0.1,
        device: str = "0badcafe-1234",
    ) -> None:
        super().__init__()
        self._url = urlsplit(url)
        self._watch, self._standardised = watch, standardised
        self._period_s, self._device = period_s, device
        self._pushed = 0
        self.answers: list[int] = []

    def send(self, recording: Recording, speed: float = 1.0) -> None:
        """Push a recording, a message each period."""
        for batch in self.play(recording, speed, self._period_s):
            self.push(self.message(self._pushed, batch))
            self._pushed += 1

    def message(self, number: int, batch: list[Row]) -> dict[str, object]:
        """A message, with its readings in the app's disorder: sensor after sensor."""
        kinds = self._of_watch if self._watch else self._of_phone
        payload = [one for kind in kinds(batch) for one in kind]
        return {
            "messageId": number,
            "sessionId": "a session",
            "deviceId": self._device,
            "payload": payload[::-1],
        }

    def push(self, message: object) -> int:
        """Push one message; the answer's status."""
        connection = http.client.HTTPConnection(self._url.hostname, self._url.port, timeout=10)
        body = message if isinstance(message, bytes) else json.dumps(message).encode()
        try:
            connection.request(
                "POST", self._url.path or "/", body, {"Content-Type": "application/json"}
            )
            self.answers.append(connection.getresponse().status)
        finally:
            connection.close()
        return self.answers[-1]

    def _of_phone(self, batch: list[Row]) -> list[list[dict[str, object]]]:
        """Gravity is told apart: here it is all in z."""
        sign = 1.0 if self._standardised else -1.0
        moving, gravity, turning = [], [], []
        for t, (x, y, z), gyr in batch:
            moving.append(_reading("accelerometer", t, sign * x, sign * y, sign * (z - G_M_S2)))
            gravity.append(_reading("gravity", t, 0.0, 0.0, sign * G_M_S2))
            if gyr is not None:
                turning.append(_reading("gyroscope", t, *gyr))
        return [moving, gravity, turning]

    def _of_watch(self, batch: list[Row]) -> list[list[dict[str, object]]]:
        unit = 1.0 if self._standardised else -1 / G_M_S2
        found = []
        for t, (x, y, z), gyr in batch:
            parts = {
                "rotationRate": gyr or (0.0, 0.0, 0.0),
                "gravity": (0.0, 0.0, unit * G_M_S2),
                "acceleration": (unit * x, unit * y, unit * (z - G_M_S2)),
            }
            values = {
                f"{part}{axis}": value
                for part, three in parts.items()
                for axis, value in zip("XYZ", three, strict=True)
            }
            values |= {"quaternionW": 1.0, "quaternionX": 0.0, "quaternionY": 0.0}
            found.append({"name": "wrist motion", "time": _ns(t), "values": values})
        return [found]


def _reading(name: str, t: float, x: float, y: float, z: float) -> dict[str, object]:
    return {"name": name, "time": _ns(t), "values": {"z": z, "y": y, "x": x}, "accuracy": 3}


def _ns(t: float) -> int:
    return EPOCH_NS + round(t * 1e9)


Line = Callable[[Row], str]


def paper_line(row: Row) -> str:
    """As the watch of the paper writes."""
    t, (x, y, z), gyr = row
    ns = round(t * 1e9) + 10**15
    turning = "" if gyr is None else f"y;{ns};{gyr[0]};{gyr[1]};{gyr[2]}\n"
    return f"{turning}a;{ns};{x};{y};{z}\n"


def csv_line(row: Row) -> str:
    """Milliseconds since 1970, m/s², rad/s, as HyperIMU writes."""
    t, acc, gyr = row
    return ",".join(str(one) for one in (_ns(t) // 1_000_000, *acc, *(gyr or ()))) + "\n"


def sensagram_line(row: Row) -> str:
    """As SensaGram writes: an event of each sensor."""
    t, acc, gyr = row
    ns = round(t * 1e9) + 10**14
    events = [("accelerometer", acc), ("gyroscope", gyr)]
    return "".join(
        json.dumps({"type": f"android.sensor.{kind}", "timestamp": ns, "values": values}) + "\n"
        for kind, values in events[::-1]
        if values is not None
    )


class UdpSender(Sender):
    """Lines in UDP packets, one of them a row."""

    def __init__(self, port: int, line: Line = csv_line, address: str = "127.0.0.1") -> None:
        super().__init__()
        self._port, self._line = port, line
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((address, 0))

    def send(self, recording: Recording, speed: float = 1.0) -> None:
        """Send each row when it is its time."""
        for batch in self.play(recording, speed, 0.01):
            for row in batch:
                self._socket.sendto(self._line(row).encode(), ("127.0.0.1", self._port))

    def stop(self) -> None:
        """Send no more."""
        super().stop()
        self._socket.close()


class TcpSender(Sender):
    """Lines over a TCP connection, some to a packet, as the paper's phone app does."""

    def __init__(self, port: int, line: Line = paper_line, address: str = "127.0.0.1") -> None:
        super().__init__()
        self._line = line
        self._socket = socket.create_connection(("127.0.0.1", port), 5, (address, 0))

    def send(self, recording: Recording, speed: float = 1.0) -> None:
        """Send some rows at once, cut anywhere."""
        rest = ""
        for batch in self.play(recording, speed, 0.04):
            text = rest + "".join(self._line(row) for row in batch)
            cut = max(0, len(text) - 7)
            self._socket.sendall(text[:cut].encode())
            rest = text[cut:]
        self._socket.sendall(rest.encode())

    def stop(self) -> None:
        """Send no more."""
        super().stop()
        self._socket.close()


def main() -> None:
    """Play a recording as an app would."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("app", choices=["sensor_logger", "apple_watch", "udp", "tcp"])
    parser.add_argument("to", help="the push URL, or the port")
    parser.add_argument("recording", type=Path, nargs="+")
    parser.add_argument("--speed", type=float, default=1.0)
    given = parser.parse_args()
    makers: dict[str, Callable[[], Sender]] = {
        "sensor_logger": lambda: SensorLogger(given.to),
        "apple_watch": lambda: SensorLogger(given.to, watch=True),
        "udp": lambda: UdpSender(int(given.to)),
        "tcp": lambda: TcpSender(int(given.to)),
    }
    with makers[given.app]() as sender:
        for path in given.recording:
            sender.send(read_recording(path), given.speed)


if __name__ == "__main__":
    main()

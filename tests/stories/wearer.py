"""Somebody with a phone that runs Sensor Logger, in a process of their own.

``python -m tests.stories.wearer URL`` rests until a line on standard input names a recording; that
movement is made then, and the process says "made" when it is over. It ends with its input.
"""

from __future__ import annotations

import queue
import sys
import threading
import time
from pathlib import Path

from nodes.recordings import read_recording
from tests.nodes.sensory.senders import SensorLogger, resting

REST_S = 0.2
RATE_HZ = 50.0


def main(url: str) -> None:
    """Send until nobody asks any more."""
    asked: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(asked,), daemon=True).start()
    phone, rest = SensorLogger(url), resting(REST_S, RATE_HZ)
    while True:
        path = "" if asked.empty() else asked.get()
        if path == "end":
            return
        try:
            phone.send(read_recording(Path(path)) if path else rest)
        except OSError:  # the studio does not listen, or not yet
            time.sleep(REST_S)
        if path:
            print("made", flush=True)


def _listen(asked: queue.SimpleQueue[str]) -> None:
    for line in sys.stdin:
        asked.put(line.strip())
    asked.put("end")


if __name__ == "__main__":
    main(sys.argv[1])

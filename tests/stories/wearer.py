"""Somebody with a phone that runs Sensor Logger, in a process of their own.

``python -m tests.stories.wearer URL REST`` rests, as in the recording REST, until a line on
standard input names a recording; that movement is made then, and the process says "made" when it is
over. It ends with its input.
"""

from __future__ import annotations

import queue
import sys
import threading
import time
from pathlib import Path

from nodes.recordings import read_recording
from tests.nodes.sensory.senders import SensorLogger

AGAIN_S = 0.2


def main(url: str, resting: Path) -> None:
    """Send until nobody asks any more."""
    asked: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(asked,), daemon=True).start()
    phone, rest = SensorLogger(url), read_recording(resting)
    while True:
        path = "" if asked.empty() else asked.get()
        if path == "end":
            return
        try:
            phone.send(read_recording(Path(path)) if path else rest)
        except OSError:  # the studio does not listen, or not yet
            time.sleep(AGAIN_S)
        if path:
            print("made", flush=True)


def _listen(asked: queue.SimpleQueue[str]) -> None:
    for line in sys.stdin:
        asked.put(line.strip())
    asked.put("end")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))

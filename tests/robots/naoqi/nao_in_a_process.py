"""A virtual NAO served over NAOqi in a process of its own, for tests of the driver.

Run it: ``python nao_in_a_process.py PORT SPEED PASSWORD MODEL``. It prints its port when it
listens, then answers each line of its input: ``sense {...}`` takes a SenseRequest, ``state`` prints
the robot's own state as JSON.
"""

from __future__ import annotations

import queue
import sys
import threading
import time
from pathlib import Path

import msgspec

from nodes.resources import model_folder
from robots.body.actor import Actor
from robots.body.animations import load_animations
from robots.body.body import load_body
from robots.body.driver import SenseRequest
from robots.body.pose import VirtualRobot
from robots.body.virtual import VirtualDriver
from robots.naoqi.server.server import Server
from robots.naoqi.services.all import Services
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.line import Login

TICK_S = 0.005


def main(port: int, speed: float, password: str, model: str) -> None:
    folder = model_folder(model)
    body = load_body(folder)
    robot = VirtualRobot("NAO", body, load_animations(folder / "animations", body))
    driver = VirtualDriver(robot)
    driver.connect()
    actor = Actor("NAO", driver)
    served = ServedRobot(actor, robot)
    services = Services(served, Path(folder))
    login = Login("nao", password) if password else None
    server = Server(services.by_name, port=port, login=login)
    print(server.start(), flush=True)
    lines: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=lambda: [lines.put(line) for line in sys.stdin], daemon=True).start()
    start_s = time.monotonic()
    while True:
        time.sleep(TICK_S)
        with served.lock:
            told = actor.step((time.monotonic() - start_s) * speed)
        served.hear(told)
        services.notice()
        while not lines.empty():
            _answer(lines.get(), served, services)


def _answer(line: str, served: ServedRobot, services: Services) -> None:
    word, _, rest = line.strip().partition(" ")
    if word == "sense":
        request = msgspec.json.decode(rest, type=SenseRequest)
        with served.lock:
            served.actor.sense(request)
        services.sense(request)
    print(msgspec.json.encode(served.state()).decode(), flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]), *sys.argv[3:])

"""A NAOqi server for the benchmark, ours or the official package's: prints its port, serves."""

from __future__ import annotations

import os
import sys
from typing import Any

KEPT: list[object] = []  # sessions of the official package end when nobody holds them
ANGLES = [0.1 * number for number in range(26)]


def serve_ours() -> int:
    """Start our server; return its port."""
    from robots.naoqi.server.server import Server
    from robots.naoqi.wire.service import method

    class ALMotion:
        """As much of the robot's service as is measured."""

        @method("getAngles::[f](mb)")
        def angles(self, names: Any, uses_sensors: bool) -> list[float]:
            return ANGLES

        @method("setAngles::v(mmf)")
        def set_angles(self, names: Any, angles: Any, speed: float) -> None:
            pass

    return Server({"ALMotion": ALMotion()}, port=0).start()


def serve_theirs() -> int:
    """Start a server of the official package; return its port."""
    import qi

    qi.logging.setLevel(qi.logging.FATAL)

    class ALMotion:
        def angles(self, names: Any, uses_sensors: bool) -> list[float]:
            return ANGLES

        def set_angles(self, names: Any, angles: Any, speed: float) -> None:
            pass

    any_any = (qi.Dynamic, qi.Bool)
    qi.bind(qi.List(qi.Float), any_any, "getAngles")(ALMotion.angles)
    qi.bind(qi.Void, (qi.Dynamic, qi.Dynamic, qi.Float), "setAngles")(ALMotion.set_angles)
    session = qi.Session()
    KEPT.append(session)
    session.listenStandalone("tcp://127.0.0.1:0")
    session.registerService("ALMotion", qi.multiThreaded()(ALMotion)())
    return int(session.endpoints()[0].rsplit(":", 1)[1])


if __name__ == "__main__":
    sys.stdout.write(f"{serve_ours() if sys.argv[1] == 'ours' else serve_theirs()}\n")
    sys.stdout.flush()
    sys.stdin.read()
    os._exit(0)  # the official package aborts at a usual exit

"""The app phyphox with its remote access: the phone is the server, and is asked what is new."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

from nodes.sensory.reading import Reading
from nodes.sensory.ways.background import Background
from nodes.sensory.ways.phone_address import phone_address
from nodes.sensory.ways.phyphox_format import Experiment, read_answer, read_config
from nodes.sensory.ways.way import Arrived, Settings

if TYPE_CHECKING:
    from aiohttp import ClientSession

_ASK_EVERY_S = 0.05
_TRY_AGAIN_S = (0.5, 1.0, 2.0, 5.0)
_ANSWER_S = 5.0
_MOST_BYTES = 4_000_000
_LOST_S = 2.0  # so long without anything new, and its times are asked for anew
_MOST_READINGS = 2_000  # of one answer: the last ones, after a pause


class PhyphoxWay:
    """Asks a phone some twenty times a second, and again when it was away."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._host, self._port = settings.address, settings.port
        self._background = Background(self._ask)

    @property
    def where(self) -> str:
        """What the node is ready for."""
        return f"asks phyphox at {self._host}, port {self._port}"

    @property
    def missing(self) -> str:
        """What to check when nothing has arrived."""
        return (
            f"Nothing has arrived for 10 seconds. Does phyphox show the address {self._host} and "
            f"the port {self._port} under “Allow remote access”, and is its experiment running?"
        )

    def open(self) -> None:
        """Begin to ask; raises ParameterError for an address that is none."""
        self._host, self._port = phone_address(
            self._settings.address, self._settings.port, "phyphox"
        )
        self._background.start()

    def readings(self, until_s: float) -> list[Arrived]:
        """What the phone answered until then."""
        return self._background.take(until_s)

    def close(self) -> None:
        """Stop asking."""
        self._background.stop()

    async def _ask(self) -> None:
        from aiohttp import ClientError, ClientSession, ClientTimeout

        failures = 0
        while True:
            try:
                timeout = ClientTimeout(total=_ANSWER_S)
                base = f"http://{self._host}:{self._port}"
                async with ClientSession(base, timeout=timeout) as session:
                    await self._follow(session)
                failures = 0
            except (ClientError, OSError, TimeoutError, ValueError):
                self._say(
                    f"phyphox at {self._host}, port {self._port} does not answer. Is “Allow "
                    "remote access” on, and the phone in the same network?"
                )
            await asyncio.sleep(_TRY_AGAIN_S[min(failures, len(_TRY_AGAIN_S) - 1)])
            failures += 1

    async def _follow(self, session: ClientSession) -> None:
        """Read one experiment until another is opened."""
        experiment = read_config(await _body(session, "/config"))
        if experiment is None:
            self._say(f"What answers at {self._host}, port {self._port} is not phyphox.")
            return
        if experiment.acc is None:
            self._say(
                f"phyphox shows “{experiment.title}”, which has no accelerometer. Open an "
                "experiment with an accelerometer, such as “Acceleration with g”."
            )
            return
        await self._read(session, experiment)

    async def _read(self, session: ClientSession, experiment: Experiment) -> None:
        first, started = "", False
        news_s = ran_s = time.monotonic()
        while True:
            answer = read_answer(await _body(session, "/get", experiment.query()))
            if answer is None:
                self._say(f"What answers at {self._host}, port {self._port} is not phyphox.")
                return
            is_apple = self._settings.units == "apple"
            readings = experiment.take(answer, is_apple=is_apple)
            first = first or experiment.session
            if experiment.session != first:
                return
            now_s = time.monotonic()
            if experiment.measuring:
                ran_s = now_s
            elif not started:
                await _body(session, "/control", [("cmd", "start")])
            elif now_s - ran_s > _LOST_S:
                self._say("The experiment in phyphox is paused. Press the play button in the app.")
            started = True
            if readings:
                news_s = now_s
                self._put(experiment, readings[-_MOST_READINGS:], now_s)
            elif now_s - news_s > _LOST_S:
                news_s = now_s
                experiment.read_to.clear()
            await asyncio.sleep(_ASK_EVERY_S)

    def _put(self, experiment: Experiment, readings: Sequence[Reading], now_s: float) -> None:
        sources = " + ".join(sensor.source for sensor in experiment.sensors)
        self._background.put(Arrived(self._host, readings, now_s, told=sources))

    def _say(self, trouble: str) -> None:
        arrived = Arrived(self._host, arrived_s=time.monotonic(), trouble=trouble)
        self._background.put(arrived)


async def _body(session: ClientSession, path: str, query: Sequence[tuple[str, str]] = ()) -> bytes:
    """The body of an answer; ValueError when it is no good one."""
    async with session.get(path, params=list(query)) as response:
        if response.status != 200:
            raise ValueError(response.status)
        body = b""
        async for chunk in response.content.iter_any():
            body += chunk
            if len(body) > _MOST_BYTES:
                raise ValueError("too large")
        return body

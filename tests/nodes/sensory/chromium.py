"""A real Chromium without a window, driven by the protocol of its own developer tools."""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

import aiohttp

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
START_S = 20.0
ANSWER_S = 10.0
FLAGS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--disable-extensions", "--disable-dev-shm-usage", "--mute-audio", "--hide-scrollbars"),
    *("--no-default-browser-check", "--disable-default-apps", "--remote-debugging-port=0"),
    "--lang=en",
)


def chromium_path() -> str | None:
    """Where Chromium is on this computer; None where it is not."""
    return next((path for name in NAMES if (path := shutil.which(name))), None)


class Chromium:
    """A browser with an empty profile, which believes certificates with this public key."""

    def __init__(self, folder: Path, spki_sha256: str) -> None:
        path = chromium_path()
        assert path is not None
        own = (
            f"--user-data-dir={folder}",
            f"--ignore-certificate-errors-spki-list={spki_sha256}",
        )
        self._process = subprocess.Popen(
            [path, *FLAGS, *own, "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._session: aiohttp.ClientSession = self._run(_session())
        self._socket = self._run(self._session.ws_connect(_address(folder), max_msg_size=0))
        self._numbers = 0
        self._waiting: dict[int, asyncio.Future[Any]] = {}
        self._reader = asyncio.run_coroutine_threadsafe(self._read(), self._loop)

    def page(self, url: str, **about: Any) -> Page:
        """A new tab with this address, which looks like a phone."""
        context = self.call("Target.createBrowserContext")["browserContextId"]
        where = {"url": "about:blank", "browserContextId": context}
        target = self.call("Target.createTarget", **where)["targetId"]
        attached = {"targetId": target, "flatten": True}
        session = self.call("Target.attachToTarget", **attached)["sessionId"]
        page = Page(self, session, context)
        page.look_like_a_phone(**about)
        page.open(url)
        return page

    def call(self, method: str, session: str = "", **parameters: Any) -> Any:
        """Call a method of the protocol; what it answers."""
        return self._run(self._call(method, session, parameters))

    def close(self) -> None:
        """End the browser."""
        with contextlib.suppress(Exception):
            self.call("Browser.close")
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._run(self._session.close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _run(self, work: Coroutine[Any, Any, Any]) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(ANSWER_S)

    async def _call(self, method: str, session: str, parameters: dict[str, Any]) -> Any:
        self._numbers += 1
        number, answer = self._numbers, self._loop.create_future()
        self._waiting[number] = answer
        message: dict[str, Any] = {"id": number, "method": method, "params": parameters}
        await self._socket.send_json(message | ({"sessionId": session} if session else {}))
        return await answer

    async def _read(self) -> None:
        async for message in self._socket:
            told = json.loads(message.data)
            answer = self._waiting.pop(told.get("id", 0), None)
            if answer is None or answer.done():
                continue
            if "error" in told:
                answer.set_exception(RuntimeError(told["error"]["message"]))
            else:
                answer.set_result(told["result"])


class Page:
    """One tab."""

    def __init__(self, browser: Chromium, session: str, context: str) -> None:
        self._browser, self._session, self._context = browser, session, context

    def call(self, method: str, **parameters: Any) -> Any:
        """Call a method of the protocol for this tab."""
        return self._browser.call(method, self._session, **parameters)

    def look_like_a_phone(
        self, *, language: str = "en", agent: str = "", is_dark: bool = False
    ) -> None:
        """The size and touch of a phone, its language and browser, light or dark."""
        size = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}
        self.call("Emulation.setDeviceMetricsOverride", **size)
        self.call("Emulation.setTouchEmulationEnabled", enabled=True)
        phone = agent or "Mozilla/5.0 (Linux; Android 14) Chrome/150 Mobile Safari/537.36"
        self.call("Emulation.setUserAgentOverride", userAgent=phone, acceptLanguage=language)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if is_dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def before_scripts(self, script: str) -> None:
        """Run this before the scripts of the next page."""
        self.call("Page.enable")
        self.call("Page.addScriptToEvaluateOnNewDocument", source=script)

    def open(self, url: str) -> None:
        """Go there."""
        self.call("Page.navigate", url=url)

    def value(self, expression: str) -> Any:
        """What an expression is worth on the page; raises RuntimeError with its error."""
        wanted = {"returnByValue": True, "awaitPromise": True, "userGesture": True}
        told = self.call("Runtime.evaluate", expression=expression, **wanted)
        if "exceptionDetails" in told:
            raise RuntimeError(str(told["exceptionDetails"]))
        return told["result"].get("value")

    def until(self, expression: str, wanted: Any = True, seconds: float = 8.0) -> Any:
        """Wait until an expression has a value."""
        return wait_until(lambda: self.value(expression), lambda found: found == wanted, seconds)

    def tap(self, selector: str) -> None:
        """Tap in the middle of an element, as a finger does."""
        script = (
            f"(() => {{ const box = document.querySelector({selector!r}).getBoundingClientRect();"
            " return [box.x + box.width / 2, box.y + box.height / 2]; })()"
        )
        x, y = self.value(script)
        self.call("Input.dispatchTouchEvent", type="touchStart", touchPoints=[{"x": x, "y": y}])
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def feel(
        self, acc: tuple[float, float, float], gyr: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> None:
        """Give the phone sensors that feel this (m/s², rad/s) until they feel something else."""
        felt = {"accelerometer": acc, "linear-acceleration": (0.0, 0.0, 0.0), "gyroscope": gyr}
        for kind, values in felt.items():
            about = {"available": True, "maximumFrequency": 60}
            self.call("Emulation.setSensorOverrideEnabled", enabled=True, type=kind, metadata=about)
            reading = {"xyz": dict(zip("xyz", values, strict=True))}
            self.call("Emulation.setSensorOverrideReadings", type=kind, reading=reading)

    def screenshot(self) -> bytes:
        """The page as a PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])

    def close(self) -> None:
        """Close the tab and all it kept."""
        self._browser.call("Target.disposeBrowserContext", browserContextId=self._context)


def wait_until(
    look: Callable[[], Any], is_wanted: Callable[[Any], bool], seconds: float = 8.0
) -> Any:
    """Look again and again until it is as wanted; fails with what was seen last."""
    end_s, pause = time.monotonic() + seconds, threading.Event()
    while not is_wanted(found := look()):
        assert time.monotonic() < end_s, f"still {found!r}"
        pause.wait(0.02)
    return found


async def _session() -> aiohttp.ClientSession:
    return aiohttp.ClientSession()


def _address(folder: Path) -> str:
    """Where the browser listens for us: it writes it into its profile."""
    file = folder / "DevToolsActivePort"

    def read() -> list[str]:
        return file.read_text().split() if file.is_file() else []

    port, path = wait_until(read, lambda lines: len(lines) == 2, START_S)
    return f"ws://127.0.0.1:{port}{path}"

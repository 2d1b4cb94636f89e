"""A headless Chromium of our own, driven by the DevTools protocol over a pipe."""

from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any

import psutil

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-extensions",
    "--disable-features=SpareRendererForSitePerProcess",
    "--disable-frame-rate-limit",
    "--disable-gpu-vsync",
    "--remote-debugging-pipe",
    "--window-size=1280,800",
)
RENAME = """
import fcntl, os, sys
reads, writes = (fcntl.fcntl(int(number), fcntl.F_DUPFD, 10) for number in sys.argv[1:3])
os.dup2(reads, 3)
os.dup2(writes, 4)
os.execvp(sys.argv[3], sys.argv[3:])
"""
"""Chromium looks for the two ends of its pipe at the numbers 3 and 4, which are taken here."""

ANSWER_S = 120.0


class ChromiumFailed(Exception):
    """Chromium did not start or did not do what it was told; the text says what."""


def executable() -> str | None:
    """The Chromium of this machine, or None."""
    return next((found for name in NAMES if (found := shutil.which(name))), None)


class Chromium:
    """A browser with one page; as a context manager it ends with all that it started."""

    def __init__(self, program: str) -> None:
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        theirs_in, self._out = os.pipe()
        self._in, theirs_out = os.pipe()
        rename = [sys.executable, "-c", RENAME, str(theirs_in), str(theirs_out)]
        self._browser = subprocess.Popen(
            [*rename, program, *FLAGS, f"--user-data-dir={self._folder.name}", "about:blank"],
            pass_fds=(theirs_in, theirs_out),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(theirs_in)
        os.close(theirs_out)
        self._waiting = b""
        self._last_id = 0
        self._session = ""

    def __enter__(self) -> Chromium:
        try:
            targets = self.call("Target.getTargets")["targetInfos"]
            page = next(target["targetId"] for target in targets if target["type"] == "page")
            attached = self.call("Target.attachToTarget", targetId=page, flatten=True)
        except BaseException:
            self.close()
            raise
        self._session = attached["sessionId"]
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """End the browser and its processes, by their ids, and remove its folder."""
        ours = self._processes()
        for process in ours:
            process.terminate()
        _, left = psutil.wait_procs(ours, timeout=5)
        for process in left:
            process.kill()
        self._browser.wait(10)
        os.close(self._in)
        os.close(self._out)
        self._folder.cleanup()

    def open(self, page: Path) -> None:
        """Show a file, and wait until all of it is there."""
        self.call("Page.navigate", url=page.as_uri())
        for _ in range(600):
            if self.evaluate("document.readyState === 'complete' && !!window.isReady"):
                return
            time.sleep(0.05)
        raise ChromiumFailed("The page with Blockly did not open.")

    def evaluate(self, script: str) -> Any:
        """The value of an expression in the page; a promise is waited for."""
        answer = self.call(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in answer:
            raise ChromiumFailed(f"In the page: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def mouse(self, kind: str, x: float, y: float) -> None:
        """A real mouse event: ``mousePressed``, ``mouseMoved`` or ``mouseReleased``."""
        is_moved = kind == "mouseMoved"
        self.call(
            "Input.dispatchMouseEvent",
            type=kind,
            x=x,
            y=y,
            button="none" if is_moved else "left",
            buttons=0 if kind == "mouseReleased" else 1,
            clickCount=0 if is_moved else 1,
        )

    def renderer(self) -> psutil.Process:
        """The process that draws the page: the largest renderer."""
        found = [p for p in self._processes() if "--type=renderer" in p.cmdline()]
        if not found:
            raise ChromiumFailed("Chromium has no process that draws the page.")
        return max(found, key=lambda process: process.memory_info().rss)

    def call(self, method: str, **parameters: Any) -> Any:
        """Ask for something and wait for the answer; events in between are not needed."""
        self._last_id += 1
        message = {"id": self._last_id, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        _write_all(self._out, json.dumps(message).encode() + b"\0")
        deadline_s = time.monotonic() + ANSWER_S
        while True:
            answer = json.loads(self._next_message(deadline_s, method))
            if answer.get("id") == self._last_id:
                break
        if "error" in answer:
            raise ChromiumFailed(f"{method}: {answer['error']}")
        return answer["result"]

    def _next_message(self, deadline_s: float, method: str) -> bytes:
        while b"\0" not in self._waiting:
            left_s = deadline_s - time.monotonic()
            is_there, _, _ = select.select([self._in], [], [], max(0.0, left_s))
            if not is_there:
                raise ChromiumFailed(f"Chromium did not answer {method} in {ANSWER_S:.0f} s.")
            received = os.read(self._in, 1 << 16)
            if not received:
                raise ChromiumFailed("Chromium has ended.")
            self._waiting += received
        message, _, self._waiting = self._waiting.partition(b"\0")
        return message

    def _processes(self) -> list[psutil.Process]:
        """The browser with all that it has started."""
        try:
            browser = psutil.Process(self._browser.pid)
            return [*browser.children(recursive=True), browser]
        except psutil.NoSuchProcess:
            return []


def _write_all(pipe: int, data: bytes) -> None:
    try:
        while data:
            data = data[os.write(pipe, data) :]
    except BrokenPipeError as error:
        raise ChromiumFailed("Chromium has ended.") from error

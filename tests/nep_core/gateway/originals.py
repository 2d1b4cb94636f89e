"""The original's real packages, fetched once, and programs that use them."""

from __future__ import annotations

import json
import os
import queue
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
FETCHED = Path(sys.prefix) / "original-nep"
FETCH_S = 60
FAILURES: dict[str, str] = {}
"""Why packages could not be fetched: it is tried only once."""
WAIT_S = 20.0


def python_package(version: str) -> Path:
    """The folder with nep of this version and what it needs besides our own packages."""
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-input", "--no-deps"]
    pip += ["--retries", "1", "--timeout", "10"]
    needs = [f"nep=={version}", "simplejson", "msgpack"]
    return _fetched(version, lambda folder: [*pip, "--target", str(folder), *needs])


def javascript_package() -> Path:
    """The folder with nep-js; its zeromq brings its compiled part along."""
    npm, node = shutil.which("npm"), shutil.which("node")
    if npm is None or node is None:
        pytest.skip("Node.js with npm is not here, which nep-js needs")
    install = [npm, "install", "--ignore-scripts", "--no-audit", "--no-fund", "--prefix"]
    install[2:2] = ["--fetch-retries=1", "--fetch-timeout=10000"]
    return _fetched("js", lambda folder: [*install, str(folder), "nep-js@0.1.1"])


class OriginalProgram:
    """A running program of the original, and what it has heard so far by topic."""

    def __init__(self, command: list[str], folder: Path, parts: list[dict[str, Any]]) -> None:
        self.heard: dict[str, list[Any]] = {}
        self._lines: list[str] = []
        self._news: queue.Queue[dict[str, Any]] = queue.Queue()
        paths = {"PYTHONPATH": str(folder), "NODE_PATH": str(folder / "node_modules")}
        self._process = subprocess.Popen(
            [*command, f"program-{len(parts)}", json.dumps(parts)],
            env=os.environ | paths,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def hears(self, parts: set[str], meanwhile: Callable[[], None] = lambda: None) -> None:
        """Wait until something has come on all these topics."""
        deadline = time.monotonic() + WAIT_S
        while not parts <= self.heard.keys():
            missing = sorted(parts - self.heard.keys())
            assert time.monotonic() < deadline, f"nothing on {missing}: {self._lines[-30:]}"
            meanwhile()
            try:
                news = self._news.get(timeout=0.03)
            except queue.Empty:
                continue
            self.heard.setdefault(news["topic"], []).append(news["heard"])

    def close(self) -> None:
        self._process.communicate(timeout=WAIT_S)
        self._reader.join(WAIT_S)

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._lines.append(line.rstrip())
            if line.startswith("@"):
                self._news.put(json.loads(line[1:]))


def python_program(version: str, parts: list[dict[str, Any]]) -> OriginalProgram:
    command = [sys.executable, str(HERE / "_original_program.py")]
    return OriginalProgram(command, python_package(version), parts)


def javascript_program(folder: Path, parts: list[dict[str, Any]]) -> OriginalProgram:
    return OriginalProgram(["node", str(HERE / "_original_program.js")], folder, parts)


def _fetched(name: str, command: Callable[[Path], list[str]]) -> Path:
    """A folder that is filled at the first call, by one of all test processes."""
    fcntl = pytest.importorskip("fcntl")
    FETCHED.mkdir(exist_ok=True)
    folder, unfinished = FETCHED / name, FETCHED / f"{name}.unfinished"
    with (FETCHED / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not folder.exists():
            if name not in FAILURES:
                shutil.rmtree(unfinished, ignore_errors=True)
                unfinished.mkdir()
                FAILURES[name] = _failure(command(unfinished))
            if FAILURES[name]:
                pytest.skip(f"the original's {name} could not be fetched: {FAILURES[name]}")
            unfinished.rename(folder)
    return folder


def _failure(command: list[str]) -> str:
    """Why a command failed; nothing when it did not."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=FETCH_S)
    except subprocess.TimeoutExpired:
        return f"it took more than {FETCH_S} s"
    return done.stderr[-300:] or "no reason given" if done.returncode else ""

"""Builds the examples in other languages, once for each state of their files, or says why not."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
CACHE = PROJECT / ".venv" / "examples"
BUILD_S = 240
HEADERS = {"zmq.hpp": "cppzmq-dev", "nlohmann/json.hpp": "nlohmann-json3-dev"}


def build(language: str) -> Path:
    """The folder of the built nodes; skips the test when this computer cannot build them."""
    source = PROJECT / "examples" / language
    place = CACHE / language / _state_of(source)
    with _locked(language):
        if not (place / "built").exists():
            shutil.rmtree(place.parent)
            shutil.copytree(source, place, ignore=shutil.ignore_patterns(*GENERATED))
            WAYS[language](place)
            (place / "built").touch()
    return place / "nodes"


GENERATED = ("build", "bin", "node_modules", "package-lock.json")


def _build_cpp(place: Path) -> None:
    missing = [name for name in ("cmake", "g++") if shutil.which(name) is None]
    missing += [name for name in HEADERS if not (Path("/usr/include") / name).exists()]
    if missing:
        packages = [HEADERS.get(name, name) for name in missing]
        pytest.skip(f"missing: {', '.join(missing)} (apt install {' '.join(packages)})")
    _run(["cmake", "-S", str(place), "-B", str(place / "build")])
    _run(["cmake", "--build", str(place / "build"), "--parallel", "2"])


def _build_javascript(place: Path) -> None:
    if shutil.which("node") is None or shutil.which("npm") is None:
        pytest.skip("missing: Node.js with npm")
    try:
        # The package brings compiled code for the usual systems: nothing of it need be run.
        _run(["npm", "install", "--ignore-scripts", "--no-audit", "--no-fund"], folder=place)
    except subprocess.CalledProcessError as error:
        if "npm error network" not in error.stdout and "ENOTFOUND" not in error.stdout:
            raise
        pytest.skip("npm could not fetch zeromq: is this computer on the internet?")


WAYS = {"cpp": _build_cpp, "javascript": _build_javascript}


def _run(command: list[str], folder: Path | None = None) -> None:
    out = subprocess.STDOUT
    ended = subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=out, text=True, timeout=BUILD_S
    )
    if ended.returncode:
        print(ended.stdout)
        ended.check_returncode()


def _state_of(folder: Path) -> str:
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    files = [path for path in files if not set(path.relative_to(folder).parts) & set(GENERATED)]
    content = b"".join(str(path).encode() + path.read_bytes() for path in files)
    return hashlib.sha256(content).hexdigest()[:16]


@contextmanager
def _locked(language: str) -> Iterator[None]:
    """One process at a time: pytest works in several."""
    fcntl = pytest.importorskip("fcntl", reason="the examples are built on Linux and macOS only")
    (CACHE / language).mkdir(parents=True, exist_ok=True)
    with (CACHE / f"{language}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield

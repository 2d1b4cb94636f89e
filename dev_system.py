"""What NEP Studio needs of the system it runs on: found, and on Debian and Ubuntu installed."""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO

QT_LIBRARIES = {
    "libgl1": "libGL.so.1",
    "libegl1": "libEGL.so.1",
    "libglib2.0-0": "libglib-2.0.so.0",
    "libxkbcommon0": "libxkbcommon.so.0",
    "libdbus-1-3": "libdbus-1.so.3",
    "libfontconfig1": "libfontconfig.so.1",
}
"""What Qt needs of a Linux system: the Debian package and the library in it."""

WINDOW_LIBRARIES = {
    "libx11-xcb1": "libX11-xcb.so.1",
    "libxcb-cursor0": "libxcb-cursor.so.0",
    "libxcb-icccm4": "libxcb-icccm.so.4",
    "libxcb-image0": "libxcb-image.so.0",
    "libxcb-keysyms1": "libxcb-keysyms.so.1",
    "libxcb-randr0": "libxcb-randr.so.0",
    "libxcb-render-util0": "libxcb-render-util.so.0",
    "libxcb-shape0": "libxcb-shape.so.0",
    "libxcb-sync1": "libxcb-sync.so.1",
    "libxcb-xfixes0": "libxcb-xfixes.so.0",
    "libxcb-xkb1": "libxcb-xkb.so.1",
    "libxkbcommon-x11-0": "libxkbcommon-x11.so.0",
}
"""What Qt needs besides, to open a window on a display."""

DISPLAY_PROGRAMS = {"xvfb": "Xvfb", "xauth": "xauth"}
"""What gives tests a display of their own: the Debian package and the program in it."""

BROWSER = {"chromium": "chromium"}
"""What opens the phone's page in tests: the Debian package and the program in it."""

NAMESPACES = {"iproute2": "ip", "util-linux": "unshare"}
"""What gives tests computers of their own in a network of their own."""

CPP_HEADERS = {
    "cppzmq-dev": "/usr/include/zmq.hpp",
    "nlohmann-json3-dev": "/usr/include/nlohmann/json.hpp",
}
"""What the examples in C++ are built with in tests, where there is a compiler."""

FREEZING = {"binutils": "objdump"}
"""What finds the libraries that the frozen program takes along."""

PACKAGING = {
    "appstream": "appstreamcli",
    "desktop-file-utils": "desktop-file-validate",
    "dpkg": "dpkg-deb",
    "nsis": "makensis",
    "xz-utils": "xz",
}
"""What packs and checks the installers: the Debian package and the program in it."""

EVERYTHING = (
    QT_LIBRARIES | WINDOW_LIBRARIES | DISPLAY_PROGRAMS | BROWSER | NAMESPACES | CPP_HEADERS
) | (FREEZING | PACKAGING)


class SetupError(Exception):
    """The work cannot go on; the text says why and what to do."""


def say(text: str) -> None:
    """Print a step to stderr: stdout belongs to the program that is run."""
    print(text, file=sys.stderr, flush=True)


def call(command: list[str], output: IO[bytes] | None = None) -> int:
    """Run a program to its end, its output to a file if one is given; return its exit code.

    Ctrl-C reaches the program too, which ends in its own time; after a step that is the end.
    """
    is_interrupted = False
    with subprocess.Popen(command, stdout=output, stderr=output) as child:
        before = signal.signal(signal.SIGTERM, lambda *_: child.terminate())
        while child.returncode is None:
            try:
                child.wait()
            except KeyboardInterrupt:
                is_interrupted = True
    signal.signal(signal.SIGTERM, before)
    if is_interrupted and output:
        raise KeyboardInterrupt
    return child.returncode if child.returncode >= 0 else 128 - child.returncode


def step(command: list[str]) -> str:
    """Run a program quietly; return its last words when it failed, nothing when it went well."""
    with tempfile.TemporaryFile() as output:
        if call(command, output) == 0:
            return ""
        output.seek(0)
        lines = output.read().decode(errors="replace").splitlines()
        return "\n".join([f"{' '.join(command)} failed:", *lines[-12:]])


@dataclass(frozen=True)
class Machine:
    """What may be done about missing system packages on a Linux machine."""

    has_apt: bool
    rights: str  # root, sudo (without a password), sudo asks, none

    @property
    def may_install(self) -> bool:
        """Whether apt-get can be run without asking anybody."""
        return self.has_apt and self.rights in ("root", "sudo")


def this_machine() -> Machine:
    """Look at the machine that runs this file."""
    has_apt = shutil.which("apt-get") is not None
    if os.geteuid() == 0:
        return Machine(has_apt, "root")
    if shutil.which("sudo") is None:
        return Machine(has_apt, "none")
    return Machine(has_apt, "sudo asks" if step(["sudo", "-n", "true"]) else "sudo")


def has_display(system: str, environment: Mapping[str, str]) -> bool:
    """Whether a window can be shown here, by ``platform.system()`` and the environment."""
    if system in ("Windows", "Darwin"):
        return True
    return bool(environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY"))


def missing_packages(
    needed: Mapping[str, str] = QT_LIBRARIES,
    load: Callable[[str], object] = ctypes.CDLL,
    find: Callable[[str], object] = importlib.util.find_spec,
    which: Callable[[str], str | None] = shutil.which,
) -> list[str]:
    """Return the Debian packages that Python's venv and ``needed`` still lack on this system.

    ``needed`` gives by package a library of its own (its name has ``.so.``), a file with its
    whole path, or a program.
    """

    def is_there(thing: str) -> bool:
        if thing.startswith("/"):
            return Path(thing).exists()
        try:
            return bool(load(thing)) if ".so." in thing else which(thing) is not None
        except OSError:
            return False

    missing = [] if find("ensurepip") else [venv_package()]
    return missing + [package for package, thing in needed.items() if not is_there(thing)]


def venv_package() -> str:
    """Return the Debian package that gives this Python its ``venv``."""
    debian_python = Path("/usr/bin/python3")
    is_default = debian_python.exists() and debian_python.samefile(sys.executable)
    return "python3-venv" if is_default else f"python3.{sys.version_info[1]}-venv"


def advice(missing: list[str], machine: Machine) -> str:
    """Say what to type for the missing packages, or what to look for without apt-get."""
    if not machine.has_apt:
        names = ", ".join(EVERYTHING.get(package, "Python's venv") for package in missing)
        return f"Missing: {names}. Install them with the package manager of your system."
    install = f"apt-get install --yes {' '.join(missing)}"
    command = {
        "root": f"apt-get update && {install}",
        "none": f'su -c "apt-get update && {install}"',
    }.get(machine.rights, f"sudo apt-get update && sudo {install}")
    return f"System packages are missing. Type this once, then start dev.py again:\n  {command}"


def install_packages(missing: list[str], machine: Machine) -> None:
    """Install with apt-get; fetch its lists only when the packages cannot be had without."""
    say(f"Installing with apt-get: {' '.join(missing)} ...")
    apt = ["env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "-o", "DPkg::Lock::Timeout=120"]
    apt = apt if machine.rights == "root" else ["sudo", "-n", *apt]
    install = [*apt, "install", "--yes", "--no-install-recommends", *missing]
    if step(install):
        say("Fetching the package lists of apt-get ...")
        step([*apt, "update"])
        if failure := step(install):
            say(failure)


def provide_packages(needed: dict[str, str], wished: dict[str, str]) -> None:
    """Install what the Linux system lacks or say what to type; stop when it cannot be done without.

    What is only ``wished`` makes some of the work possible: there the advice is all.
    """
    missing = missing_packages(needed | wished)
    if not missing:
        return
    machine = this_machine()
    if machine.may_install:
        install_packages(missing, machine)
        importlib.invalidate_caches()
        missing = missing_packages(needed | wished)
    if {venv_package(), *needed}.intersection(missing):
        raise SetupError(advice(missing, machine))
    if missing:
        say(advice(missing, machine))

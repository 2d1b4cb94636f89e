"""Make NEP Studio's environment, then run, test, check or measure the program in it."""

from __future__ import annotations

import ctypes
import hashlib
import importlib
import importlib.util
import json
import os
import platform
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO

HELP = """\
python3 dev.py run                 play the karate story on the simulated NAO
python3 dev.py run ARGUMENTS       start nep-studio with these arguments
python3 dev.py test [ARGUMENTS]    run the tests; the arguments go to pytest
python3 dev.py lint                check format, style and types
python3 dev.py bench [NAME...] [--json]
                                   measure against references; exit code 1 when a goal is missed
python3 dev.py setup               make the environment only

Each makes .venv beside this file when it is not there or out of date."""

ROOT = Path(__file__).resolve().parent
OLDEST, NEWEST = (3, 11), (3, 13)
STORY = ["run", str(ROOT / "resources" / "examples" / "karate_greeting.nep")]

QT_LIBRARIES = {
    "libgl1": "libGL.so.1",
    "libegl1": "libEGL.so.1",
    "libglib2.0-0": "libglib-2.0.so.0",
    "libxkbcommon0": "libxkbcommon.so.0",
    "libdbus-1-3": "libdbus-1.so.3",
    "libfontconfig1": "libfontconfig.so.1",
}
"""What Qt needs of a Linux system: the Debian package and the library in it."""

UNABLE = {
    "Windows": "On Windows dev.py installs no system software. If Qt does not start, install the"
    ' "Microsoft Visual C++ Redistributable" (x64) yourself.',
    "Darwin": "On macOS dev.py installs no system software. Qt needs macOS 13 or newer.",
}
"""What dev.py cannot do on systems that have no apt-get, by ``platform.system()``."""

PIP_FAILED = """\
The packages that NEP Studio needs could not be installed; pip's last words are above.
Try, in order:
  [ ] Is this computer on the internet?  Behind a proxy, set HTTPS_PROXY first.
  [ ] Is there 1.5 GB of free disk space, and is this Python a 64-bit one?
  [ ] Run the same command again: it starts the environment afresh."""


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
        signal.signal(signal.SIGTERM, lambda *_: child.terminate())
        while child.returncode is None:
            try:
                child.wait()
            except KeyboardInterrupt:
                is_interrupted = True
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


def check_python(version: tuple[int, int], which: Callable[[str], str | None]) -> None:
    """Stop when this Python is too old or too new, naming one that is here and fits."""
    if OLDEST <= version <= NEWEST:
        return
    names = [f"3.{minor}" for minor in range(OLDEST[1], NEWEST[1] + 1)]
    fitting = [f"python{name}" for name in names if which(f"python{name}")]
    way_out = f"Type: {fitting[-1]} {' '.join(sys.argv)}" if fitting else "Install one of them."
    needs = f"NEP Studio needs Python {' or '.join(names)}"
    raise SetupError(f"{needs}; {sys.executable} is {version[0]}.{version[1]}.\n{way_out}")


def missing_packages(
    load: Callable[[str], object] = ctypes.CDLL,
    find: Callable[[str], object] = importlib.util.find_spec,
) -> list[str]:
    """Return the Debian packages that Python's venv and Qt still need on this Linux system."""
    missing = [] if find("ensurepip") else [venv_package()]
    for package, library in QT_LIBRARIES.items():
        try:
            load(library)
        except OSError:
            missing.append(package)
    return missing


def venv_package() -> str:
    """Return the Debian package that gives this Python its ``venv``."""
    debian_python = Path("/usr/bin/python3")
    is_default = debian_python.exists() and debian_python.samefile(sys.executable)
    return "python3-venv" if is_default else f"python3.{sys.version_info[1]}-venv"


def advice(missing: list[str], machine: Machine) -> str:
    """Say what to type for the missing packages, or what to look for without apt-get."""
    if not machine.has_apt:
        names = ", ".join(QT_LIBRARIES.get(package, "Python's venv") for package in missing)
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


def provide_packages(*, is_qt_needed: bool) -> None:
    """Install what the Linux system lacks or say what to type; stop when it cannot be done without.

    A run without a window needs no Qt library, so there the advice is all.
    """
    missing = missing_packages()
    if not missing:
        return
    machine = this_machine()
    if machine.may_install:
        install_packages(missing, machine)
        importlib.invalidate_caches()
        missing = missing_packages()
    if missing and (is_qt_needed or venv_package() in missing):
        raise SetupError(advice(missing, machine))
    if missing:
        say(advice(missing, machine))


def wanted_stamp(root: Path) -> dict[str, str]:
    """Return what an environment of this folder is made for, to compare with the one there."""
    project = hashlib.sha256((root / "pyproject.toml").read_bytes()).hexdigest()
    python = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return {"python": python, "folder": str(root), "project": project}


def read_stamp(path: Path) -> dict[str, str]:
    """Return the stamp in a file; empty when there is none that can be read."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def work_to_do(found: dict[str, str], wanted: dict[str, str], *, has_python: bool) -> str:
    """Return ``nothing``, ``update`` (only pyproject.toml changed) or ``make`` (afresh)."""
    if not has_python or any(found.get(key) != wanted[key] for key in ("python", "folder")):
        return "make"
    return "nothing" if found == wanted else "update"


def make_environment(root: Path) -> Path:
    """Make or update ``.venv`` in a folder where needed; return its Python."""
    environment = root / ".venv"
    is_windows = platform.system() == "Windows"
    python = environment / ("Scripts/python.exe" if is_windows else "bin/python")
    stamp_file = environment / "nep-studio-stamp.json"
    wanted = wanted_stamp(root)
    to_do = work_to_do(read_stamp(stamp_file), wanted, has_python=python.exists())
    if to_do == "nothing":
        return python
    stamp_file.unlink(missing_ok=True)  # so that an interrupted installation is made afresh
    if to_do == "make":
        say(f"Making the environment .venv for Python {wanted['python']} ...")
        if failure := step([sys.executable, "-m", "venv", "--clear", str(environment)]):
            raise SetupError(f"{failure}\nDelete {environment}, then try again.")
        if platform.system() in UNABLE:
            say(UNABLE[platform.system()])
    say("Installing NEP Studio and what it needs (the first time: a minute or two) ...")
    pip = [str(python), "-m", "pip", "install", "--quiet", "--no-input"]
    if failure := step([*pip, "--editable", f"{root}[dev]"]):
        raise SetupError(f"{failure}\n{PIP_FAILED}")
    stamp_file.write_text(json.dumps(wanted), encoding="utf-8")
    return python


def modules(arguments: list[str]) -> dict[str, list[list[str]]]:
    """Return by command the modules, each with its arguments, to run one after the other."""
    return {
        "run": [["nep_studio", *(arguments or STORY)]],
        "test": [["pytest", *arguments]],
        "lint": [["ruff", "format", "--check", "."], ["ruff", "check", "."], ["mypy"]],
        "bench": [["benchmarks", *arguments]],
        "setup": [],
    }


def work(command: str, arguments: list[str]) -> int:
    """Prepare what a command needs, run it, and return its exit code."""
    os.environ["PYTHONUTF8"] = "1"
    check_python(sys.version_info[:2], shutil.which)
    if platform.system() == "Linux":
        provide_packages(is_qt_needed=command in ("setup", "test"))
    python = make_environment(ROOT)
    if command == "setup":
        say(f"The environment is ready: {python}")
    if command != "run":  # run may name files in the folder that the person is in
        os.chdir(ROOT)
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    programs = modules(arguments)[command]
    return max([call([str(python), "-m", *program]) for program in programs], default=0)


def main(arguments: list[str]) -> int:
    """Do what the command line asks; return the exit code."""
    command, *rest = arguments or ["help"]
    if command in ("help", "-h", "--help"):
        print(HELP)
        return 0
    if command not in modules([]) or (rest and command in ("setup", "lint")):
        say(f"dev.py cannot do this: {' '.join(arguments)}\n\n{HELP}")
        return 2
    try:
        return work(command, rest[1:] if rest[:1] == ["--"] else rest)
    except SetupError as error:
        say(str(error))
        return 1
    except OSError as error:
        say(f"{error}\nDelete {ROOT / '.venv'}, make sure you may write there, then try again.")
        return 1
    except KeyboardInterrupt:
        say("Stopped.")
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Make NEP Studio's environment, then run, test, check or measure the program in it."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

from dev_system import (
    BROWSER,
    CPP_HEADERS,
    DISPLAY_PROGRAMS,
    FREEZING,
    NAMESPACES,
    PACKAGING,
    QT_LIBRARIES,
    WINDOW_LIBRARIES,
    SetupError,
    call,
    has_display,
    provide_packages,
    say,
    step,
)
from dev_tests import EVERY_TEST, run_all

HELP = """\
python3 dev.py run                 open the window; without a display, play the karate story
                                   on the simulated NAO in the terminal
python3 dev.py run ARGUMENTS       start nep-studio with these arguments
python3 dev.py test [ARGUMENTS]    run the tests; the arguments go to pytest
python3 dev.py lint                check format, style and types
python3 dev.py bench [NAME...] [--json] [--with-peers]
                                   measure against references; exit code 1 when a goal is missed
python3 dev.py fuzz [TARGET...] [--minutes N] [--count N] [--seed N]
                                   feed bad input to what reads strangers' files and messages;
                                   exit code 1 when something breaks
python3 dev.py monkey [--steps N] [--seed N] [--tell]
                                   click and type at random in all windows;
                                   exit code 1 when something breaks
python3 dev.py freeze              make the program that needs no Python: dist/nep-studio
python3 dev.py package [--quick]   freeze it, try it, and pack the installers of this system
python3 dev.py setup               make the environment only

Each makes .venv beside this file when it is not there or out of date."""

ROOT = Path(__file__).resolve().parent
OLDEST, NEWEST = (3, 11), (3, 13)
STORY = ["run", str(ROOT / "resources" / "examples" / "karate_greeting.nep")]
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


def check_python(version: tuple[int, int], which: Callable[[str], str | None]) -> None:
    """Stop when this Python is too old or too new, naming one that is here and fits."""
    if OLDEST <= version <= NEWEST:
        return
    names = [f"3.{minor}" for minor in range(OLDEST[1], NEWEST[1] + 1)]
    fitting = [f"python{name}" for name in names if which(f"python{name}")]
    way_out = f"Type: {fitting[-1]} {' '.join(sys.argv)}" if fitting else "Install one of them."
    needs = f"NEP Studio needs Python {' or '.join(names)}"
    raise SetupError(f"{needs}; {sys.executable} is {version[0]}.{version[1]}.\n{way_out}")


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


def modules(arguments: list[str], *, is_shown: bool) -> dict[str, list[list[str]]]:
    """Return by command the modules, each with its arguments, to run one after the other.

    What ends with ".py" is a file. ``is_shown`` says that there is a display.
    """
    return {
        "run": [["nep_studio", *(arguments or ([] if is_shown else STORY))]],
        "test": [["pytest", *arguments]],
        "lint": [["ruff", "format", "--check", "."], ["ruff", "check", "."], ["mypy"]],
        "bench": [["benchmarks", *arguments]],
        "fuzz": [["fuzz", *arguments]],
        "monkey": [["tools/monkey.py", *arguments]],
        "freeze": [["packaging/freeze.py"]],
        "package": [["packaging/package.py", *arguments]],
        "setup": [],
    }


def system_needs(
    command: str,
    arguments: list[str],
    *,
    is_shown: bool,
    which: Callable[[str], str | None] = shutil.which,
) -> tuple[dict[str, str], dict[str, str]]:
    """Return what a command cannot do without on Linux, and what some of its work needs."""
    is_window = not arguments or arguments[0].endswith(".nep")
    if command == "run" and is_window and is_shown:
        return QT_LIBRARIES | WINDOW_LIBRARIES, {}
    if command == "test" and "freeze" in arguments:  # it is tried without a screen
        return QT_LIBRARIES | FREEZING, WINDOW_LIBRARIES
    wished = WINDOW_LIBRARIES if is_shown or command in ("test", "bench") else {}
    programs = DISPLAY_PROGRAMS if command in ("test", "bench") else {}
    if command == "test":
        can_build = which("g++") and which("cmake")  # nobody gets a compiler unasked
        programs = programs | BROWSER | NAMESPACES | (CPP_HEADERS if can_build else {})
    if command in ("freeze", "package"):  # what the program takes along must be here
        needed = QT_LIBRARIES | WINDOW_LIBRARIES | FREEZING
        return needed, PACKAGING if command == "package" else {}
    if command in ("setup", "test", "bench", "monkey"):
        return QT_LIBRARIES, wished | programs
    return {}, QT_LIBRARIES | wished


def work(command: str, arguments: list[str]) -> int:
    """Prepare what a command needs, run it, and return its exit code."""
    os.environ["PYTHONUTF8"] = "1"
    check_python(sys.version_info[:2], shutil.which)
    is_shown = has_display(platform.system(), os.environ)
    if platform.system() == "Linux":
        provide_packages(*system_needs(command, arguments, is_shown=is_shown))
    python = make_environment(ROOT)
    if command == "setup":
        say(f"The environment is ready: {python}")
    if command != "run":  # run may name files in the folder that the person is in
        os.chdir(ROOT)
        os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    if command == "test" and not arguments:
        return run_all(str(python), ROOT, EVERY_TEST)
    programs = modules(arguments, is_shown=is_shown)[command]
    return max([call([str(python), *how_to_run(program)]) for program in programs], default=0)


def how_to_run(program: list[str]) -> list[str]:
    """Return what Python is told to run a file or a module."""
    return program if program[0].endswith(".py") else ["-m", *program]


def main(arguments: list[str]) -> int:
    """Do what the command line asks; return the exit code."""
    command, *rest = arguments or ["help"]
    if command in ("help", "-h", "--help"):
        print(HELP)
        return 0
    if command not in modules([], is_shown=False) or (
        rest and command in ("setup", "lint", "freeze")
    ):
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

"""dev.py: what it finds missing, what it advises, and when it makes the environment again."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import dev
import dev_system

ROOT = Path(dev.__file__).parent
QT_PACKAGES = "libgl1 libegl1 libglib2.0-0 libxkbcommon0 libdbus-1-3 libfontconfig1"


def nothing_loads(library: str) -> object:
    raise OSError(library)


def test_a_bare_debian_lacks_venv_and_the_six_qt_libraries() -> None:
    missing = dev_system.missing_packages(load=nothing_loads, find=lambda module: None)

    assert missing == [dev_system.venv_package(), *QT_PACKAGES.split()]


def test_programs_are_looked_for_by_their_names() -> None:
    programs = dev_system.DISPLAY_PROGRAMS

    missing = dev_system.missing_packages(programs, which=lambda name: None)

    assert missing[-2:] == ["xvfb", "xauth"]


def test_files_are_looked_for_by_their_paths(tmp_path: Path) -> None:
    (tmp_path / "zmq.hpp").touch()
    needed = {"cppzmq-dev": f"{tmp_path}/zmq.hpp", "nlohmann-json3-dev": f"{tmp_path}/json.hpp"}

    missing = dev_system.missing_packages(needed)

    assert missing[-1:] == ["nlohmann-json3-dev"] and "cppzmq-dev" not in missing


def test_what_is_there_is_not_asked_for_again() -> None:
    def only_glib_is_missing(library: str) -> object:
        return nothing_loads(library) if "glib" in library else object()

    assert dev_system.missing_packages(load=only_glib_is_missing, find=str) == ["libglib2.0-0"]


@pytest.mark.parametrize(
    ("machine", "may_install"),
    [
        (dev_system.Machine(has_apt=True, rights="root"), True),
        (dev_system.Machine(has_apt=True, rights="sudo"), True),
        (dev_system.Machine(has_apt=True, rights="sudo asks"), False),
        (dev_system.Machine(has_apt=True, rights="none"), False),
        (dev_system.Machine(has_apt=False, rights="root"), False),
    ],
)
def test_packages_are_installed_only_where_nobody_must_be_asked(
    machine: dev_system.Machine, may_install: bool
) -> None:
    assert machine.may_install is may_install


@pytest.mark.parametrize(
    ("rights", "command"),
    [
        ("sudo asks", "sudo apt-get update && sudo apt-get install --yes libgl1 libegl1"),
        ("none", 'su -c "apt-get update && apt-get install --yes libgl1 libegl1"'),
        ("root", "apt-get update && apt-get install --yes libgl1 libegl1"),
    ],
)
def test_the_advice_is_the_exact_command_to_type(rights: str, command: str) -> None:
    advice = dev_system.advice(
        ["libgl1", "libegl1"], dev_system.Machine(has_apt=True, rights=rights)
    )

    assert advice.splitlines()[-1] == f"  {command}"


def test_without_apt_the_libraries_are_named() -> None:
    machine = dev_system.Machine(has_apt=False, rights="root")

    advice = dev_system.advice(["python3-venv", "libgl1", "libegl1"], machine)

    assert "Python's venv, libGL.so.1, libEGL.so.1" in advice


def test_apt_lists_are_fetched_only_when_the_packages_cannot_be_had(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    steps: list[list[str]] = []

    def step(command: list[str]) -> str:
        steps.append(command)
        return "Unable to locate package libgl1" if len(steps) == 1 else ""

    monkeypatch.setattr(dev_system, "step", step)
    dev_system.install_packages(["libgl1"], dev_system.Machine(has_apt=True, rights="sudo"))

    assert all(command[:2] == ["sudo", "-n"] for command in steps)
    verbs = [next(word for word in c if word in ("install", "update")) for c in steps]
    assert verbs == ["install", "update", "install"]


@pytest.mark.parametrize("version", [(3, 9), (3, 10), (3, 14)])
def test_a_python_that_does_not_fit_is_told_which_do(version: tuple[int, int]) -> None:
    with pytest.raises(dev.SetupError, match=r"needs Python 3\.11 or 3\.12 or 3\.13; .*") as found:
        dev.check_python(version, lambda name: name if name == "python3.12" else None)

    assert "Type: python3.12 " in str(found.value)


@pytest.mark.parametrize("version", [(3, 11), (3, 12), (3, 13)])
def test_the_pythons_of_pyproject_are_welcome(version: tuple[int, int]) -> None:
    dev.check_python(version, lambda name: None)


@pytest.mark.parametrize(
    ("changes", "has_python", "to_do"),
    [
        ({}, True, "nothing"),
        ({}, False, "make"),
        ({"project": "another pyproject.toml"}, True, "update"),
        ({"python": "3.9"}, True, "make"),
        ({"folder": "before it was moved"}, True, "make"),
    ],
)
def test_the_environment_is_made_again_only_when_it_does_not_fit(
    changes: dict[str, str], has_python: bool, to_do: str
) -> None:
    wanted = dev.wanted_stamp(ROOT)

    assert dev.work_to_do(wanted | changes, wanted, has_python=has_python) == to_do


@pytest.mark.parametrize("content", [None, b"", b"{", b"[1]", b"\xff\xfe"])
def test_a_half_made_environment_is_made_again(tmp_path: Path, content: bytes | None) -> None:
    stamp_file = tmp_path / "stamp.json"
    if content is not None:
        stamp_file.write_bytes(content)

    found = dev.read_stamp(stamp_file)

    assert dev.work_to_do(found, dev.wanted_stamp(ROOT), has_python=True) == "make"


@pytest.mark.parametrize(
    ("system", "python"),
    [("Windows", "Scripts/python.exe"), ("Darwin", "bin/python"), ("Linux", "bin/python")],
)
def test_every_system_gets_an_environment_and_hears_what_is_not_done_for_it(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    system: str,
    python: str,
) -> None:
    commands: list[str] = []

    def step(command: list[str]) -> str:
        (tmp_path / ".venv").mkdir(exist_ok=True)
        commands.append(" ".join(command))
        return ""

    monkeypatch.setattr(dev, "step", step)
    monkeypatch.setattr(dev.platform, "system", lambda: system)
    (tmp_path / "pyproject.toml").touch()

    made = dev.make_environment(tmp_path)

    assert made == tmp_path / ".venv" / python
    assert [" venv --clear " in commands[0], " pip install " in commands[1]] == [True, True]
    assert ("installs no system software" in capsys.readouterr().err) is (system != "Linux")
    assert dev.read_stamp(tmp_path / ".venv" / "nep-studio-stamp.json")["folder"] == str(tmp_path)


def test_lint_checks_format_style_and_types() -> None:
    lint = dev.modules([], is_shown=False)["lint"]

    assert [program[0] for program in lint] == ["ruff", "ruff", "mypy"]


def test_run_opens_the_window_and_without_a_display_plays_the_story() -> None:
    assert dev.modules([], is_shown=True)["run"] == [["nep_studio"]]
    assert dev.modules([], is_shown=False)["run"] == [["nep_studio", *dev.STORY]]


@pytest.mark.parametrize("is_shown", [True, False])
def test_run_with_arguments_starts_what_they_say(is_shown: bool) -> None:
    run = dev.modules(["code", "a.nep"], is_shown=is_shown)["run"]

    assert run == [["nep_studio", "code", "a.nep"]]


@pytest.mark.parametrize(
    ("system", "environment", "is_shown"),
    [
        ("Linux", {}, False),
        ("Linux", {"DISPLAY": ""}, False),
        ("Linux", {"DISPLAY": ":0"}, True),
        ("Linux", {"WAYLAND_DISPLAY": "wayland-0"}, True),
        ("Windows", {}, True),
        ("Darwin", {}, True),
    ],
)
def test_a_display_is_recognised(system: str, environment: dict[str, str], is_shown: bool) -> None:
    assert dev_system.has_display(system, environment) is is_shown


@pytest.mark.parametrize("arguments", [[], ["mine.nep"]])
def test_a_window_cannot_do_without_the_libraries_of_a_display(arguments: list[str]) -> None:
    needed, wished = dev.system_needs("run", arguments, is_shown=True)

    assert needed == dev_system.QT_LIBRARIES | dev_system.WINDOW_LIBRARIES
    assert wished == {}


@pytest.mark.parametrize(
    ("command", "more"),
    [("test", {"chromium", "iproute2", "util-linux"}), ("bench", set())],
)
def test_what_needs_a_display_or_browser_is_wished_for_where_the_rest_runs_without(
    command: str, more: set[str]
) -> None:
    needed, wished = dev.system_needs(command, [], is_shown=False, which=lambda name: None)

    assert needed == dev_system.QT_LIBRARIES
    assert set(wished) == {*dev_system.WINDOW_LIBRARIES, "xvfb", "xauth"} | more


def test_headers_are_wished_for_only_where_there_is_a_compiler_that_can_use_them() -> None:
    def wished(*programs: str) -> dict[str, str]:
        which = {name: name for name in programs}.get
        return dev.system_needs("test", [], is_shown=False, which=which)[1]

    assert dev_system.CPP_HEADERS.items() <= wished("g++", "cmake").items()
    assert "cppzmq-dev" not in wished("cmake")


def test_the_story_in_the_terminal_runs_without_any_qt_library() -> None:
    needed, _ = dev.system_needs("run", [], is_shown=False)

    assert needed == {}


def test_what_is_only_wished_for_does_not_stop_the_work(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    machine = dev_system.Machine(has_apt=True, rights="none")
    monkeypatch.setattr(dev_system, "this_machine", lambda: machine)
    absent = {"xvfb": "no such program"}

    dev_system.provide_packages({}, absent)

    assert "apt-get install --yes xvfb" in capsys.readouterr().err
    with pytest.raises(dev_system.SetupError, match="install --yes xvfb"):
        dev_system.provide_packages(absent, {})


def run_dev(*arguments: str, folder: Path = ROOT, **more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, folder / "dev.py", *arguments],
        capture_output=True,
        text=True,
        env=os.environ | more,
    )


def test_without_a_command_it_helps_and_an_unknown_one_is_refused() -> None:
    assert run_dev().stdout == dev.HELP + "\n"

    refused = run_dev("tset")

    assert refused.returncode == 2
    assert refused.stdout == ""
    assert "dev.py cannot do this: tset" in refused.stderr


@pytest.mark.skipif(
    sys.platform != "linux" or bool(dev_system.missing_packages()), reason="cannot start"
)
def test_without_packages_to_be_had_it_says_what_to_try_and_leaves_no_stamp(tmp_path: Path) -> None:
    for name in ("dev.py", "dev_system.py", "pyproject.toml"):
        shutil.copy(ROOT / name, tmp_path)

    ended = run_dev("setup", folder=tmp_path, PIP_NO_INDEX="1", PIP_CONFIG_FILE=os.devnull)

    assert ended.returncode == 1
    assert ended.stderr.endswith(dev.PIP_FAILED + "\n")
    assert "Traceback" not in ended.stderr
    assert not (tmp_path / ".venv" / "nep-studio-stamp.json").exists()

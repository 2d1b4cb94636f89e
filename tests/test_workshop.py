"""The workshop: versions that agree, files of a good size, a wheel that is whole, a sound Qt."""

import importlib
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtGui import QImage, QPainter, QPen

import dev

ROOT = Path(dev.__file__).parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
LONGEST_FILE_LINES = 800
MADE_BY_MACHINES = {"build", "dist", "__pycache__"}
MACHINE_PATH = re.compile(
    r"(?<![\w.~-])/(?:tmp|root|work|home/(?!nao/)\w+|Users/\w+)/|\b[A-Z]:\\Users\\"
)  # /home/nao is where every NAO keeps its files


def project_files(root: Path, pattern: str = "*") -> Iterator[Path]:
    """Give the files that people wrote: nothing hidden, nothing built."""
    for path in sorted(root.rglob(pattern)):
        folders = path.relative_to(root).parts
        is_hidden = any(name.startswith(".") and name != ".ci" for name in folders)
        if path.is_file() and not is_hidden and not MADE_BY_MACHINES & set(folders):
            yield path


def shape_problems(root: Path) -> list[str]:
    """Return the Python files that are too long, or that do not say what they are for."""
    problems = []
    for path in project_files(root, "*.py"):
        text = path.read_text(encoding="utf-8")
        name, length = path.relative_to(root).as_posix(), len(text.splitlines())
        if length > LONGEST_FILE_LINES:
            problems.append(f"{name} has {length} lines")
        if not name.startswith("tests/") and not text.startswith('"""'):
            problems.append(f"{name} has no docstring")
    return problems


def machine_paths(root: Path) -> list[str]:
    """Return the places where a file names a path that only one machine has."""
    found = []
    for path in project_files(root):
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except UnicodeDecodeError:
            continue  # a picture or a recording
        name = path.relative_to(root).as_posix()
        found += [f"{name}:{n}" for n, line in enumerate(lines, 1) if MACHINE_PATH.search(line)]
    return found


def test_qt_keeps_the_reference_count_of_none(qapp: object) -> None:
    """PySide6 6.12.0 drops one reference of None a call on Python 3.11, and dies of it."""
    image = QImage(8, 8, QImage.Format.Format_RGB32)
    painter, pen = QPainter(image), QPen()
    before = sys.getrefcount(None)

    for _ in range(500):
        painter.setPen(pen)
        pen.setWidthF(1.5)
    painter.end()

    assert before - sys.getrefcount(None) < 50


def test_dev_and_pyproject_ask_for_the_same_pythons() -> None:
    too_new = (dev.NEWEST[0], dev.NEWEST[1] + 1)

    assert PROJECT["requires-python"] == ">={}.{},<{}.{}".format(*dev.OLDEST, *too_new)


@pytest.mark.parametrize("program", sorted(PROJECT["scripts"]))
def test_every_program_of_the_project_can_be_started(program: str) -> None:
    module, function = PROJECT["scripts"][program].split(":")

    assert callable(getattr(importlib.import_module(module), function))


def test_every_file_has_a_good_size_and_says_what_it_is_for() -> None:
    assert shape_problems(ROOT) == []


def test_a_long_file_and_a_silent_one_are_found(tmp_path: Path) -> None:
    (tmp_path / "long.py").write_text('"""Long."""\n' + "x = 1\n" * LONGEST_FILE_LINES)
    (tmp_path / "silent.py").write_text("x = 1\n")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_silent.py").write_text("x = 1\n")
    (tmp_path / ".venv").mkdir()
    (tmp_path / ".venv" / "foreign.py").write_text("x = 1\n")

    problems = shape_problems(tmp_path)

    assert problems == ["long.py has 801 lines", "silent.py has no docstring"]


def test_no_file_names_a_path_of_one_machine() -> None:
    assert machine_paths(ROOT) == []


@pytest.mark.parametrize(
    ("parts", "is_found"),
    [
        (("open('", "/tmp", "/a.csv')"), True),
        (("", "/home", "/ann/nao"), True),
        (("", "/root", "/.venv"), True),
        (("C:", "\\Users", "\\ann"), True),
        (("https://example.org", "/work", "/index.html"), False),
        (("nodes", "/root", "/x"), False),
        (("", "/usr", "/bin/env bash"), False),
    ],
)
def test_a_path_of_one_machine_is_found(
    tmp_path: Path, parts: tuple[str, ...], is_found: bool
) -> None:
    (tmp_path / "planted.toml").write_text("\n" + "".join(parts))

    assert machine_paths(tmp_path) == (["planted.toml:2"] if is_found else [])


@pytest.fixture(scope="module")
def wheel_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project as a person gets it: its wheel, built and unpacked."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    [wheel] = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "unpacked")
    return folder / "unpacked"


def python_in(folder: Path, code: str) -> list[str]:
    """Run code in a Python that finds our packages in this folder first; return its lines."""
    child = subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(folder)},
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    return child.stdout.splitlines()


def test_the_wheel_holds_the_packages_the_manifests_and_the_licence(wheel_folder: Path) -> None:
    names = ("nep_core", "nodes", "nep_studio")
    imports = [f"import {name}; print({name}.__file__)" for name in names]

    assert python_in(wheel_folder, "\n".join(imports)) == [
        str(wheel_folder / name / "__init__.py") for name in names
    ]
    for manifest in ROOT.glob("nodes/*/*.toml"):
        assert (wheel_folder / manifest.relative_to(ROOT)).read_bytes() == manifest.read_bytes()
    [licence] = wheel_folder.glob("nep_studio-*.dist-info/licenses/LICENSE")
    assert licence.read_bytes() == (ROOT / "LICENSE").read_bytes()


def test_the_wheel_finds_its_own_resources_examples_and_nodes(wheel_folder: Path) -> None:
    code = """
from nep_core.places import node_folders
from nep_studio.paths import examples, resources
print(resources(), examples(), node_folders()[-1], sep="\\n")"""
    resources, examples, nodes = map(Path, python_in(wheel_folder, code))

    assert all(place.is_relative_to(wheel_folder) for place in (resources, examples, nodes))
    names = [path.name for path in (ROOT / "resources" / "examples").glob("*.nep")]
    assert {path.name for path in examples.glob("*.nep")} == set(names) != set()
    assert (nodes / "__init__.py").exists()


TERMS_OF_THE_FIELD = (
    *("Threshold", "Confidence", "False positive", "Null class", "Hard negatives", "Repetition"),
    *("Sample", "Dataset", "Classifier", "Connector", "Controller", "Plugin", "Crash handler"),
    *("Lazy initialiser", "Participant", "Trigger", "Joint", "Posture", "Stiffness", "Endpoint"),
    *("High-water mark", "Publisher", "Subscriber", "Fault", "Template"),
)


def test_the_glossary_has_the_terms_of_the_field_and_forbids_none_without_a_reason() -> None:
    glossary = (ROOT / "GLOSSARY.md").read_text(encoding="utf-8")
    terms = re.findall(r"^\*\*(.+?)\*\*: ", glossary, re.MULTILINE)
    avoided = re.findall(r"^\*Avoid\*: (.+)\.$", glossary, re.MULTILINE)

    assert len(terms) == len(set(terms)) > 150
    assert [term for term in TERMS_OF_THE_FIELD if term not in terms] == []
    assert [words for words in avoided if words.count("(") <= words.count("),")] == []

"""What goes into the frozen program: every file is there, and nothing of the workshop."""

import ast
import importlib.util
import sys
from pathlib import Path

import freeze
import frozen_start
import icons
import licences
import parts
import pytest

from nep_core.processes.manifest import NodeCatalog
from nep_studio import paths


def test_the_recipe_is_python_and_begins_at_a_file_that_is_there() -> None:
    recipe = (parts.ROOT / "build.spec").read_text(encoding="utf-8")

    tree = ast.parse(recipe)

    assert "frozen_start.py" in ast.unparse(tree)
    assert Path(frozen_start.__file__).is_file()


def test_every_example_manifest_and_node_is_taken_along_and_nothing_that_makes_them() -> None:
    shipped = dict(parts.data_files())

    wanted = [*paths.examples().glob("*.nep"), *NodeCatalog((parts.ROOT / "nodes",)).paths()]
    assert {str(path): str(path.parent.relative_to(parts.ROOT)) for path in wanted}.items() <= (
        shipped.items()
    )
    assert all(Path(path).is_file() for path in shipped)
    assert str(parts.ROOT / "resources" / "fonts" / "make_fonts.py") not in shipped
    assert not [path for path in shipped if "__pycache__" in path]
    assert not [path for path in shipped if "/docs/" in path]


def test_pages_and_licences_that_were_made_go_where_the_program_looks(tmp_path: Path) -> None:
    page = tmp_path / "de" / "index.html"
    page.parent.mkdir()
    page.write_text("Hallo", encoding="utf-8")

    made = parts.made_files(tmp_path, parts.DOCUMENTATION)

    assert made == [(str(Path("documentation", "de", "index.html")), str(page), "DATA")]


def test_every_library_that_is_named_because_nothing_imports_it_early_is_there() -> None:
    lost = [name for name in parts.LATE if importlib.util.find_spec(name.partition(".")[0]) is None]

    assert lost == []
    assert {"statistics", "csv", "sqlite3", "asyncio"} <= set(parts.for_programs())
    assert not {"tkinter", "idlelib", "antigravity"} & set(parts.for_programs())


@pytest.mark.parametrize(
    ("place", "is_wanted"),
    [
        ("nep_studio-0.1.0.dist-info/direct_url.json", False),
        ("PySide6/Qt/plugins/platforms/libqxcb.so", True),
        ("PySide6/Qt/plugins/platforms/libqoffscreen.so", True),
        ("PySide6/Qt/plugins/platformthemes/libqgtk3.so", False),
        ("libgtk-3.so.0", False),
        ("libstdc++.so.6", False),
        ("PySide6\\translations\\qtbase_de.qm", True),
        ("PySide6/Qt/translations/qt_help_de.qm", False),
        ("resources/translations/de.toml", True),
        ("numpy.libs/libscipy_openblas64_-32a4b2a6.so", True),
    ],
)
def test_what_recipes_of_others_bring_is_taken_along_only_where_it_is_of_use(
    place: str, is_wanted: bool
) -> None:
    assert parts.is_wanted(place) is is_wanted


def test_the_icon_of_each_system_holds_pictures_of_its_sizes(tmp_path: Path) -> None:
    icons.write_icons(tmp_path)

    png = (tmp_path / "48.png").read_bytes()
    ico = (tmp_path / "nep-studio.ico").read_bytes()
    icns = (tmp_path / "nep-studio.icns").read_bytes()
    assert png[:4] == b"\x89PNG" and int.from_bytes(png[16:20], "big") == 48
    assert ico[:6] == bytes([0, 0, 1, 0, len(icons.ICO_SIZES), 0])
    assert png in ico
    assert icns[:4] == b"icns" and int.from_bytes(icns[4:8], "big") == len(icns)


def test_the_licence_of_every_part_is_collected_and_qt_may_be_replaced(tmp_path: Path) -> None:
    modules = ["numpy", "zmq", "PySide6", "pyqtgraph", "mcap"]
    library = Path(sys.executable).resolve()  # comes from no Debian package, or from Python's

    licences.write_licences(tmp_path / "licences", modules, [str(library)])

    told = (tmp_path / "licences" / "README.txt").read_text(encoding="utf-8")
    for part in ("numpy", "pyzmq", "pyqtgraph", "mcap", "Python ", "Atkinson", "lucide"):
        assert f"* {part}" in told
    assert "you may\nreplace them" in told
    foxglove = (tmp_path / "licences" / "mcap" / "LICENSE.txt").read_text(encoding="utf-8")
    assert "Copyright (c) Foxglove" in foxglove  # its package comes without
    for name in ("numpy", "pyzmq", "pyqtgraph", "mcap", "qt", "python", "fonts", "icons"):
        assert any(file.stat().st_size for file in (tmp_path / "licences" / name).iterdir())


def test_programs_that_ours_starts_find_their_own_libraries(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("LD_LIBRARY_PATH", "/ours")
    monkeypatch.setenv("LD_LIBRARY_PATH_ORIG", "/theirs")
    monkeypatch.setenv("DYLD_LIBRARY_PATH", "/ours")
    monkeypatch.delenv("DYLD_LIBRARY_PATH_ORIG", raising=False)

    frozen_start.give_back_environment()

    assert frozen_start.os.environ["LD_LIBRARY_PATH"] == "/theirs"
    assert "DYLD_LIBRARY_PATH" not in frozen_start.os.environ


def test_under_its_second_name_the_program_is_the_command_nep(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["/usr/bin/nep"])

    code = frozen_start.start()

    assert code == 0
    assert "nep COMMAND" in capsys.readouterr().out


def test_modules_are_stored_as_they_are_in_the_way_that_pyinstaller_knows() -> None:
    from PyInstaller.archive import writers

    known = Path(writers.__file__).read_text(encoding="utf-8")

    assert all(name in known for name in freeze.STORED)

"""Pictures of programs: what is in them, and that they open again as the same program."""

from __future__ import annotations

import os
import struct
import sys
import zlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QByteArray
from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtSvg import QSvgRenderer
from pytestqt.qtbot import QtBot

from nep_core.errors import RecordingError
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.program import Project
from nep_studio.project import picture_files
from nep_studio.project.picture_files import project_bytes_from
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.plugins.exporting.picture import (
    LARGEST_PIXELS,
    PictureDialog,
    PictureOptions,
    copy_picture,
    fitting_scale,
    image_of,
    png_of,
    scene_of,
    svg_of,
    write_picture,
)
from nep_studio.ui.plugins.gestures.exchange import read_mcap
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.workbench.snippets import read_snippet
from nodes.recordings import check_size
from tests.blocks.block_building import B, build, karate

LANGUAGE = studio_language()
ODD = "¡Hola! 日本語 \x07 \ud83d\ude00".encode("utf-16", "surrogatepass").decode("utf-16")


@pytest.fixture
def canvas(qtbot) -> Canvas:
    canvas = Canvas(karate(LANGUAGE), load_theme("light"))
    qtbot.addWidget(canvas)
    canvas.resize(800, 600)
    return canvas


@pytest.mark.parametrize("kind", ["png", "svg"])
@pytest.mark.parametrize("what", ["page", "pages"])
def test_a_picture_opens_again_as_the_same_program(canvas, tmp_path, kind, what):
    say = next(b.id for b in canvas.editor.project.blocks.values() if b.type == "robot.say")
    canvas.editor.apply(SetField(say, "text", ODD))
    canvas.editor.apply(RenameProject("Größe & <Ruhe> “ja”"))
    path = tmp_path / f"picture.{kind}"

    write_picture(canvas, path, kind, PictureOptions(what))

    found = project_bytes_from(path)
    assert found == to_bytes(canvas.editor.project)
    assert to_bytes(from_bytes(found, "picture", LANGUAGE)) == found


def test_the_name_of_the_file_does_not_matter(canvas, tmp_path):
    path = tmp_path / "renamed.txt"

    path.write_bytes(png_of(canvas, PictureOptions()))

    assert project_bytes_from(path) == to_bytes(canvas.editor.project)


def test_a_picture_of_the_selection_has_those_blocks_only(canvas, tmp_path):
    together = next(
        b.id for b in canvas.editor.project.blocks.values() if b.type == "control.together"
    )
    canvas.selection.set([together])
    path = tmp_path / "some.png"

    write_picture(canvas, path, "png", PictureOptions("selection"))

    inside = from_bytes(project_bytes_from(path), "picture", LANGUAGE)
    types = {block.type for block in inside.blocks.values()}
    assert "control.together" in types
    assert "event.started" not in types
    whole = scene_of(canvas, "page")
    assert QImage(str(path)).height() < 2 * whole.height


def test_without_the_program_a_picture_is_only_a_picture(canvas, tmp_path):
    path = tmp_path / "plain.png"

    write_picture(canvas, path, "png", PictureOptions(has_program=False))

    assert not QImage(str(path)).isNull()
    assert project_bytes_from(path) is None


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0])
def test_a_picture_is_as_large_as_is_asked_for(canvas, scale):
    scene = scene_of(canvas, "page")

    image = image_of(canvas, PictureOptions(scale=scale))

    assert image.width() == pytest.approx(scene.width * scale, abs=1)
    assert image.height() == pytest.approx(scene.height * scale, abs=1)


def test_the_margin_is_as_wide_as_is_asked_for(canvas):
    narrow = image_of(canvas, PictureOptions(scale=1.0, margin=0))

    wide = image_of(canvas, PictureOptions(scale=1.0, margin=50))

    assert wide.width() - narrow.width() == pytest.approx(100, abs=1)


def test_the_background_is_the_theme_or_nothing(canvas):
    painted = image_of(canvas, PictureOptions())
    bare = image_of(canvas, PictureOptions(is_transparent=True))

    assert painted.pixelColor(1, 1) == canvas.look.theme.colour("canvas")
    assert bare.pixelColor(1, 1).alpha() == 0


def test_all_pages_are_in_one_picture(canvas):
    build(LANGUAGE, [B("nodes.launch")], page="nodes", editor=canvas.editor)

    scene = scene_of(canvas, "pages")

    assert [part.title for part in scene.parts] == ["Behaviour", "Nodes"]
    assert image_of(canvas, PictureOptions("pages")).height() > 2 * scene_of(canvas, "page").height


def test_a_giant_program_becomes_a_picture_with_less_detail(canvas):
    scene = scene_of(canvas, "page")
    scene.parts[0].bounds = scene.parts[0].bounds._replace(width=40_000, height=90_000)

    scale = fitting_scale(scene, 4.0)

    assert scene.width * scale * scene.height * scale <= LARGEST_PIXELS * 1.01
    assert scene.height * scale <= 30_000


def test_an_svg_has_its_words_as_text_that_fits(canvas):
    svg = svg_of(canvas, PictureOptions()).decode()

    assert ">takes the posture</text>" in svg
    assert svg.count("textLength=") > 20
    assert QSvgRenderer(QByteArray(svg.encode())).isValid()


def test_a_picture_is_copied_to_the_clipboard(canvas):
    copy_picture(canvas, PictureOptions(scale=1.0))

    image = QGuiApplication.clipboard().image()
    assert image.width() == round(scene_of(canvas, "page").width)


def test_a_pdf_is_made_to_print(canvas, tmp_path):
    path = tmp_path / "program.pdf"

    write_picture(canvas, path, "pdf", PictureOptions())

    assert path.read_bytes().startswith(b"%PDF-")
    assert path.stat().st_size > 5000


def test_an_empty_page_has_no_picture(qtbot):
    canvas = Canvas(Editor(Project(), LANGUAGE), load_theme("light"))
    qtbot.addWidget(canvas)

    with pytest.raises(EditRefused, match="nothing to show"):
        png_of(canvas, PictureOptions())


def test_a_folder_that_is_not_there_is_told(canvas, tmp_path):
    with pytest.raises(EditRefused, match="cannot be written"):
        write_picture(canvas, tmp_path / "no" / "a.png", "png", PictureOptions())


def test_the_dialog_saves_what_was_chosen(canvas, qtbot, tmp_path):
    dialog = PictureDialog(canvas, tmp_path, "karate", canvas)
    dialog.format.setCurrentIndex(dialog.format.findData("svg"))
    dialog.transparent.setChecked(True)
    told = []
    dialog.done_well.connect(told.append)

    assert dialog.save(tmp_path / "karate")

    assert told == ["Saved “karate.svg”."]
    assert project_bytes_from(tmp_path / "karate.svg") == to_bytes(canvas.editor.project)
    assert not dialog.scale.isEnabled()


def test_the_dialog_says_why_a_picture_cannot_be_saved(canvas, tmp_path):
    dialog = PictureDialog(canvas, tmp_path, "karate", canvas)

    assert not dialog.save(tmp_path / "no" / "karate")

    assert "cannot be written" in dialog.reason.text


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=3000))
def test_any_bytes_come_back_from_a_picture(program):
    header = struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)
    png = (
        picture_files.SIGNATURE
        + picture_files._chunk(b"IHDR", header)
        + picture_files._chunk(b"IEND", b"")
    )

    assert picture_files.program_in_png(picture_files.png_with_program(png, program)) == program
    svg = picture_files.svg_with_program(b"<svg></svg>", program)
    assert picture_files.program_in_svg(svg) == (program or None)


@settings(max_examples=80, deadline=None)
@given(st.data())
def test_a_damaged_picture_gives_the_program_or_nothing(data):
    program = b'{"format": "x"}' * 20
    header = struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)
    png = (
        picture_files.SIGNATURE
        + picture_files._chunk(b"IHDR", header)
        + picture_files._chunk(b"IEND", b"")
    )
    whole = picture_files.png_with_program(png, program)
    at = data.draw(st.integers(0, len(whole) - 1))

    cut = picture_files.program_in_png(whole[:at])
    changed = picture_files.program_in_png(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])

    assert cut in (None, program)
    assert changed in (None, program)


HOSTILE = {
    "bomb": picture_files.SIGNATURE
    + picture_files._chunk(
        b"iTXt", picture_files.KEY + b"\0\x01\0\0\0" + zlib.compress(b"\0" * 65_000_000, 1)
    ),
    "long": picture_files.SIGNATURE + struct.pack(">I", 0xFFFFFFFF) + b"iTXt" + b"x" * 50,
    "short": picture_files.SIGNATURE + picture_files._chunk(b"iTXt", picture_files.KEY + b"\0"),
    "laughs": b'<!DOCTYPE s [<!ENTITY a "ha"><!ENTITY b "&a;&a;">]><svg>'
    b'<metadata id="nep-studio-project">&b;&b;</metadata></svg>',
    "open": b'<svg><metadata id="nep-studio-project">QUJD',
    "empty": b"",
    "text": b"nep-studio-project",
}


@pytest.mark.parametrize("name", sorted(HOSTILE))
def test_a_hostile_picture_is_no_program(tmp_path, name):
    path = tmp_path / "hostile.png"
    path.write_bytes(HOSTILE[name])

    assert project_bytes_from(path) is None


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files")
@pytest.mark.parametrize("name", ["pipe.png", "endless.png"])
def test_what_is_only_called_like_a_file_holds_nobody_up(tmp_path, name):
    """An archive can bring both; who reads the one waits for ever, who reads the other too."""
    os.mkfifo(tmp_path / "pipe.png")
    (tmp_path / "endless.png").symlink_to("/dev/zero")

    assert project_bytes_from(tmp_path / name) is None
    with pytest.raises(EditRefused, match="it is not a file"):
        read_snippet(tmp_path / name, LANGUAGE)
    with pytest.raises(OSError, match="it is not a file"):
        check_size(tmp_path / name)
    with pytest.raises(RecordingError, match="it is not a file"):
        read_mcap(tmp_path / name)


def test_a_file_that_is_not_there_is_no_program():
    assert project_bytes_from(Path("nowhere.png")) is None


def test_a_dialog_that_is_closed_is_gone(canvas: Canvas, tmp_path: Path, qtbot: QtBot) -> None:
    dialog = PictureDialog(canvas, tmp_path, "karate", canvas)
    dialog.open()

    dialog.reject()

    qtbot.waitUntil(lambda: not canvas.findChildren(PictureDialog))

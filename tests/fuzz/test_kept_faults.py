"""What once broke a reader is told in a sentence now, or passed over, and the rest goes on."""

from __future__ import annotations

import logging
import os
import shutil
import threading
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QByteArray, QSettings

from faults import FaultError
from fuzz.target import SEEDS
from fuzz.targets import target
from nep_core.errors import ManifestError
from nep_core.networks.gateway.lines import recall
from nep_core.networks.security.keys import KeyFile
from nep_core.places import NODES_VARIABLE
from nep_core.processes.handover import take
from nep_core.processes.manifest import NodeCatalog, read_manifest
from nep_core.recordings.file import overview
from nep_studio.blocks.errors import ProjectFileError
from nep_studio.blocks.file_text import MOST_VALUES, decode
from nep_studio.blocks.program import split_slot
from nep_studio.project.picture_files import (
    png_with_program,
    program_in_png,
    project_bytes_from,
)
from nep_studio.project.trust import Approvals
from nep_studio.run.installation import launchable_nodes, table_in
from nep_studio.settings import Settings
from nep_studio.ui.plugins.gestures.exchange import read_mcap
from nep_studio.ui.robot_view.parts import read_view
from nep_studio.ui.words import read_catalogue, read_name
from nodes.perceptual.recognition.model import read_model
from nodes.recordings import read_recording
from nodes.resources import resource_folder
from nodes.sensory.connectors.bluetooth import read_profile
from nodes.sensory.connectors.phyphox import read_answer
from nodes.sensory.connectors.sensor_logger import read_message
from robots.body.animations import load_animation
from robots.body.body import load_body
from robots.body.speech import load_gesture_words
from robots.errors import FilesUnusable

NAO = resource_folder() / "robots" / "nao"


@pytest.mark.parametrize(
    ("name", "kept", "said"),
    [
        ("nep", "digits_in_slot.nep", "cannot be used"),
        ("nep", "digits.nep", "number in it that is too large"),
        ("models", "bomb.gestures", "is not a gesture model"),
        ("manifests", "deep.toml", "cannot be used"),
        ("manifests", "digits.toml", "cannot be used"),
        ("manifests", "dotted.toml", "too many parts"),
        ("manifests", "not_text.toml", "cannot be used"),
        ("csv", "long_number.csv", "not finite"),
        ("csv", "not_text.csv", "not a text file"),
        ("python", "deep_in_rule.txt", "read"),
    ],
)
def test_a_bad_file_is_told_in_a_sentence(tmp_path: Path, name: str, kept: str, said: str) -> None:
    with target(name).open(tmp_path) as feed, pytest.raises(FaultError) as raised:
        feed((SEEDS / name / kept).read_bytes())

    assert said in str(raised.value.sentence)


@pytest.mark.parametrize("kept", sorted(path.name for path in (SEEDS / "mcap").iterdir()))
def test_of_a_damaged_or_lying_recording_the_whole_part_is_read(kept: str) -> None:
    told = overview(SEEDS / "mcap" / kept)

    sound = {"plain.mcap": 5, "chunk.mcap": 5, "zstd.mcap": 5, "lz4.mcap": 5, "takes.mcap": 3}
    assert told.is_whole == (kept in sound)
    assert kept not in sound or told.messages == sound[kept]


def test_one_broken_manifest_hides_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "sensory").mkdir()
    kept = [path for path in (SEEDS / "manifests").iterdir() if path.stem != "lamp"]
    for path in kept:
        (tmp_path / "sensory" / path.name).write_bytes(path.read_bytes())
    monkeypatch.setenv(NODES_VARIABLE, str(tmp_path))

    shown = launchable_nodes()

    assert "sensory/virtual_watch" in shown
    assert {f"sensory/{path.stem}" for path in kept} <= shown.keys()
    for path in kept:
        with pytest.raises(ManifestError):
            NodeCatalog((tmp_path,)).find(f"sensory/{path.stem}")


Reads = Callable[[Path], object]
WAITING_FOR_NOBODY: dict[str, tuple[str, Reads]] = {
    "a recording": ("a.mcap", overview),
    "recorded gestures": ("a.mcap", read_mcap),
    "a movement": ("a.csv", read_recording),
    "a gesture model": ("a.gestures", read_model),
    "a manifest": ("sensory/a.toml", read_manifest),
    "keys": ("keys", KeyFile),
    "a picture": ("a.png", project_bytes_from),
    "words": (
        "xx.toml",
        lambda path: (read_name(path), read_catalogue("xx", path), table_in(path)),
    ),
    "a motion": ("a.toml", lambda path: load_animation(path, load_body(NAO))),
    "a body": ("body.json", lambda path: load_body(path.parent)),
    "a robot's look": ("view.toml", read_view),
    "a robot's gestures": ("gesture_words.toml", lambda path: load_gesture_words(path.parent)),
    "a Bluetooth device": ("a.toml", read_profile),
    "ports of the original": ("ports.json", recall),
    "a fault": ("fault.json", take),
    "what was approved": ("approved.json", lambda path: Approvals(path).has("")),
}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no such pipes here")
@pytest.mark.parametrize(("name", "read"), WAITING_FOR_NOBODY.values(), ids=WAITING_FOR_NOBODY)
def test_a_pipe_in_the_place_of_a_file_keeps_nobody_waiting(
    tmp_path: Path, name: str, read: Reads
) -> None:
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    os.mkfifo(path)
    ended: list[Exception | None] = []

    def reads() -> None:
        try:
            read(path)
        except Exception as error:
            ended.append(error)
        else:
            ended.append(None)

    reading = threading.Thread(target=reads, daemon=True)
    reading.start()
    reading.join(10)

    assert [isinstance(one, FaultError) for one in ended if one is not None] in ([], [True])
    assert ended


@pytest.mark.parametrize("name", ["body.json", "robot.toml", "gesture_words.toml", "a.toml"])
@pytest.mark.parametrize(
    "data", [b"\xff", b"[" * 3000, b".".join([b"a"] * 5000) + b" = 1", b"z = " + b"[" * 3000]
)
def test_what_describes_a_robot_of_ones_own_is_told_when_it_is_broken(
    tmp_path: Path, name: str, data: bytes
) -> None:
    for shipped in ("body.json", "robot.toml"):
        shutil.copy(NAO / shipped, tmp_path / shipped)
    (tmp_path / name).write_bytes(data)

    with pytest.raises(FilesUnusable):
        load_body(tmp_path)
        load_gesture_words(tmp_path)
        load_animation(tmp_path / "a.toml", load_body(NAO))


def test_a_push_that_is_no_text_is_no_message() -> None:
    assert read_message((SEEDS / "push" / "not_text.json").read_bytes()) is None
    assert read_message(b'{"payload": [{"name": "\xff"}]}') is None
    assert read_answer((SEEDS / "push" / "phyphox_not_text.json").read_bytes()) is None


@pytest.mark.parametrize("kept", ["deep.toml", "not_text.toml", "tables.toml", "other_kinds.toml"])
def test_a_broken_translation_leaves_the_words_english(
    tmp_path: Path, kept: str, caplog: pytest.LogCaptureFixture
) -> None:
    path = SEEDS / "translations" / kept
    with caplog.at_level(logging.CRITICAL):
        words = read_catalogue("xx", path).words
        table = table_in(path)

    assert all(isinstance(text, str) for text in words.values())
    assert isinstance(table, dict)
    assert read_name(path)
    with target("translations").open(tmp_path) as feed:
        feed(path.read_bytes())


def test_a_setting_of_no_type_of_python_counts_as_not_set(tmp_path: Path) -> None:
    kept = (SEEDS / "settings" / "no_type_of_python.ini").read_bytes()
    (tmp_path / "settings.ini").write_bytes(kept)

    settings = Settings(tmp_path)

    assert (settings.theme, settings.language, settings.text_scale) == ("system", "system", 1.0)
    assert isinstance(settings.values, QSettings)


STREAM = rb"\0\0\0\x9\x99\x99\x30\0\0\x1)"
"""A list of Qt of half a milliard values, as the file says."""


@pytest.mark.parametrize(
    "kept",
    [
        b"@Variant(" + STREAM,
        b'a, "@Variant(' + STREAM + b'"',
        b'""@Variant(' + STREAM,
        b"\\x40Vari\\141nt(" + STREAM,
        b"@DateTime(" + STREAM,
    ],
)
def test_a_setting_that_says_it_is_endless_counts_as_not_set(tmp_path: Path, kept: bytes) -> None:
    file = tmp_path / "settings.ini"
    file.write_bytes(b"[look]\ntheme=" + kept + b"\nlanguage=de\n[robots]\nsound=no\n")

    settings = Settings(tmp_path)

    assert b"theme" not in file.read_bytes()
    assert (settings.theme, settings.language, settings.has_sound) == ("system", "de", False)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes in folders are those of Unix")
@pytest.mark.parametrize("make", ["mkfifo", "mkdir"])
def test_what_is_no_file_in_place_of_the_settings_is_put_aside(tmp_path: Path, make: str) -> None:
    getattr(os, make)(tmp_path / "settings.ini")

    settings = Settings(tmp_path)
    settings.theme = "dark"
    settings.write()

    assert Settings(tmp_path).theme == "dark"
    assert (tmp_path / "settings.ini.old").exists()


def test_what_is_kept_of_ours_is_found_again_whatever_it_says(tmp_path: Path) -> None:
    settings = Settings(tmp_path)
    settings.recent_commands = ["@Variant(x)", "a, b(", "@"]
    settings.set_state("row", QByteArray(b"\0\x01(@)"))
    settings.write()

    again = Settings(tmp_path)

    assert again.recent_commands == ["@Variant(x)", "a, b(", "@"]
    assert again.state("row") == QByteArray(b"\0\x01(@)")


def test_a_picture_that_unpacks_to_much_more_than_its_size_has_no_program() -> None:
    plain = (SEEDS / "png" / "plain.png").read_bytes()
    program = zlib.compress(bytes(100)) * 2000  # packs by much less than a bomb

    assert program_in_png((SEEDS / "png" / "bomb.png").read_bytes()) is None
    assert program_in_png(png_with_program(plain, program)) == program


def test_a_project_of_too_many_values_is_refused_before_they_are_made() -> None:
    with pytest.raises(ProjectFileError, match="too many values"):
        decode(b"[" + b"[]," * (MOST_VALUES + 1) + b"0]", "many.nep")


def test_only_a_short_number_behind_a_dot_is_one_of_a_group() -> None:
    assert split_slot("item.12") == ("item", 12)
    assert split_slot("item." + "9" * 5000) == ("item." + "9" * 5000, 0)
    assert split_slot("item") == ("item", 0)

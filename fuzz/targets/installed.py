"""Files of this installation, and recordings: what nodes, windows and people bring along."""

from __future__ import annotations

import itertools
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fuzz.formats import mcap_changed, toml_changed
from fuzz.mutations import lines_changed
from fuzz.target import Feed, Target


@contextmanager
def mcap(folder: Path) -> Iterator[Feed]:
    """A recording: what `nep play` and the window's player do with one before they play it."""
    from nep_core.recordings.file import Recording, overview

    path = folder / "take.mcap"

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        told = overview(path)
        recording = Recording(path)
        for message in recording:
            message.payload.count(b"a")
        assert recording.is_whole == told.is_whole
        assert told.seconds >= 0.0 and told.messages >= 0

    yield feed


@contextmanager
def manifests(folder: Path) -> Iterator[Feed]:
    """A node's description, beside one that is sound: that one must always be there."""
    from faults import FaultError
    from nep_core.places import NODES_VARIABLE
    from nep_core.processes.manifest import NodeCatalog, read_manifest
    from nep_studio.run.installation import launchable_nodes

    before = dict(os.environ)
    os.environ[NODES_VARIABLE] = str(folder)
    place = folder / "sensory"
    place.mkdir()
    for name in ("lamp", "sound"):
        (place / f"{name}.py").write_text("def run(node): pass\n", encoding="utf-8")
    (place / "sound.toml").write_text(
        'type = "sensory"\nname = "sound"\ntitle = "Sound"\ndescription = "d"\naliases = ["noise"]',
        encoding="utf-8",
    )
    path, catalog, moments = place / "lamp.toml", NodeCatalog((folder,)), itertools.count(10**18)

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        moment = next(moments)
        os.utime(path, ns=(moment, moment))  # else one of the same size may be taken for this
        assert catalog.find("sensory/noise").name == "sound"
        assert {"sensory/lamp", "sensory/sound"} <= launchable_nodes().keys()
        manifest = read_manifest(path)
        for name, parameter in manifest.parameters.items():
            try:
                parameter.read(name, "1e5")
            except FaultError:
                continue
        manifest.read_parameters({})

    try:
        yield feed
    finally:
        os.environ.clear()
        os.environ.update(before)


@contextmanager
def settings(folder: Path) -> Iterator[Feed]:
    """The file of what a person has chosen: every value is asked for, and one is changed."""
    from nep_studio.settings import Settings

    asked = [
        name for name, one in vars(Settings).items() if not name.startswith("__") and _asks(one)
    ]

    def feed(data: bytes) -> None:
        with tempfile.TemporaryDirectory(dir=folder) as place:
            (Path(place) / "settings.ini").write_bytes(data)
            kept = Settings(Path(place))
            for name in asked:
                getattr(kept, name)
            for what in ("projects", "recordings", "logs"):
                kept.folder_for(what)
            kept.state("main")
            kept.is_shown("Log", default=True)
            kept.is_pin("1")
            kept.add_recent(Path("a.nep"))
            kept.write()

    yield feed


def _asks(one: object) -> bool:
    return isinstance(one, property) or (hasattr(type(one), "__get__") and not callable(one))


@contextmanager
def translations(folder: Path) -> Iterator[Feed]:
    """The table of a language that somebody added: the window's words, and those of blocks."""
    from nep_studio.blocks.language import faults, translated
    from nep_studio.run.installation import studio_language, table_in
    from nep_studio.ui.words import read_catalogue, read_name

    language = studio_language()
    path = folder / "xx.toml"

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        read_name(path).encode()
        words = read_catalogue("xx", path).words
        assert all(isinstance(text, str) for text in words.values())
        table = table_in(path)
        list(faults(language, table, "xx"))
        changed = translated(language, table, "xx")
        assert changed.definitions.keys() == language.definitions.keys()

    yield feed


TARGETS = {
    one.name: one
    for one in (
        Target("mcap", mcap, mcap_changed, heavy=("many_in_chunk.mcap",)),
        Target("manifests", manifests, toml_changed),
        Target("settings", settings, lines_changed),
        Target("translations", translations, toml_changed),
    )
}

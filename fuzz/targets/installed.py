"""Files of this installation, and recordings: what nodes, windows and people bring along."""

from __future__ import annotations

import contextlib
import itertools
import os
import random
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from fuzz.formats import mcap_changed, toml_changed
from fuzz.mutations import flipped, json_changed, lines_changed
from fuzz.target import Feed, Target


@contextmanager
def mcap(folder: Path) -> Iterator[Feed]:
    """A recording: what `nep play`, the player and who learns gestures do with one first."""
    from faults import FaultError
    from nep_core.recordings.file import Recording, overview
    from nep_studio.ui.plugins.gestures.exchange import read_mcap

    path = folder / "take.mcap"

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        told = overview(path)
        recording = Recording(path)
        for message in recording:
            message.payload.count(b"a")
        assert recording.is_whole == told.is_whole
        assert told.seconds >= 0.0 and told.messages >= 0
        with contextlib.suppress(FaultError):
            read_mcap(path)

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


@contextmanager
def brought(folder: Path) -> Iterator[Feed]:
    """Small things: a motion of Choregraphe, a sound, a Bluetooth device, an update, words."""
    import struct

    from faults import FaultError
    from nep_studio.blocks.own_animations import JointKeys, OwnAnimation, why_not_animation
    from nep_studio.support.updates import newest_in
    from nodes.sensory.connectors.bluetooth import Decoder, profiles, read_profile
    from nodes.sensory.sample_stream import SampleStream
    from robots.body.choregraphe import read_choregraphe
    from robots.body.sense_tasks import length_s
    from robots.body.speech import speaking_time_s
    from robots.naoqi.services.speech import Voice, read_text

    path = folder / "brought"
    known = [one for profile in profiles().values() for one in profile.characteristics]

    def motion(text: str) -> None:
        tracks = read_choregraphe(text).tracks
        joints = {name: JointKeys(o.times, o.keys, o.handles) for name, o in tracks.items()}
        str(why_not_animation("motion", OwnAnimation("A motion", joints))).encode()

    def device(data: bytes) -> None:
        sent = (data, data[:12], struct.pack("<3h", *data[:3].ljust(3)))
        for one in (*known, *read_profile(path).characteristics):
            decoder, stream = Decoder(one), SampleStream()
            for number, message in enumerate(sent):
                stream.samples(decoder.readings(message) or [], 1000.0 + number)

    def feed(data: bytes) -> None:
        path.write_bytes(data)
        text, refused = data.decode(errors="replace"), None
        with contextlib.suppress(ValueError):  # it is no sound
            assert length_s(path) >= 0.0
        newest = newest_in(data)
        assert newest is None or newest.is_newer in (True, False)
        read_text(text, Voice(), with_instructions=True)
        assert speaking_time_s(text) >= 0.0
        for read in (partial(motion, text), partial(device, data)):
            try:
                read()
            except FaultError as error:
                refused = error
        if refused is not None:
            raise refused

    yield feed


def _brought_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    if b"[[characteristics]]" in data:
        return toml_changed(data, chance, seeds)
    if data.startswith(b"{"):
        return json_changed(data, chance, seeds)
    is_text = data.isascii() and b"\0" not in data
    return (lines_changed if is_text else flipped)(data, chance, seeds)


TARGETS = {
    one.name: one
    for one in (
        Target("mcap", mcap, mcap_changed, heavy=("many_in_chunk.mcap",)),
        Target("manifests", manifests, toml_changed),
        Target("settings", settings, lines_changed),
        Target("translations", translations, toml_changed),
        Target("brought", brought, _brought_changed),
    )
}

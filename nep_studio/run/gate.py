"""The one gate that all passes which a project starts: its program, and each of its nodes.

``LocalNetwork.start`` and ``Session`` ask it, whoever called them, and it is closed: what nobody
has looked at does not start. So a new way to start something cannot forget it.
"""

from __future__ import annotations

import ast
import ipaddress
import os
import re
import threading
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path

from faults import Text, Words, text_of
from faults.files import content, opened
from nep_core.errors import NepError
from nep_core.places import node_folders
from nep_core.processes.manifest import Manifest, NodeCatalog
from nep_studio import paths
from nep_studio.blocks.code_text import parse_lines, plainly_and_short, plainly_in_a_line
from nep_studio.blocks.deployment import NODE_BLOCK, node_entries, robot_entries
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.files import load
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ROBOT_BLOCK, Block, Project, Stack
from nep_studio.project.trust import (
    Approvals,
    Brought,
    Concern,
    key_of,
    python_concerns,
    python_texts,
    shared_approvals,
)

from .plan import PlannedNode, Setting, check_for_pages, listed_node, robot_node


class NotApproved(NepError, title="Nobody has approved this yet"):
    """Something that is not blocks was to run, and no person has said yes; see ``concerns``."""

    def __init__(self, concerns: Sequence[Concern]) -> None:
        told = ", ".join(dict.fromkeys(str(concern.title) for concern in concerns))
        super().__init__(
            "This project brings what is not blocks: {told}.",
            checklist=(
                "Look at it, and decide whether you trust who made it.",
                "Press Run, or start it with --trust.",
            ),
            told=told or Text("a program that nobody has looked at"),
        )
        self.concerns = tuple(concerns)


# What nodes can reach.


def node_concern(planned: PlannedNode, page: str = "nodes") -> Concern | None:
    """What there is to know of a node before it starts; None where it stays among ourselves.

    A node of somebody's own is asked about with all its settings and with the bytes of its files;
    one that we ship with those settings that reach files or other computers.
    """
    try:
        manifest = NodeCatalog(node_folders()).find(planned.node)
    except NepError:
        return None  # it cannot start: the checks say so
    is_own = not _is_shipped(manifest)
    reaching = {
        name: value
        for name, value in planned.parameters.items()
        if is_own or _reaches(planned, manifest, name, value)
    }
    if not reaching and not is_own:
        return None
    inside = {
        name: _digest(Path(str(reaching[name]))) for name in _files(planned, manifest, reaching)
    }
    content = [
        key_of(name, type(value).__name__, inside.get(name, str(value)))
        for name, value in sorted(reaching.items())
    ]
    own = _own_parts(manifest) if is_own else ()
    lines = [*own_lines(manifest)] if is_own else []
    lines += [plainly_in_a_line(f"{name} = {value}") for name, value in reaching.items()]
    is_robot = "driver" in planned.parameters
    title = text_of("The node {name}", name=planned.name)
    if is_robot:
        title = text_of("The robot {name}", name=planned.name)
    return Concern(
        "robot" if is_robot else "node",
        title,
        "\n".join([planned.node, *lines]),
        page,
        planned.block_id,
        key_of("node", planned.node, *own, *content),
        tuple(_notes(reaching, manifest, is_own=is_own)),
        frozenset({*reaching, *(["node"] if is_own else ())}),
        (*inside.items(), *([("node", key_of(*own))] if is_own else ())),
    )


def own_lines(manifest: Manifest) -> Iterator[str]:
    """How a node is started that we do not ship: its command, or its file."""
    yield " ".join(manifest.command) if manifest.command else manifest.module


def _is_shipped(manifest: Manifest) -> bool:
    """Whether it lies in the folder of our own nodes, which is the last of all."""
    return Path(manifest.path).parent.parent == node_folders()[-1]


def _reaches(planned: PlannedNode, manifest: Manifest, name: str, value: Setting) -> bool:
    """Whether a setting of one of our nodes lets it reach something."""
    parameter = manifest.parameters.get(name)
    if parameter is None or value in ("", None) or value == parameter.default:
        return False
    if parameter.type == "file" or parameter.reach == "file":
        is_ours = parameter.type != "file" and str(value) in _shipped_robots()
        return not _is_kept(planned, value) and not is_ours
    if parameter.reach != "network":
        return False
    if name == "address":
        is_virtual = planned.parameters.get("driver", "naoqi") != "naoqi"
        return not is_virtual and not is_here(str(value))
    return True


def _is_kept(planned: PlannedNode, value: Setting) -> bool:
    """Whether it is what we write ourselves of what the project keeps: data that is checked."""
    return planned.files is not None and Path(str(value)).is_relative_to(planned.files.folder)


@lru_cache(maxsize=1)
def _shipped_robots() -> frozenset[str]:
    """The names of the robots that we ship: any other name may be that of somebody's folder."""
    folder = paths.resources() / "robots"
    return frozenset(path.parent.name for path in folder.glob("*/body.json"))


def is_here(address: str) -> bool:
    """Whether an address, perhaps with a port, is this computer's own."""
    host = address.strip().removeprefix("tcp://")
    found = _WITH_PORT.fullmatch(host)
    host = (found["inside"] or found["host"]) if found is not None else host
    if host.casefold() in ("", "localhost"):
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


_WITH_PORT = re.compile(r"(?:\[(?P<inside>[^]]*)\]|(?P<host>[^:]*))(?::[0-9]+)?")


def _notes(reaching: Mapping[str, Setting], manifest: Manifest, *, is_own: bool) -> Iterator[Words]:
    if is_own:
        yield Text("a node that does not come with NEP Studio")
    kinds = {name: manifest.parameters[name] for name in reaching if name in manifest.parameters}
    if any(one.type == "file" or one.reach == "file" for one in kinds.values()):
        yield Text("reads a file")
    if any(one.reach == "network" for one in kinds.values()):
        yield Text("uses the network")


def _own_parts(manifest: Manifest) -> tuple[str, ...]:
    """The bytes of a node that we do not ship: its description, its files, what they import."""
    folder = Path(manifest.path).parent
    files = [Path(manifest.path), Path(manifest.module)]
    files += [Path(part.replace("{folder}", str(folder))) for part in manifest.command]
    return tuple(_digest(file) for file in (*files, *_imported(files)))


def _imported(files: Iterable[Path]) -> list[Path]:
    """The Python files and packages beside these files that they import, and those import."""
    found = dict.fromkeys(files)
    waiting = [file for file in found if file.suffix == ".py"]
    while waiting:
        file = waiting.pop()
        with suppress(OSError, BlocksError):  # it cannot be read: nor can it run
            for name in _names_imported(file, _stamp(file.stat())):
                beside = (file.with_name(f"{name}.py"), file.with_name(name))
                new = [one for one in beside if one not in found and one.exists()]
                found |= dict.fromkeys(new)
                waiting += [one for one in new if one.is_file()]
    return sorted(found.keys() - set(files))


@lru_cache(maxsize=256)
def _names_imported(file: Path, _stamp: Stamp) -> frozenset[str]:
    tree = parse_lines(content(file, MOST_PYTHON_BYTES).decode("utf-8", "replace"))
    names = [
        name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import | ast.ImportFrom)
        for name in (
            *(alias.name for alias in node.names),  # also of “from . import helper”
            *([node.module] if isinstance(node, ast.ImportFrom) and node.module else ()),
        )
    ]
    return frozenset(name.partition(".")[0] for name in names)


def _files(planned: PlannedNode, manifest: Manifest, names: Iterable[str]) -> Iterator[str]:
    """The settings that name a file beside the project: it counts by its bytes, wherever it is."""
    for name in names:
        parameter = manifest.parameters.get(name)
        is_file = parameter is not None and "file" in (parameter.type, parameter.reach)
        if is_file and isinstance(planned.parameters[name], str) and name in planned.inside:
            yield name


MOST_FILES = 2000
"""A folder with more of them counts by its name."""
PIECE_BYTES = 1 << 20
MOST_READ_BYTES = 200_000_000
"""A larger file, which would hold the window up, counts as the one that it is on this disk."""
MOST_PYTHON_BYTES = 10_000_000
Stamp = tuple[int, int, int, int]


def _digest(path: Path) -> str:
    """The bytes of a file, or of all files of a folder; "" where there is none."""
    import hashlib  # slow to load

    folder = path if path.is_dir() else path.parent
    files = sorted(path.rglob("*"))[:MOST_FILES] if path.is_dir() else [path]
    digest = hashlib.sha256()
    for file in files:
        try:
            found = file.stat()
            if file.is_file():
                name = file.relative_to(folder).as_posix()
                digest.update(f"{name}:{found.st_size}:".encode("utf-8", "surrogateescape"))
                stamp = _stamp(found)
                is_large = found.st_size > MOST_READ_BYTES
                digest.update(repr(stamp).encode() if is_large else _bytes_of(file, stamp))
        except OSError:
            digest.update(b"?")
    return digest.hexdigest()


def _stamp(found: os.stat_result) -> Stamp:
    """Who swaps a file can give it the old one's size and time, but not all of this."""
    return found.st_mtime_ns, found.st_ctime_ns, found.st_ino, found.st_size


@lru_cache(maxsize=4096)
def _bytes_of(path: Path, _stamp: Stamp) -> bytes:
    import hashlib  # slow to load

    digest = hashlib.sha256()
    with opened(path) as file:
        while piece := file.read(PIECE_BYTES):
            digest.update(piece)
    return digest.digest()


# All that a project brings.


def concerns_of(project: Project, language: Language, folder: Path) -> list[Concern]:
    """What a person is asked about: Python first, then robots and nodes as on their pages.

    ``folder`` is the project's. Nothing runs, and only files inside the folder are looked at.
    """
    found = list(python_concerns(project, language))
    for robot in robot_entries(project, language):
        planned = robot_node(robot, language.profile.node)
        found += [concern] if (concern := node_concern(planned, "robots")) is not None else []
    for node in node_entries(project, language):
        planned = listed_node(node, folder)
        found += [concern] if (concern := node_concern(planned)) is not None else []
    return found


def brought_by(
    block: Block, project: Project, language: Language, folder: Path
) -> list[Concern | Brought]:
    """What is not blocks in one block."""
    texts = [Brought(key, text) for text, key in python_texts(block, language)]
    if block.type not in (NODE_BLOCK, ROBOT_BLOCK):
        return [*texts]
    found = concerns_of(_only(block), language, folder)
    return [*texts, *(concern for concern in found if concern.kind != "python")]


def _only(block: Block) -> Project:
    """A project with one block of the pages Robots and Nodes, as if it were switched on."""
    project = Project()
    page = "nodes" if block.type == NODE_BLOCK else "robots"
    copy = block.copy()
    copy.disabled, copy.inputs, copy.bodies = False, {}, {}
    project.blocks[block.id] = copy
    stack = Stack("s0", 0, 0, [block.id])
    project.pages[page].append(stack)
    project.stacks[stack.id] = stack
    return project


class Gate:
    """Lets through what a person has approved, what is their own, and what we ship; any thread."""

    def __init__(self, approvals: Approvals | None = None) -> None:
        self.approvals = approvals or shared_approvals()
        self._lock = threading.Lock()
        self._vouched: set[str] = set()
        self._programs: set[str] = set()

    def unapproved(self, concerns: Iterable[Concern]) -> list[Concern]:
        """Those that a person must be asked about, each content once."""
        left = {one.key: one for one in concerns if not self._is_known(one.key)}
        if left:
            shipped = shipped_keys()
            left = {key: one for key, one in left.items() if key not in shipped}
        return list(left.values())

    def vouch(self, keys: Iterable[str]) -> None:
        """Let this content through until the program ends: a person has just asked for it."""
        with self._lock:
            self._vouched |= set(keys)

    def vouch_for(self, *nodes: PlannedNode) -> None:
        """Let these nodes through, with their settings: a person has just made them so."""
        self.vouch(one.key for one in map(node_concern, nodes) if one is not None)

    def approve(self, concerns: Iterable[Concern]) -> None:
        """A person has looked at it all, and said yes: for good, by its content."""
        self.approvals.add(one.key for one in concerns)

    def admit(self, program: str) -> None:
        """Let the Python through that was made of a project of which all is approved."""
        with self._lock:
            self._programs.add(key_of("program", program))

    def check_program(self, file: Path) -> None:
        """Raise NotApproved for a program that was not admitted."""
        text = file.read_bytes().decode("utf-8", "replace")
        with self._lock:
            if key_of("program", text) in self._programs:
                return
        raise NotApproved(())

    def check_node(self, planned: PlannedNode) -> None:
        """Raise NotApproved for a node of which not all is approved; NotForPages."""
        check_for_pages(planned.node, planned.name)
        if (concern := node_concern(planned)) is not None and (left := self.unapproved([concern])):
            raise NotApproved(left)

    def _is_known(self, key: str) -> bool:
        with self._lock:
            if key in self._vouched:
                return True
        return self.approvals.has(key)


@lru_cache(maxsize=1)
def shipped_keys() -> frozenset[str]:
    """The content of our examples, which is ours wherever it has been copied to."""
    from .installation import studio_language

    language, keys = studio_language(), set[str]()
    for path in sorted(paths.examples().glob("*.nep")):
        try:
            project = load(path, language)
        except BlocksError:
            continue
        keys |= {one.key for one in concerns_of(project, language, path.parent)}
    return frozenset(keys)


def listing(concerns: Iterable[Concern]) -> Iterator[str]:
    """What a project brings, for a terminal: all of it, line by line."""
    for concern in concerns:
        notes = "".join(f", {note}" for note in concern.notes)
        title = plainly_in_a_line(str(concern.title))
        yield f"{title} (page {concern.page.capitalize()}{notes}):"
        yield from (f"    {line}" for line in plainly_and_short(concern.text).split("\n"))

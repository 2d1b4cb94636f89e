"""What a project brings that is not blocks, and what of that a person has approved here.

Nothing marks a project as somebody else's: what a person typed in this window, what they said yes
to, and what we ship is known by its content, in ``approved.json`` of the user's folder. All else
is asked about before it runs, wherever it came from: a download, a stick, a picture, a paste.
"""

from __future__ import annotations

import errno
import logging
import os
import sys
import threading
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Literal, NamedTuple

import msgspec

from faults import Text, Words, text_of
from faults.files import content, whole_file
from nep_core.places import own_folder, private_folder
from nep_core.wire.frames import CANNOT_DECODE
from nep_studio.blocks.code_text import python_slots
from nep_studio.blocks.deployment import NODE_BLOCK
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import Edit
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import ROBOT_BLOCK, Block, Project
from nep_studio.support.portable import SETTINGS_VARIABLE

log = logging.getLogger(__name__)

ConcernKind = Literal["python", "node", "robot"]


@dataclass(frozen=True)
class Concern:
    """Something of a project that is not blocks: what it is, all of it, and where it stands.

    ``key`` tells it from all others by its content alone; ``notes`` say what a look at the page
    would not show: that it is inside folded blocks, or switched off. ``settings`` are the names of
    the settings that it is about, ``files`` what tells the bytes behind some of them from others.
    """

    kind: ConcernKind
    title: Words
    text: str
    page: str
    block: str
    key: str
    notes: tuple[Words, ...] = ()
    settings: frozenset[str] = frozenset()
    files: tuple[tuple[str, str], ...] = ()


class Brought(NamedTuple):
    """Python in a block, as a concern for who follows the edits; it has no settings."""

    key: str
    text: str
    settings: frozenset[str] = frozenset()
    files: tuple[tuple[str, str], ...] = ()


def key_of(*parts: str) -> str:
    """What tells this content from all other; parts cannot run into each other."""
    import hashlib  # it loads all of OpenSSL, which a start needs for nothing

    digest = hashlib.sha256()
    for part in parts:
        data = part.encode("utf-8", "surrogatepass")
        digest.update(f"{len(data)}:".encode() + data)
    return digest.hexdigest()


# Python that stands in fields.

FOLDED = Text("inside folded blocks")
OFF = Text("switched off")
IN_NO_RULE = Text("in no rule: it does not run as it is")
LONG_LINE = 400
"""A line of more letters is told with how long it is, as many lines are."""


def python_texts(block: Block, language: Language) -> Iterator[tuple[str, str]]:
    """The Python in a block: each text, and its key; a new block's own is nothing to ask about."""
    definition = language.definitions.get(block.type)
    if definition is None or not definition.holds_python:
        return
    for slot in python_slots(definition, block.groups):
        text = str(definition.value(block, slot))
        if text.strip() and text != definition.defaults.get(slot):
            yield text, key_of("python", text.strip())  # as files are read


def python_concerns(project: Project, language: Language) -> Iterator[Concern]:
    """All Python of a project, page by page; also what is folded, switched off, or in no rule."""
    definitions = language.of(project).definitions
    for page, stacks in project.pages.items():
        for stack in stacks:
            first = definitions.get(project.blocks[stack.body[0]].type)
            about = () if first is not None and first.shape == "hat" else (IN_NO_RULE,)
            for block, notes in _noted(project, stack.body, about):
                for text, key in python_texts(block, language):
                    title = text_of("Python, {count} lines", count=text.count("\n") + 1)
                    if "\n" not in text:
                        title = Text("Python, one line")
                        if len(text) > LONG_LINE:  # what is at its end is far below
                            count = len(text)
                            title = text_of("Python, one line of {count} letters", count=count)
                    yield Concern("python", title, text, page, block.id, key, notes)


def _noted(
    project: Project, chain: list[str], about: tuple[Words, ...]
) -> Iterator[tuple[Block, tuple[Words, ...]]]:
    """The blocks of a chain and all inside them, each with what does not show of it."""
    waiting = [(block_id, about) for block_id in reversed(chain)]
    while waiting:
        block_id, notes = waiting.pop()
        block = project.blocks[block_id]
        if block.disabled and OFF not in notes:
            notes = (*notes, OFF)
        yield block, notes
        if block.collapsed and FOLDED not in notes:
            notes = (*notes, FOLDED)
        waiting += [(child, notes) for child in reversed(list(block.children()))]


# What was approved on this computer.

MOST_KEPT = 50_000
_FILE = "approved.json"


def approvals_file() -> Path:
    """Where it is kept what was approved: for this user alone, as all of their settings."""
    named = os.environ.get(SETTINGS_VARIABLE)
    return (Path(named) if named else own_folder("config", "settings")) / _FILE


class Approvals:
    """The keys of all that was approved; any thread. Other windows' approvals count too."""

    def __init__(self, path: Path | None = None) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._keys: dict[str, None] = {}
        self._unsaved: dict[str, None] = {}
        self._stamp: object = None

    @property
    def path(self) -> Path:
        """The file; a variable may name another one later on."""
        return self._path or approvals_file()

    def has(self, key: str) -> bool:
        """Whether this content was approved."""
        with self._lock:
            self._read()
            return key in self._keys or key in self._unsaved

    def add(self, keys: Iterable[str]) -> None:
        """Approve this content from now on; where nothing can be written, until the end."""
        with self._lock:
            self._read()
            new = [key for key in keys if key not in self._keys]
            if not new:
                return
            self._unsaved |= dict.fromkeys(new)
            kept = [*self._keys, *(key for key in self._unsaved if key not in self._keys)]
            try:
                private_folder(self.path.parent)
                with whole_file(self.path, is_private=True) as file:
                    file.write(msgspec.json.encode(kept[-MOST_KEPT:]))
            except OSError as error:
                log.warning("What was approved cannot be kept: %s", error)
                return
            self._unsaved.clear()
            self._keys = dict.fromkeys(kept)

    def _read(self) -> None:
        try:
            found = self.path.stat()
            if sys.platform != "win32" and found.st_uid != os.getuid():
                raise PermissionError(errno.EPERM, "somebody else has written it")
            stamp = (found.st_mtime_ns, found.st_size, str(self.path))
            if stamp == self._stamp:
                return
            self._keys = dict.fromkeys(msgspec.json.decode(content(self.path), type=list[str]))
            self._stamp = stamp
        except (OSError, *CANNOT_DECODE):
            self._keys, self._stamp = {}, None


@lru_cache(maxsize=1)
def shared_approvals() -> Approvals:
    """Those of this program: what cannot be written down holds in all of it, until its end."""
    return Approvals()


# Who wrote what: a person's own fields are approved as they are typed.

BroughtBy = Callable[[Block], Sequence[Concern | Brought]]
"""What is not blocks in a block."""
_SETTINGS = "parameters"


def settings_of(block: Block) -> dict[str, object]:
    """The settings of a robot or a node by their names; those that were never set are not there."""
    inside = block.fields.get(_SETTINGS)
    return {**block.fields, **(inside if isinstance(inside, dict) else {})}


SHORTEST_PIECE = 9
"""A line of fewer letters is in anybody's Python."""


def _squashed(text: str) -> list[str]:
    """The lines of Python without gaps, which a window may change as it shows them."""
    lines = ("".join(line.split()) for line in text.splitlines())
    return [line for line in lines if len(line) >= SHORTEST_PIECE]


@dataclass(slots=True)
class _Strange:
    """What came in with a block: the keys of all that it held, and the lines of its Python."""

    keys: set[str] = field(default_factory=set)
    lines: set[str] = field(default_factory=set)
    has_python: bool = False


class Authorship:
    """Follows the edits of one project: which blocks the person made what they are.

    Python that is typed is the person's own, unless its block held some that nobody has approved,
    or it has lines of such: a letter more does not make that theirs, nor another place. Of robots
    and nodes a person chooses each setting, and with it the file that it names as that is then:
    theirs is what has no other setting that reaches anything. Blocks that come in whole, by a
    paste, a drop, an import, or by undoing one, are what their content is; those made in
    ``editor.history.as_own()`` are the person's, unless they hold what came in that way, or Python
    in a project with some that nobody has approved: it may be cut from that.

    ``shipped`` gives the keys of what comes with us, which nobody needs to approve.
    """

    def __init__(
        self,
        editor: Editor,
        approvals: Approvals,
        brought_by: BroughtBy,
        shipped: Callable[[], Collection[str]] = frozenset,
    ) -> None:
        self._editor, self._approvals = editor, approvals
        self._brought_by, self._shipped = brought_by, shipped
        self._foreign: set[str] = set()
        """The blocks with what nobody has approved."""
        self._strange: dict[str, _Strange] = {}
        """What nobody has approved by the block that it came with, also where that is gone."""
        self._unlike: set[str] = set()
        """Lines that have been compared with all of these."""
        self._came: dict[str, dict[str, object]] = {}
        """The settings with which robots and nodes came in, but for those that were seen."""
        self._bytes: dict[tuple[str, str, object], str] = {}
        """What was behind a setting of a block when it was chosen or approved."""
        self._own: set[str] = set()
        self._typed: set[str] = set()
        """The keys of all that was typed, so that undoing brings nothing strange."""
        for block in editor.project.blocks.values():
            found = self._brought_by(block)
            if block.type in (ROBOT_BLOCK, NODE_BLOCK):
                self._came[block.id] = settings_of(block)
            if not self._is_known(found):
                self._keep_out(block, found)
            else:
                self._note_seen(block, found)
        editor.history.record(self._on_edits)

    def keep(self) -> None:
        """Approve what is the person's own, as they have typed it."""
        blocks = self._editor.project.blocks
        self._own &= blocks.keys()
        found = [one.key for block in self._own for one in self._brought_by(blocks[block])]
        self._approvals.add(key for key in found if key in self._typed)

    def look_again(self) -> None:
        """Something was approved: who changes that from now on changes what they know."""
        blocks = self._editor.project.blocks
        for block_id in self._foreign & blocks.keys():
            found = self._brought_by(blocks[block_id])
            if self._is_known(found):
                self._foreign.discard(block_id)
                self._strange.pop(block_id, None)
                self._note_seen(blocks[block_id], found)

    def close(self) -> None:
        """Follow no more."""
        self.keep()
        self._editor.history.unrecord(self._on_edits)

    def _is_known(self, found: Iterable[Concern | Brought]) -> bool:
        unknown = [one.key for one in found if not self._approvals.has(one.key)]
        return not unknown or set(unknown).issubset(self._shipped())

    def _keep_out(self, block: Block, found: Iterable[Concern | Brought]) -> None:
        self._foreign.add(block.id)
        self._own.discard(block.id)
        strange = self._strange.setdefault(block.id, _Strange())
        for one in found:
            strange.keys.add(one.key)
            if isinstance(one, Brought):
                strange.has_python = True
                strange.lines.update(_squashed(one.text))
                self._unlike.clear()

    def _let_in(self, block: Block, found: Iterable[Concern | Brought]) -> None:
        self._foreign.discard(block.id)
        self._own.add(block.id)
        self._typed.update(one.key for one in found)

    def _on_edits(self, edits: tuple[Edit, ...]) -> None:
        is_own = self._editor.history.is_own
        for edit in edits:
            match edit:
                case SetField(block=block_id):
                    self._on_changed(block_id, is_typed=True, is_own=is_own)
                case CreateBlocks(blocks=blocks):
                    for block in blocks:
                        if is_own:
                            self._came.setdefault(block.id, {})
                        self._on_changed(block.id, is_typed=is_own, is_own=is_own)
                case _:
                    self._on_changed(getattr(edit, "block", ""), is_typed=is_own, is_own=is_own)

    def _on_changed(self, block_id: str, *, is_typed: bool, is_own: bool) -> None:
        block = self._editor.project.blocks.get(block_id)
        if block is None:
            return
        found = self._brought_by(block)
        is_setting = block.type in (ROBOT_BLOCK, NODE_BLOCK)
        came = self._came.setdefault(block_id, settings_of(block)) if is_setting else {}
        if not found:
            if not is_setting:  # nothing of it is left
                self._foreign.discard(block_id)
            return
        if is_setting:
            is_theirs = is_typed and self._is_chosen(block, found, came)
        else:
            is_theirs = is_typed and block_id not in self._foreign and not self._is_strange(found)
            is_theirs &= not (is_own and self._has_strangers())
        if is_theirs or self._typed.issuperset(one.key for one in found):
            self._let_in(block, found)
        elif not self._is_known(found):
            self._keep_out(block, found)

    def _has_strangers(self) -> bool:
        """Whether there is, or was, Python that nobody has approved."""
        return any(one.has_python for one in self._strange.values())

    def _is_strange(self, found: Iterable[Concern | Brought]) -> bool:
        """Whether Python came in as it is, or lines of it did, or a part of such a line."""
        if any(one.key in strange.keys for one in found for strange in self._strange.values()):
            return True
        theirs = {line for strange in self._strange.values() for line in strange.lines}
        lines = {line for one in found if isinstance(one, Brought) for line in _squashed(one.text)}
        for line in lines - self._unlike if theirs else ():
            if any(line in other or other in line for other in theirs):
                return True
            self._unlike.add(line)
        return False

    def _is_chosen(
        self, block: Block, found: Iterable[Concern | Brought], came: Mapping[str, object]
    ) -> bool:
        """Whether all that a robot or a node reaches was chosen here, or seen.

        A file counts as it was then: who changes something else has not seen it.
        """
        now = settings_of(block)
        is_chosen = True
        for one in found:
            files = dict(one.files)
            for name in one.settings:
                digest = files.get(name, "")
                known = self._bytes.setdefault((block.id, name, now.get(name)), digest)
                is_same = name in came and came[name] == now.get(name)
                is_chosen &= known == digest and not is_same
        return is_chosen

    def _note_seen(self, block: Block, found: Iterable[Concern | Brought]) -> None:
        """A person knows what a block reaches as it is now; its other settings nobody has shown."""
        now = settings_of(block)
        for one in found:
            files = dict(one.files)
            for name in one.settings:
                self._came.get(block.id, {}).pop(name, None)
                self._bytes[block.id, name, now.get(name)] = files.get(name, "")

"""What a project brings that is not blocks, and what of that a person has approved here.

Nothing marks a project as somebody else's: what a person typed in this window, what they said yes
to, and what we ship is known by its content, in ``approved.json`` of the user's folder. All else
is asked about before it runs, wherever it came from: a download, a stick, a picture, a paste.
"""

from __future__ import annotations

import errno
import hashlib
import logging
import os
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Literal

import msgspec

from faults import Text, Words, text_of
from faults.files import content, whole_file
from nep_core.places import own_folder, private_folder
from nep_core.wire.frames import CANNOT_DECODE
from nep_studio.blocks.code_text import python_slots
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits import Edit
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import CreateBlocks
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Block, Project
from nep_studio.support.portable import SETTINGS_VARIABLE

log = logging.getLogger(__name__)

ConcernKind = Literal["python", "node", "robot"]


@dataclass(frozen=True)
class Concern:
    """Something of a project that is not blocks: what it is, all of it, and where it stands.

    ``key`` tells it from all others by its content alone; ``notes`` say what a look at the page
    would not show: that it is inside folded blocks, or switched off.
    """

    kind: ConcernKind
    title: Words
    text: str
    page: str
    block: str
    key: str
    notes: tuple[Words, ...] = ()


def key_of(*parts: str) -> str:
    """What tells this content from all other; parts cannot run into each other."""
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

KeysOf = Callable[[Block], Iterable[str]]
"""The keys of what is not blocks in a block."""


class Authorship:
    """Follows the edits of one project: which blocks the person made what they are.

    A field that is set is typed: its block is the person's own, unless it held something that
    nobody has approved, for a letter more does not make that theirs. Blocks that come in whole,
    by a paste, a drop, an import, or by undoing one, are what their content is; those made in
    ``editor.history.as_own()`` are the person's, unless they hold what came in that way.
    """

    def __init__(self, editor: Editor, approvals: Approvals, keys_of: KeysOf) -> None:
        self._editor, self._approvals, self._keys_of = editor, approvals, keys_of
        blocks = editor.project.blocks.values()
        self._foreign = {block.id for block in blocks if not self._is_known(keys_of(block))}
        self._strange = {
            key for block in blocks if block.id in self._foreign for key in keys_of(block)
        }
        """The keys of all that came in: moved into another block, it is still a stranger's."""
        self._own: set[str] = set()
        self._typed: set[str] = set()
        """The keys of all that was typed, so that undoing brings nothing strange."""
        editor.history.record(self._on_edits)

    def keep(self) -> None:
        """Approve what is the person's own, as it is now."""
        blocks = self._editor.project.blocks
        self._own &= blocks.keys()
        self._approvals.add([key for one in self._own for key in self._keys_of(blocks[one])])

    def look_again(self) -> None:
        """Something was approved: who changes that from now on changes what they know."""
        blocks = self._editor.project.blocks
        self._foreign &= blocks.keys()
        known = {one for one in self._foreign if self._is_known(self._keys_of(blocks[one]))}
        self._foreign -= known

    def close(self) -> None:
        """Follow no more."""
        self.keep()
        self._editor.history.unrecord(self._on_edits)

    def _is_known(self, keys: Iterable[str]) -> bool:
        return all(self._approvals.has(key) for key in keys)

    def _on_edits(self, edits: tuple[Edit, ...]) -> None:
        is_own = self._editor.history.is_own
        for edit in edits:
            match edit:
                case SetField(block=block_id):
                    self._on_typed(block_id)
                case CreateBlocks(blocks=blocks):
                    for block in blocks:
                        self._on_made(block.id, is_own=is_own)
                case _:
                    self._on_made(getattr(edit, "block", ""), is_own=is_own)

    def _on_typed(self, block_id: str) -> None:
        block = self._editor.project.blocks.get(block_id)
        if block is None:
            return
        keys = list(self._keys_of(block))
        if block_id in self._foreign and not (self._typed.issuperset(keys) or self._is_known(keys)):
            self._strange.update(keys)
            return
        self._foreign.discard(block_id)
        self._own.add(block_id)
        self._typed.update(keys)

    def _on_made(self, block_id: str, *, is_own: bool) -> None:
        block = self._editor.project.blocks.get(block_id)
        keys = list(self._keys_of(block)) if block is not None else []
        if not keys:
            return
        is_strange = not self._strange.isdisjoint(keys) and not self._is_known(keys)
        if (is_own and not is_strange) or self._typed.issuperset(keys):
            self._foreign.discard(block_id)
            self._own.add(block_id)
            self._typed.update(keys)
        elif not self._is_known(keys):
            self._foreign.add(block_id)
            self._strange.update(keys)
            self._own.discard(block_id)

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
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
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
    """A concern as who follows edits needs it, where it stands in Python."""

    key: str
    settings: frozenset[str] = frozenset()
    files: tuple[tuple[str, str], ...] = ()


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

BroughtBy = Callable[[Block], Sequence[Concern | Brought]]
"""What is not blocks in a block."""
_SETTINGS = "parameters"


def settings_of(block: Block) -> dict[str, object]:
    """The settings of a robot or a node by their names; those that were never set are not there."""
    inside = block.fields.get(_SETTINGS)
    return {**block.fields, **(inside if isinstance(inside, dict) else {})}


class Authorship:
    """Follows the edits of one project: which blocks the person made what they are.

    Python that is typed is the person's own, unless its block held some that nobody has approved:
    a letter more does not make that theirs. Of robots and nodes a person chooses each setting, and
    with it the file that it names as that is then: theirs is what has no other setting that reaches
    anything. Blocks that come in whole, by a paste, a drop, an import, or by undoing one, are what
    their content is; those made in ``editor.history.as_own()`` are the person's, unless they hold
    what came in that way, or Python in a project with some that nobody has approved: it may be cut
    from that.

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
        """The blocks with what nobody has approved, also those that are gone."""
        self._strange: set[str] = set()
        """The keys of all that came in: moved into another block, it is still a stranger's."""
        self._came: dict[str, dict[str, object]] = {}
        """The settings with which robots and nodes came in."""
        self._bytes: dict[tuple[str, str, object], str] = {}
        """What was behind a setting of a block when it was chosen or approved."""
        self._own: set[str] = set()
        self._typed: set[str] = set()
        """The keys of all that was typed, so that undoing brings nothing strange."""
        self._has_strangers = False
        """Whether there is, or was, Python that nobody has approved."""
        for block in editor.project.blocks.values():
            self._come_in(block)
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
        self._foreign &= blocks.keys()
        for block_id in list(self._foreign):
            found = self._brought_by(blocks[block_id])
            if self._is_known(found):
                self._foreign.discard(block_id)
                self._is_chosen(blocks[block_id], found, anew=True)
        self._has_strangers = any(map(self._holds_python, map(blocks.__getitem__, self._foreign)))

    def close(self) -> None:
        """Follow no more."""
        self.keep()
        self._editor.history.unrecord(self._on_edits)

    def _is_known(self, found: Iterable[Concern | Brought]) -> bool:
        unknown = [one.key for one in found if not self._approvals.has(one.key)]
        return not unknown or set(unknown).issubset(self._shipped())

    def _holds_python(self, block: Block) -> bool:
        definition = self._editor.language.definitions.get(block.type)
        return definition is not None and definition.holds_python

    def _come_in(self, block: Block) -> None:
        """A block is there that somebody else may have made."""
        found = self._brought_by(block)
        if not self._is_known(found):
            self._keep_out(block, found)
        if block.type in (ROBOT_BLOCK, NODE_BLOCK):
            self._came[block.id] = settings_of(block)
            if found and block.id not in self._foreign:
                self._is_chosen(block, found, anew=True)

    def _keep_out(self, block: Block, found: Iterable[Concern | Brought]) -> None:
        self._foreign.add(block.id)
        self._own.discard(block.id)
        self._strange.update(one.key for one in found)
        self._has_strangers |= self._holds_python(block)

    def _let_in(self, block: Block, found: Iterable[Concern | Brought]) -> None:
        self._foreign.discard(block.id)
        self._own.add(block.id)
        self._typed.update(one.key for one in found)

    def _on_edits(self, edits: tuple[Edit, ...]) -> None:
        is_own = self._editor.history.is_own
        for edit in edits:
            match edit:
                case SetField(block=block_id):
                    self._on_typed(block_id, is_own=is_own)
                case CreateBlocks(blocks=blocks):
                    for block in blocks:
                        self._on_made(block.id, is_own=is_own, is_new=True)
                case _:
                    self._on_made(getattr(edit, "block", ""), is_own=is_own)

    def _on_typed(self, block_id: str, *, is_own: bool) -> None:
        block = self._editor.project.blocks.get(block_id)
        if block is None:
            return
        found = self._brought_by(block)
        is_setting = block.type in (ROBOT_BLOCK, NODE_BLOCK)
        if not found:
            if not is_setting:  # nothing of it is left
                self._foreign.discard(block_id)
            return
        if is_setting:
            is_theirs = self._is_chosen(block, found)
        else:
            is_strange = any(one.key in self._strange for one in found)
            is_mixed = is_own and self._has_strangers
            is_theirs = block_id not in self._foreign and not is_strange and not is_mixed
        self._take(block, found, is_theirs=is_theirs)

    def _on_made(self, block_id: str, *, is_own: bool, is_new: bool = False) -> None:
        block = self._editor.project.blocks.get(block_id)
        if block is None:
            return
        found = self._brought_by(block)
        is_setting = block.type in (ROBOT_BLOCK, NODE_BLOCK)
        is_typed = self._typed.issuperset(one.key for one in found)
        if is_setting and is_new:
            self._came[block_id] = {} if is_own or (found and is_typed) else settings_of(block)
        if found:
            is_strange = any(one.key in self._strange for one in found)
            is_mixed = self._has_strangers and not is_setting
            self._take(block, found, is_theirs=is_own and not is_strange and not is_mixed)

    def _take(self, block: Block, found: Sequence[Concern | Brought], *, is_theirs: bool) -> None:
        if is_theirs or self._typed.issuperset(one.key for one in found):
            self._let_in(block, found)
        elif not self._is_known(found):
            self._keep_out(block, found)

    def _is_chosen(
        self, block: Block, found: Iterable[Concern | Brought], *, anew: bool = False
    ) -> bool:
        """Whether all that a robot or a node reaches was chosen here, or is, ``anew``, from now on.

        A file counts as it was when it was chosen: who changes something else has not seen it.
        """
        now = settings_of(block)
        if anew:
            self._came[block.id] = {}
        came = self._came.get(block.id, {})
        is_chosen = True
        for one in found:
            is_chosen &= not any(n in came and came[n] == now.get(n) for n in one.settings)
            for name, digest in one.files:
                place = (block.id, name, now.get(name))
                known = digest if anew else self._bytes.get(place, digest)
                self._bytes[place] = known
                is_chosen &= known == digest
        return is_chosen

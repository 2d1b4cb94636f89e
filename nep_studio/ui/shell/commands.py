"""Where the commands of the palette come from: the same actions, panels and files as the menus."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QIcon, QKeySequence
from PySide6.QtWidgets import QMenu

from nep_studio.project.examples import examples
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.words import tr
from nep_studio.ui.workbench.pages_bar import page_title

from .menus import NEEDS_SELECTION

if TYPE_CHECKING:
    from .main_window import MainWindow


# A command of the palette as data: what it is called, what it does, why it cannot be used now.


@dataclass(frozen=True)
class Command:
    """Something that a person can do.

    ``id`` is the same each time and in every language; ``kind`` says in a word what it is ("Panel",
    "Example"), ``also`` are more words that it is found by. ``why_not`` is "" when it can be used.
    """

    id: str
    words: str
    do: Callable[[], object]
    kind: str = ""
    keys: str = ""
    icon: QIcon = field(default_factory=QIcon)
    also: str = ""
    why_not: str = ""
    is_on: bool | None = None


Source = Callable[[], Iterable[Command]]
"""Gives commands as they are at the moment; called each time that the palette opens."""


# Why an action cannot be used now, in a sentence that says what to do.

NOT_NOW = {
    "undo": "Nothing has been changed yet.",
    "redo": "Nothing has been taken back.",
    "paste": "Copy something first.",
    "compare": "The project is saved as it is now.",
    "stop": "Nothing runs now.",
    "pause": "Nothing runs now.",
    "step": "Pause the program first.",
    "run": "The program runs already.",
}


def why_not(window: MainWindow, action: QAction) -> str:
    """Why an action cannot be used now, "" when it can."""
    if action.isEnabled():
        return ""
    if window.files.document is None:
        return tr("Open a project first.")
    if action.objectName() in NEEDS_SELECTION:
        return tr("Select a block first.")
    reason = tr(NOT_NOW.get(action.objectName(), ""))
    return reason or tr("There is nothing to do for it now.")


NOT_IN_ITSELF = "palette"


def sources_of(window: MainWindow) -> list[Source]:
    """All that a window offers by itself."""
    kinds = (_actions, _pages, _panels, _examples, _recent, _choices)
    return [partial(kind, window) for kind in kinds]


def _actions(window: MainWindow) -> Iterator[Command]:
    menus = {action: menu for menu in window.menus.values() for action in menu.actions()}
    for name, action in window.actions_by_name.by_name.items():
        if name == NOT_IN_ITSELF or not action.isVisible():
            continue
        menu = menus.get(action)
        kind = _plain(menu.title()) if menu is not None else ""
        yield _command(f"action:{name}", action, kind, why_not(window, action))


def _command(command_id: str, action: QAction, kind: str, reason: str) -> Command:
    return Command(
        command_id,
        _plain(action.text()),
        action.trigger,
        kind,
        action.shortcut().toString(QKeySequence.SequenceFormat.NativeText),
        action.icon(),
        _plain(f"{action.iconText()} {action.toolTip()}"),
        reason,
        action.isChecked() if action.isCheckable() else None,
    )


def _panels(window: MainWindow) -> Iterator[Command]:
    for panel in window.workbench.panels.all:
        action = panel.action
        yield _command(f"panel:{panel.name}", action, tr("Panel"), why_not(window, action))


def _pages(window: MainWindow) -> Iterator[Command]:
    document, canvas = window.files.document, window.workbench.canvas
    if document is None:
        return
    for page in document.project.pages:
        yield Command(
            f"page:{page}",
            page_title(document.project, page),
            partial(canvas.show_page, page),
            tr("Page"),
            icon=icon("file", window.look.theme),
            is_on=True if page == canvas.page else None,
        )


def _examples(window: MainWindow) -> Iterator[Command]:
    for example in examples():
        yield Command(
            f"example:{example.path.stem}",
            tr(example.title),
            partial(window.files.open_example, example.path),
            tr("Example"),
            icon=icon("graduation-cap", window.look.theme),
            also=tr(example.sentence),
        )


def _recent(window: MainWindow) -> Iterator[Command]:
    for path in window.settings.recent_files:
        yield Command(
            f"recent:{path}",
            path.stem,
            partial(window.files.open, path),
            tr("Recent project"),
            icon=icon("history", window.look.theme),
            also=str(path),
            why_not="" if path.is_file() else tr("It is not there any more."),
        )


def _choices(window: MainWindow) -> Iterator[Command]:
    """The choices inside menus, such as the themes and the languages."""
    entries = (action for menu in window.menus.values() for action in menu.actions())
    for inner in (action.menu() for action in entries):
        if not isinstance(inner, QMenu):
            continue
        title = _plain(inner.title())
        for action in inner.actions():
            group = action.actionGroup()
            if group is not None and group.isExclusive():
                yield _command(f"choice:{title}:{action.data()}", action, title, "")


def _plain(words: str) -> str:
    """Words without the mark of the key that chooses them in a menu."""
    return words.replace("&&", "\0").replace("&", "").replace("\0", "&")


# Find what a person means by a few letters: fuzzy, whatever the case, the accents, the order.

WHOLE, START, INITIAL, INSIDE, SCATTERED = 100, 60, 40, 25, 10
"""What a typed word is worth: all of a word, its start, first letters of words, a part, letters."""

ALSO_WORTH = 0.5
"""What is found in the other words of a command counts half."""

LETTERS_PER_GAP = 4
"""Letters that lie further apart than a gap for so many are found by accident."""

EXACT = 20
"""What it is worth more when a command is called just what was typed."""


@dataclass(frozen=True)
class Match:
    """How well a text fits, and which of its letters were found."""

    score: float
    letters: tuple[int, ...] = ()


def match(typed: str, text: str, also: str = "") -> Match | None:
    """How well a text fits what was typed; None when a typed word is nowhere in it."""
    plain, places = _folded(text)
    other, _ = _folded(also)
    total, found = 0.0, set[int]()
    for word in _folded(typed)[0].split():
        here, there = _best(word, plain), _together(word, other)
        if here is None and there is None:
            return None
        if here is not None and (there is None or here.score >= there.score * ALSO_WORTH):
            total += here.score
            found.update(places[letter] for letter in here.letters)
        elif there is not None:
            total += there.score * ALSO_WORTH
    total += EXACT if plain == _folded(typed)[0].strip() else 0
    return Match(total - len(plain) / 1000, tuple(sorted(found)))


def _folded(text: str) -> tuple[str, list[int]]:
    """A text without case and accents, and where each of its letters was in the text."""
    letters, places = [], []
    for place, letter in enumerate(text):
        for plain in unicodedata.normalize("NFKD", letter).casefold():
            if not unicodedata.combining(plain):
                letters.append(plain)
                places.append(place)
    return "".join(letters), places


def _best(word: str, text: str) -> Match | None:
    return _together(word, text) or _initials(word, text) or _scattered(word, text)


def _together(word: str, text: str) -> Match | None:
    """The word as it is: at the start of a word if it can be."""
    inside = start = text.find(word)
    while start > 0 and text[start - 1].isalnum():
        start = text.find(word, start + 1)
    at = start if start >= 0 else inside
    end = at + len(word)
    if start >= 0:
        is_whole = end == len(text) or not text[end].isalnum()
        score = (WHOLE if is_whole else START) + (5 if at == 0 else 0)
        return Match(score, tuple(range(at, end)))
    return Match(INSIDE, tuple(range(at, end))) if at >= 0 else None


def _initials(word: str, text: str) -> Match | None:
    """First letters of words, in order: "sp" for "save the Python"."""
    starts = [i for i, c in enumerate(text) if c.isalnum() and (i == 0 or text[i - 1] == " ")]
    found = _in_order(word, text, starts)
    return Match(INITIAL, found) if found and len(word) > 1 else None


def _scattered(word: str, text: str) -> Match | None:
    """The letters in order, most of them beside each other: a letter was left out or is wrong."""
    for start, letter in enumerate(text):
        if letter != word[0] or (start and text[start - 1].isalnum()):
            continue
        found = _in_order(word, text, range(start, len(text)))
        if found and _gaps(found) <= len(word) // LETTERS_PER_GAP:
            return Match(SCATTERED - _gaps(found), found)
    return None


def _in_order(word: str, text: str, places: Sequence[int]) -> tuple[int, ...]:
    """Where the letters of a word are, one after the other, among some places; else ()."""
    found: list[int] = []
    for place in places:
        if len(found) < len(word) and text[place] == word[len(found)]:
            found.append(place)
    return tuple(found) if len(found) == len(word) else ()


def _gaps(places: Sequence[int]) -> int:
    return sum(after != before + 1 for before, after in pairwise(places))


# Which commands the palette shows for what is typed, in which order.

MOST_SHOWN = 200
RECENT_WORTH = 8.0
"""What a command that was used last is worth more than one that was not."""


@dataclass(frozen=True)
class Ranked:
    """A command that fits, with the letters of its words that were typed."""

    command: Command
    letters: tuple[int, ...] = ()
    is_recent: bool = False


def ranked(commands: Iterable[Command], typed: str, recent: Sequence[str]) -> list[Ranked]:
    """The commands that fit, the best first; with nothing typed, those that were used last first.

    ``recent`` are the ids of commands that were used, the last one first.
    """
    places = {one: number for number, one in enumerate(recent)}
    found: list[tuple[float, float, int, Ranked]] = []
    first: dict[str, Command] = {}
    for command in commands:  # each once, as it was given first
        first.setdefault(command.id, command)
    for number, command in enumerate(first.values()):
        fit = match(typed, command.words, f"{command.kind} {command.also}")
        if fit is None:
            continue
        place = places.get(command.id)
        bonus = RECENT_WORTH / (1 + place) if place is not None else 0.0
        score = fit.score + bonus if typed.strip() else bonus
        one = Ranked(command, fit.letters, place is not None and not typed.strip())
        found.append((-score, bool(command.why_not), number, one))
    found.sort(key=lambda entry: entry[:3])
    return [one for *_, one in found[:MOST_SHOWN]]

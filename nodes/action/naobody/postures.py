"""Which posture a word means, and by which postures a robot gets from one to another."""

from __future__ import annotations

from collections import deque

from nep_core.errors import ActionFailed
from nodes.action.naobody.body import Body


def posture_name(body: Body, word: str) -> str:
    """Return the posture that a word such as ``posture_stand`` or ``StandInit`` means.

    Raises ActionFailed with the words that are possible.
    """
    plain = _plain(word)
    for name in body.postures:
        if _plain(name) == plain:
            return name
    known = ", ".join(_word(name) for name in body.postures)
    raise ActionFailed(f'There is no posture "{word}". Possible postures: {known}.')


def posture_path(body: Body, start: str, goal: str) -> list[str]:
    """Return the postures to pass after ``start``, the goal last: the way with the fewest moves."""
    came_from: dict[str, str | None] = {start: None}
    waiting = deque([start])
    while waiting:
        here = waiting.popleft()
        if here == goal:
            return _way_back(came_from, goal)
        for neighbour in body.postures[here].next:
            if neighbour not in came_from:
                came_from[neighbour] = here
                waiting.append(neighbour)
    raise ActionFailed(f"There is no way from {start} to {goal}.")


def _way_back(came_from: dict[str, str | None], goal: str) -> list[str]:
    path = []
    here: str | None = goal
    while here is not None:
        path.append(here)
        here = came_from[here]
    path.reverse()
    return path[1:] or [goal]


def _word(name: str) -> str:
    return "posture" + "".join(f"_{c.lower()}" if c.isupper() else c for c in name)


def _plain(word: str) -> str:
    letters = "".join(letter for letter in word if letter.isalnum()).casefold()
    return letters.removeprefix("posture")

"""The faces that a virtual robot knows by name: whom it has learnt, and whom it has forgotten."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from nep_core.words import plain

TOLD = "told "
"""Before the name of a face that the robot was told to see; others are placed things, by id."""


@dataclass
class Faces:
    """Names by face, as long as the robot lives.

    A person who has a name is known by it without being learnt. Once that name is forgotten,
    such a person is a plain face, until the name is learnt again.
    """

    learnt: dict[str, str] = field(default_factory=dict)
    forgotten: set[str] = field(default_factory=set)

    def name_of(self, face: str, own_name: str = "") -> str:
        """The name by which a face is known, as part of a human state; "" for a plain face."""
        name = plain(self.learnt.get(face, own_name))
        return "" if name in self.forgotten else name

    def told_as(self, name: str) -> str:
        """The face that the robot was told to see, and that is known by a name."""
        learnt = (face for face in self.learnt if face.startswith(TOLD))
        known = (face for face in learnt if plain(self.learnt[face]) == name)
        return next(known, TOLD + name)

    def learn(self, face: str, name: str) -> None:
        """Know a face by a name from now on, and no other face that was learnt."""
        self.unlearn(name)
        self.forgotten.discard(plain(name))
        self.learnt[face] = name

    def forget(self, name: str, known: Iterable[str]) -> bool:
        """Notice a name no more; whether it was learnt, or is among the known ones."""
        was_known = self.unlearn(name) or plain(name) in set(known) - self.forgotten
        if was_known:
            self.forgotten.add(plain(name))
        return was_known

    def unlearn(self, name: str) -> bool:
        """Take a name away from the face that was learnt under it; whether there was one."""
        faces = [face for face, old in self.learnt.items() if plain(old) == plain(name)]
        for face in faces:
            del self.learnt[face]
        return bool(faces)

"""Icons and words of cues, for the panel of their operator and for the public of a show."""

from __future__ import annotations

from nep_studio.project.triggers import SOURCE, Cue, CueKind
from nep_studio.ui.words import tr

ICONS: dict[CueKind, str] = {
    "state": "flag",
    "word": "ear",
    "gesture": "watch",
    "touch": "hand",
    "sight": "eye",
    "emotion": "user",
    "person": "users",
    "arm": "person-standing",
}


def cue_words(cue: Cue) -> str:
    """What a button says: what a person called it, else what it tells of."""
    if cue.label:
        return cue.label
    words = _words(cue)
    return words if cue.source == SOURCE else f"{words} ({cue.source})"


def _words(cue: Cue) -> str:
    about = cue.words or cue.state.replace("_", " ")
    match cue.kind:
        case "word":
            return f"“{about}”"
        case "touch":
            return tr("Touch {part}", part=about)
        case "sight":
            return tr("Sees {thing}", thing=about)
        case "emotion":
            return tr("Looks {emotion}", emotion=about)
        case "person":
            return tr("Somebody is {distance}", distance=about)
        case "arm":
            return tr("The arm is {posture}", posture=about)
    return about[:1].upper() + about[1:]


def invitation(cue: Cue) -> str:
    """What the public is told that it can do; what a person called the cue, if anything."""
    if cue.label:
        return cue.label
    match cue.kind:
        case "word":
            return tr("Say “{word}”", word=cue.words)
        case "gesture":
            return tr("Make the gesture: {gesture}", gesture=cue.words)
        case "sight":
            return tr("Show it: {thing}", thing=cue.words)
        case "emotion":
            return tr("Your face: {emotion}", emotion=cue.words)
        case "person":
            return tr("Your place: {distance}", distance=cue.words)
        case "arm":
            return tr("Your arm: {posture}", posture=cue.words)
    return _words(cue)

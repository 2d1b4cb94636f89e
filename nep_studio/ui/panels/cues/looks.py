"""How cues look: their words, their icons, their colours."""

from __future__ import annotations

from PySide6.QtGui import QColor

from nep_studio.cues import SOURCE, Cue, Kind
from nep_studio.ui.words import tr

ICONS: dict[Kind, str] = {
    "state": "flag",
    "word": "ear",
    "gesture": "watch",
    "touch": "hand",
    "sight": "eye",
    "emotion": "user",
    "person": "users",
}

COLOURS = ("", "#1f6f78", "#3b6fc9", "#7a4fb5", "#a33b5e", "#b3541e", "#8a6d00", "#2a6b3c")
"""What a person can choose; "" is the theme's own."""


def colour_words(colour: str) -> str:
    """What a colour is called."""
    words = (
        tr("Usual colour"),
        tr("Teal"),
        tr("Blue"),
        tr("Purple"),
        tr("Raspberry"),
        tr("Orange"),
        tr("Gold"),
        tr("Green"),
    )
    return dict(zip(COLOURS, words, strict=True)).get(colour, colour)


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
    return about[:1].upper() + about[1:]


def ink_on(colour: QColor) -> QColor:
    """Black or white, whichever is read better on a colour."""
    red, green, blue = colour.redF(), colour.greenF(), colour.blueF()
    light = sum(w * _linear(c) for w, c in ((0.2126, red), (0.7152, green), (0.0722, blue)))
    return QColor("black") if (light + 0.05) ** 2 > 1.05 * 0.05 else QColor("white")


def _linear(channel: float) -> float:
    return channel / 12.92 if channel <= 0.03928 else float(((channel + 0.055) / 1.055) ** 2.4)

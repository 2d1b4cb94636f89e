"""Writes an animation as the text of a file that ``load_animation`` reads back."""

from __future__ import annotations

import json

from nodes.action.naobody.animations import Animation
from nodes.action.naobody.keyframes import Track

DIGITS = 6
"""Angles and times are kept to a millionth."""


def write_animation(animation: Animation) -> str:
    """Return the text of an animation's file; its name is the file's name."""
    head = [
        f"{name} = {_text(getattr(animation, name))}"
        for name in ("title", "description", "kind", "starts_from", "says")
        if getattr(animation, name) or name in ("title", "description", "kind")
    ]
    joints = [_joint(name, track) for name, track in animation.keyframes.tracks.items()]
    return "\n".join([*head, "", *joints])


def _joint(name: str, track: Track) -> str:
    header = name if name.isascii() and name.isidentifier() else _text(name)
    lines = [f"[joints.{header}]", f"times = {_row(track.times)}", f"keys = {_row(track.keys)}"]
    if track.handles is not None:
        rows = ", ".join(_row(handle) for handle in track.handles)
        lines.append(f"handles = [{rows}]")
    return "\n".join([*lines, ""])


def _row(numbers: tuple[float, ...]) -> str:
    return "[" + ", ".join(repr(round(float(number), DIGITS)) for number in numbers) + "]"


def _text(text: str) -> str:
    # JSON's texts are TOML's too, but for a control character that TOML wants escaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")

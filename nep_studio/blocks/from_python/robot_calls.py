"""What robots are asked in Python, as blocks write it: some values by place, some by name."""

from __future__ import annotations

import ast

from .told_names import may_be_asked_twice

CALLS = {
    "ask": "question words / seconds",
    "ask_number": "question / seconds",
    "awareness": "on",
    "breathing": "on",
    "close_hand": "side",
    "do": "posture",
    "forget_face": "name",
    "imitate": "animal",
    "is_doing": "what",
    "is_in": "posture",
    "is_touched": "part",
    "learn_face": "name",
    "leds": "group colour / seconds",
    "leds_brightness": "group percent",
    "leds_off": "group",
    "leds_reset": "group",
    "lock": "part",
    "look": "yaw_deg pitch_deg",
    "look_at": "x_m y_m z_m / frame",
    "move_joint": "joint degrees",
    "move_joint_by": "joint degrees",
    "open_hand": "side",
    "person_is": "distance",
    "place_of": "thing measure",
    "play": "animation / mirror reverse stretch",
    "play_sound": "file",
    "point_at": "x_m y_m z_m / frame arm",
    "random_eyes": "seconds",
    "record_video": "file seconds / camera",
    "release": "part",
    "rotate_eyes": "seconds",
    "say": "text / gesture language speed pitch",
    "sees": "thing name",
    "sensor": "name",
    "set_language": "language",
    "set_volume": "percent",
    "start_walking": "forward left turn",
    "take_picture": "file / camera",
    "track": "thing using",
    "turn": "degrees",
    "walk": "forward_m / left_m turn_deg",
}
"""The values of each call in their order; those behind “/” are written by name."""
SAID_ALWAYS: dict[tuple[str, str], object] = {
    ("ask", "seconds"): 10,
    ("ask_number", "seconds"): 10,
    ("close_hand", "side"): "both",
    ("lock", "part"): "body",
    ("look", "pitch_deg"): 0,
    ("open_hand", "side"): "both",
    ("place_of", "measure"): "distance",
    ("release", "part"): "body",
    ("track", "using"): "head",
}
"""What blocks say though it is usual."""


def as_blocks_write(node: ast.Call, method: str) -> ast.Call:
    """A call of a robot as blocks write it; the same call where they do not know it."""
    in_order, _, by_name = (part.split() for part in CALLS[method].partition("/"))
    every = [*in_order, *by_name]
    given = {word.arg: word.value for word in node.keywords}
    is_known = len(node.args) <= len(every) and given.keys() <= set(every[len(node.args) :])
    if not is_known or any(isinstance(one, ast.Starred) for one in node.args):
        return node
    values = dict(zip(every, node.args, strict=False)) | given
    if sum(not may_be_asked_twice(value) for value in values.values()) > 1:
        return node  # they may be worked out in the order in which they stand alone
    for (name, key), usual in SAID_ALWAYS.items():
        if name == method and not (key == "seconds" and "question" not in values):
            values.setdefault(key, ast.Constant(usual))  # type: ignore[arg-type]
    if method == "walk" and "turn_deg" in values:
        in_order, by_name = ["forward_m", "left_m"], ["turn_deg"]
        values.setdefault("left_m", ast.Constant(0))
    first = [values[key] for key in in_order if key in values]
    if [key for key in in_order if key in values] != in_order[: len(first)]:
        return node
    named = [ast.keyword(key, values[key]) for key in by_name if key in values]
    return ast.Call(node.func, first, named)

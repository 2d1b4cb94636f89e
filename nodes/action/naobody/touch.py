"""Where a robot feels that it is touched."""

from __future__ import annotations

TOUCH_SENSORS = (
    "head_front",
    "head_middle",
    "head_rear",
    "hand_left",
    "hand_right",
    "bumper_left",
    "bumper_right",
    "chest_button",
)

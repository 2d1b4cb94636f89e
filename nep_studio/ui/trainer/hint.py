"""The one next thing to do, from the first connection to the robot that reacts."""

from __future__ import annotations

from typing import Literal

from nep_studio.blocks.own_gestures import OwnGesture
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.words import count_words, tr

Step = Literal["project", "connect", "name", "record", "more", "another", "train", "try"]
ENOUGH_TAKES = 3
MANY_TAKES = 5


def next_step(desk: TrainerDesk) -> tuple[Step, str]:
    """The step, and the name of the gesture that it is about."""
    if desk.editor is None:
        return "project", ""
    lacking = _lacking(desk)
    if not desk.is_hearing and (lacking or len(desk.gestures) < 2):
        return "connect", ""
    if not desk.gestures:
        return "name", ""
    if lacking:
        return ("more" if desk.gestures[lacking].takes else "record"), lacking
    if len(desk.gestures) < 2:
        return "another", ""
    return ("try" if desk.is_up_to_date else "train"), ""


def hint_words(desk: TrainerDesk) -> str:
    """The next step in words."""
    step, name = next_step(desk)
    gesture = desk.gestures.get(name, OwnGesture(""))
    said = {
        "project": tr("Open a project first, or make a new one: gestures belong to a project."),
        "connect": tr("Connect a watch or phone, so that movements can be recorded."),
        "name": tr("Give your first gesture a name, such as “wave”."),
        "record": tr(
            "Record “{gesture}”: press Record, then make it five times, with a short rest between.",
            gesture=gesture.title,
        ),
        "more": count_words(
            max(1, ENOUGH_TAKES - _used(gesture)),
            "Record “{gesture}” once more.",
            "Record “{gesture}” {n} more times.",
            gesture=gesture.title,
        ),
        "another": tr("Add another gesture: what can be confused can be told apart."),
        "train": tr("Train: the program learns from the takes."),
        "try": tr("Try it, then drag “when …” of a gesture onto the page."),
    }
    return said[step]


def button_words(step: Step) -> str:
    """What the button beside the words says; empty for none."""
    return {
        "name": tr("New gesture"),
        "record": tr("Record"),
        "more": tr("Record"),
        "another": tr("New gesture"),
        "train": tr("Train"),
        "try": tr("Try it"),
    }.get(step, "")


def _lacking(desk: TrainerDesk) -> str:
    """The first gesture with too few takes."""
    few = (name for name, one in desk.gestures.items() if _used(one) < ENOUGH_TAKES)
    return next(few, "")


def _used(gesture: OwnGesture) -> int:
    return sum(not take.left_out for take in gesture.takes)

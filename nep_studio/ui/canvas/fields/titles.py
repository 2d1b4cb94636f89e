"""What a field is called: for the screen reader, and as the tool tip of its place."""

from __future__ import annotations

from nep_studio.blocks.sentence import Slot
from nep_studio.ui.words import tr


def slot_name(slot: Slot) -> str:
    """The name of a slot as words."""
    return slot.label or slot.name.replace("_", " ")


def title_of(slot: Slot) -> str:
    """A field by its name and kind, such as "seconds: a time in seconds"."""
    return tr("{name}: {kind}", name=tr(slot_name(slot)), kind=tr(slot.kind.noun))


def hint_of(slot: Slot) -> str:
    """What goes into a place, for the tool tip over it."""
    if slot.kind.name == "parameter":
        return tr("{name}. Drag it out to use it, press it to rename it.", name=slot.label)
    if slot.low is not None and slot.high is not None:
        ends = {"low": f"{slot.low:g}", "high": f"{slot.high:g}"}
        return tr("{title} from {low} to {high}", title=title_of(slot), **ends)
    if not slot.kind.typed:
        return tr("{title}. Put a block here.", title=title_of(slot))
    return title_of(slot)

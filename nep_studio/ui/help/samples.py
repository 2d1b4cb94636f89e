"""A block of each type as it is when it is new, for its picture and its title."""

from __future__ import annotations

from nep_studio.blocks.definitions import Definition
from nep_studio.blocks.edits import AddVariable
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.copying import Clip, clip_of
from nep_studio.blocks.text import sentence
from nep_studio.ui.words import tr


def sample_clip(language: Language, definition: Definition) -> Clip:
    """One new block; where it names a variable, there is one."""
    names = [slot.name for slot in definition.slots.values() if slot.kind.name == "variable"]
    clip = clip_of(language, definition.id, **dict.fromkeys(names, "v1"))
    if names:
        AddVariable("v1", tr("variable"), 0).apply(clip.project)
    return clip


def sample_words(language: Language, definition: Definition) -> str:
    """What a new block says."""
    clip = sample_clip(language, definition)
    return sentence(clip.project, language, clip.roots[0][0])

"""The language of this installation with one more block for each kind of slot."""

from __future__ import annotations

from dataclasses import replace

from nep_studio.blocks.definitions import Definition, parse, slots_of
from nep_studio.blocks.language import Language
from nep_studio.run.installation import studio_language

SENTENCES = {
    "kinds.lines": ("remember {text:lines} for later", {"text": ""}),
    "kinds.angle": ("turn by {angle:angle} to the left", {"angle": 30}),
    "kinds.duration": ("rest {time:duration} then go on", {"time": 1}),
    "kinds.slider": ("be {much:slider(0..100)} loud", {"much": 50}),
    "kinds.checkbox": ("loud {on:checkbox}", {"on": True}),
    "kinds.colour": ("in {colour:colour}", {"colour": "#00aaff"}),
}


def kinds_language() -> Language:
    """The language."""
    language = studio_language()
    definitions = dict(language.definitions)
    for block_type, (sentence, defaults) in SENTENCES.items():
        parts = parse(sentence)
        definitions[block_type] = Definition(
            id=block_type,
            category=definitions["control.wait"].category,
            shape="statement",
            parts=parts,
            slots=slots_of(parts),
            groups={},
            minimum={},
            defaults=defaults,
            generator="number",
        )
    return replace(language, definitions=definitions)

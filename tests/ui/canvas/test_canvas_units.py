"""Fields show their unit where the sentence does not say it, in every language."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.blocks.slots import kind_of
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.layout.slot_style import shown_text, unit_of
from nep_studio.ui.words import available_languages, use_language


@pytest.fixture(params=sorted(available_languages()))
def code(request: pytest.FixtureRequest) -> Iterator[str]:
    use_language(request.param)
    yield request.param
    use_language("en")


def test_no_sentence_says_the_unit_of_its_field_twice(code: str) -> None:
    editor = Editor(Project(), studio_language(code))
    block_id = editor.create("control.wait", editor.new_stack("behaviour", 0, 0))
    slot = editor.language.definitions["control.wait"].slots["seconds"]
    block = editor.project.blocks[block_id]

    assert shown_text(editor.project, editor.language, block, "seconds", slot) == "1"
    assert unit_of(kind_of("duration")).strip()

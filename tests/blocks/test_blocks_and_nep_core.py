"""What generated programs call is what nep_core offers, with the arguments that it takes."""

from __future__ import annotations

import inspect

import nep_core
from nep_studio.blocks.generate.names import API


def test_every_name_that_programs_import_is_there():
    assert set(nep_core.__all__) >= API


def test_every_call_of_a_block_fits_its_function(language):
    for definition in language.definitions.values():
        made = definition.call
        if made is None:
            continue
        function = getattr(nep_core.Robot if made.on else nep_core, made.name)
        itself = [None] if made.on else []

        named = {**made.keywords, **made.constants}
        inspect.signature(function).bind(*itself, *made.arguments, **named)


def test_defaults_that_are_left_out_are_the_defaults_of_the_function(language):
    for definition in language.definitions.values():
        if definition.call is None:
            continue
        for name, slot in definition.call.keywords.items():
            if slot in definition.call.optional:
                function = getattr(nep_core.Robot, definition.call.name)
                assert (
                    inspect.signature(function).parameters[name].default
                    == (definition.defaults[slot])
                )


def test_rules_know_each_way_to_begin_again(language):
    parameters = inspect.signature(nep_core.Behavior.when).parameters

    assert parameters["again"].default == "ignore"
    assert set(language.choices["again"]) == {"ignore", "restart", "queue"}

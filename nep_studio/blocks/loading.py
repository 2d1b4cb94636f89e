"""Load the block language from the folders that hold its definitions and its robot profile."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from .definition_files import load_definitions
from .generate.registry import generator_names
from .language import Language
from .profile import drivers_beside, load_profile


def load_language(
    blocks_folder: Path,
    robot_file: Path,
    *,
    gestures: Mapping[str, str] | None = None,
    nodes: Mapping[str, str] | None = None,
) -> Language:
    """Read the definitions and the robot profile.

    ``gestures`` (name to label) and ``nodes`` ("type/name" to label) are what this installation
    can recognise and launch. Raises DefinitionError, which names the file and the block.
    """
    found = load_definitions(blocks_folder, generator_names())
    profile = load_profile(robot_file)
    choices: dict[str, Mapping[str, str]] = {
        "gestures": gestures or {},
        "nodes": nodes or {},
        **profile.choices,
        **drivers_beside(robot_file, profile),
        **found.choices,
    }
    return Language(found.definitions, tuple(found.categories), choices, profile)

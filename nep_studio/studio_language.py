"""The block language with what this installation can recognise and launch."""

from __future__ import annotations

import tomllib

from nep_core.errors import ManifestError
from nep_core.manifest import NodeCatalog, read_manifest
from nep_core.places import node_folders
from nep_studio import paths
from nep_studio.blocks.language import Language
from nep_studio.blocks.loading import load_language
from nep_studio.blocks.translation import translated


def shipped_gestures() -> dict[str, str]:
    """The gestures of the shipped model: name to label."""
    path = paths.resources() / "gestures" / "paper.toml"
    gestures: dict[str, str] = tomllib.loads(path.read_text(encoding="utf-8"))["gestures"]
    return gestures


def launchable_nodes() -> dict[str, str]:
    """The nodes that can be launched: "type/name" to title.

    A node whose manifest is wrong is there too, so that a check can say what is wrong with it.
    """
    nodes = {}
    for path in NodeCatalog(node_folders()).paths():
        try:
            nodes[f"{path.parent.name}/{path.stem}"] = read_manifest(path).title
        except ManifestError:
            nodes[f"{path.parent.name}/{path.stem}"] = path.stem
    return nodes


def studio_language(code: str = "en") -> Language:
    """The language of this installation, in the words of ``code``; raises DefinitionError.

    Words that the table of ``code`` does not have stay English, all of them without a table.
    """
    resources = paths.resources()
    language = load_language(
        resources / "blocks",
        resources / "robots" / "nao" / "robot.toml",
        gestures=shipped_gestures(),
        nodes=launchable_nodes(),
    )
    table = resources / "translations" / f"{code}.toml"
    if code == "en" or not table.is_file():
        return language
    return translated(language, tomllib.loads(table.read_text(encoding="utf-8")))

"""All targets by name; a module is imported when one of its targets is wanted."""

from __future__ import annotations

from importlib import import_module

from fuzz.target import Target

# By the module that has them: a child loads what its target needs, and no more.
MODULES = {
    "network": ("frames", "master", "gateway", "pairing"),
    "robots": ("naoqi", "requests", "robot"),
    "sensors": ("lines", "push", "page", "csv", "models"),
    "projects": ("nep", "pack", "png", "python"),
    "installed": ("mcap", "manifests", "settings", "translations", "brought"),
}
NAMES = tuple(name for names in MODULES.values() for name in names)


def target(name: str) -> Target:
    """The target of a name; KeyError when there is none."""
    module = next((one for one, names in MODULES.items() if name in names), None)
    if module is None:
        raise KeyError(name)
    found: dict[str, Target] = import_module(f"fuzz.targets.{module}").TARGETS
    return found[name]

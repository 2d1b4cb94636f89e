"""``nep-studio node TYPE/NAME [setting=value ...]``: one node, in this process."""

from __future__ import annotations

import argparse
import importlib.util
import logging
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from faults import FaultError
from nep_core.errors import ManifestError, NepError, ParameterError
from nep_core.places import node_folders
from nep_core.processes import handover, lifeline
from nep_core.processes.manifest import Manifest, NodeCatalog, read_manifest
from nep_core.processes.node import Node, check_node_name
from nep_core.processes.process import ASKED

from . import explain, steps_of

log = logging.getLogger(__name__)


# Running one node in this process: what the launcher starts.


def run_node(manifest: Manifest, name: str, given: dict[str, Any]) -> int:
    """Run a Python node until it ends or is stopped; the exit code.

    A FaultError ends it with its sentence and code 1; anything else is a fault of the node and
    shows its traceback (the launcher keeps it in the node's log). A launched node that somebody in
    the network asked to stop ends with a code that says so: it is not started again.
    """
    parameters = manifest.read_parameters(given)
    run = _run_function(manifest)
    with Node(name, manifest.type) as node:
        node.stop_on_signals()
        # A robot that rests before its node ends is not let go when the launcher is killed either
        is_launched = lifeline.on_parent_end(node.stop, grace_s=manifest.stop_s)
        try:
            run(node, **parameters)
        except FaultError as error:
            if node.stopping:
                log.info("after it was asked to stop: %s", error)
            else:
                node.close("crashed", error.fault)
                handover.hand_over(error.fault)
                print("\n".join([str(error), *steps_of(error)]), file=sys.stderr)
                return 1
    return ASKED if is_launched and node.was_asked else 0


def _run_function(manifest: Manifest) -> Callable[..., None]:
    module = _load(manifest)
    run = getattr(module, "run", None)
    if not callable(run):
        raise ManifestError(
            "The node {id} has no function run(node, ...) in {module}.",
            checklist=("Write one: def run(node, **parameters).",),
            id=manifest.id,
            module=manifest.module,
        )
    return run  # type: ignore[no-any-return]


def _load(manifest: Manifest) -> ModuleType:
    shipped = f"nodes.{manifest.type}.{manifest.name}"
    spec = importlib.util.find_spec(shipped)
    if spec is not None and spec.origin and Path(spec.origin) == Path(manifest.module):
        return importlib.import_module(shipped)
    name = f"{manifest.type}_{manifest.name}"  # its own name may be that of a library
    spec = importlib.util.spec_from_file_location(name, manifest.module)
    assert spec is not None and spec.loader is not None  # read_manifest has seen the file
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    sys.path.append(str(Path(manifest.module).parent))  # it may have files beside it
    spec.loader.exec_module(module)
    return module


def main(arguments: list[str]) -> int:
    """Run the node until it ends, Ctrl-C or SIGTERM; the exit code."""
    parser = argparse.ArgumentParser(
        prog="nep-studio node", description="Run one node in this terminal; Ctrl-C stops it."
    )
    parser.add_argument("node", help='type and name, such as "sensory/virtual_watch", or a .toml')
    parser.add_argument("--name", default="", help="the node's name in the network")
    parser.add_argument("settings", nargs="*", metavar="setting=value")
    options = parser.parse_intermixed_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    try:
        if options.node.endswith(".toml"):
            manifest = read_manifest(Path(options.node))
        else:
            manifest = NodeCatalog(node_folders()).find(options.node)
        name = check_node_name(options.name or manifest.name)
        given = settings(options.settings) | handover.take_secrets()
        return run_node(manifest, name, given)
    except NepError as error:
        handover.hand_over(error.fault)
        print(explain(error), file=sys.stderr)
        return 1


def settings(words: list[str]) -> dict[str, str]:
    """``name=value`` words as a dictionary; raises ParameterError."""
    pairs = [word.partition("=") for word in words]
    for name, equals, _ in pairs:
        if not equals:
            raise ParameterError(
                '"{name}" is not a setting.',
                checklist=("Write settings as name=value.",),
                name=name,
            )
    return {name: value for name, _, value in pairs}

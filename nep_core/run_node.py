"""Running one node in this process: what the launcher starts."""

from __future__ import annotations

import importlib.util
import logging
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

from nep_core import lifeline
from nep_core.errors import ManifestError, NepError
from nep_core.manifest import Manifest
from nep_core.node import Node
from nep_core.outcome import ASKED

log = logging.getLogger(__name__)


def run_node(manifest: Manifest, name: str, given: dict[str, Any]) -> int:
    """Run a Python node until it ends or is stopped; the exit code.

    A NepError ends it with its sentence and code 1; anything else is a fault of the node and
    shows its traceback (the launcher keeps it in the node's log). A launched node that somebody in
    the network asked to stop ends with a code that says so: it is not started again.
    """
    parameters = manifest.read_parameters(given)
    run = _run_function(manifest)
    with Node(name, manifest.type) as node:
        node.stop_on_signals()
        is_launched = lifeline.on_parent_end(node.stop)
        try:
            run(node, **parameters)
        except NepError as error:
            if node.stopping:
                log.info("after it was asked to stop: %s", error)
            else:
                return _failed(node, error)
    return ASKED if is_launched and node.was_asked else 0


def _failed(node: Node, error: NepError) -> int:
    node.close("crashed", error.sentence)
    print(error.sentence, file=sys.stderr)
    for step in error.checklist:
        print(f"  [ ] {step}", file=sys.stderr)
    return 1


def _run_function(manifest: Manifest) -> Callable[..., None]:
    module = _load(manifest)
    run = getattr(module, "run", None)
    if not callable(run):
        raise ManifestError(
            f"The node {manifest.id} has no function run(node, ...) in {manifest.module}.",
            checklist=("Write one: def run(node, **parameters).",),
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

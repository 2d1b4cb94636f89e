"""``nep-studio node TYPE/NAME [setting=value ...]``: one node in this process."""

from __future__ import annotations

import argparse
import logging
import sys
from pathlib import Path

from nep_core.cli import explain
from nep_core.errors import NepError, ParameterError
from nep_core.manifest import Manifest, NodeCatalog, read_manifest
from nep_core.node_name import check_node_name
from nep_core.places import node_folders
from nep_core.run_node import run_node


def main(arguments: list[str]) -> int:
    """Run the node until it ends, Ctrl-C or SIGTERM; the exit code."""
    options = _parser().parse_intermixed_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    try:
        manifest = _manifest(options.node)
        name = check_node_name(options.name or manifest.name)
        return run_node(manifest, name, settings(options.settings))
    except NepError as error:
        print(explain(error), file=sys.stderr)
        return 1


def settings(words: list[str]) -> dict[str, str]:
    """``name=value`` words as a dictionary; raises ParameterError."""
    pairs = [word.partition("=") for word in words]
    for name, equals, _ in pairs:
        if not equals:
            raise ParameterError(
                f'"{name}" is not a setting.', checklist=("Write settings as name=value.",)
            )
    return {name: value for name, _, value in pairs}


def _manifest(node: str) -> Manifest:
    if node.endswith(".toml"):
        return read_manifest(Path(node))
    return NodeCatalog(node_folders()).find(node)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="nep-studio node", description="Run one node in this terminal; Ctrl-C stops it."
    )
    parser.add_argument("node", help='type and name, such as "sensory/virtual_watch", or a .toml')
    parser.add_argument("--name", default="", help="the node's name in the network")
    parser.add_argument("settings", nargs="*", metavar="setting=value")
    return parser

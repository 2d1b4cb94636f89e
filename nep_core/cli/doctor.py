"""``nep doctor``: what this computer has for NEP, and what is missing."""

from __future__ import annotations

import argparse
import platform
from importlib import metadata

import zmq

from nep_core.endpoints import master_endpoint
from nep_core.errors import ManifestError
from nep_core.manifest import NodeCatalog, read_manifest
from nep_core.master_probe import ask_master
from nep_core.places import log_folder, node_folders


def add_arguments(_name: str, _parser: argparse.ArgumentParser) -> None:
    """There are no options."""


def run(options: argparse.Namespace) -> int:
    """Print the report; 0 when nothing is wrong."""
    endpoint = options.master or master_endpoint()
    listing = ask_master(endpoint, timeout_s=0.5)
    problems = _wrong_manifests()
    print(f"Python    {platform.python_version()} on {platform.platform()}")
    print(f"ZeroMQ    {zmq.zmq_version()} (pyzmq {zmq.__version__})")
    print(f"msgspec   {metadata.version('msgspec')}")
    nodes = len(listing.registrations) if listing else 0
    print(f"master    {f'{nodes} nodes' if listing else 'does not answer'} at {endpoint}")
    print(f"logs      {log_folder()}")
    for problem in problems:
        print(f"\n{problem}")
    return 1 if problems else 0


def _wrong_manifests() -> list[str]:
    problems = []
    for path in NodeCatalog(node_folders()).paths():
        try:
            read_manifest(path)
        except ManifestError as error:
            problems.append(error.sentence)
    return problems

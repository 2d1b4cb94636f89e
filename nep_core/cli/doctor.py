"""``nep doctor``: what this computer has for NEP, what to look at, and what to do."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence

import psutil

from nep_core.cli.arguments import add_json
from nep_core.cli.finding import Finding
from nep_core.cli.showing import say, say_json
from nep_core.errors import NepError

MARKS = {"ok": "ok       ", "look": "LOOK     ", "unknown": "unknown  ", "note": "-        "}


def add_arguments(_name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    parser.add_argument("--robot", metavar="ADDRESS", help="does a NAO answer there?")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print the report; 1 when there is something to look at."""
    findings = examine(options.master, options.robot)
    if options.json:
        say_json(findings)
    else:
        say("\n".join(report_lines(findings)))
    return 1 if any(found.state == "look" for found in findings) else 0


def examine(master: str | None = None, robot: str | None = None) -> list[Finding]:
    """All that was found out about this computer."""
    return [found for group in examined(master, robot).values() for found in group]


def examined(master: str | None = None, robot: str | None = None) -> dict[str, list[Finding]]:
    """The same by what it is about: computer, network, folders, nodes."""
    from nep_core.cli import checks_of_network as network
    from nep_core.cli import checks_of_system as system

    return {
        "computer": [
            *_found("versions", system.versions),
            *_found("computer", system.computer),
            *_found("clock", system.clock),
        ],
        "network": [
            *_found("variables", network.variables),
            *_found("master", lambda: network.service(master)),
            *_found("ports", network.original_ports),
            *_found("ports", network.naoqi_port),
            *(_found("robot", lambda: network.robot(robot)) if robot else []),
            *_found("clocks", lambda: network.clocks(master)),
            *_found("firewall", system.firewalls),
        ],
        "folders": [
            *_found("folders", system.folders),
            *_found("key file", system.key_file),
            *_found("disk", system.disk_space),
        ],
        "nodes": _found("nodes", system.manifests),
    }


def _found(about: str, look: Callable[[], Finding | list[Finding]]) -> list[Finding]:
    """What a check finds out; one that fails on this computer does not hide the others."""
    try:
        found = look()
    except (OSError, RuntimeError, ValueError, psutil.Error, NepError) as error:
        return [Finding(about, "unknown", f"could not be found out: {error}")]
    return found if isinstance(found, list) else [found]


def report_lines(findings: list[Finding]) -> list[str]:
    """The report for people: what was found, and a sentence at the end."""
    looks = sum(found.state == "look" for found in findings)
    end = "Nothing is wrong." if not looks else f"Look at {looks} of these, the first one first."
    return [*finding_lines(findings), "", end]


def finding_lines(findings: Sequence[Finding]) -> list[str]:
    """A line for each, steps below what needs a look."""
    width = max((len(found.about) for found in findings), default=0)
    lines = []
    for found in findings:
        lines.append(f"{MARKS[found.state]}{found.about.ljust(width)}  {found.told}")
        lines += [f"           [ ] {step}" for step in found.steps]
    return lines

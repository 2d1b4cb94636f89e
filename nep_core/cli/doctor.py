"""``nep doctor``: what this computer has for NEP, what to look at, and what to do."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from nep_core.cli.arguments import add_json
from nep_core.cli.finding import Finding
from nep_core.cli.showing import say, say_json

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
        "computer": [*system.versions(), *system.computer(), system.clock()],
        "network": [
            *network.variables(),
            network.service(master),
            *network.original_ports(),
            network.naoqi_port(),
            *([network.robot(robot)] if robot else []),
            *network.clocks(master),
            *system.firewalls(),
        ],
        "folders": [*system.folders(), system.key_file(), *system.disk_space()],
        "nodes": [system.manifests()],
    }


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

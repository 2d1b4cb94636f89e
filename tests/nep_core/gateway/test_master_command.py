"""``nep master`` lets programs of the original join, a session's master only when it is told to."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from nep_core.networks.gateway.gateway import Ports
from tests.nep_core.gateway.own_network import own_network
from tests.nep_core.gateway.raw_programs import RawPrograms, is_free

pytestmark = pytest.mark.long

NEP = "import sys; from nep_core.cli import main; sys.exit(main(sys.argv[1:]))"
STUDIO = "import sys; from nep_core.cli.services import run_master as m; sys.exit(m(sys.argv[1:]))"

Start = Callable[..., subprocess.Popen[str]]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Starts masters in a network where the original's own ports are free."""
    with ExitStack() as ending:
        ending.enter_context(own_network())

        def start(code: str, *words: str, original: str = "") -> subprocess.Popen[str]:
            master = subprocess.Popen(
                [sys.executable, "-c", code, *words, "--endpoint", "tcp://127.0.0.1:*"],
                stdout=subprocess.PIPE,
                text=True,
                env=os.environ | {"NEP_ORIGINAL": original, "XDG_CACHE_HOME": str(tmp_path)},
            )
            ending.enter_context(master)
            ending.callback(master.terminate)
            return master

        yield start


def lines_until_it_serves(master: subprocess.Popen[str]) -> list[str]:
    assert master.stdout is not None
    lines = [master.stdout.readline()]
    while lines[-1] and "serves at" not in lines[-1]:
        lines.append(master.stdout.readline())
    return lines


def test_it_serves_the_original_and_a_second_one_says_that_the_ports_are_taken(
    start: Start,
) -> None:
    lines_until_it_serves(start(NEP, "master"))
    raw = RawPrograms(Ports())
    answer = raw.ask(json.dumps({"node": "a", "topic": "/t"}).encode())
    raw.close()

    told = lines_until_it_serves(start(NEP, "master"))

    assert answer["state"] == "success"
    assert told[0].startswith("Programs of the original NEP cannot join.")
    assert "7000" in told[0]


@pytest.mark.parametrize(
    ("code", "words", "original", "serves"),
    [
        (NEP, ["master", "--no-original"], "", False),
        (NEP, ["master"], "0", False),
        (STUDIO, [], "", False),
        (STUDIO, [], "1", True),
    ],
)
def test_the_original_is_served_where_it_is_wanted(
    start: Start, code: str, words: list[str], original: str, serves: bool
) -> None:
    lines_until_it_serves(start(code, *words, original=original))

    assert is_free(Ports().new) != serves

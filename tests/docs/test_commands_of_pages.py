"""Every command of the documentation is run, or a page says why not; all of them are understood."""

from __future__ import annotations

import re
import shlex
import sys
from argparse import ArgumentParser
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, suppress
from importlib import import_module
from io import StringIO
from pathlib import Path

import pytest

from nep_core.cli import COMMANDS, parse
from nep_studio.__main__ import JOBS
from tests.conftest import PROJECT
from tests.docs.terminals import Fence, Terminals, fences_of

DOCS = PROJECT / "docs"
GUIDE = DOCS / "guide"
SHELL = ("sh", "")
NO_SHELL = ("python", "toml", "json", "hex", "js", "text")
PAGES = [
    *sorted(GUIDE.glob("*.md")),
    *sorted(DOCS.glob("*.md")),
    *sorted((PROJECT / "resources" / "help" / "en").glob("*.md")),
    PROJECT / "examples" / "README.md",
    PROJECT / "README.md",
]
MARKED = {"install.md": 3, "museums.md": 1, "benchmarks.md": 1}
"""How many fences of a guide say that they cannot be run here."""

MASTER, WATCH = "nep master", "nep launch sensory virtual_watch"
BROKER, ZENOH = "NEP_NETWORK=broker ", "NEP_NETWORK=zenoh "
OPEN = "nep open --host 127.0.0.1 --keys owner.keys"
GOES_ON = {
    MASTER: "The NEP master serves",
    WATCH: "is ready",
    "nep broker": "serves",
    BROKER + WATCH: "is ready",
    "nep broker --zenoh": "serves",
    ZENOH + WATCH: "is ready",
    OPEN: "nep pair",
}
"""The commands that have a terminal of their own, with what each says when it is at work."""

COMMAND = re.compile(r"(?:[A-Z_]+=\S+ )*(nep|nep-studio) (?=[a-z])(.+)")
PLACES = {"FILE", "TOPIC", "CODE", "TYPE", "NAME", "COMMAND", "JSON", "DIRECTORY", "FOLDER"}

only_in_a_shell = pytest.mark.skipif(sys.platform == "win32", reason="its commands are for a shell")
Follow = Callable[[tuple[str, ...]], list[str]]


@pytest.fixture
def follow(tmp_path: Path, free_port: int) -> Iterator[Follow]:
    """Gives what was printed, line by line."""
    here = f"tcp://127.0.0.1:{free_port}"
    zenoh = f"tcp/127.0.0.1:{free_port}"
    variables = {"NEP_MASTER": here, "NEP_BROKER": here, "NEP_ZENOH": zenoh}
    (tmp_path / "resources").symlink_to(PROJECT / "resources")
    terminals = Terminals(tmp_path, variables, GOES_ON)
    yield lambda lines: [terminals.follow(line) for line in lines]
    terminals.close()


def shell_fences(page: Path) -> list[Fence]:
    return [fence for fence in fences_of(page) if fence.language == "sh"]


def test_commands_stand_where_the_tests_look_for_them() -> None:
    languages = {fence.language for page in PAGES for fence in fences_of(page)}
    plain = [f for page in GUIDE.glob("*.md") for f in fences_of(page) if f.language == ""]

    assert languages <= {*SHELL, *NO_SHELL}
    assert not [line for fence in plain for line in fence.lines if COMMAND.fullmatch(line)]


def test_a_guide_says_which_commands_cannot_be_run_here() -> None:
    marked = {
        page.name: sum(not fence.is_run for fence in shell_fences(page))
        for page in GUIDE.glob("*.md")
    }

    assert {name: count for name, count in marked.items() if count} == MARKED
    said = "".join(page.read_text(encoding="utf-8") for page in GUIDE.glob("*.md"))
    reasons = re.findall(r"<!-- not run here: ([^\n]+) -->", said)
    places = [re.findall(r"[\w.]+/[\w./]*\w", reason) for reason in reasons]
    assert all(there and all((PROJECT / place).exists() for place in there) for there in places)


@only_in_a_shell
@pytest.mark.parametrize("name", ["first-program", "developers"])
def test_the_commands_of_a_guide_do_what_it_says(follow: Follow, name: str) -> None:
    [lines] = [fence.lines for fence in shell_fences(GUIDE / f"{name}.md") if fence.is_run]

    printed = follow(lines)

    told = {
        "first-program": ["Nothing to correct.", '@behavior.when("gesture_karate")', "bow"],
        "developers": ["serves", "ready", '"acc"', "/imu", "virtual_watch"],
    }[name]
    assert all(words in text for words, text in zip(told, printed, strict=True)), printed


def test_no_other_guide_has_commands_that_nobody_runs() -> None:
    run = {
        page.stem
        for page in GUIDE.glob("*.md")
        if any(fence.is_run for fence in shell_fences(page))
    }

    assert run == {"first-program", "developers"}


def commands_in(page: Path) -> Iterator[str]:
    for fence in fences_of(page):
        if fence.language in SHELL:
            yield from (line for line in fence.lines if COMMAND.fullmatch(line))
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
    yield from (said for said in re.findall(r"`([^`\n]+)`", text) if COMMAND.fullmatch(said))


def is_understood(line: str) -> bool:
    """Whether the program knows the command with its options; CODE stands for what differs."""
    found = COMMAND.fullmatch(line)
    assert found is not None
    words = shlex.split(re.split("[|&]", found[2])[0])
    if words[0] not in (JOBS if found[1] == "nep-studio" else COMMANDS):
        return False
    if len(words) == 1 or PLACES.intersection(re.split(r"\W", found[2])):
        return True
    try:
        with redirect_stderr(StringIO()):
            (takes if found[1] == "nep-studio" else parse)(words[0], words[1:])
    except SystemExit as end:
        return end.code in (0, None)
    return True


class Understood(Exception):
    """A job would begin its work now."""


def takes(job: str, words: list[str]) -> None:
    """Let a job of nep-studio read its words, and go no further; SystemExit when it cannot."""

    known_of = ArgumentParser.parse_known_args

    def read(parser: ArgumentParser, given: list[str] | None = None, *_: object) -> None:
        _, unknown = known_of(parser, given)
        if unknown:
            parser.error(f"unknown: {unknown}")
        raise Understood

    def read_known(parser: ArgumentParser, given: list[str] | None = None, *_: object) -> None:
        known_of(parser, given)  # such as a node, whose settings have any name
        raise Understood

    module, _, name = JOBS[job].partition(":")
    main = getattr(import_module(module), name)
    with pytest.MonkeyPatch.context() as patch, suppress(Understood):
        patch.setattr(ArgumentParser, "parse_args", read)
        patch.setattr(ArgumentParser, "parse_known_args", read_known)
        main(words)
        raise AssertionError(f"nep-studio {job} does not read its words with argparse")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_every_command_of_a_page_is_understood(page: Path) -> None:
    commands = list(commands_in(page))

    assert [line for line in commands if not is_understood(line)] == []


@pytest.mark.parametrize(
    "line",
    [
        "nep ecoh /imu",
        "nep echo /imu --cuont 1",
        "nep-studio rnu x",
        "nep-studio show play.nep --run --ceus",
        "nep-studio run play.nep --speed fast",
    ],
)
def test_a_command_that_there_is_not_is_found(line: str) -> None:
    assert not is_understood(line)


@only_in_a_shell
@pytest.mark.parametrize("network", [BROKER, ZENOH])
def test_the_networks_of_the_page_about_transports_are_as_it_says(
    follow: Follow, network: str
) -> None:
    if network == ZENOH:
        pytest.importorskip("zenoh")
    [lines] = [f.lines for f in fences_of(DOCS / "transports.md") if network + WATCH in f.lines]

    printed = follow(lines)

    assert '"acc"' in printed[-1]


@only_in_a_shell
def test_two_terminals_are_paired_as_the_page_about_opened_networks_says(
    follow: Follow, free_port: int
) -> None:
    [lines] = [f.lines for f in fences_of(DOCS / "open_network.md") if OPEN in f.lines]
    door = free_port + 1  # the next two are free, too

    [shown] = follow((f"{lines[0]} --port {free_port} --door {door}",))
    code = re.search(r"nep pair (\d+ \d+)", shown)
    assert code is not None
    [paired] = follow((lines[1].replace("127.0.0.1 CODE", f"127.0.0.1:{door} {code[1]}"),))

    assert "Paired with" in paired

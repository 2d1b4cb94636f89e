"""A stranger's project without a window: it is listed, and runs only with --trust."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import msgspec
import pytest

from nep_core.processes.process import program_command
from nep_core.wire import messages as m
from nep_studio import paths
from nep_studio.blocks.code_text import plainly
from nep_studio.blocks.edits.content import SetComment, SetField
from nep_studio.blocks.files import load
from nep_studio.blocks.generate.source_map import Code
from nep_studio.commands import run
from nep_studio.commands.project import check, code
from nep_studio.project.trust import Approvals, approvals_file
from nep_studio.run.controller import Request, RunController, Subject
from nep_studio.run.gate import (
    Gate,
    NotApproved,
    concerns_of,
    is_here,
    listing,
    node_concern,
)
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import NotForPages, PlannedNode, file_inside
from nep_studio.run.session import Session
from tests.blocks.block_building import B, build
from tests.nep_studio.run.hostile_projects import (
    STARTED,
    TRAPS,
    Maker,
    Trap,
    all_in_one,
    lines,
)

pytestmark = pytest.mark.strangers


def file_of(trap: Trap, make: Maker) -> str:
    """What a command takes: pictures are opened by the window alone."""
    return str(trap.file if trap.file.suffix == ".nep" else make.folder / "gift.nep")


@contextmanager
def played(file: str, *words: str) -> Iterator[None]:
    """``nep-studio run`` beside the test, until this is left."""
    command = program_command("run", file, *words)
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as running:
        try:
            yield
        finally:
            running.send_signal(signal.SIGINT)
            running.communicate(timeout=30)


def soon(is_so: Callable[[], bool]) -> bool:
    until_s = time.monotonic() + 30
    while not is_so() and time.monotonic() < until_s:
        time.sleep(0.05)
    return is_so()


@pytest.mark.parametrize("trap_of", TRAPS)
def test_nothing_runs_that_nobody_has_approved(
    make: Maker, trap_of: Callable[[Maker], Trap], capsys: pytest.CaptureFixture[str]
) -> None:
    trap = trap_of(make)

    code_ = run.main([file_of(trap, make), "--seconds", "1"])

    told = capsys.readouterr().err
    assert code_ == (run.UNUSABLE if trap.is_never else run.NOT_APPROVED)
    assert trap.tells in told
    assert trap.is_never or "--trust" in told
    assert not trap.has_sprung()


def test_what_is_trusted_runs(make: Maker) -> None:
    """So the test above could have seen it: four of them in one project."""
    traps = all_in_one(make)

    with played(str(make.folder / "gift.nep"), "--trust"):
        assert soon(lambda: all(trap.has_sprung() for trap in traps))
    assert not approvals_file().exists()  # it was trusted this once


def test_what_was_approved_in_the_window_runs_without_a_question(make: Maker) -> None:
    trap = lines(make)
    project = load(trap.file, make.language)
    Gate(Approvals()).approve(concerns_of(project, make.language, make.folder))
    if os.name == "posix":
        assert approvals_file().stat().st_mode & 0o077 == 0

    with played(str(trap.file)):
        assert soon(trap.has_sprung)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="it takes root")
def test_what_somebody_else_wrote_down_as_approved_is_not(make: Maker) -> None:
    """In a folder for all, as that for temporary files of who has no home, others were first."""
    found = concerns_of(load(lines(make).file, make.language), make.language, make.folder)
    Gate(Approvals()).approve(found)

    os.chown(approvals_file(), 12345, -1)

    assert Gate(Approvals()).unapproved(found)


def test_blocks_alone_ask_nothing(make: Maker) -> None:
    editor = build(make.language, [STARTED, B("robot.say", {"text": "Hello"})])
    build(make.language, [B("robots.robot")], page="robots", editor=editor)

    assert not concerns_of(editor.project, make.language, make.folder)


def test_what_we_ship_is_known_by_its_content_wherever_it_is(make: Maker) -> None:
    for path in sorted(paths.examples().glob("*.nep")):
        project = load(path, make.language)

        found = concerns_of(project, make.language, make.folder)

        assert not Gate(Approvals()).unapproved(found), path.name


@pytest.mark.parametrize("trap_of", TRAPS)
def test_looking_at_a_project_runs_nothing(make: Maker, trap_of: Callable[[Maker], Trap]) -> None:
    trap = trap_of(make)

    check([file_of(trap, make)])
    code([file_of(trap, make)])
    code(["--nodes", file_of(trap, make)])

    assert not trap.has_sprung()


def test_a_comment_does_not_ask_again_and_a_letter_of_python_does(make: Maker) -> None:
    editor = build(make.language, [STARTED, B("code.lines", {"code": make.python})])
    gate = Gate(Approvals())
    gate.approve(concerns_of(editor.project, make.language, make.folder))
    python = next(b.id for b in editor.project.blocks.values() if b.type == "code.lines")

    def asked() -> int:
        return len(gate.unapproved(concerns_of(editor.project, make.language, make.folder)))

    editor.apply(SetComment(python, "what a nice day"))
    assert asked() == 0
    editor.apply(SetField(python, "code", make.python + "#"))
    assert asked() == 1


def test_a_file_beside_the_project_counts_by_its_bytes(make: Maker) -> None:
    (make.folder / "wave.csv").write_text("1", encoding="utf-8")
    project = load(make.with_node("sensory/replay", recording="wave.csv").file, make.language)
    gate = Gate(Approvals())
    gate.approve(concerns_of(project, make.language, make.folder))
    assert not gate.unapproved(concerns_of(project, make.language, make.folder))

    (make.folder / "wave.csv").write_text("2", encoding="utf-8")

    assert gate.unapproved(concerns_of(project, make.language, make.folder))


def test_what_an_own_node_imports_from_beside_it_counts_too(make: Maker) -> None:
    folder = make.folder.parent / "nodes" / "sensory"
    (folder / "helper.py").write_text("from . import deeper", encoding="utf-8")
    (folder / "deeper").mkdir()
    deeper = folder / "deeper" / "__init__.py"
    deeper.write_text("", encoding="utf-8")
    gift = folder / "gift.py"
    gift.write_text("import helper\n" + gift.read_text(encoding="utf-8"), encoding="utf-8")
    project = load(make.with_node("sensory/gift").file, make.language)
    gate = Gate(Approvals())
    gate.approve(concerns_of(project, make.language, make.folder))
    assert not gate.unapproved(concerns_of(project, make.language, make.folder))

    deeper.write_text(make.python, encoding="utf-8")

    assert gate.unapproved(concerns_of(project, make.language, make.folder))


def test_a_file_of_a_terabyte_holds_nobody_up(make: Maker) -> None:
    with (make.folder / "wave.csv").open("wb") as file:
        file.truncate(1 << 40)
    project = load(make.with_node("sensory/replay", recording="wave.csv").file, make.language)
    gate = Gate(Approvals())

    gate.approve(concerns_of(project, make.language, make.folder))
    assert not gate.unapproved(concerns_of(project, make.language, make.folder))
    os.utime(make.folder / "wave.csv")

    assert gate.unapproved(concerns_of(project, make.language, make.folder))


def test_a_file_that_was_swapped_is_noticed_though_its_size_and_time_are_the_same(
    make: Maker,
) -> None:
    wave = make.folder / "wave.csv"
    wave.write_text("1", encoding="utf-8")
    project = load(make.with_node("sensory/replay", recording="wave.csv").file, make.language)
    gate = Gate(Approvals())
    gate.approve(concerns_of(project, make.language, make.folder))
    stamp = wave.stat()

    other = make.folder / "other.csv"
    other.write_text("2", encoding="utf-8")
    other.replace(wave)
    os.utime(wave, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))

    assert gate.unapproved(concerns_of(project, make.language, make.folder))


def test_a_file_that_is_swapped_just_after_the_look_does_not_start(
    make: Maker, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What starts is what was looked at: approved is the old one, and the new one is refused."""
    wave = make.folder / "wave.csv"
    wave.write_text("1", encoding="utf-8")
    project = load(make.with_node("sensory/replay", recording="wave.csv").file, make.language)
    subject = Subject(project, make.language, make.folder)
    network = LocalNetwork(logs=tmp_path)
    network.gate.approve(concerns_of(project, make.language, make.folder))
    begun: list[Request] = []
    controller = RunController(lambda: network, lambda: subject, lambda do: do(), lambda _: None)
    monkeypatch.setattr(controller, "start", begun.append)
    looked = network.gate.unapproved

    def look_and_swap(concerns: list) -> list:
        left = looked(concerns)
        wave.write_text("swapped", encoding="utf-8")
        return left

    request = Request(Code("pass", ("",)), tuple(subject.nodes()))
    with monkeypatch.context() as patch:
        patch.setattr(network.gate, "unapproved", look_and_swap)
        assert controller.begin(subject, request) and begun

    with pytest.raises(NotApproved):
        network.start(request.nodes)
    network.close()


@pytest.mark.parametrize(
    "address",
    [
        *("[::1].stranger.org:9559", "[127.0.0.1]x:9559", "127.0.0.1:9559@stranger.org", "[::1"),
        *("127.0.0.1 stranger.org", "localhost.stranger.org", "127.1", "0", "0.0.0.0", "[]x"),
        *("::ffff:203.0.113.7", "tcp://tcp://127.0.0.1", ":80:x"),
    ],
)
def test_an_address_that_only_begins_as_this_computer_is_asked_about(address: str) -> None:
    assert not is_here(address)
    assert all(is_here(own) for own in ("127.0.0.1:9559", "localhost", "::1", "[::1]:9559"))


def test_to_take_a_robot_over_is_asked_about_also_where_its_address_is_known(make: Maker) -> None:
    settings = {"driver": "naoqi", "address": "203.0.113.7"}
    gate = Gate(Approvals())
    node = PlannedNode("action/nao", "nao", settings)
    gate.approve([node_concern(node)])
    gate.check_node(node)

    with pytest.raises(NotApproved):
        gate.check_node(PlannedNode("action/nao", "nao", {**settings, "take_over": True}))


# A way to start something that was made later, and knows nothing of the question.


def test_a_session_that_was_planted_starts_nothing(make: Maker, tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(make.python, encoding="utf-8")
    network = LocalNetwork(logs=tmp_path)

    with pytest.raises(NotApproved), Session([], network, program=program):
        pass  # it does not come to this
    network.close()

    assert not make.marker.exists()


@pytest.mark.parametrize("node", ["sensory/gift", "sensory/gift_command", "cognitive/program"])
def test_a_node_that_was_planted_does_not_start(make: Maker, tmp_path: Path, node: str) -> None:
    network = LocalNetwork(logs=tmp_path)

    with pytest.raises((NotApproved, NotForPages)):
        network.start([PlannedNode(node, "gift", {"marker": str(make.marker)})])
    network.close()

    assert not make.marker.exists()


def test_no_name_and_no_value_forges_a_line_of_what_is_told() -> None:
    """The lines below look like ours: a person would take them for what we say."""
    settings = {
        "address": "203.0.113.7\n    Approved by NEP Studio\u202e\x1b[2J",
        "driver": "naoqi",
    }
    node = PlannedNode("action/nao", "nao\n\nAll of it is safe", settings)

    concern = node_concern(node)
    assert concern is not None
    told = list(listing([concern]))

    assert len(told) == 3
    assert "U+000A" in told[0] and "U+000A" in told[2] and "U+202E" in told[2]
    assert not any("\n" in line or "\x1b" in line for line in told)


def test_what_a_strangers_robot_says_does_not_steer_the_terminal_as_json_either(
    make: Maker, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    said = "\x9b31m\u202e\x7f\x1b[2J"
    request = m.ActionRequest(id="1", robots=["NAO"], action="say", args={"text": said})

    run.Printer(make.language, as_json=True).hear(m.ACTION_REQUEST, request)

    told = capfdbinary.readouterr().out.decode()
    assert not [sign for sign in said if sign in told and not sign.isalnum() and sign != "["]
    assert msgspec.json.decode(told)["args"]["text"] == said


# Which files of a project a node may be given.


@pytest.mark.parametrize(
    "named",
    [
        *("../secret.csv", "..\\secret.csv", "inside/../../secret.csv", "link.csv", "links/a.csv"),
        *("/etc/hostname", "C:\\a.csv", "C:a.csv", "\\\\server\\share\\a.csv", "//server/a.csv"),
        *("wave.csv ", "wave.csv.", " wave.csv", "NUL", "wave.csv:stream", "wave\0.csv", "x" * 300),
        *("", 3, True, "none.csv", "wave\u202e.csv"),
    ],
)
def test_a_file_that_is_not_inside_the_folder_is_no_file_of_the_project(
    tmp_path: Path, named: object
) -> None:
    folder = tmp_path / "project"
    (folder / "inside").mkdir(parents=True)
    (folder / "wave.csv").write_text("")
    (tmp_path / "secret.csv").write_text("")
    (tmp_path / "a.csv").write_text("")
    if os.name == "posix":
        (folder / "link.csv").symlink_to(tmp_path / "secret.csv")
        (folder / "links").symlink_to(tmp_path)
        (folder / "wave.csv ").write_text("")

    assert file_inside(folder, named) is None
    assert file_inside(folder, "wave.csv") == folder / "wave.csv"


def test_nobody_looks_for_a_file_on_another_computer(make: Maker, monkeypatch) -> None:
    """Windows would tell that computer the person's name and the hash of their password."""
    trap = make.with_node("sensory/replay", recording="\\\\stranger\\share\\a.csv")
    looked = []
    exists = Path.exists
    monkeypatch.setattr(Path, "exists", lambda path: looked.append(str(path)) or exists(path))

    assert check([str(trap.file)]) == 1
    assert not [path for path in looked if "stranger\\" in path]


def test_what_stands_far_to_the_right_or_cannot_be_seen_has_signs() -> None:
    hidden = f"1{' ' * 3000}or evil()\u202e # \x1b[2J\n    pass"

    told = plainly(hidden)

    assert len(told) < 100
    assert "3000" in told and "evil()" in told
    assert "U+202E" in told and "U+001B" in told
    assert told.endswith("\n    pass")

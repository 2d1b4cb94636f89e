"""Which parts of a stranger's project count as the person's own, after they have edited it."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.files import load
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.operations.copying import copy, paste
from nep_studio.blocks.operations.fixes import use_real_robot
from nep_studio.project.trust import Approvals, Authorship
from nep_studio.run.gate import Gate, brought_by, concerns_of
from tests.blocks.block_building import B, build
from tests.nep_studio.run.hostile_projects import STARTED, Maker

pytestmark = pytest.mark.strangers
FAR = "203.0.113.7"
ROBOT = {"name": "NAO", "driver": "naoqi", "address": FAR}


class Opened:
    """A project that came in, in an editor whose edits are followed."""

    def __init__(self, make: Maker, *stacks: list[B], page: str = "behaviour") -> None:
        self.make = make
        file = make.save(build(make.language, *stacks, page=page))
        self.project = load(file, make.language)
        self.editor = Editor(self.project, make.language)
        self.authorship = Authorship(self.editor, Approvals(), self._brought_by)

    def block(self, block_type: str) -> str:
        return next(b.id for b in self.project.blocks.values() if b.type == block_type)

    def set(self, block_type: str, field: str, value: object) -> None:
        self.editor.apply(SetField(self.block(block_type), field, value))

    def settings(self, **values: object) -> None:
        block = self.project.blocks[self.block("nodes.launch")]
        self.set("nodes.launch", "parameters", {**block.fields["parameters"], **values})

    def apply(self, old: str, new: str) -> None:
        """Change the text in the Python view, as the window does."""
        text = generate_program(self.project, self.make.language).text
        assert old in text
        with self.editor.history.as_own():
            update_from_python(self.editor, text.replace(old, new))

    def approve(self) -> None:
        Gate(Approvals()).approve(concerns_of(self.project, self.make.language, self.make.folder))
        self.authorship.look_again()

    def asks(self) -> list[str]:
        """What a person would be asked about at Run."""
        self.authorship.keep()
        found = concerns_of(self.project, self.make.language, self.make.folder)
        return [one.kind for one in Gate(Approvals()).unapproved(found)]

    def _brought_by(self, block):
        return brought_by(block, self.project, self.make.language, self.make.folder)


def python_of(make: Maker) -> Opened:
    return Opened(make, [STARTED, B("code.lines", {"code": make.python}), B("robot.say")])


def test_what_a_person_empties_and_takes_back_is_a_strangers_still(make: Maker) -> None:
    opened = python_of(make)

    opened.set("code.lines", "code", "")
    assert opened.asks() == []
    opened.editor.history.undo()

    assert opened.asks() == ["python"]


def test_what_a_person_writes_in_an_emptied_block_is_their_own(make: Maker) -> None:
    opened = python_of(make)

    opened.set("code.lines", "code", "")
    opened.set("code.lines", "code", "x = 1")

    assert opened.asks() == []


@pytest.mark.parametrize(
    ("code", "old", "new"),
    [
        ("def f():\n    return 1\n\n\nX = {value}\n\n\ndef g():\n    return X", "Hello", "Hi"),
        ("X = {value}\ndef f():\n    return X", "Hello", "Hi"),
    ],
)
def test_python_that_is_cut_when_the_text_is_applied_is_a_strangers_still(
    make: Maker, code: str, old: str, new: str
) -> None:
    program = [B("code.program", {"code": code.format(value=make.value)})]
    opened = Opened(make, program, [STARTED, B("robot.say", {"text": "Hello"})])

    opened.apply(old, new)

    assert "python" in opened.asks()


def test_a_strangers_value_in_a_line_of_the_persons_is_a_strangers_still(make: Maker) -> None:
    wait = B("control.wait", inputs={"seconds": B("code.value", {"code": make.value})})
    opened = Opened(make, [STARTED, wait])

    opened.apply(make.value, f"{make.value} + 1")

    assert "python" in opened.asks()


def test_after_the_yes_what_is_written_as_python_is_the_persons(make: Maker) -> None:
    opened = python_of(make)
    opened.approve()

    opened.apply(make.python, f"{make.python}; x = 1")

    assert opened.asks() == []


@pytest.mark.parametrize("driver", ["naoqi", "virtual"])
def test_an_address_that_came_in_is_not_chosen_with_the_driver(make: Maker, driver: str) -> None:
    opened = Opened(make, [B("robots.robot", {**ROBOT, "driver": driver})], page="robots")

    opened.set("robots.robot", "driver", "virtual")
    assert opened.asks() == []
    opened.set("robots.robot", "driver", "naoqi")

    assert opened.asks() == ["robot"]


def test_an_address_that_is_typed_is_the_persons(make: Maker) -> None:
    opened = Opened(make, [B("robots.robot", {**ROBOT, "driver": "virtual"})], page="robots")

    opened.set("robots.robot", "driver", "naoqi")
    opened.set("robots.robot", "address", "203.0.113.8")

    assert opened.asks() == []


def test_a_robot_that_is_pasted_is_a_strangers_whatever_is_switched(make: Maker) -> None:
    theirs = Opened(make, [B("robots.robot", {**ROBOT, "driver": "virtual"})], page="robots")
    opened = Opened(make, [STARTED])

    clip = copy(theirs.project, make.language, [theirs.block("robots.robot")])
    paste(opened.editor, clip, "robots", 0, 0)
    opened.set("robots.robot", "driver", "naoqi")

    assert opened.asks() == ["robot"]


def test_a_node_of_the_persons_stays_so_when_it_is_deleted_and_taken_back(make: Maker) -> None:
    opened = Opened(make, [STARTED])
    with opened.editor.history.as_own():
        build(make.language, [B("robots.robot", ROBOT)], page="robots", editor=opened.editor)
    assert opened.asks() == []

    opened.editor.apply(DeleteBlocks(opened.block("robots.robot"), 1))
    opened.editor.history.undo()

    assert opened.asks() == []


def test_a_file_that_is_swapped_is_asked_about_whatever_else_was_typed(make: Maker) -> None:
    (make.folder / "wave.csv").write_text("time,x\n0,1\n")
    settings = {"recording": "wave.csv", "speed": 1.0}
    node = B("nodes.launch", {"node": "sensory/replay", "name": "r", "parameters": settings})
    opened = Opened(make, [node], page="nodes")
    assert opened.asks() == ["node"]
    opened.approve()
    opened.settings(speed=2.0)
    assert opened.asks() == []

    (make.folder / "wave.csv").write_text("time,x\n0,9\n")
    before = opened.asks()
    opened.settings(speed=3.0)

    assert before == opened.asks() == ["node"]


def test_the_swapped_code_of_a_node_is_asked_about_whatever_was_typed(
    make: Maker, tmp_path: Path
) -> None:
    node = {"node": "sensory/gift", "name": "gift", "parameters": {}}
    opened = Opened(make, [B("nodes.launch", node)], page="nodes")
    assert opened.asks() == ["node"]
    opened.approve()
    opened.set("nodes.launch", "name", "another")
    assert opened.asks() == []

    code = next(tmp_path.rglob("gift.py"))
    code.write_text(code.read_text() + "\n# swapped\n")
    before = opened.asks()
    opened.set("nodes.launch", "name", "one more")

    assert before == opened.asks() == ["node"]


@pytest.mark.parametrize("model", ["evilbot", "nao2", "a/b"])
def test_a_folder_that_is_no_robot_of_ours_is_told(make: Maker, model: str) -> None:
    node = {"node": "action/nao", "name": "NAO2", "parameters": {"robot": "NAO2", "model": model}}

    assert Opened(make, [B("nodes.launch", node)], page="nodes").asks() == ["node"]


def test_a_robot_of_ours_is_no_file(make: Maker) -> None:
    node = {"node": "action/nao", "name": "P", "parameters": {"robot": "P", "model": "pepper"}}

    assert Opened(make, [B("nodes.launch", node)], page="nodes").asks() == []


@pytest.mark.parametrize("value", ["nao", "a"])
def test_a_file_counts_as_one_whatever_it_is_called(make: Maker, value: str) -> None:
    settings = {"recording": value}
    node = B("nodes.launch", {"node": "sensory/replay", "name": "r", "parameters": settings})

    assert Opened(make, [node], page="nodes").asks() == ["node"]


@pytest.mark.parametrize(
    "piece",
    ["{0}", "x = 1\n{0}", "x = {0}", "if 1: {0}  # mine", "# mine\n#{0}"],
)
def test_a_strangers_line_in_a_block_of_ones_own_is_a_strangers_still(
    make: Maker, piece: str
) -> None:
    python = f"x = 5\n{make.python}"
    mine = B("code.lines", {"code": "y = 1"})
    opened = Opened(make, [STARTED, B("code.lines", {"code": python})], [STARTED, mine])
    first, second = (b.id for b in opened.project.blocks.values() if b.type == "code.lines")

    opened.editor.apply(DeleteBlocks(first, 1))
    for text in ("z = 1", piece.format(make.python)):
        opened.editor.apply(SetField(second, "code", text))

    assert opened.asks() == ["python"]


def test_a_part_of_a_strangers_value_is_a_strangers_still(make: Maker) -> None:
    def wait(code: str) -> B:
        return B("control.wait", inputs={"seconds": B("code.value", {"code": code})})

    opened = Opened(make, [STARTED, wait(f"{make.value} or 1"), wait("1 + 1")])
    first, second = (b.id for b in opened.project.blocks.values() if b.type == "code.value")

    opened.editor.apply(SetField(second, "code", make.value))
    opened.editor.apply(DeleteBlocks(first, 1))

    assert opened.asks() == ["python"]


def test_python_that_is_gone_before_a_yes_to_something_else_comes_back_a_strangers(
    make: Maker,
) -> None:
    opened = Opened(make, [STARTED, B("code.lines", {"code": f"a = 1\n{make.python}"})])
    build(make.language, [B("robots.robot", ROBOT)], page="robots", editor=opened.editor)
    text = generate_program(opened.project, make.language).text

    opened.editor.apply(DeleteBlocks(opened.block("code.lines"), 1))
    opened.approve()
    with opened.editor.history.as_own():
        update_from_python(opened.editor, text.replace("a = 1", "a = 2"))

    assert opened.asks() == ["python"]


@pytest.mark.parametrize("is_known", [True, False])
def test_a_yes_to_a_model_is_none_to_an_address_beside_it(make: Maker, is_known: bool) -> None:
    settings = {"robot": "N", "driver": "virtual", "model": "ourbot"}
    node = {"node": "action/nao", "name": "N", "parameters": settings}
    if is_known:
        Opened(make, [B("nodes.launch", node)], page="nodes").approve()
    far = {**node, "parameters": {**settings, "address": FAR}}
    opened = Opened(make, [B("nodes.launch", far)], page="nodes")
    if not is_known:
        opened.approve()
    assert opened.asks() == []

    opened.settings(driver="naoqi")

    assert opened.asks() == ["robot"]


def test_a_file_that_comes_after_the_yes_is_asked_about(make: Maker) -> None:
    settings = {"recording": "late.csv", "speed": 1.0}
    node = B("nodes.launch", {"node": "sensory/replay", "name": "r", "parameters": settings})
    opened = Opened(make, [node], page="nodes")
    opened.approve()

    (make.folder / "late.csv").write_text("time,x\n0,1\n")
    opened.settings(speed=2.0)

    assert opened.asks() == ["node"]


def test_a_robot_that_is_connected_here_is_the_persons(make: Maker) -> None:
    opened = Opened(make, [STARTED])

    with opened.editor.history.as_own():
        use_real_robot(opened.editor, "NAO", FAR, "connect a robot")

    assert opened.asks() == []

"""A dozen projects of strangers: each does one thing, as soon as it may, that a test can see."""

from __future__ import annotations

import socket
import sys
import zipfile
from collections.abc import Callable
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from pathlib import Path

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetFlag
from nep_studio.blocks.edits.project import AddPage
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.language import Language
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import Parameter
from nep_studio.project.picture_files import png_with_program
from tests.blocks.block_building import B, add, build

STARTED = B("event.started")
FOREVER = B("control.wait", {"seconds": 600})
NODE = """
def run(node, *, marker, token="", through=""):
    open(marker, "w").close()
    node.ready()
    while not node.wait(60):
        pass
"""
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010806000000"
    "1f15c4890000000d49444154789c6360606060000000050001a5f64540"
    "0000000049454e44ae426082"
)


@dataclass(frozen=True)
class Trap:
    """A project in its folder: the file to open, and whether it has done what it is there for."""

    file: Path
    has_sprung: Callable[[], bool]
    tells: str = ""
    """What a person must be shown, whole."""
    is_never: bool = False
    """Whether it may not run, even if somebody approves it."""


@dataclass
class Maker:
    """Makes the projects in a folder, in which there are nodes of one's own too."""

    folder: Path
    language: Language
    ending: ExitStack

    @property
    def marker(self) -> Path:
        return self.folder / "marker"

    @property
    def python(self) -> str:
        """Python that leaves a mark."""
        return f"open({str(self.marker)!r}, 'w').close()"

    @property
    def value(self) -> str:
        return f"__import__('pathlib').Path({str(self.marker)!r}).write_text('')"

    def save(self, editor: Editor, name: str = "gift.nep") -> Path:
        path = self.folder / name
        path.write_bytes(to_bytes(editor.project))
        return path

    def trap(self, *stacks: list[B], tells: str = "") -> Trap:
        return self.of(build(self.language, *stacks), tells)

    def of(self, editor: Editor, tells: str = "", *, is_never: bool = False) -> Trap:
        return Trap(self.save(editor), self.marker.exists, tells, is_never)

    def with_node(self, node: str, is_never: bool = False, **settings: object) -> Trap:
        editor = build(self.language, [STARTED, FOREVER])
        fields = {"node": node, "name": "gift", "parameters": settings}
        build(self.language, [B("nodes.launch", fields)], page="nodes", editor=editor)
        return self.of(editor, "", is_never=is_never)


def lines(make: Maker) -> Trap:
    return make.trap([STARTED, B("code.lines", {"code": make.python}), FOREVER], tells=make.python)


def value(make: Maker) -> Trap:
    wait = B("control.wait", inputs={"seconds": B("code.value", {"code": make.value})})
    return make.trap([STARTED, wait, FOREVER], tells=make.value)


def far_to_the_right(make: Maker) -> Trap:
    text = f"0{' ' * 3000}or {make.value}"
    wait = B("control.wait", inputs={"seconds": B("code.value", {"code": text})})
    return make.trap([STARTED, wait, FOREVER], tells=make.value)


def folded(make: Maker) -> Trap:
    inner = B("control.repeat", bodies={"do": [B("code.lines", {"code": make.python})]})
    editor = build(make.language, [STARTED, inner, FOREVER])
    block = next(one for one in editor.project.blocks.values() if one.bodies)
    editor.apply(SetFlag(block.id, "collapsed", True))
    return make.of(editor, make.python)


def in_an_own_block(make: Maker) -> Trap:
    editor = build(make.language, [STARTED])
    place = editor.new_stack("behaviour", 400, 40)
    name = editor.add_procedure(("greet", Parameter("a1", "who")), place=place)
    add(editor, B("code.lines", {"code": make.python}), InStack(place.stack, 1))
    start = next(iter(editor.project.pages["behaviour"]))
    add(editor, B(f"my.call.{name}"), InStack(start.id, 1))
    add(editor, FOREVER, InStack(start.id, 2))
    return make.of(editor, make.python)


def on_another_page(make: Maker) -> Trap:
    editor = build(make.language, [STARTED, FOREVER])
    editor.apply(AddPage("p9", "Notes", 3))
    build(
        make.language,
        [STARTED, B("code.lines", {"code": make.python})],
        page="p9",
        editor=editor,
    )
    return make.of(editor, make.python)


def after_many_lines(make: Maker) -> Trap:
    text = "\n".join([*("pass" for _ in range(900)), make.python])
    return make.trap([STARTED, B("code.lines", {"code": text}), FOREVER], tells=make.python)


def in_a_picture(make: Maker) -> Trap:
    trap = lines(make)
    picture = make.folder / "postcard.png"
    picture.write_bytes(png_with_program(PNG, trap.file.read_bytes()))
    return Trap(picture, trap.has_sprung, make.python)


def own_node(make: Maker) -> Trap:
    return make.with_node("sensory/gift", marker=str(make.marker))


def own_command(make: Maker) -> Trap:
    return make.with_node("sensory/gift_command", marker=str(make.marker))


def robot_elsewhere(make: Maker) -> Trap:
    """A robot at an address that does not look like this computer."""
    door = make.ending.enter_context(socket.create_server(("127.0.0.1", 0)))
    door.setblocking(False)
    callers = []

    def has_sprung() -> bool:
        with suppress(BlockingIOError):
            callers.append(make.ending.enter_context(door.accept()[0]))
        return bool(callers)

    editor = build(make.language, [STARTED, B("robot.say", {"text": "Hello"}), FOREVER])
    fields = {"driver": "naoqi", "address": f"127.1:{door.getsockname()[1]}"}
    build(make.language, [B("robots.robot", fields)], page="robots", editor=editor)
    return Trap(make.save(editor), has_sprung, fields["address"])


def open_door(make: Maker) -> Trap:
    """A node that listens to the whole network."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]

    def has_sprung() -> bool:
        with socket.socket() as knock:
            return knock.connect_ex(("127.0.0.1", port)) == 0

    settings = {"through": "tcp", "listen_on": "network", "port": port}
    trap = make.with_node("sensory/smartwatch", **settings)
    return Trap(trap.file, has_sprung, str(port))


def all_in_one(make: Maker) -> list[Trap]:
    """Four of them in one project: Python far to the right, a node, a command and a door."""
    door = open_door(make)
    markers = [make.folder / f"marker{number}" for number in range(3)]
    python = f"__import__('pathlib').Path({str(markers[0])!r}).write_text('')"
    code = B("code.value", {"code": f"0{' ' * 3000}or {python}"})
    editor = build(make.language, [STARTED, B("control.wait", inputs={"seconds": code}), FOREVER])
    settings = {"through": "tcp", "listen_on": "network", "port": int(door.tells)}
    nodes = [
        ("sensory/gift", {"marker": str(markers[1])}),
        ("sensory/gift_command", {"marker": str(markers[2])}),
        ("sensory/smartwatch", settings),
    ]
    for number, (node, parameters) in enumerate(nodes):
        fields = {"node": node, "name": f"gift{number}", "parameters": parameters}
        build(make.language, [B("nodes.launch", fields)], page="nodes", editor=editor)
    file = make.save(editor)
    return [*(Trap(file, marker.exists) for marker in markers), Trap(file, door.has_sprung)]


def program_node(make: Maker) -> Trap:
    (make.folder / "helper.py").write_text(make.python, encoding="utf-8")
    return make.with_node("cognitive/program", is_never=True, file="helper.py")


def picture_that_is_a_program(make: Maker) -> Trap:
    picture = make.folder / "photo.png"
    picture.write_bytes(PNG)
    with zipfile.ZipFile(picture, "a") as packed:
        packed.writestr("__main__.py", make.python)
    return make.with_node("cognitive/program", is_never=True, file="photo.png")


TRAPS = (
    *(lines, value, far_to_the_right, folded, in_an_own_block, on_another_page, after_many_lines),
    *(in_a_picture, own_node, own_command, robot_elsewhere, open_door),
    *(program_node, picture_that_is_a_program),
)


def own_nodes(folder: Path) -> Path:
    """A folder with nodes that do not come with NEP Studio."""
    sensory = folder / "nodes" / "sensory"
    sensory.mkdir(parents=True)
    (sensory / "gift.py").write_text(NODE, encoding="utf-8")
    parts = 'title = "Gift"\ndescription = "A gift."\ntype = "sensory"\n'
    marker = '[parameters.marker]\ntype = "text"\ndefault = ""\n'
    (sensory / "gift.toml").write_text(f'{parts}name = "gift"\n{marker}', encoding="utf-8")
    code = "import sys; open([w for w in sys.argv if w.startswith('marker=')][0][7:], 'w').close()"
    command = [sys.executable, "-c", code]
    (sensory / "gift_command.toml").write_text(
        f'{parts}name = "gift_command"\ncommand = {command!r}\nrestart = "never"\n{marker}',
        encoding="utf-8",
    )
    return folder / "nodes"

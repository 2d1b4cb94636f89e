"""A stranger's project in the window: asked about before anything of it runs, whoever starts it."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QAbstractItemView, QLabel, QWidget
from pytestqt.qtbot import QtBot

from nep_core.places import NODES_VARIABLE
from nep_core.wire.messages import RobotState
from nep_studio import paths
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.operations.copying import copy, paste
from nep_studio.project.trust import Concern
from nep_studio.run.installation import studio_language
from nep_studio.run.plan import PlannedNode
from nep_studio.settings import ShowOptions
from nep_studio.ui.message_cards import MessageCard
from nep_studio.ui.messages import Message
from nep_studio.ui.plugins.robots.participants import robots_of
from nep_studio.ui.plugins.show import ShowMode
from nep_studio.ui.plugins.watches.dialog import WatchTrial
from nep_studio.ui.robot_view.view import folder_of
from nep_studio.ui.running.needs import NeedsDialog
from nep_studio.ui.running.trust import MOST_CARDS, TrustDialog
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.speech.robot_voices import PLAYING, RobotSounds
from robots.body.sense_tasks import found
from tests.blocks.block_building import B, build
from tests.nep_studio.run.hostile_projects import (
    FOREVER,
    STARTED,
    TRAPS,
    Maker,
    Trap,
    after_many_lines,
    folded,
    in_a_picture,
    in_an_own_block,
    lines,
    on_another_page,
    open_door,
    own_node,
    robot_elsewhere,
    value,
)
from tests.ui.running.window_use import press, state_is
from tests.ui.window.conftest import answer, chooser, home, studio, window

__all__ = ["answer", "chooser", "home", "studio", "window"]

pytestmark = [pytest.mark.strangers, pytest.mark.long]
ASKED = tuple(trap for trap in TRAPS if "program" not in trap.__name__)
A_WHILE_MS = 300
LONG_MS = 60_000
"""A program may take so long to begin on a computer that is busy."""


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Maker]:
    """Made before the window, which then knows the strangers' nodes."""
    from tests.nep_studio.run.hostile_projects import own_nodes

    monkeypatch.setenv(NODES_VARIABLE, str(own_nodes(tmp_path)))
    folder = tmp_path / "from a stranger"
    folder.mkdir()
    with ExitStack() as ending:
        yield Maker(folder, studio_language(), ending)


class Dozen:
    """Strangers' projects in folders of their own, opened one after the other in one window."""

    def __init__(self, make: Maker, window: MainWindow, qtbot: QtBot) -> None:
        self._make, self._window, self._qtbot = make, window, qtbot
        self._traps: dict[str, Trap] = {}

    def open_each(self, kinds: Iterable[Callable[[Maker], Trap]], more: str = "") -> Iterator[Trap]:
        for trap_of in kinds:
            name = f"{trap_of.__name__} {more}"
            print(name)  # which one it was, when one fails
            folder = self._make.folder / name
            folder.mkdir()
            trap = trap_of(Maker(folder, self._make.language, self._make.ending))
            self._traps[name] = trap
            open_in(self._window, self._qtbot, trap.file)
            yield trap

    def sprung(self) -> list[str]:
        """Those that have done what they are there for."""
        return [name for name, trap in self._traps.items() if trap.has_sprung()]


def open_in(window: MainWindow, qtbot: QtBot, file: Path) -> None:
    before = window.files.document
    window.files.open(file)
    qtbot.waitUntil(lambda: window.files.document not in (None, before))
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())


@pytest.fixture
def dozen(make: Maker, studio: Studio, window: MainWindow, qtbot: QtBot) -> Dozen:
    studio.language = make.language
    return Dozen(make, window, qtbot)


@pytest.fixture
def stranger(make: Maker, studio: Studio, window: MainWindow, qtbot: QtBot) -> Callable[..., Trap]:
    """Opens a stranger's project in the window."""
    studio.language = make.language

    def open_(trap_of: Callable[[Maker], Trap]) -> Trap:
        trap = trap_of(make)
        open_in(window, qtbot, trap.file)
        return trap

    return open_


def dialog_of(window: QWidget) -> TrustDialog | None:
    shown = [one for one in window.findChildren(TrustDialog) if one.isVisible()]
    return shown[0] if shown else None


def asked(window: QWidget, qtbot: QtBot) -> TrustDialog:
    qtbot.waitUntil(lambda: dialog_of(window) is not None)
    dialog = dialog_of(window)
    assert dialog is not None
    return dialog


def test_nothing_of_a_dozen_projects_runs_before_a_person_has_said_yes(
    dozen: Dozen, window: MainWindow, home: Path, qtbot: QtBot
) -> None:
    """All in one window, one after the other: each is asked about with all that is in it."""
    for trap in dozen.open_each(ASKED):
        press(window, qtbot, "run")
        dialog = asked(window, qtbot)

        shown = "\n".join(text.toPlainText() for text in dialog.texts)
        assert trap.tells in shown
        assert not any(text.horizontalScrollBar().maximum() for text in dialog.texts)
        assert dialog.refuse_button.isDefault() and not dialog.run_button.isDefault()
        qtbot.keyClick(dialog, Qt.Key.Key_Escape)
        qtbot.waitUntil(lambda: dialog_of(window) is None)
        assert window.running.runner.state == "idle"

    qtbot.wait(A_WHILE_MS)
    assert not dozen.sprung()
    assert not (home / "approved.json").exists()


def test_a_show_of_each_asks_too(dozen: Dozen, window: MainWindow, qtbot: QtBot) -> None:
    mode = ShowMode(window.host)
    for _ in dozen.open_each(ASKED):
        show = mode.begin(ShowOptions(runs_at_once=True))
        dialog = asked(show, qtbot)
        qtbot.keyClick(dialog, Qt.Key.Key_Escape)
        assert show.performance.state == "attention"
        show.leave()
    qtbot.wait(A_WHILE_MS)
    assert not dozen.sprung()

    for trap in dozen.open_each([lines], "and now"):
        show = mode.begin(ShowOptions(runs_at_once=True))
        qtbot.mouseClick(asked(show, qtbot).run_button, Qt.MouseButton.LeftButton)
        qtbot.waitUntil(trap.has_sprung, timeout=LONG_MS)
        window.running.close()
        show.leave()


def test_a_node_that_is_a_program_never_runs(
    dozen: Dozen, window: MainWindow, qtbot: QtBot
) -> None:
    for _ in dozen.open_each([trap_of for trap_of in TRAPS if trap_of not in ASKED]):
        press(window, qtbot, "run")
        qtbot.waitUntil(lambda: any("Python file" in str(p.sentence) for p in problems(window)))
        for dialog in window.findChildren(NeedsDialog):
            dialog.reject()

    qtbot.wait(A_WHILE_MS)
    assert not dozen.sprung()


def problems(window: MainWindow) -> list:
    return window.workbench.checks.problems


def test_what_is_approved_runs_and_is_not_asked_about_again(
    dozen: Dozen, window: MainWindow, home: Path, qtbot: QtBot
) -> None:
    kinds = [
        *(value, folded, in_an_own_block, on_another_page, after_many_lines, in_a_picture),
        *(own_node, robot_elsewhere),
    ]
    for trap in dozen.open_each(kinds):
        press(window, qtbot, "run")
        dialog = asked(window, qtbot)

        qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
        qtbot.waitUntil(lambda: dialog_of(window) is None)

        qtbot.waitUntil(trap.has_sprung, timeout=LONG_MS)
        window.running.stop()
        state_is(window, qtbot, "idle")
        press(window, qtbot, "run")
        qtbot.waitUntil(lambda: window.running.runner.state != "idle")
        assert dialog_of(window) is None
        window.running.stop()
        state_is(window, qtbot, "idle")

    if os.name == "posix":
        assert (home / "approved.json").stat().st_mode & 0o077 == 0


# Ways to start a part of it.


def test_a_node_is_asked_about_however_it_is_started(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(own_node)
    runner = window.running.runner

    runner.start_node(runner.planned()[0])

    dialog = asked(window, qtbot)
    assert not trap.has_sprung()
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(trap.has_sprung, timeout=LONG_MS)


def test_a_node_that_no_page_can_start_is_refused_in_words(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(own_node)

    helper = PlannedNode("cognitive/program", "helper", {"file": str(trap.file)})
    window.running.runner.start_node(helper)

    cards = window.message_area.cards
    qtbot.waitUntil(lambda: any("Python file" in str(one.message.sentence) for one in cards))
    assert "helper" not in window.running.runner.local.launcher.nodes


def test_to_look_at_a_strangers_watch_does_not_let_its_node_in(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    """The dialog that connects watches takes over what the project says: that is no choice."""
    trap = stranger(open_door)
    runner = window.running.runner
    planned = runner.planned()[0]
    trial = WatchTrial(runner, planned.name, window)

    trial.want(planned)

    dialog = asked(window, qtbot)
    assert not trap.has_sprung()
    dialog.reject()
    trial.end()


SHARE = "//stranger/share/a"


@pytest.mark.parametrize(
    "look",
    [
        lambda: robots_of([PlannedNode("action/nao", "nao", {"model": SHARE})]),
        lambda: folder_of(SHARE),
        lambda: found(SHARE),
        lambda: found(f"/home/nao/{SHARE}"),
        lambda: RobotSounds(QObject()).hear_state(
            RobotState(robot="nao", joints={}, settings={PLAYING: SHARE})
        ),
    ],
    ids=[
        "a robot's looks",
        "a robot that is heard",
        "a sound",
        "its sound",
        "a sound that is heard",
    ],
)
def test_nobody_looks_at_what_is_on_a_strangers_computer(
    look: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows would tell that computer the person's name and the hash of their password."""
    looked, is_file = [], Path.is_file
    monkeypatch.setattr(Path, "is_file", lambda path: looked.append(str(path)) or is_file(path))

    look()

    assert not [path for path in looked if path.startswith("//stranger")]


def test_nobody_knocks_at_a_strangers_robot_to_see_whether_it_is_there(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(robot_elsewhere)

    window.running.show_needs()
    qtbot.wait(A_WHILE_MS)

    assert not trap.has_sprung()


# What the person writes is their own; what comes in otherwise is not.


def python_block(window: MainWindow) -> str:
    blocks = window.workbench.canvas.editor.project.blocks.values()
    return next(block.id for block in blocks if block.type == "code.lines")


def runs_unasked(window: MainWindow, qtbot: QtBot, trap: Trap) -> None:
    press(window, qtbot, "run")
    qtbot.waitUntil(lambda: dialog_of(window) is not None or trap.has_sprung(), timeout=LONG_MS)
    assert dialog_of(window) is None


@pytest.fixture
def own(make: Maker, studio: Studio, window: MainWindow, qtbot: QtBot) -> Trap:
    """A new project, in which the person types what leaves a mark."""
    studio.language = make.language
    window.files.new()
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    editor = window.workbench.canvas.editor
    place = editor.new_stack("behaviour", 40, 40)
    editor.create("event.started", place)
    from nep_studio.blocks.places import InStack

    block = editor.create("code.lines", InStack(place.stack, 1))
    for end in range(1, len(make.python) + 1):  # letter by letter, as a field is typed
        editor.apply(SetField(block, "code", make.python[:end]))
    return Trap(make.folder / "gift.nep", make.marker.exists)


def test_what_the_person_typed_is_never_asked_about(
    own: Trap, window: MainWindow, qtbot: QtBot
) -> None:
    runs_unasked(window, qtbot, own)


def test_what_the_person_wrote_as_python_is_never_asked_about(
    make: Maker, own: Trap, window: MainWindow, qtbot: QtBot
) -> None:
    code = window.workbench.code
    code.begin_editing()
    text = code.text.toPlainText().replace(make.python, f"{make.python}; import os; os.getpid()")
    code.text.setPlainText(text)
    code.apply()

    runs_unasked(window, qtbot, own)


def test_what_is_pasted_is_asked_about_also_after_undo_and_redo(
    make: Maker, own: Trap, window: MainWindow, qtbot: QtBot
) -> None:
    editor = window.workbench.canvas.editor
    runs_unasked(window, qtbot, own)
    window.running.stop()
    state_is(window, qtbot, "idle")
    project = lines(Maker(make.folder / "..", make.language, make.ending)).file
    from nep_studio.blocks.files import load

    strange = load(project, make.language)
    clip = copy(strange, make.language, next(iter(strange.pages["behaviour"])).body)
    paste(editor, clip, "behaviour", 400, 40)
    for step in (lambda: None, editor.history.undo, editor.history.redo):
        step()
    press(window, qtbot, "run")

    asked(window, qtbot).reject()


def test_a_letter_more_does_not_make_a_strangers_text_ones_own(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(lines)
    editor, block = window.workbench.canvas.editor, python_block(window)
    text = editor.project.blocks[block].fields["code"]

    editor.apply(SetField(block, "code", f"{text}#"))
    press(window, qtbot, "run")

    asked(window, qtbot).reject()
    assert not trap.has_sprung()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("wait(0.5)", "wait(0.25)"),
        ("    for _", "    if True:\n      for _"),
        (".close()", ".close()\n          print(1)"),
        (".close()", ".close() #"),
        ("        open(", "          print(1)\n        open("),
    ],
    ids=["beside it", "around it", "below it", "in it", "above it"],
)
def test_who_writes_python_beside_a_strangers_does_not_take_that_over(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot, old: str, new: str
) -> None:
    trap = stranger(in_a_loop)
    code = window.workbench.code
    window.workbench.panels.show(code)
    qtbot.waitUntil(lambda: "marker" in code.text.toPlainText())
    code.begin_editing()
    code.text.setPlainText(
        code.text.toPlainText().replace(old, new).replace("        open(", "          open(")
    )
    code.apply()
    assert not code.is_editing, "it was not taken"

    press(window, qtbot, "run")

    asked(window, qtbot).reject()
    assert not trap.has_sprung()


def in_a_loop(make: Maker) -> Trap:
    wait = B("control.wait", {"seconds": 0.5})
    inner = B("control.repeat", bodies={"do": [B("code.lines", {"code": make.python})]})
    return make.trap([STARTED, wait, inner, FOREVER])


def test_what_was_approved_and_then_changed_is_ones_own(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(lines)
    press(window, qtbot, "run")
    asked(window, qtbot).accept()
    qtbot.waitUntil(trap.has_sprung, timeout=LONG_MS)
    window.running.stop()
    state_is(window, qtbot, "idle")

    editor, block = window.workbench.canvas.editor, python_block(window)
    text = editor.project.blocks[block].fields["code"]
    editor.apply(SetField(block, "code", f"{text}  # mine"))

    runs_unasked(window, qtbot, trap)


def test_ones_own_that_is_saved_and_opened_again_is_not_asked_about(
    own: Trap, window: MainWindow, qtbot: QtBot
) -> None:
    document = window.files.document
    document.save(own.file)
    window.files.open(own.file)
    qtbot.waitUntil(lambda: window.files.document is not document)

    runs_unasked(window, qtbot, own)


def test_a_file_that_another_program_changed_is_asked_about(
    make: Maker, own: Trap, window: MainWindow, qtbot: QtBot
) -> None:
    document = window.files.document
    document.save(own.file)
    text = own.file.read_text(encoding="utf-8")
    own.file.write_text(text.replace("close()", "close();"), encoding="utf-8")
    window.files.open(own.file)
    qtbot.waitUntil(lambda: window.files.document is not document)

    press(window, qtbot, "run")

    asked(window, qtbot).reject()


def test_work_that_is_recovered_is_known_by_its_content(
    make: Maker, window: MainWindow, studio: Studio, qtbot: QtBot
) -> None:
    from nep_studio.blocks.files import load
    from nep_studio.project.journal import Recoverable

    studio.language = make.language
    trap = lines(make)
    project = load(trap.file, make.language)
    window.files.restore(Recoverable("gift", None, 0.0, project, make.folder / "none"))
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())

    press(window, qtbot, "run")

    asked(window, qtbot).reject()
    assert not trap.has_sprung()


def test_an_example_of_ours_asks_nothing(window: MainWindow, qtbot: QtBot) -> None:
    from nep_studio import paths

    window.files.open_example(paths.examples() / "morning_greeter.nep")
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())

    press(window, qtbot, "run")
    qtbot.waitUntil(lambda: window.running.runner.state != "idle")

    assert dialog_of(window) is None


def test_no_name_of_a_stranger_is_shown_as_a_page_that_fetches_pictures(
    dozen: Dozen, window: MainWindow, qtbot: QtBot
) -> None:
    """On Windows, a picture on a stranger's computer tells that one who looks at it."""
    list(dozen.open_each([full_of_pictures]))
    window.running.show_needs()
    for panel in window.workbench.panels.all:
        window.host.show_panel(panel.widget)
    qtbot.waitUntil(lambda: any(PICTURE in label.text() for label in labels_of(window)))

    pages = [
        label.text()
        for label in labels_of(window)
        if PICTURE in label.text() and label.textFormat() != Qt.TextFormat.PlainText
    ]
    tips = [one.toolTip() for one in window.findChildren(QWidget)]
    for shown in window.findChildren(QAbstractItemView):
        model = shown.model()
        places = [model.index(row, 0) for row in range(model.rowCount())] if model else []
        tips += [str(one.data(Qt.ItemDataRole.ToolTipRole)) for one in places]
    assert not pages
    assert not [tip for tip in tips if PICTURE in tip]
    assert any(html.escape(PICTURE) in tip for tip in tips)
    window.findChild(NeedsDialog).reject()


PICTURE = "<img src='//stranger/a.png'>"


def labels_of(window: MainWindow) -> list[QLabel]:
    return window.findChildren(QLabel)


def full_of_pictures(make: Maker) -> Trap:
    say = B("robot.say", {"text": PICTURE})
    heard = [B("robot_events.heard", {"word": PICTURE}), B("robot.say")]
    editor = build(
        make.language, [STARTED, say, B("code.lines", {"code": f'x = "{PICTURE}"'})], heard
    )
    robot = B("robots.robot", {"driver": "naoqi", "address": PICTURE})
    build(make.language, [robot], page="robots", editor=editor)
    settings = {"node": "sensory/replay", "name": "gift", "parameters": {"recording": PICTURE}}
    build(make.language, [B("nodes.launch", settings)], page="nodes", editor=editor)
    return make.of(editor)


def test_among_hundreds_of_pieces_none_is_left_out(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(among_hundreds)
    press(window, qtbot, "run")
    dialog = asked(window, qtbot)

    shown = "\n".join(text.toPlainText() for text in dialog.texts)
    assert len(dialog.texts) == MOST_CARDS + 1
    assert trap.tells in shown
    assert all(f"piece_{number} = {number}" in shown for number in range(200))
    dialog.reject()


def among_hundreds(make: Maker) -> Trap:
    texts = [f"piece_{number} = {number}" for number in range(200)]
    blocks = [B("code.lines", {"code": text}) for text in [*texts, make.python]]
    return make.trap([STARTED, *blocks, FOREVER], tells=make.python)


def test_a_name_without_an_end_pushes_nothing_off_the_screen(
    window: MainWindow, studio: Studio
) -> None:
    name = "W" * 200
    concern = Concern("node", f"The node {name}", "x = 1", "nodes", "b1", "key")

    dialog = TrustDialog(window, studio.look, name, [concern], {"nodes": name})
    dialog.open()
    card = MessageCard(Message("info", name, name), studio.look.theme, window)

    assert dialog.width() < 900
    assert not dialog.list.horizontalScrollBar().maximum()
    assert card.minimumSizeHint().width() < 900
    dialog.reject()


def test_screen_readers_hear_what_each_text_is(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    stranger(folded)
    press(window, qtbot, "run")
    dialog = asked(window, qtbot)

    names = [text.accessibleName() for text in dialog.texts]

    assert names == ["Python, one line, page Behaviour · inside folded blocks"]
    dialog.reject()


def test_a_strangers_project_is_marked_when_it_is_opened(
    stranger: Callable[..., Trap], window: MainWindow, qtbot: QtBot
) -> None:
    trap = stranger(lines)
    cards = window.message_area.cards

    qtbot.waitUntil(lambda: any("more than blocks" in one.message.title for one in cards))
    mark = next(one.message for one in cards if "more than blocks" in one.message.title)
    mark.answers[0].do()
    dialog = asked(window, qtbot)
    assert not trap.has_sprung()
    dialog.accept()

    qtbot.waitUntil(trap.has_sprung, timeout=LONG_MS)
    assert mark not in [one.message for one in cards]


def test_a_project_of_blocks_alone_is_not_marked(window: MainWindow, qtbot: QtBot) -> None:
    open_in(window, qtbot, paths.examples() / "karate_greeting.nep")
    qtbot.wait(A_WHILE_MS)

    assert not [one for one in window.message_area.cards if one.message.kind == "info"]

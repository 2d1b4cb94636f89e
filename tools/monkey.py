"""A monkey at the window: clicks, drags and types at random, by a seed that can be repeated.

It works on a window of its own in a folder that is thrown away, through the same door as a mouse
and a keyboard: what is behind a question cannot be pressed. It fails, and says by what it was
brought about, when Python raises something, when Qt warns of a mistake, when the window stops
answering, and when there is no way back from where it is.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import logging
import os
import random
import shutil
import socket
import sys
import tempfile
import threading
import time
import traceback
from collections import Counter, deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import psutil
from PySide6.QtCore import (
    QObject,
    Qt,
    QThread,
    QTimer,
    QtMsgType,
    QUrl,
    Slot,
    qInstallMessageHandler,
)
from PySide6.QtGui import QAction, QDesktopServices
from PySide6.QtPrintSupport import QPrintDialog, QPrinterInfo
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QFileDialog, QLineEdit, QMenu, QWidget

from tools.monkey_hands import Hands

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

REMEMBERED = 40
"""So many of the last steps are told when something breaks."""

LONGEST_STEP_S = 60.0
"""A step that takes longer ends the monkey: the window hangs. The machine may be busy."""

MOST_TRIES_TO_LEAVE = 40
"""So often it presses Esc, and what says Cancel or Close, before there is no way back."""

MOST_AWAY = 25
"""After so many steps in what lies over the window, it leaves: there is more to see."""

HELD_MS = 3000
"""So long is Esc held to leave the show."""

WAYS_BACK = ("cancel", "close", "discard", "don", "no", "not now", "ok", "leave", "back", "done")
"""How buttons begin that lead back, in English."""

NEVER = frozenset({"quit"})
"""Actions that are left alone: the window would be gone, as it should."""

HARMLESS = (
    *("This plugin does not support", "QFont", "font", "libpng", "Wayland", "OpenType"),
    "QPageSetupDialog: Cannot be used on non-native printers",  # it works all the same
)
"""Words in what Qt tells that are no mistake of ours."""

SCHEMES = ("http", "https", "file", "mailto")
"""How addresses begin that would open elsewhere."""


OWN_FOLDER = (
    *("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME"),
    *("XDG_RUNTIME_DIR", "TMPDIR"),
)
"""Where programs look for the folders to write to."""


class Broken(Exception):
    """Something that must not happen has happened."""


class Monkey(QObject):
    """Does one step after the other, from a timer: so it goes on within questions, too."""

    def __init__(self, seed: int, steps: int, folder: Path, *, is_told: bool) -> None:
        super().__init__()
        from nep_studio.settings import Settings
        from nep_studio.ui.services import Studio

        self.random = random.Random(seed)
        self.steps, self.done, self.folder, self.is_told = steps, 0, folder, is_told
        self.last: deque[str] = deque(maxlen=REMEMBERED)
        self.used: dict[str, int] = {}
        self.offered: set[str] = set()
        self.faults: list[str] = []
        self.windows = 0
        self.seen: Counter[str] = Counter()
        """In how many steps it was in a kind of window, a dialog, a panel, a running program."""
        self.slowest = (0.0, "")
        self._hands = Hands(self.random, self._note)
        self._pause_ms, self._away = 0, 0
        self._busy: int | None = None
        """How many event loops there were when the step began that is being done."""
        self._began = time.monotonic()
        self._tries_left = 0
        """How often it tries yet to come back to the window; 0 while it plays."""
        self._left: QWidget | None = None
        """Where it has pressed Esc last to leave."""
        self._is_resting = False
        self._turns = QTimer(self, singleShot=True)
        self._turns.timeout.connect(self._on_turn)
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        settings = Settings(self.folder / "home")
        settings.language = "en"
        self.studio = Studio(app, settings)
        self.window = self._open()

    # The window

    def _open(self) -> MainWindow:
        from nep_studio.ui.shell.main_window import MainWindow

        window = MainWindow(self.studio)
        window.show()
        window.start(None)
        self.windows += 1
        return window

    def _close(self) -> None:
        """End as the program does, with all that was begun since the window was closed."""
        for widget in QApplication.topLevelWidgets():
            widget.hide()
        self.window.close_now()
        if self.window.services.made_running is not None:
            self.window.running.close()

    def _reopen(self) -> None:
        self._close()
        self.window.deleteLater()
        self.window = self._open()

    def run(self) -> None:
        """Do all steps; raises Broken."""
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        app.setQuitOnLastWindowClosed(False)
        self._turns.start(0)
        app.exec()
        if self.faults:
            raise Broken(self.faults[0])

    @Slot()
    def step(self) -> None:
        """Do one thing; the next one follows also when this one waits for an answer to it."""
        loops = QThread.currentThread().loopLevel()
        if self._busy is not None and loops <= self._busy:
            self._turns.start(20)  # Qt only looks for events: hands are still full
            return
        faulthandler.dump_traceback_later(LONGEST_STEP_S, exit=True)
        self._take_time()
        self._hands.let_go()
        if self.faults or (self.done >= self.steps and not self._tries_left):
            self._end()
            return
        self._is_resting = True
        self._turns.start(0)
        around, self._busy = self._busy, loops
        try:
            if self._tries_left:
                self._go_back()
                return
            self.done += 1
            if self.done % 250 == 0 or self.done == self.steps:
                self._tries_left = MOST_TRIES_TO_LEAVE
            self._do_something()
        except RuntimeError as error:  # a widget that was deleted by what was done to it
            if "already deleted" not in str(error):
                raise
        finally:
            self._busy = around

    @Slot()
    def _on_turn(self) -> None:
        """First rest after a step, then do the next one."""
        if self._is_resting:
            self._is_resting = False
            self._turns.start(self._pause_ms)
        else:
            self.step()

    def _take_time(self) -> None:
        """Remember the step that has held the window up longest."""
        now = time.monotonic()
        took = now - self._began - self._pause_ms / 1000
        if self.last and took > self.slowest[0]:
            self.slowest = (took, self.last[-1])
        self._began, self._pause_ms = now, 0

    def _end(self) -> None:
        self._close()
        QTimer.singleShot(0, QApplication.exit)

    def _note(self, what: str) -> None:
        self.last.append(f"{self.done}: {what}")
        if self.is_told:
            print(self.last[-1], flush=True)

    # What it can do

    def _do_something(self) -> None:
        is_show = any(widget.isFullScreen() for widget in QApplication.topLevelWidgets())
        if not self.window.isVisible() and not is_show:
            self._note("the window was closed: another one")
            self._reopen()
            return
        top = self._top() or self.window
        self._look_around(top)
        if isinstance(top, QFileDialog):
            self._answer_file_dialog(top)
            return
        self._away = 0 if top is self.window else self._away + 1
        is_printing = isinstance(top, QPrintDialog) and bool(QPrinterInfo.availablePrinterNames())
        if is_printing or self._away > MOST_AWAY or (self._away and self.random.random() < 0.04):
            self._leave(top)
            return
        hands = self._hands
        choices: list[tuple[int, Callable[[QWidget], None]]] = [
            (34, hands.click_something),
            (12, hands.click_anywhere),
            (12, hands.drag),
            (10, hands.type_keys),
            (6, hands.say),
            (5, hands.wheel),
            (3, hands.double_click),
            (4, hands.right_click),
            (3, self._wait),
            (1, hands.resize),
            (1, self._drop),
        ]
        if top is self.window:
            choices += [(10, self._trigger), (6, self._build), (2, self._play), (1, self._restart)]
        weights, does = zip(*choices, strict=True)
        self.random.choices(does, weights)[0](top)

    def _look_around(self, top: QWidget) -> None:
        """Remember where it is."""
        self.seen[type(top).__name__] += 1
        window = self.window
        if top is not window or not window.lazy.is_done:
            return
        if window.start_page.isVisible():
            self.seen["the start page"] += 1
        for panel in window.workbench.panels.all:
            if panel.widget.isVisible():
                self.seen[f"the panel {panel.name}"] += 1
        if window.actions_by_name["stop"].isEnabled():
            self.seen["a program that runs"] += 1

    def _top(self) -> QWidget | None:
        """What takes the mouse now: a popup, else a question, else a window besides."""
        popup = QApplication.activePopupWidget() or QApplication.activeModalWidget()
        if popup is not None:
            return popup
        shown = [w for w in QApplication.topLevelWidgets() if self._is_window(w)]
        if self.window in shown and (len(shown) == 1 or self.random.random() < 0.5):
            return self.window
        return self.random.choice(shown) if shown else None

    def _is_window(self, widget: QWidget) -> bool:
        handle = widget.windowHandle()
        is_tip = widget.windowType() in (Qt.WindowType.ToolTip, Qt.WindowType.SplashScreen)
        return widget.isVisible() and handle is not None and not is_tip

    def _wait(self, _top: QWidget) -> None:
        self._note("wait")
        self._pause_ms = self.random.choice((20, 100, 400))

    def _drop(self, top: QWidget) -> None:
        self._hands.drop(top, self._own_project())

    def _trigger(self, _top: QWidget) -> None:
        """Do what a menu has; what it has done least before."""
        actions: dict[str, QAction] = dict(self.window.actions_by_name.by_name)
        panels = self.window.workbench.panels.all
        actions |= {f"panel {panel.name}": panel.action for panel in panels}
        self.offered |= {*actions} - NEVER
        known = [name for name, one in actions.items() if one.isEnabled() and name not in NEVER]
        if not known:
            return
        least = min(self.used.get(name, 0) for name in known)
        rare = [name for name in known if self.used.get(name, 0) <= least + 1]
        name = self.random.choice(rare)
        self.used[name] = self.used.get(name, 0) + 1
        self._note(f"choose {name}")
        QTimer.singleShot(0, actions[name].trigger)  # a question that waits does not hold this up

    def _build(self, top: QWidget) -> None:
        """Drag something of the palette onto the canvas."""
        canvas, shelf = self.window.workbench.canvas, self.window.workbench.helpers.palette.shelf
        if not canvas.isVisible() or shelf.visibleRegion().isEmpty():
            self._trigger(top)
            return
        hands = self._hands
        hands.drag_between(top, hands.place(top, shelf), hands.place(top, canvas))

    def _play(self, _top: QWidget) -> None:
        """Open an example, or a stranger's project, and often run it."""
        if self.random.random() < 0.3:
            path = self._strangers_project()
            self._note("open a stranger's project")
            self.window.files.open(path)
        else:
            path = self.random.choice(self._examples())
            self._note(f"open {path.name}")
            self.window.files.open_example(path)
        if self.random.random() < 0.6:
            self._pause_ms = 300
            QTimer.singleShot(200, self.window.actions_by_name["run"].trigger)

    def _restart(self, _top: QWidget) -> None:
        """Close the window; or end the program as by a signal, which offers the work again."""
        document = self.window.files.document
        if self.random.random() < 0.5:
            self._note("close the window")
            self.window.close()
            return
        self._note("end the program, and start it again")
        if document is not None:
            document.close(keep=document.is_modified)
        self._reopen()

    def _examples(self) -> list[Path]:
        from nep_studio import paths

        return sorted(paths.examples().glob("*.nep"))

    def _own_project(self) -> Path:
        """A copy of an example: what is opened as a file may be saved there."""
        path = self.folder / f"own{self.done}.nep"
        shutil.copy(self.random.choice(self._examples()), path)
        return path

    def _strangers_project(self) -> Path:
        """A copy of the karate story with Python in it that nobody has seen before."""
        from nep_studio import paths

        told = json.loads((paths.examples() / "karate_greeting.nep").read_text(encoding="utf-8"))
        for block in told["blocks"]:
            if block["type"] == "robot.do":
                block.update(type="code.lines", fields={"code": f"x = {self.done}"})
        path = self.folder / f"stranger{self.done}.nep"
        path.write_text(json.dumps(told), encoding="utf-8")
        return path

    def _answer_file_dialog(self, dialog: QFileDialog) -> None:
        """Give a name in the monkey's own folder, or leave: nothing else may be touched."""
        line = dialog.findChild(QLineEdit)
        if line is None or self.random.random() < 0.5:
            self._note("leave the file dialog")
            self._hands.key(dialog, Qt.Key.Key_Escape)
            return
        path = self.folder / f"monkey{self.done}.nep"
        if dialog.fileMode() is QFileDialog.FileMode.Directory:
            path = self.folder
        elif dialog.acceptMode() == QFileDialog.AcceptMode.AcceptOpen:  # one that is there
            path = self._own_project()
        self._note(f"answer the file dialog: {path.name}")
        line.setText(str(path))
        line.setFocus()
        self._hands.key(dialog, Qt.Key.Key_Return)

    # The way back

    def _go_back(self) -> None:
        """Leave one thing that lies over the window: each step, until there is none.

        So a question that was opened by another one has ended before that is left, too.
        """
        popup = QApplication.activePopupWidget() or QApplication.activeModalWidget()
        others = [w for w in QApplication.topLevelWidgets() if self._is_window(w)]
        others = [widget for widget in others if widget is not self.window]
        if popup is None and not others:
            self._tries_left = 0
            if self.window.isVisible() and not self.window.menuBar().isEnabled():
                raise Broken("The menus cannot be used.")
            return
        target = popup or others[0]
        self._tries_left -= 1
        if not self._tries_left:
            raise Broken(f"There is no way back from {type(target).__name__}.")
        self._pause_ms = 10
        self._leave(target)

    def _leave(self, target: QWidget) -> None:
        """Press Esc; the next time what says Cancel or Close, else the window's own button."""
        if target.windowHandle() is None:
            return
        self._note(f"leave {type(target).__name__}")
        if target.isFullScreen():  # the show: Esc, held for a while
            self._pause_ms = HELD_MS + 200  # before Qt looks for what comes next
            QTimer.singleShot(HELD_MS, lambda: self._hands.let_key_go(target, Qt.Key.Key_Escape))
            QTest.keyPress(target.windowHandle(), Qt.Key.Key_Escape)
            return
        if self._left is not target:
            self._left = target
            self._hands.key(target, Qt.Key.Key_Escape)
            return
        self._left = None
        ways = [
            button
            for button in target.findChildren(QAbstractButton)
            if button.isVisible()
            and button.isEnabled()
            and not button.visibleRegion().isEmpty()
            and button.text().replace("&", "").lower().startswith(WAYS_BACK)
        ]
        if ways:
            way = self.random.choice(ways)
            self._hands.click(target, self._hands.place(target, way), f"“{way.text()}”")
        elif not isinstance(target, QMenu):
            target.close()  # what the window's own button does


def watch(monkey: Monkey) -> None:
    """Let nothing that goes wrong pass unseen."""

    def on_error(
        kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        if isinstance(error, KeyboardInterrupt):
            monkey.faults.append("interrupted")
            return
        try:
            monkey.faults.append("".join(traceback.format_exception(kind, error, trace)))
        except RecursionError:
            monkey.faults.append(f"{kind.__name__}: {error}; too deep to tell where")

    def on_message(kind: QtMsgType, _context: object, text: str) -> None:
        is_bad = kind in (QtMsgType.QtCriticalMsg, QtMsgType.QtFatalMsg)
        is_warning = kind is QtMsgType.QtWarningMsg
        if is_bad or (is_warning and not any(word in text for word in HARMLESS)):
            monkey.faults.append(f"Qt: {text}")

    class Logged(logging.Handler):
        """Hears of errors that were caught and logged."""

        def emit(self, record: logging.LogRecord) -> None:
            """Take it for a fault."""
            monkey.faults.append(f"{record.getMessage()}\n{record.exc_text or record.exc_info}")

    logging.getLogger().addHandler(Logged(logging.ERROR))
    threading.excepthook = lambda one: on_error(
        one.exc_type, one.exc_value or one.exc_type(), one.exc_traceback
    )
    sys.excepthook = on_error
    sys.unraisablehook = lambda one: on_error(
        one.exc_type, one.exc_value or one.exc_type(), one.exc_traceback
    )
    qInstallMessageHandler(on_message)


def processes_left() -> list[str]:
    """What the monkey has started and still runs; it is ended."""
    _, left = psutil.wait_procs(psutil.Process().children(recursive=True), timeout=10)
    told = []
    for one in left:
        with suppress(psutil.NoSuchProcess):
            told.append(" ".join(one.cmdline()) or one.name())
            one.kill()
    return told


class Nowhere(QObject):
    """Takes the addresses that would open in a browser or another program."""

    @Slot(QUrl)
    def open(self, url: QUrl) -> None:
        """Open nothing."""


def main(arguments: list[str]) -> int:
    """Do as many steps as asked; the exit code is 1 when something broke."""
    parser = argparse.ArgumentParser(prog="dev.py monkey", description=__doc__)
    parser.add_argument("--steps", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tell", action="store_true", help="say each step")
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="monkey") as name:
        folder = Path(name)
        for variable in OWN_FOLDER:
            os.environ[variable] = name
        os.environ["NEP_STUDIO_FOLDER"] = str(folder / "home")
        os.environ["NEP_ORIGINAL"] = "0"
        with socket.socket() as free:  # not where a studio of somebody's own may be
            free.bind(("127.0.0.1", 0))
            os.environ["NEP_MASTER"] = f"tcp://127.0.0.1:{free.getsockname()[1]}"
        os.chdir(name)
        return play(asked.seed, asked.steps, folder, is_told=asked.tell)


def play(seed: int, steps: int, folder: Path, *, is_told: bool) -> int:
    """Let the monkey play in a folder; the exit code."""
    from nep_studio.ui.shell.app import make_application

    app = make_application()
    nowhere = Nowhere()
    for scheme in SCHEMES:
        QDesktopServices.setUrlHandler(scheme, nowhere, "open")  # type: ignore[arg-type]  # Qt's stub is wrong
    began = time.monotonic()
    monkey = Monkey(seed, steps, folder, is_told=is_told)
    watch(monkey)
    try:
        monkey.run()
        if left := processes_left():
            raise Broken(f"It has left behind: {', '.join(left)}")
    except Broken as broken:
        print(f"seed {seed}, step {monkey.done} of {steps}: it broke.\n{broken}\nThe last steps:")
        print("\n".join(monkey.last))
        return 1
    finally:
        processes_left()
        qInstallMessageHandler(None)
        sys.excepthook = sys.__excepthook__
    places = ", ".join(f"{name} ({count})" for name, count in sorted(monkey.seen.items()))
    unused = ", ".join(sorted(monkey.offered - {*monkey.used})) or "none"
    print(
        f"seed {seed}: {monkey.done} steps in {time.monotonic() - began:.0f} s, "
        f"{monkey.windows} windows, {len(monkey.used)} commands; never chosen: {unused}\n"
        f"The slowest step took {monkey.slowest[0]:.1f} s: {monkey.slowest[1]}\n"
        f"Steps in each place: {places}"
    )
    app.processEvents()
    return 0


if __name__ == "__main__":
    code = main(sys.argv[1:])
    sys.stdout.flush()
    os._exit(code)  # what the monkey left half open is not put away in an order

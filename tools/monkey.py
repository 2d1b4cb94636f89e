"""A monkey at the window: clicks, drags and types at random, by a seed that can be repeated.

It works on a window of its own in a folder that is thrown away, through the same door as a mouse
and a keyboard: what is behind a question cannot be pressed. It fails, and says by what it was
brought about, when Python raises something, when Qt warns of a mistake, when the window stops
answering, and when there is no way back from where it is.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import random
import shutil
import sys
import tempfile
import time
import traceback
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from PySide6.QtCore import (
    QEvent,
    QMimeData,
    QObject,
    QPoint,
    QPointF,
    Qt,
    QTimer,
    QtMsgType,
    QUrl,
    Slot,
    qInstallMessageHandler,
)
from PySide6.QtGui import (
    QAction,
    QDesktopServices,
    QDragEnterEvent,
    QDropEvent,
    QKeyEvent,
    QWheelEvent,
)
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QFileDialog,
    QLineEdit,
    QMenu,
    QSlider,
    QTabBar,
    QWidget,
)

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

REMEMBERED = 40
"""So many of the last steps are told when something breaks."""

LONGEST_STEP_S = 60.0
"""A step that takes longer ends the monkey: the window hangs. The machine may be busy."""

MOST_TRIES_TO_LEAVE = 40
"""So often it presses Esc, and what says Cancel or Close, before there is no way back."""

WAYS_BACK = ("cancel", "close", "discard", "don", "no", "not now", "ok", "leave", "back", "done")
"""How buttons begin that lead back, in English."""

SAYINGS = ("hello", "nao says", "when", "repeat 3", "karate", "12", "-0.5", "<b>&", "日本語", "…")
KEYS = (
    *(Qt.Key.Key_Return, Qt.Key.Key_Escape, Qt.Key.Key_Tab, Qt.Key.Key_Backtab, Qt.Key.Key_Space),
    *(Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Home),
    *(Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_Slash, Qt.Key.Key_Menu, Qt.Key.Key_F1),
    *(Qt.Key.Key_F2, Qt.Key.Key_F5, Qt.Key.Key_F6, Qt.Key.Key_F8, Qt.Key.Key_F10, Qt.Key.Key_End),
)
WITH_CONTROL = "ZYACVXDFNSPGKL0+-"
NEVER = frozenset({"quit"})
"""Actions that are left alone: the window would be gone, as it should."""

HARMLESS = ("This plugin does not support", "QFont", "font", "libpng", "Wayland", "OpenType")
"""Words in what Qt tells that are no mistake of ours."""


class Broken(Exception):
    """Something that must not happen has happened."""


class Monkey(QObject):
    """Does one step after the other, from a timer: so it goes on within questions, too."""

    def __init__(self, seed: int, steps: int, folder: Path, *, is_told: bool) -> None:
        super().__init__()
        self.random = random.Random(seed)
        self.steps, self.done, self.folder, self.is_told = steps, 0, folder, is_told
        self.last: deque[str] = deque(maxlen=REMEMBERED)
        self.used: dict[str, int] = {}
        self.faults: list[str] = []
        self.windows = 0
        self.seen: set[str] = set()
        """The kinds of windows and dialogs that it was in."""
        self._pause_ms, self._is_leaving = 0, False
        self.window = self._open()

    # The window

    def _open(self) -> MainWindow:
        from nep_studio.settings import Settings
        from nep_studio.ui.services import Studio
        from nep_studio.ui.shell.main_window import MainWindow

        app = QApplication.instance()
        assert isinstance(app, QApplication)
        settings = Settings(self.folder / "home")
        settings.language = "en"
        self.studio = Studio(app, settings)
        window = MainWindow(self.studio)
        window.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose, False)
        window.show()
        window.start(None)
        self.windows += 1
        return window

    def run(self) -> None:
        """Do all steps; raises Broken."""
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        app.setQuitOnLastWindowClosed(False)
        QTimer.singleShot(0, self.step)
        app.exec()
        if self.faults:
            raise Broken(self.faults[0])

    @Slot()
    def step(self) -> None:
        """Do one thing; the next one follows also when this one waits for an answer to it."""
        faulthandler.dump_traceback_later(LONGEST_STEP_S, exit=True)
        if self.faults or self.done >= self.steps:
            self._end()
            return
        if self._is_leaving:
            QTimer.singleShot(20, self.step)
            return
        self.done += 1
        self._pause_ms = 0
        QTimer.singleShot(0, self._next)
        try:
            self._do_something()
            if self.done % 250 == 0 or self.done == self.steps:
                self._is_leaving = True
                self._find_the_way_back()
        except RuntimeError as error:  # a widget that was deleted by what was done to it
            if "already deleted" not in str(error):
                raise
        finally:
            self._is_leaving = False

    @Slot()
    def _next(self) -> None:
        QTimer.singleShot(self._pause_ms, self.step)

    def _end(self) -> None:
        for widget in QApplication.topLevelWidgets():
            widget.hide()
        self.window.close_now()
        QTimer.singleShot(0, QApplication.exit)

    def _note(self, what: str) -> None:
        self.last.append(f"{self.done}: {what}")
        if self.is_told:
            print(self.last[-1], flush=True)

    # What it can do

    def _do_something(self) -> None:
        if not self.window.isVisible() and self._top() is None:
            self._note("the window was closed: another one")
            self.window.close_now()
            self.window = self._open()
            return
        top = self._top() or self.window
        self.seen.add(type(top).__name__)
        if isinstance(top, QFileDialog):
            self._answer_file_dialog(top)
            return
        choices: list[tuple[int, Callable[[QWidget], None]]] = [
            (34, self._click_something),
            (14, self._click_anywhere),
            (16, self._drag),
            (10, self._type_keys),
            (6, self._say),
            (5, self._wheel),
            (3, self._double_click),
            (4, self._right_click),
            (3, self._wait),
            (1, self._resize),
            (1, self._drop),
        ]
        if top is self.window:
            choices += [(10, self._trigger), (1, self._example)]
        weights, does = zip(*choices, strict=True)
        self.random.choices(does, weights)[0](top)

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

    def _within(self, top: QWidget, kinds: tuple[type[QWidget], ...]) -> QWidget | None:
        found = [
            widget
            for kind in kinds
            for widget in top.findChildren(kind)
            if widget.isVisible() and widget.isEnabled() and widget.window() is top
        ]
        return self.random.choice(found) if found else None

    def _place(self, top: QWidget, widget: QWidget) -> QPoint:
        """A place in a widget, in its window."""
        seen = widget.visibleRegion().boundingRect()
        if seen.isEmpty():
            seen = widget.rect()
        x = self.random.randint(seen.left(), max(seen.left(), seen.right()))
        y = self.random.randint(seen.top(), max(seen.top(), seen.bottom()))
        return widget.mapTo(top, QPoint(x, y)) if widget is not top else QPoint(x, y)

    def _click(self, top: QWidget, place: QPoint, what: str) -> None:
        self._note(f"click {what} of {type(top).__name__} at {place.x()},{place.y()}")
        QTest.mouseClick(top.windowHandle(), Qt.MouseButton.LeftButton, pos=place)

    def _click_something(self, top: QWidget) -> None:
        kinds = (QAbstractButton, QComboBox, QLineEdit, QTabBar, QAbstractSpinBox, QSlider)
        chosen = self._within(top, (self.random.choice(kinds),)) or self._within(top, kinds)
        if chosen is None:
            self._click_anywhere(top)
            return
        words = getattr(chosen, "text", str)()
        self._click(top, self._place(top, chosen), f"{type(chosen).__name__} “{words}”")

    def _click_anywhere(self, top: QWidget) -> None:
        self._click(top, self._place(top, top), "a place")

    def _double_click(self, top: QWidget) -> None:
        place = self._place(top, top)
        self._note(f"double click {type(top).__name__} at {place.x()},{place.y()}")
        QTest.mouseDClick(top.windowHandle(), Qt.MouseButton.LeftButton, pos=place)

    def _right_click(self, top: QWidget) -> None:
        place = self._place(top, top)
        self._note(f"menu of {type(top).__name__} at {place.x()},{place.y()}")
        handle = top.windowHandle()
        QTest.mouseClick(handle, Qt.MouseButton.RightButton, pos=place)

    def _drag(self, top: QWidget) -> None:
        start, end = self._place(top, top), self._place(top, top)
        self._note(
            f"drag in {type(top).__name__} from {start.x()},{start.y()} to {end.x()},{end.y()}"
        )
        handle, button = top.windowHandle(), Qt.MouseButton.LeftButton
        QTest.mousePress(handle, button, pos=start)
        for part in range(1, 6):
            if not top.isVisible() or top.windowHandle() is None:
                return
            QTest.mouseMove(handle, start + (end - start) * part / 5)
        if self.random.random() < 0.1:
            QTest.keyClick(handle, Qt.Key.Key_Escape)
        QTest.mouseRelease(handle, button, pos=end)

    def _type_keys(self, top: QWidget) -> None:
        handle = top.windowHandle()
        if self.random.random() < 0.3:
            letter = self.random.choice(WITH_CONTROL)
            self._note(f"Ctrl+{letter} in {type(top).__name__}")
            QTest.keyClick(handle, Qt.Key(ord(letter)), Qt.KeyboardModifier.ControlModifier)
            return
        key = self.random.choice(KEYS)
        shift = Qt.KeyboardModifier.ShiftModifier
        modifier = shift if self.random.random() < 0.2 else Qt.KeyboardModifier.NoModifier
        self._note(f"{key.name} {modifier.name or ''} in {type(top).__name__}")
        QTest.keyClick(handle, key, modifier)

    def _say(self, top: QWidget) -> None:
        focus = QApplication.focusWidget()
        text = self.random.choice(SAYINGS)
        self._note(f"type “{text}” into {type(focus).__name__}")
        none = Qt.KeyboardModifier.NoModifier
        for letter in text:  # QTest knows those of Latin-1 alone
            if not isinstance(focus, QWidget) or focus.window() is not top:
                return
            for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
                QApplication.sendEvent(focus, QKeyEvent(kind, 0, none, letter))
            focus = QApplication.focusWidget()

    def _wheel(self, top: QWidget) -> None:
        place = self._place(top, top)
        target = top.childAt(place) or top
        steps = self.random.choice((-120, 120, -360, 360))
        self._note(f"wheel {steps} over {type(target).__name__}")
        local = target.mapFrom(top, place)
        none = Qt.KeyboardModifier.NoModifier
        modifier = self.random.choice((none, none, none, Qt.KeyboardModifier.ControlModifier))
        event = QWheelEvent(
            QPointF(local),
            QPointF(target.mapToGlobal(local)),
            QPoint(),
            QPoint(0, steps),
            Qt.MouseButton.NoButton,
            modifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(target, event)

    def _wait(self, _top: QWidget) -> None:
        self._note("wait")
        self._pause_ms = self.random.choice((20, 100, 400))

    def _resize(self, top: QWidget) -> None:
        size = self.random.choice(((1280, 800), (1366, 728), (1024, 640), (1920, 1040)))
        self._note(f"resize {type(top).__name__} to {size}")
        if not top.isFullScreen():
            top.resize(*size)

    def _drop(self, top: QWidget) -> None:
        """Drop a project onto whatever is there."""
        place = self._place(top, top)
        target: QWidget | None = top.childAt(place) or top
        self._note(f"drop a project on {type(target).__name__}")
        mime = QMimeData()
        mime.setUrls([QUrl.fromLocalFile(str(self.random.choice(self._examples())))])
        copy, left = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton
        none = Qt.KeyboardModifier.NoModifier
        while target is not None and not target.acceptDrops():
            target = target.parentWidget()
        if target is None:
            return
        enter = QDragEnterEvent(QPoint(5, 5), copy, mime, left, none)
        QApplication.sendEvent(target, enter)
        if enter.isAccepted():
            QApplication.sendEvent(target, QDropEvent(QPointF(5, 5), copy, mime, left, none))

    def _trigger(self, _top: QWidget) -> None:
        """Do what a menu has; what it has done least before."""
        known: list[QAction] = [
            action
            for action in self.window.actions_by_name.by_name.values()
            if action.isEnabled() and action.objectName() not in NEVER
        ]
        panels = [panel.action for panel in self.window.workbench.panels.all]
        known += [action for action in panels if action.isEnabled()]
        if not known:
            return
        names = {id(action): action.objectName() or action.text() for action in known}
        least = min(self.used.get(name, 0) for name in names.values())
        rare = [one for one in known if self.used.get(names[id(one)], 0) <= least + 1]
        chosen = self.random.choice(rare)
        name = names[id(chosen)]
        self.used[name] = self.used.get(name, 0) + 1
        self._note(f"choose {name}")
        QTimer.singleShot(0, chosen.trigger)  # a question that waits does not hold this up

    def _example(self, _top: QWidget) -> None:
        path = self.random.choice(self._examples())
        self._note(f"open {path.name}")
        self.window.files.open_example(path)

    def _examples(self) -> list[Path]:
        from nep_studio import paths

        return sorted(paths.examples().glob("*.nep"))

    def _answer_file_dialog(self, dialog: QFileDialog) -> None:
        """Give a name in the monkey's own folder, or leave: nothing else may be touched."""
        line = dialog.findChild(QLineEdit)
        if line is None or self.random.random() < 0.5:
            self._note("leave the file dialog")
            QTest.keyClick(dialog.windowHandle(), Qt.Key.Key_Escape)
            return
        path = self.folder / f"monkey{self.done}.nep"
        if dialog.acceptMode() == QFileDialog.AcceptMode.AcceptOpen:  # one that is there
            shutil.copy(self.random.choice(self._examples()), path)
        self._note(f"answer the file dialog: {path.name}")
        line.setText(str(path))
        QTest.keyClick(line, Qt.Key.Key_Return)

    # The way back

    def _find_the_way_back(self) -> None:
        """From wherever it is, the window with its menus can be reached again."""
        for _ in range(MOST_TRIES_TO_LEAVE):
            top = QApplication.activePopupWidget() or QApplication.activeModalWidget()
            others = [
                widget
                for widget in QApplication.topLevelWidgets()
                if widget is not self.window and self._is_window(widget)
            ]
            if top is None and not others:
                break
            target = top or others[0]
            self._note(f"leave {type(target).__name__}")
            self._leave(target)
            QTest.qWait(10)
        else:
            raise Broken(f"There is no way back from {type(target).__name__}.")
        if self.window.isVisible() and not self.window.menuBar().isEnabled():
            raise Broken("The menus cannot be used.")

    def _leave(self, target: QWidget) -> None:
        handle = target.windowHandle()
        if handle is None:
            return
        if target.isFullScreen():  # the show: Esc, held for a while
            QTest.keyPress(handle, Qt.Key.Key_Escape)
            QTest.qWait(3000)
            if target.isVisible():
                QTest.keyRelease(handle, Qt.Key.Key_Escape)
            return
        QTest.keyClick(handle, Qt.Key.Key_Escape)
        QTest.qWait(5)
        if not target.isVisible():
            return
        ways = [
            button
            for button in target.findChildren(QAbstractButton)
            if button.isVisible()
            and button.isEnabled()
            and button.text().replace("&", "").lower().startswith(WAYS_BACK)
        ]
        if ways:
            way = self.random.choice(ways)
            QTest.mouseClick(handle, Qt.MouseButton.LeftButton, pos=self._place(target, way))
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
        monkey.faults.append("".join(traceback.format_exception(kind, error, trace)))

    def on_message(kind: QtMsgType, _context: object, text: str) -> None:
        is_bad = kind in (QtMsgType.QtCriticalMsg, QtMsgType.QtFatalMsg)
        is_warning = kind is QtMsgType.QtWarningMsg
        if is_bad or (is_warning and not any(word in text for word in HARMLESS)):
            monkey.faults.append(f"Qt: {text}")

    sys.excepthook = on_error
    sys.unraisablehook = lambda one: on_error(
        one.exc_type, one.exc_value or one.exc_type(), one.exc_traceback
    )
    qInstallMessageHandler(on_message)


class Nowhere(QObject):
    """Takes the addresses that would open in a browser or another program."""

    @Slot(QUrl)
    def open(self, url: QUrl) -> None:
        """Open nothing."""


def schemes() -> Iterator[str]:
    """What addresses begin with."""
    yield from ("http", "https", "file", "mailto")


def main(arguments: list[str]) -> int:
    """Do as many steps as asked; the exit code is 1 when something broke."""
    parser = argparse.ArgumentParser(prog="dev.py monkey", description=__doc__)
    parser.add_argument("--steps", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tell", action="store_true", help="say each step")
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="monkey") as name:
        folder = Path(name)
        for variable in ("HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_RUNTIME_DIR"):
            os.environ[variable] = name
        os.environ["NEP_STUDIO_FOLDER"] = str(folder / "home")
        os.chdir(name)
        return play(asked.seed, asked.steps, folder, is_told=asked.tell)


def play(seed: int, steps: int, folder: Path, *, is_told: bool) -> int:
    """Let the monkey play in a folder; the exit code."""
    from nep_studio.ui.shell.app import make_application

    app = make_application()
    nowhere = Nowhere()
    for scheme in schemes():
        QDesktopServices.setUrlHandler(scheme, nowhere, b"open")
    began = time.monotonic()
    monkey = Monkey(seed, steps, folder, is_told=is_told)
    watch(monkey)
    try:
        monkey.run()
    except Broken as broken:
        print(f"seed {seed}, step {monkey.done} of {steps}: it broke.\n{broken}\nThe last steps:")
        print("\n".join(monkey.last))
        return 1
    finally:
        qInstallMessageHandler(None)
        sys.excepthook = sys.__excepthook__
    rooms = ", ".join(sorted(monkey.seen))
    print(
        f"seed {seed}: {monkey.done} steps in {time.monotonic() - began:.0f} s, "
        f"{monkey.windows} windows, {len(monkey.used)} commands; it was in {rooms}"
    )
    app.processEvents()
    return 0


if __name__ == "__main__":
    code = main(sys.argv[1:])
    sys.stdout.flush()
    os._exit(code)  # what the monkey left half open is not put away in an order

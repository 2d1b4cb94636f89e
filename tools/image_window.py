"""A window of the program for pictures, always the same and quiet; sheets of the examples."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from PySide6.QtCore import (
    QDeadlineTimer,
    QEvent,
    QPoint,
    QPointF,
    QRect,
    QSize,
    Qt,
    qInstallMessageHandler,
)
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPainter
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from nep_studio import paths
from nep_studio.settings import Settings
from nep_studio.ui import words
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.app import make_application
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.theme.colours import themes
from nep_studio.ui.theme.look import load_fonts
from nep_studio.ui.words import PSEUDO

SIZE = (1280, 800)
SMALL = (900, 600)
KARATE = "karate_greeting"
QUIET_MS = 350
"""So long everything that waits for a pause has had it: checks, code, sharp blocks."""


class Stage:
    """The application on whose stage the windows of the pictures are."""

    def __init__(self, home: Path) -> None:
        qInstallMessageHandler(lambda *message: None)  # a screen that is not there says much
        self.home = home
        self.app = make_application()
        self.app.setCursorFlashTime(0)
        self.app.setEffectEnabled(Qt.UIEffect.UI_AnimateCombo, False)
        load_fonts()
        self._count = 0

    @contextmanager
    def window(
        self,
        *,
        theme: str = "light",
        language: str = "en",
        example: str | None = KARATE,
        size: tuple[int, int] = SIZE,
        scale: float = 1.0,
    ) -> Iterator[MainWindow]:
        """A window with an example, or with the start page; it is gone afterwards."""
        self._count += 1
        home = self.home / str(self._count)
        os.environ["NEP_STUDIO_FOLDER"] = str(home)
        settings = Settings(home)
        settings.theme, settings.language, settings.text_scale = theme, language, scale
        studio = Studio(self.app, settings)
        window = MainWindow(studio)
        window.resize(*size)
        window.show()
        window.start(None)
        if example is not None:
            checked: list[object] = []
            window.workbench.checks.found.connect(checked.append)
            window.files.open_example(paths.examples() / f"{example}.nep")
            until(lambda: window.files.document is not None and bool(checked))
            code = window.workbench.code
            until(lambda: not code.isVisible() or code.live.code is not None)
        quiet()
        try:
            yield window
        finally:
            _close(window)
            studio.look.deleteLater()
            studio.deleteLater()
            words.use_language("en")
            self.app.sendPostedEvents(None, QEvent.Type.DeferredDelete)


def until(is_so: Callable[[], bool]) -> None:
    """Wait for something."""
    deadline = QDeadlineTimer(10_000)
    while not is_so():
        if deadline.hasExpired():
            raise TimeoutError("The window did not become what the picture needs.")
        QTest.qWait(10)


def quiet(milliseconds: int = QUIET_MS) -> None:
    """Wait until nothing happens any more."""
    QTest.qWait(milliseconds)


def picture(window: QWidget, part: QRect | None = None) -> QImage:
    """What is to be seen of a window, with the popups over it, or of a part of it."""
    ratio = window.devicePixelRatioF()
    image = window.grab().toImage()
    with QPainter(image) as painter:
        for popup in QApplication.topLevelWidgets():
            if popup is not window and popup.isVisible():
                place = popup.mapToGlobal(QPoint()) - window.mapToGlobal(QPoint())
                painter.drawPixmap(place, popup.grab())
    image.setDevicePixelRatio(1.0)
    if part is None:
        return image
    whole = QRect(QPoint(), window.size())
    cut = part.intersected(whole)
    corner, size = QPointF(cut.topLeft()) * ratio, QSize(cut.size()) * ratio
    return image.copy(QRect(corner.toPoint(), size))


def part_of(window: QWidget, *widgets: QWidget, margin: int = 0) -> QRect:
    """Where widgets are in a window, also when they are windows themselves."""
    found = QRect()
    for widget in widgets:
        corner = widget.mapToGlobal(QPoint()) - window.mapToGlobal(QPoint())
        found = found.united(QRect(corner, widget.size()))
    return found.adjusted(-margin, -margin, margin, margin)


def around(canvas: Canvas, block: str, size: tuple[int, int]) -> QRect:
    """A part of the window that begins a little before a block."""
    rect = canvas.sight.view_rect_of(block)
    assert rect is not None
    corner = canvas.viewport().mapTo(canvas.window(), rect.topLeft().toPoint())
    return QRect(corner - QPoint(28, 28), QSize(*size))


def block_of(canvas: Canvas, kind: str, number: int = 0) -> str:
    """A block of the project by its type."""
    blocks = canvas.editor.project.blocks.values()
    return [block.id for block in blocks if block.type == kind][number]


def drag(canvas: Canvas, block: str, to: QPointF) -> None:
    """Take a block with the mouse, so that its corner comes to a point of the view, and hold it."""
    rect = canvas.sight.view_rect_of(block)
    assert rect is not None
    grip = rect.topLeft() + QPointF(5, 14)
    _mouse(canvas, QEvent.Type.MouseButtonPress, grip)
    for step in range(1, 6):
        way = (to - rect.topLeft()) * (step / 5)
        _mouse(canvas, QEvent.Type.MouseMove, grip + way)
    QApplication.processEvents()


def _mouse(canvas: Canvas, kind: QEvent.Type, at: QPointF) -> None:
    left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    is_press = kind == QEvent.Type.MouseButtonPress
    view = canvas.viewport()
    place = QPointF(view.mapToGlobal(at.toPoint()))
    plain = Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(
        view, QMouseEvent(kind, at, place, left if is_press else none, left, plain)
    )


def _close(window: MainWindow) -> None:
    window.workbench.canvas.pointing.cancel()
    window.workbench.canvas.fields.close()
    for popup in QApplication.topLevelWidgets():
        if popup is not window and popup.isVisible():
            popup.close()
    window.workbench.retire()
    if window.files.document is not None:
        window.files.document.close()
        window.files.document = None
    window.hide()
    window.deleteLater()


LANGUAGES = ("en", "ja", PSEUDO)
LARGEST = QSize(760, 1800)
"""How much of an example is drawn, in units of the screen."""

EDGE = 24


def make_sheets(stage: Stage, folder: Path, scale: str, tell: Callable[[str], None]) -> None:
    """Draw one sheet for each language and theme; ``scale`` goes into its name."""
    folder.mkdir(parents=True, exist_ok=True)
    for language in LANGUAGES:
        for theme in themes():
            name = f"{language}-{theme}-{scale}.png"
            _beside(_examples(stage, language, theme)).save(str(folder / name))
            tell(name)


def _examples(stage: Stage, language: str, theme: str) -> list[QImage]:
    """The behaviour page of each example, as large as it is."""
    pictures = []
    for path in sorted(paths.examples().glob("*.nep")):
        with stage.window(theme=theme, language=language, example=path.stem) as window:
            pictures.append(_whole_page(window.workbench.canvas))
    return pictures


def _whole_page(canvas: Canvas) -> QImage:
    """All blocks of a page, drawn by a view that is large enough for them."""
    view = Canvas(
        canvas.editor,
        canvas.look.theme,
        font=canvas.look.block_font,
        is_mirrored=canvas.look.measures.is_mirrored,
    )
    bounds = view.page_layout.bounds()
    assert bounds is not None
    size = QSize(round(bounds.width) + 2 * EDGE, round(bounds.height) + 2 * EDGE)
    view.resize(size.boundedTo(LARGEST))
    view.show()
    view.sight.move_camera(bounds.x - EDGE, bounds.y - EDGE)
    quiet(120)
    image = view.viewport().grab().toImage()
    image.setDevicePixelRatio(1.0)
    view.hide()
    canvas.editor.history.unlisten(view._on_changes)
    view.deleteLater()
    return image


def _beside(pictures: list[QImage]) -> QImage:
    """Pictures beside each other."""
    width = sum(picture.width() for picture in pictures)
    height = max(picture.height() for picture in pictures)
    sheet = QImage(width, height, QImage.Format.Format_RGB32)
    sheet.fill(QColor("#808080"))
    with QPainter(sheet) as painter:
        left = 0
        for picture in pictures:
            painter.drawImage(QPoint(left, 0), picture)
            left += picture.width()
    return sheet

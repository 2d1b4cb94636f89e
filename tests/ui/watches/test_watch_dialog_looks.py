"""The dialog of watches as it is seen: the code for cameras, and every look."""

from __future__ import annotations

import pytest
from PySide6.QtWidgets import QApplication, QLabel, QPushButton
from pytestqt.qtbot import QtBot

from nep_studio.ui.plugins.watches.dialog import Plan, WatchDialog
from nep_studio.ui.theme.colours import themes
from nep_studio.ui.theme.look import Look
from nodes.sensory.phone_page.server import page_urls
from tests.ui.watches.watch_stage import (
    ADDRESS,
    TOKEN,
    RecordingRunner,
    open_dialog,
    runner,
    settles_at_once,
)

__all__ = ["open_dialog", "runner", "settles_at_once"]


def test_a_code_is_drawn_in_whole_pixels_black_on_white(qtbot: QtBot, qapp: QApplication) -> None:
    from nep_studio.ui.plugins.watches.qr_code import QUIET, QrCode, modules_of

    Look(qapp, "dark")
    code = QrCode()
    qtbot.addWidget(code)
    url = page_urls(8443, TOKEN, [ADDRESS])[0]
    code.show_url(url)
    code.resize(233, 240)
    code.show()

    image = code.grab().toImage()

    modules = modules_of(url)
    module = code.module_pixels()
    side = (len(modules) + 2 * QUIET) * module
    left, top = (image.width() - side) // 2, (image.height() - side) // 2
    colours = {image.pixelColor(left + x, top + y).name() for x in range(side) for y in range(side)}
    assert colours == {"#000000", "#ffffff"}
    for y, row in enumerate(modules, QUIET):
        for x, is_dark in enumerate(row, QUIET):
            middle = image.pixelColor(left + x * module + 1, top + y * module + 1).name()
            assert middle == ("#000000" if is_dark else "#ffffff")
    Look(qapp, "light")


def test_an_open_dialog_follows_the_theme(
    qtbot: QtBot, qapp: QApplication, runner: RecordingRunner
) -> None:
    look = Look(qapp, "light")
    made = WatchDialog(runner, Plan("watch"), TOKEN, look, None, lambda: [ADDRESS])
    qtbot.addWidget(made)
    made.begin()
    [picture, *_] = made.choosing.cards["phone_page"].findChildren(QLabel)
    before = picture.pixmap().toImage()

    look.choose("dark")

    assert picture.pixmap().toImage() != before
    made.show_connector("sensor_logger")
    look.choose("light")
    assert picture.pixmap().toImage() == before
    made.close()


@pytest.mark.parametrize("theme", themes())
@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_no_button_of_it_is_cut_off_in_any_look(
    qtbot: QtBot, qapp: QApplication, runner: RecordingRunner, theme: str, scale: float
) -> None:
    look = Look(qapp, theme, scale)
    made = WatchDialog(runner, Plan("watch"), TOKEN, look, None, lambda: [ADDRESS])
    qtbot.addWidget(made)
    made.begin()
    made.show_connector("udp")
    QApplication.processEvents()

    shown = [one for one in made.findChildren(QPushButton) if one.isVisible()]

    assert len(shown) >= 4
    for button in shown:
        assert button.width() >= button.fontMetrics().horizontalAdvance(button.text())
    for label in made.page.findChildren(QLabel):
        if label.isVisible() and label.wordWrap():
            assert label.height() >= label.heightForWidth(label.width()) - 1, label.text()
    made.close()
    Look(qapp, "light")

"""All icons of the window take the colours of another theme at once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import pytest
from PySide6.QtGui import QAction, QIcon, QImage
from PySide6.QtWidgets import (
    QAbstractButton,
    QComboBox,
    QDialog,
    QLabel,
    QListWidget,
    QMenu,
    QTabBar,
    QTreeWidget,
    QTreeWidgetItemIterator,
    QWidget,
)
from pytestqt.qtbot import QtBot

from nep_studio.ui.theme.colours import Theme, load_theme

SIDE = 32


def icons_of(window: QWidget) -> Iterator[tuple[str, QIcon]]:
    """Every icon inside a window, with where it is."""
    for action in window.findChildren(QAction):
        yield f"action {action.objectName() or action.text()}", action.icon()
    for menu in window.findChildren(QMenu):
        yield f"menu {menu.title()}", menu.icon()
    for button in window.findChildren(QAbstractButton):
        yield f"button {_place(button)} {button.text() or button.toolTip()}", button.icon()
    for bar in window.findChildren(QTabBar):
        for index in range(bar.count()):
            yield f"tab {bar.tabText(index)}", bar.tabIcon(index)
    for combo in window.findChildren(QComboBox):
        for index in range(combo.count()):
            yield f"choice {_place(combo)} {combo.itemText(index)}", combo.itemIcon(index)
    for rows in window.findChildren(QListWidget):
        for row in range(rows.count()):
            yield f"row {_place(rows)} {rows.item(row).text()}", rows.item(row).icon()
    for tree in window.findChildren(QTreeWidget):
        rest = QTreeWidgetItemIterator(tree)
        while item := rest.value():
            yield f"tree {_place(tree)} {item.text(0)}", item.icon(0)
            rest += 1
    for label in window.findChildren(QLabel):
        if label.isVisible() and not label.pixmap().isNull():
            yield f"label {_place(label)}", QIcon(label.pixmap())


def _place(widget: QWidget) -> str:
    path = []
    while widget is not None and not widget.isWindow() and len(path) < 5:
        path.append(type(widget).__name__)
        widget = widget.parentWidget()
    return "/".join(reversed(path))


def ink(icon: QIcon) -> str:
    """The colour in which most of an icon is drawn; empty for one of many colours."""
    image = icon.pixmap(SIDE).toImage().convertToFormat(QImage.Format.Format_ARGB32)
    found = Counter(
        colour.name()
        for x in range(image.width())
        for y in range(image.height())
        if (colour := image.pixelColor(x, y)).alpha() > 250
    )
    [(name, count)] = found.most_common(1) or [("", 0)]
    return name if count * 2 > found.total() else ""


def inks_of(theme: Theme) -> set[str]:
    return {colour.name() for colour in theme.colours.values()}


def kept_by(window: QWidget, qtbot: QtBot, name: str) -> list[str]:
    """Where icons keep a colour that only the light theme has, when another one is chosen."""
    window.studio.choose_theme(name)
    qtbot.waitUntil(lambda: window.look.theme.name == name)
    stale = inks_of(load_theme("light")) - inks_of(load_theme(name))
    return [place for place, icon in icons_of(window) if ink(icon) in stale]


@pytest.mark.parametrize("name", ["dark", "high_contrast"])
def test_no_icon_keeps_the_colour_of_the_old_theme(karate, qtbot, name) -> None:
    panels = karate.workbench.panels
    for panel in panels.all:
        panels.show(panel.widget)
    qtbot.waitUntil(lambda: karate.lazy.is_done)
    count = len(list(icons_of(karate)))

    assert kept_by(karate, qtbot, name) == []
    assert count > 100


def test_no_icon_of_the_start_page_keeps_the_colour_of_the_old_theme(window, qtbot) -> None:
    assert kept_by(window, qtbot, "dark") == []


def test_no_icon_of_an_open_dialog_keeps_the_colour_of_the_old_theme(karate, qtbot) -> None:
    karate.open_settings()
    qtbot.waitUntil(lambda: any(d.isVisible() for d in karate.findChildren(QDialog)))

    assert kept_by(karate, qtbot, "dark") == []

"""Dressing the application: palette, style sheet and lengths, and following the system."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QFontMetrics, QFontMetricsF, QIcon, QPalette, QPixmap
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QLabel,
    QLineEdit,
    QListWidget,
    QMenu,
    QPushButton,
    QSpinBox,
    QStyle,
    QStyleOptionSpinBox,
)
from pytestqt.qtbot import QtBot

from nep_studio.ui.theme.colours import Theme, load_theme
from nep_studio.ui.theme.look import (
    Fonts,
    Look,
    apply_theme,
    base_point_size,
    style_sheet,
    system_theme_name,
    text_font,
)


def test_the_palette_has_the_colours_of_the_theme(plain_app: QApplication, theme: Theme) -> None:
    apply_theme(plain_app, theme)

    palette = plain_app.palette()
    assert palette.color(QPalette.ColorRole.Window) == theme.colour("panel")
    assert palette.color(QPalette.ColorRole.Base) == theme.colour("field")
    assert palette.color(QPalette.ColorGroup.Disabled, QPalette.ColorRole.Text) == theme.colour(
        "disabled"
    )


def test_every_name_in_the_style_sheet_is_filled_in(fonts: Fonts, theme: Theme) -> None:
    sheet = style_sheet(theme, QFontMetricsF(text_font(11)))

    assert "$" not in sheet
    drawings = re.findall(r'url\("([^"]+)"\)', sheet)
    assert drawings
    assert all(Path(drawing).is_file() for drawing in drawings)


def test_a_field_is_painted_in_the_colour_of_fields(
    plain_app: QApplication, qtbot: QtBot, theme: Theme
) -> None:
    apply_theme(plain_app, theme)
    field = QLineEdit()
    qtbot.addWidget(field)
    field.resize(200, 60)

    middle = field.grab().toImage().pixelColor(100, 30)

    assert middle == theme.colour("field")


def test_a_selected_row_is_painted_in_the_colours_of_selection(
    plain_app: QApplication, qtbot: QtBot, theme: Theme
) -> None:
    apply_theme(plain_app, theme)
    rows = QListWidget()
    qtbot.addWidget(rows)
    rows.addItems(["one", "two"])
    rows.setCurrentRow(1)
    rows.resize(300, 200)

    rect = rows.visualItemRect(rows.item(1))
    spot = rows.viewport().grab().toImage().pixelColor(rect.right() - 10, rect.center().y())

    assert spot == theme.colour("selection")


@pytest.mark.parametrize("kind", [QPushButton, QLineEdit, QComboBox, QSpinBox, QLabel])
def test_widgets_grow_with_the_text(
    plain_app: QApplication, qtbot: QtBot, kind: type[QPushButton]
) -> None:
    heights = []
    for scale in (1.0, 1.5, 2.0):
        apply_theme(plain_app, load_theme("light"), scale)
        widget = kind()
        qtbot.addWidget(widget)
        widget.ensurePolished()
        heights.append((widget.sizeHint().height(), QFontMetrics(widget.font()).height()))

    assert all(height >= line for height, line in heights)
    assert all(first < second for first, second in itertools.pairwise(heights))


def test_rows_of_lists_are_higher_than_their_text(plain_app: QApplication, qtbot: QtBot) -> None:
    apply_theme(plain_app, load_theme("light"), 2.0)
    rows = QListWidget()
    qtbot.addWidget(rows)
    rows.addItems(["one", "two"])
    with qtbot.waitExposed(rows):
        rows.show()

    first, second = (rows.visualItemRect(rows.item(row)) for row in (0, 1))

    assert first.height() > QFontMetricsF(rows.font()).height() * 1.3
    assert not first.intersects(second)


def test_the_text_of_a_spin_box_lies_between_its_buttons(
    plain_app: QApplication, qtbot: QtBot
) -> None:
    apply_theme(plain_app, load_theme("light"))
    box = QSpinBox()
    qtbot.addWidget(box)
    box.resize(200, 40)
    option = QStyleOptionSpinBox()
    box.initStyleOption(option)

    up, down, text = (
        box.style().subControlRect(QStyle.ComplexControl.CC_SpinBox, option, part, box)
        for part in (
            QStyle.SubControl.SC_SpinBoxUp,
            QStyle.SubControl.SC_SpinBoxDown,
            QStyle.SubControl.SC_SpinBoxEditField,
        )
    )

    assert down.right() <= text.left() < text.right() <= up.left()


def test_dressing_again_does_not_let_the_text_grow(plain_app: QApplication) -> None:
    apply_theme(plain_app, load_theme("light"), 2.0)
    apply_theme(plain_app, load_theme("dark"), 1.0)

    assert plain_app.font().pointSizeF() == base_point_size(plain_app)


def test_a_system_that_does_not_say_has_the_light_theme(plain_app: QApplication) -> None:
    assert plain_app.styleHints().colorScheme() == Qt.ColorScheme.Unknown
    assert system_theme_name(plain_app.styleHints()) == "light"


def test_the_system_theme_follows_the_system(plain_app: QApplication, qtbot: QtBot) -> None:
    system = ["light"]
    look = Look(plain_app, read_system=lambda hints: system[0])
    first = look.theme.name

    system[0] = "dark"
    with qtbot.waitSignal(look.theme_changed):
        plain_app.styleHints().colorSchemeChanged.emit(Qt.ColorScheme.Dark)

    assert (first, look.theme.name, look.choice) == ("light", "dark", "system")
    assert plain_app.palette().color(QPalette.ColorRole.Window) == look.theme.colour("panel")
    look.deleteLater()


def test_a_chosen_theme_stays_when_the_system_changes(plain_app: QApplication) -> None:
    look = Look(plain_app, "high_contrast")

    plain_app.styleHints().colorSchemeChanged.emit(Qt.ColorScheme.Light)

    assert look.theme.name == "high_contrast"
    look.deleteLater()


def test_a_theme_that_is_not_known_any_more_means_the_system(plain_app: QApplication) -> None:
    look = Look(plain_app, "solarised")

    assert (look.choice, look.theme.name) == ("system", "light")
    look.deleteLater()


def test_a_larger_scale_is_told_to_the_views(plain_app: QApplication, qtbot: QtBot) -> None:
    look = Look(plain_app, "light")

    with qtbot.waitSignal(look.theme_changed):
        look.set_scale(1.5)

    assert plain_app.font().pointSizeF() == base_point_size(plain_app) * 1.5
    look.deleteLater()


def test_the_signs_in_menus_grow_with_the_words_which_begin_below_each_other(
    plain_app: QApplication, qtbot: QtBot, theme: Theme
) -> None:
    apply_theme(plain_app, theme, 2.0)
    menu = QMenu()
    qtbot.addWidget(menu)
    pixmap = QPixmap(64, 64)
    pixmap.fill(Qt.GlobalColor.transparent)
    icon = QIcon(pixmap)  # nothing is seen of it
    entries = [menu.addAction(icon, "H"), menu.addAction("H")]
    menu.popup(QPoint())
    image = menu.grab().toImage()
    side = menu.style().pixelMetric(QStyle.PixelMetric.PM_SmallIconSize, None, menu)

    def begin(entry: QAction) -> int:
        row = menu.actionGeometry(entry)
        y = row.center().y()
        back = image.pixelColor(row.right() - 3, y)
        return next(x for x in range(row.left() + 3, row.right()) if image.pixelColor(x, y) != back)

    assert side > 0.8 * menu.fontMetrics().height()
    assert abs(begin(entries[0]) - begin(entries[1])) <= 1


def test_a_list_of_choices_shows_all_of_a_few(
    plain_app: QApplication, qtbot: QtBot, theme: Theme
) -> None:
    apply_theme(plain_app, theme, 1.5)
    choices = QComboBox()
    qtbot.addWidget(choices)
    choices.addItems(["karate", "batting", "hand up"])
    with qtbot.waitExposed(choices):
        choices.show()

    choices.showPopup()
    qtbot.waitUntil(choices.view().isVisible)

    last = choices.view().visualRect(choices.model().index(2, 0))
    assert choices.view().viewport().rect().contains(last)
    choices.hidePopup()

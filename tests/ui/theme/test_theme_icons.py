"""The icons: there, in the colour asked for, and sharp on any screen."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QColor, QIcon, QPixmap
from PySide6.QtSvg import QSvgRenderer
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.ui.theme.colours import Theme, load_theme
from nep_studio.ui.theme.icons import (
    CATEGORY_ICONS,
    UnknownIcon,
    application_icon,
    category_icon_name,
    icon,
    icon_path,
    icon_pixmap,
    wear,
)

NAMES = sorted(path.stem for path in (paths.resources() / "icons").glob("*.svg"))


def colours_in(pixmap: QPixmap) -> set[str]:
    """The colours of the solid pixels."""
    image = pixmap.toImage()
    pixels = (image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height()))
    return {pixel.name() for pixel in pixels if pixel.alpha() == 255}


def is_all(pixmap: QPixmap, colour: str) -> bool:
    """Whether all solid pixels have this colour, but for what rounding does to it."""
    wanted = QColor(colour).getRgb()
    found = [QColor(it).getRgb() for it in colours_in(pixmap)]
    return bool(found) and all(
        abs(a - b) <= 2 for one in found for a, b in zip(one, wanted, strict=True)
    )


@pytest.mark.parametrize("name", NAMES)
def test_every_icon_can_be_drawn_in_any_colour(qtbot: QtBot, name: str) -> None:
    drawn = icon_pixmap(name, QColor("#cc3311"), 24, 2)

    assert QSvgRenderer(str(icon_path(name))).isValid()
    assert is_all(drawn, "#cc3311") or name == "nep-studio"


def test_every_category_icon_is_there() -> None:
    assert set(CATEGORY_ICONS.values()) <= set(NAMES)


def test_a_category_without_an_icon_gets_the_one_of_blocks() -> None:
    assert icon_path(category_icon_name("plaid")).is_file()


def test_a_name_that_does_not_exist_is_told_at_once(qtbot: QtBot) -> None:
    with pytest.raises(UnknownIcon, match="no-such-icon"):
        icon("no-such-icon", QColor("black"))


def test_an_icon_has_the_colours_of_its_theme(qtbot: QtBot, theme: Theme) -> None:
    made = icon("save", theme)

    usual = made.pixmap(QSize(32, 32), 1.0, QIcon.Mode.Normal)
    disabled = made.pixmap(QSize(32, 32), 1.0, QIcon.Mode.Disabled)

    assert is_all(usual, theme.colour("text").name())
    assert is_all(disabled, theme.colour("disabled").name())


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0, 3.0])
def test_an_icon_has_as_many_pixels_as_the_screen_shows(qtbot: QtBot, ratio: float) -> None:
    pixmap = icon("bot", QColor("black")).pixmap(QSize(20, 20), ratio)

    assert pixmap.size() == QSize(20, 20) * ratio
    assert pixmap.devicePixelRatio() == ratio


def test_a_copied_icon_draws_itself_still(qtbot: QtBot) -> None:
    made = [QIcon(icon("bot", QColor("#0000ff"))) for _ in range(50)]

    assert all(is_all(one.pixmap(24, 24), "#0000ff") for one in made)


def test_the_application_icon_keeps_its_own_colours(qtbot: QtBot) -> None:
    assert {"#e9ae2e", "#2b7f88"} <= colours_in(application_icon().pixmap(128, 128))


def test_the_licence_is_beside_the_icons() -> None:
    assert "ISC License" in (paths.resources() / "icons" / "LICENSE-lucide.txt").read_text()


def test_an_icon_of_the_theme_that_is_worn_follows_the_windows_to_another(qtbot: QtBot) -> None:
    light, dark = load_theme("light"), load_theme("dark")
    wear(light)
    worn, other = icon("save", light, "accent"), icon("save", dark)

    wear(dark)
    shown = worn.pixmap(QSize(32, 32)), other.pixmap(QSize(32, 32))
    wear(load_theme("high_contrast"))

    assert is_all(shown[0], dark.colour("accent").name())
    assert is_all(shown[1], dark.colour("text").name())
    assert is_all(other.pixmap(QSize(32, 32)), dark.colour("text").name())
    wear(light)

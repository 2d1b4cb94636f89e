"""Finds out about screen, graphics, fonts and sound, in a process that a driver may end."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import msgspec

from nep_core.cli.doctor import Finding


def main(_arguments: list[str]) -> int:
    """Print a finding a line, as JSON, each at once: what comes first is known if this ends."""
    for found in findings():
        sys.stdout.buffer.write(msgspec.json.encode(found) + b"\n")
        sys.stdout.buffer.flush()
    return 0


def findings() -> Iterator[Finding]:
    """What there is, the graphics card last."""
    import PySide6
    from PySide6.QtCore import qVersion

    yield Finding("Qt", "ok", f"{qVersion()}, PySide6 {PySide6.__version__}")
    yield from _sound()
    from PySide6.QtWidgets import QApplication

    app = QApplication(sys.argv[:1])
    yield Finding("platform of Qt", "ok", app.platformName())
    yield from _screens()
    yield from _fonts()
    yield from _graphics()


def _sound() -> Iterator[Finding]:
    import importlib.util

    from nep_studio.ui.speech.robot_voices import find_player
    from nep_studio.ui.speech.voices import MODULE, find_system_voice

    voice, player = find_system_voice(), find_player()
    with_qt = "Qt's voices are there" if importlib.util.find_spec(MODULE) else ""
    told = [voice.name if voice is not None else "", with_qt]
    yield _found("voice", ", ".join(filter(None, told)), "none: robots on the screen are silent")
    yield _found("sound", player.name if player is not None else "", "no player of sound files")


def _found(about: str, told: str, missing: str) -> Finding:
    return Finding(about, "ok", told) if told else Finding(about, "note", missing)


def _screens() -> Iterator[Finding]:
    from PySide6.QtGui import QGuiApplication

    for number, screen in enumerate(QGuiApplication.screens(), 1):
        size = screen.size()
        told = (
            f"{size.width()} x {size.height()} at {screen.devicePixelRatio():.0%},"
            f" {screen.logicalDotsPerInch():.0f} dots per inch, {screen.refreshRate():.0f} Hz,"
            f" {screen.depth()} bits"
        )
        yield Finding(f"screen {number}", "ok", told)
    hints = QGuiApplication.styleHints()
    accessibility = hints.accessibility()
    contrast = accessibility.contrastPreference().name
    scheme = hints.colorScheme().name
    yield Finding("colours", "ok", f"{scheme.lower()}, contrast {contrast.lower()}")


def _fonts() -> Iterator[Finding]:
    from PySide6.QtGui import QFontDatabase, QGuiApplication

    from nep_studio.ui.theme.look import load_fonts

    count = len(QFontDatabase.families())
    font = QGuiApplication.font()
    yield Finding("fonts", "ok", f"{count} families, {font.family()} {font.pointSizeF():g} pt")
    ours = load_fonts()
    shipped = ", ".join((ours.text[0], ours.code[0])) if ours.text and ours.code else ""
    yield _found("our fonts", shipped, "the shipped fonts could not be loaded")


def _graphics() -> Iterator[Finding]:
    from nep_studio.ui.robot_view.drawing import NoContext
    from nep_studio.ui.robot_view.gl_context import GlContext

    try:
        context = GlContext.made()
    except NoContext as error:
        yield Finding("graphics", "note", f"{error}: robots are drawn without the graphics card")
        return
    version = context.context.format().version()
    speed = "" if context.is_fast else ", without a graphics card"
    told = f"OpenGL {version[0]}.{version[1]} of {context.renderer}{speed}"
    context.leave()
    yield Finding("graphics", "ok", told)

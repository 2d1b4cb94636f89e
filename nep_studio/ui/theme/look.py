"""The look that a person chose, which follows the system where they left it to the system."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QStyleHints
from PySide6.QtWidgets import QApplication

from nep_studio.ui.theme.applying import apply_theme
from nep_studio.ui.theme.colours import DARK, HIGH_CONTRAST, LIGHT, Theme, load_theme, themes

SYSTEM = "system"


def system_theme_name(hints: QStyleHints) -> str:
    """Return the theme that fits the system; light where the system does not say."""
    if hints.accessibility().contrastPreference() == Qt.ContrastPreference.HighContrast:
        return HIGH_CONTRAST
    return DARK if hints.colorScheme() == Qt.ColorScheme.Dark else LIGHT


class Look(QObject):
    """The theme and the size of text in use; views listen to ``theme_changed``.

    ``read_system`` says which theme fits the system at the moment.
    """

    theme_changed = Signal(object)  # the Theme

    def __init__(
        self,
        app: QApplication,
        choice: str = SYSTEM,
        scale: float = 1.0,
        read_system: Callable[[QStyleHints], str] = system_theme_name,
    ) -> None:
        super().__init__(app)
        self._app, self._choice, self._scale = app, SYSTEM, scale
        self._read_system = read_system
        hints = app.styleHints()
        hints.colorSchemeChanged.connect(self._on_system_changed)
        hints.accessibility().contrastPreferenceChanged.connect(self._on_system_changed)
        self._theme = load_theme(LIGHT)
        self.choose(choice)

    @property
    def choice(self) -> str:
        """What the person chose: a theme's name, or "system"."""
        return self._choice

    @property
    def theme(self) -> Theme:
        """The theme in use."""
        return self._theme

    @property
    def scale(self) -> float:
        """How much larger than the system's the text is."""
        return self._scale

    def choose(self, choice: str) -> None:
        """Use a theme by its name, or "system"; a name that is not known means the system."""
        self._choice = choice if choice in themes() else SYSTEM
        self._tell_the_system()
        self._apply()

    def set_scale(self, scale: float) -> None:
        """Make the text, and all that is measured by it, this much larger than the system's."""
        self._scale = scale
        self._apply()

    def refresh(self) -> None:
        """Dress the windows again, as after a change of the direction of writing."""
        self._apply()

    def _tell_the_system(self) -> None:
        """Let title bars and the system's own dialogs be as light or dark as we are."""
        hints = self._app.styleHints()
        if self._choice == SYSTEM:
            hints.unsetColorScheme()
            return
        is_dark = load_theme(self._choice).is_dark
        hints.setColorScheme(Qt.ColorScheme.Dark if is_dark else Qt.ColorScheme.Light)

    def _on_system_changed(self) -> None:
        if self._choice == SYSTEM:
            self._apply()

    def _apply(self) -> None:
        is_left = self._choice == SYSTEM
        name = self._read_system(self._app.styleHints()) if is_left else self._choice
        self._theme = load_theme(name)
        apply_theme(self._app, self._theme, self._scale)
        self.theme_changed.emit(self._theme)

"""What all parts of the window share: built once for the life of the program.

It knows neither the window nor what stands in it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QApplication, QWidget

from nep_studio import settings
from nep_studio.settings import Settings
from nep_studio.support import safe_mode
from nep_studio.ui import words
from nep_studio.ui.document_files import FileChooser, Files, SystemFileChooser
from nep_studio.ui.labels import tell_again
from nep_studio.ui.messages import Messages
from nep_studio.ui.theme.look import Look, load_fonts

if TYPE_CHECKING:
    from nep_studio.blocks.language import Language
    from nep_studio.ui.documents import Document
    from nep_studio.ui.running.control import RunControl
    from nep_studio.ui.running.runner import Runner


class Studio(QObject):
    """What all parts of the window share.

    ``words_changed`` comes after a change of language, before the words are told again that are
    labels: the blocks speak first.
    """

    words_changed = Signal()

    def __init__(self, app: QApplication, chosen: Settings | None = None) -> None:
        super().__init__(app)
        self.app = app
        usual = safe_mode.passing_settings if safe_mode.is_on() else Settings
        self.settings = chosen or usual()
        load_fonts()
        self._use_words()
        self.look = Look(app, self.settings.theme, self.settings.text_scale)
        self._language: Language | None = None

    @property
    def language(self) -> Language:
        """The blocks that there are; their files are read when somebody first asks."""
        if self._language is None:
            self.read_language()
        assert self._language is not None
        return self._language

    @language.setter
    def language(self, language: Language) -> None:
        self._language = language

    def read_language(self) -> None:
        """Read the files of the blocks now."""
        from nep_studio.run.installation import studio_language  # the first page needs none

        self._language = studio_language(words.language_code())

    def choose_theme(self, name: str) -> None:
        """Use a theme from now on."""
        self.settings.theme = name
        self.look.choose(name)

    def choose_text_scale(self, scale: float) -> None:
        """Make the text larger or smaller from now on."""
        self.settings.text_scale = scale
        self.look.set_scale(self.settings.text_scale)

    def choose_language(self, code: str) -> None:
        """Speak a language from now on; "system" is the computer's."""
        self.settings.language = code
        was_mirrored = words.is_right_to_left()
        self._use_words()
        self._language = None
        if words.is_right_to_left() != was_mirrored:
            self.look.refresh()
        self.words_changed.emit()
        tell_again()

    def _use_words(self) -> None:
        code = self.settings.language
        if code == settings.SYSTEM:
            code = settings.system_language(words.available_languages())
        words.use_language(code)
        is_mirrored = words.is_right_to_left()
        direction = (
            Qt.LayoutDirection.RightToLeft if is_mirrored else Qt.LayoutDirection.LeftToRight
        )
        self.app.setLayoutDirection(direction)


class Services(QObject):
    """The files, the messages, what runs, and what the studio knows of the person's choices.

    ``over`` is the widget that dialogs lie over. ``make_running`` makes what runs the project; it
    is called when somebody first asks for it, for a start needs none of it.
    """

    def __init__(
        self,
        studio: Studio,
        over: QWidget,
        make_running: Callable[[], RunControl],
        chooser: FileChooser | None = None,
    ) -> None:
        super().__init__(over)
        self.studio = studio
        self.settings, self.look = studio.settings, studio.look
        self.messages = Messages(over)
        chooser = chooser or SystemFileChooser()
        self.files = Files(lambda: studio.language, studio.settings, self.messages, chooser, over)
        self._make_running = make_running
        self.made_running: RunControl | None = None

    @property
    def language(self) -> Language:
        """The blocks that there are."""
        return self.studio.language

    @property
    def document(self) -> Document | None:
        """The project that is open."""
        return self.files.document

    @cached_property
    def running(self) -> RunControl:
        """What runs the project, made when somebody first asks."""
        self.made_running = self._make_running()
        return self.made_running

    @cached_property
    def runner(self) -> Runner:
        """The program and its nodes while they run: what is heard of them, what is told them."""
        return self.running.runner

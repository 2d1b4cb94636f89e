"""Two buttons that tell the recogniser what it did wrong, while one tries it out."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtWidgets import QMenu, QPushButton, QWidget

from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.results.corrections import keep_false_alarm, keep_missed
from nep_studio.ui.trainer.results.looks import Looks
from nep_studio.ui.words import tr

MISSED_S, ALARM_S = 6.0, 10.0
"""How far back a missed gesture, and a false alarm, is looked for."""
USUAL_S = 1.5
"""A movement of which nothing is known is taken to be so long."""


class CorrectionBar(QWidget):
    """``looks`` gives what the recogniser saw in the last half minute."""

    def __init__(
        self, desk: TrainerDesk, looks: Callable[[], Looks], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._desk, self._looks = desk, looks
        self.missed = QPushButton(tr("It missed it"))
        self.missed.setToolTip(tr("Keep the last seconds as a take more of a gesture"))
        self.false_alarm = QPushButton(tr("False alarm"))
        self.false_alarm.setToolTip(tr("Keep the last seconds as everyday movement"))
        self.menu = QMenu(self.missed)
        self.menu.aboutToShow.connect(self.fill_menu)
        self.missed.setMenu(self.menu)
        self.false_alarm.clicked.connect(self.keep_false_alarm)
        row = FlowLayout(self)
        row.addWidget(self.missed)
        row.addWidget(self.false_alarm)

    def fill_menu(self) -> None:
        """Offer the gestures that may have been missed."""
        self.menu.clear()
        for name, gesture in self._desk.gestures.items():
            action = self.menu.addAction(gesture.title.replace("&", "&&"))
            action.triggered.connect(partial(self.keep_missed, name))

    def keep_missed(self, name: str, _is_on: bool = False) -> None:
        """Keep the movement of the last seconds that is most like a gesture as a take of it."""
        live, looks = self._desk.live, self._looks()
        if live is None:
            return
        best = looks.best(name, looks.now_s - MISSED_S)
        end_s = best.t_end if best is not None else live.last_t
        start_s = best.t_start if best is not None else end_s - USUAL_S
        title = self._desk.gestures[name].title
        is_kept = keep_missed(self._desk, name, start_s, end_s)
        self._tell(is_kept, tr("Kept as a take of “{gesture}”", gesture=title))

    def keep_false_alarm(self) -> None:
        """Keep what caused the last trigger as everyday movement."""
        live = self._desk.live
        if live is None:
            return
        recent = [one for one in self._looks().triggers if one.t_end > live.last_t - ALARM_S]
        end_s = recent[-1].t_end if recent else live.last_t
        start_s = recent[-1].t_start if recent else end_s - 2 * USUAL_S
        is_kept = keep_false_alarm(self._desk, start_s, end_s)
        self._tell(is_kept, tr("Kept as everyday movement"))

    def _tell(self, is_kept: bool, words: str) -> None:
        if is_kept:
            self._desk.messages.confirm(words)
        else:
            self._desk.messages.refuse(
                "Too little movement was heard in the last seconds.",
                ("Make the movement, then press the button at once.",),
            )

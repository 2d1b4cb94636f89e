"""The menus of gestures, of takes and of the whole panel."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QMenu

from nep_studio.ui.motion.menu_titles import add_title
from nep_studio.ui.theme import icon
from nep_studio.ui.trainer.cards import Cards
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.keeping import Keeping
from nep_studio.ui.words import tr

EVERYDAY_S = (30, 120)


class Menus:
    """Makes menus; ``cards`` has the gesture that is meant."""

    def __init__(self, desk: TrainerDesk, keeping: Keeping, cards: Cards) -> None:
        self._desk, self._keeping, self._cards = desk, keeping, cards

    def of_gesture(self, name: str) -> QMenu:
        """What can be done with a gesture."""
        card = self._cards.cards[name]
        menu = QMenu(self._cards)
        self._add(menu, "circle-dot", tr("Record"), lambda: self._cards.record_asked.emit(name))
        words = tr("Add the block “{words}”", words=card.chip.text())
        self._add(menu, "blocks", words, card.chip.add_block)
        self._add(menu, "pencil", tr("Another name…"), card.edit_title)
        menu.addSeparator()
        words = tr("Delete the gesture with its takes")
        self._add(menu, "trash-2", words, lambda: self._keeping.delete_gesture(name))
        return menu

    def of_take(self, name: str) -> QMenu | None:
        """What can be done with the take at the keyboard; None when there is none."""
        card = self._cards.cards[name]
        ids = card.takes.chosen
        found = self._desk.find_take(ids[0]) if ids else None
        if found is None:
            return None
        take, menu = found[1], QMenu(self._cards)
        self._add(menu, "maximize", tr("Look at it"), lambda: self._desk.choose_take(take.id))
        is_out = take.left_out
        words = tr("Learn from it again") if is_out else tr("Do not learn from it")
        sign = "eye" if is_out else "eye-off"
        self._add(menu, sign, words, lambda: self._keeping.leave_out(ids, not is_out))
        others = {key: one.title for key, one in self._desk.gestures.items() if key != name}
        if others:
            add_title(menu, tr("It is a take of"))
            for key, title in others.items():
                words = title.replace("&", "&&")
                self._add(menu, "hand", words, partial(self._keeping.relabel_takes, ids, key))
        menu.addSeparator()
        words = tr("Delete the take")
        self._add(menu, "trash-2", words, lambda: self._keeping.delete_takes(ids))
        return menu

    def of_everyday(self, record: Callable[[float], object]) -> QMenu:
        """What records everyday movement, and what there is of it."""
        menu = QMenu(self._cards)
        for seconds in EVERYDAY_S:
            is_short = seconds < 60
            words = (
                tr("Record {seconds} seconds", seconds=seconds)
                if is_short
                else tr("Record {minutes} minutes", minutes=seconds // 60)
            )
            self._add(menu, "circle-dot", words, partial(record, float(seconds)))
        kept = {key: one for key, one in self._desk.recordings.items() if one.everyday}
        if kept:
            add_title(menu, tr("Delete a recording"))
        for key, one in kept.items():
            when = one.recorded[:16].replace("T", " ")
            words = tr(
                "{person}, {seconds} s, {when}",
                person=one.person or tr("Somebody"),
                seconds=round(one.seconds),
                when=when,
            ).replace("&", "&&")
            self._add(menu, "trash-2", words, partial(self._keeping.delete_recording, key))
        return menu

    def of_panel(self, parts: list[tuple[str, str, Callable[[], object], bool]]) -> QMenu:
        """Sign, words, what it does, and whether it can be done now."""
        menu = QMenu(self._cards)
        for sign, words, do, is_possible in parts:
            self._add(menu, sign, words, do, is_possible=is_possible)
        return menu

    def _add(
        self,
        menu: QMenu,
        sign: str,
        words: str,
        do: Callable[[], object],
        *,
        is_possible: bool = True,
    ) -> None:
        action = menu.addAction(icon(sign, self._desk.look.theme), words)
        action.triggered.connect(lambda _is_on=False: do())
        action.setEnabled(is_possible)


def show_menu(menu: QMenu | None, place: QPoint) -> None:
    """Show a menu at a place of the screen; it goes when it is closed."""
    if menu is not None:
        menu.aboutToHide.connect(menu.deleteLater)
        menu.popup(place)

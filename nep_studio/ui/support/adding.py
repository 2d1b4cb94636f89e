"""What a window tells after its start: that it runs in safe mode, or that nothing is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio import portable, safe_mode, settings
from nep_studio.ui.main_window_dialogs import show_report
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr
from nep_studio.updates import UpdateChoice

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow


def tell_how_it_runs(window: MainWindow) -> None:
    """Tell what is unusual, and look for a newer version if the person wants that."""
    if safe_mode.is_on():
        window.messages.tell(_safe_mode(window))
    if folder := portable.not_kept():
        window.messages.tell(_nothing_kept(str(folder)))
    if UpdateChoice(window.settings).is_wanted and not safe_mode.is_on():
        from nep_studio.ui.support.asking import ask_if_due

        ask_if_due(window)


def _safe_mode(window: MainWindow) -> Message:
    sentence = tr(
        "Your settings, snippets and own nodes are left out, and settings that you change are"
        " not kept. Work that was not saved is offered again at the next usual start."
    )
    steps = (
        tr("Does all work here? Then set your settings aside, and start as usual."),
        tr("If it fails again, send a report to those who help you."),
    )
    answers = (
        Answer(tr("Set the settings aside"), lambda: _set_aside(window)),
        Answer(tr("Report for support…"), lambda: show_report(window)),
    )
    return Message("info", tr("This is safe mode"), sentence, steps, answers=answers)


def _set_aside(window: MainWindow) -> None:
    folder = settings.user_folder()
    if safe_mode.set_settings_aside(folder):
        title = tr("The next usual start is as the first one")
        sentence = tr("Your old settings are in {file}.", file=str(folder / "settings.old.ini"))
        window.messages.tell(Message("success", title, sentence))
    else:
        window.messages.tell(Message("info", tr("There are no settings to set aside")))


def _nothing_kept(folder: str) -> Message:
    sentence = tr(
        "The program cannot write into {folder}. Settings, logs and unsaved work are gone when"
        " it ends.",
        folder=folder,
    )
    steps = (
        tr("Is the stick write-protected, or full?"),
        tr("Save your projects in another place."),
    )
    return Message("warning", tr("Nothing is kept"), sentence, steps)

"""Connecting a watch or phone: choose the way, follow its steps, see what arrives, use it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from nep_studio.blocks.deployment import names_used, node_entries
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.fixes import USUAL_NAME, WATCH, free_name, use_watch, watch_entry
from nep_studio.blocks.own_gestures import own_gestures
from nep_studio.run.plan import VIRTUAL_WATCH, PlannedNode, with_takes
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.messages import Answer, Message
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from .dialog import Plan, WatchDialog


# Puts “Connect a watch or phone” into the window: its action, and what “Use” changes.

RECORDINGS = "recordings"
MOST_GESTURES = 5
"""So many are offered to be made by a simulated person when the program waits for none yet."""


def make(host: Host) -> Parts:
    """The action, in the Robots menu; others open the dialog from where a watch is missing."""
    kit = WatchKit(host)
    action = NewAction(
        "connect_watch",
        "Connect a watch or phone…",
        kit.open,
        "watch",
        tip="Let the movements of a real watch or phone into this project.",
        menu="robots",
    )
    return Parts(actions=[action], commands={"watches.open": kit.open})


class WatchKit(QObject):
    """What the action does; the dialog is loaded when it is opened, and there is one."""

    def __init__(self, host: Host) -> None:
        super().__init__(host.actions)
        self._host = host
        self._token = ""
        self.dialog: WatchDialog | None = None
        host.services.files.document_changed.connect(self._on_document_changed)

    def open(self) -> None:
        """Show the dialog; when another watch is in use, ask first."""
        host = self._host
        if host.services.document is None:
            host.services.messages.refuse(
                tr("There is no project to run."), (tr("Open or make one first."),)
            )
        elif self.dialog is not None:
            self.dialog.raise_()
            self.dialog.activateWindow()
        elif self._is_in_use(name := self._plan().name):
            self._ask(name)
        else:
            self._show(self._plan())

    def _ask(self, name: str) -> None:
        """A watch is connected: it may be looked at, or another one comes beside it."""
        words = tr("“{name}” is connected now. What would you like?", name=name)
        answers = (
            Answer(tr("See or change it"), lambda: self._show(self._plan()), "primary"),
            Answer(tr("Connect another one"), lambda: self._show(self._plan(is_another=True))),
            Answer(tr("Cancel"), lambda: None),
        )
        self._host.services.messages.ask(
            Message("info", tr("A watch is in use"), words, answers=answers)
        )

    def _show(self, plan: Plan) -> None:
        from nodes.sensory.phone_page.site import new_token

        from .dialog import WatchDialog

        host = self._host
        self._token = self._token or new_token()
        runner, look = host.services.runner, host.services.look
        dialog = self.dialog = WatchDialog(runner, plan, self._token, look, host.widget)
        dialog.used.connect(lambda: self._use(dialog))
        dialog.finished.connect(self._on_finished)
        host.services.studio.words_changed.connect(dialog.reject)  # it speaks the one before
        dialog.begin()

    def _plan(self, *, is_another: bool = False) -> Plan:
        """What the project says of its watch."""
        from .dialog import Plan

        editor = self._host.workbench.canvas.editor
        folder = self._host.services.settings.last_folder / RECORDINGS
        blank = Plan(
            free_name(editor, USUAL_NAME),
            gestures=self._gestures(),
            wanted=self._wanted(),
            folder=folder,
            equip=lambda node: with_takes(node, editor.project),
        )
        entry = watch_entry(node_entries(editor.project, editor.language))
        if is_another or entry is None:
            return blank
        if entry.node != WATCH:  # what stands in for a watch: its name may do for a watch too
            return replace(blank, name=USUAL_NAME) if entry.name == USUAL_NAME else blank
        return replace(
            blank, name=entry.name, settings=dict(entry.parameters) or {"through": "udp"}
        )

    def _gestures(self) -> dict[str, str]:
        """What a simulated person can make, names to titles."""
        from nodes.sensory.arm.gestures import GESTURES

        editor = self._host.workbench.canvas.editor
        own = own_gestures(editor.project)
        offered = self._host.services.language.choices.get("gestures", {})
        return {
            **{name: one.title for name, one in own.items() if one.takes},
            **{name: title for name, title in offered.items() if name in GESTURES},
        }

    def _wanted(self) -> list[str]:
        """What it begins with: what the program waits for, else the first few that are offered."""
        editor, known = self._host.workbench.canvas.editor, self._gestures()
        used = names_used(editor.project, editor.language, "gesture")
        return [name for name in used if name in known] or list(known)[:MOST_GESTURES]

    def _is_in_use(self, name: str) -> bool:
        """Whether a real watch of this name sends now."""
        status = self._host.services.runner.board.nodes.get(name)
        if status is None or not status.is_there:
            return False
        return status.event == "connected" or (status.event == "warning" and bool(status.measures))

    def _use(self, dialog: WatchDialog) -> None:
        """Let the watch that runs be the project's; one step of undo."""
        planned, host = dialog.planned, self._host
        if planned is None:
            dialog.trial.end()
            return
        try:
            editor = host.workbench.canvas.editor
            with editor.history.as_own():
                block = use_watch(
                    editor,
                    planned.parameters,
                    tr("connect a watch"),
                    node=planned.node,
                    name=planned.name,
                )
        except EditRefused as refusal:
            dialog.trial.end()
            host.services.messages.refuse(refusal.sentence, refusal.checklist)
            return
        runner = host.services.runner
        # The virtual watches that run, and that the project does not ask for any more
        started = runner.started
        wanted = {node.name for node in self._host.services.runner.planned()}
        virtual = [one.name for one in started.values() if one.node == VIRTUAL_WATCH]
        for name in [name for name in virtual if name not in wanted]:
            runner.stop_node(name)
        dialog.trial.keep(self._planned_of(block))
        told = tr("“{name}” gives the movements now", name=planned.name)
        host.workbench.show_change(block, told)

    def _planned_of(self, block: str) -> PlannedNode | None:
        planned = self._host.services.runner.planned()
        return next((node for node in planned if node.block_id == block), None)

    def _on_finished(self) -> None:
        self.dialog = None

    def _on_document_changed(self) -> None:
        """Another project: what is being connected was for the last one."""
        self._token = ""
        if self.dialog is not None:
            self.dialog.reject()


plugin = Plugin("watches", make, order=150)

"""Popups that choose by name and can make the name: variables and robots."""

from __future__ import annotations

from collections.abc import Callable

from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.project import RemoveVariable, RenameVariable, SetScope
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.finding import why_not_robot_name
from nep_studio.blocks.places import InStack, variable_uses
from nep_studio.blocks.program import ALL_ROBOTS, ROBOT_BLOCK, SCOPE_KEPT, SCOPE_PROGRAM
from nep_studio.ui.words import count_words, tr

from .choice import ChoicePopup, Option
from .popup import Question

ICONS = {SCOPE_PROGRAM: "layers", SCOPE_KEPT: "save"}
"""The signs of variables that have another scope than the usual one."""
_SCOPE = "scope:"


class VariablePopup(ChoicePopup):
    """A variable: choose one, make one, rename or delete the one that is chosen."""

    def options(self) -> list[Option]:
        """The variables of the project."""
        variables = self._editors.canvas.editor.project.variables
        return [Option(one.name, one.id, ICONS.get(one.scope, "variable")) for one in variables]

    def more_rows(self) -> list[Option]:
        """Make, rename, delete."""
        rows = [Option(tr("new variable…"), icon="plus", action="new")]
        if self._name:
            named = {"name": self._name}
            rows.append(Option(tr("rename “{name}”…", **named), icon="pencil", action="rename"))
            rows.append(Option(tr("delete “{name}”…", **named), icon="trash-2", action="delete"))
            rows += self._scopes()
        return rows

    def _scopes(self) -> list[Option]:
        """Where the chosen variable is known: a sign stands at what holds now."""
        variable = self._editors.canvas.editor.project.variable(str(self.edit.value))
        now = variable.scope if variable is not None and variable.scope in ICONS else ""
        words = {
            "": tr("only where it is set first (usual)"),
            SCOPE_PROGRAM: tr("for the whole program"),
            SCOPE_KEPT: tr("kept for the next run"),
        }
        return [
            Option(text, icon="check" if scope == now else "", action=f"{_SCOPE}{scope}")
            for scope, text in words.items()
        ]

    def act(self, action: str) -> None:
        """Ask for the name, or whether to delete; or say where the variable is known."""
        if action.startswith(_SCOPE):
            edit = SetScope(str(self.edit.value), action.removeprefix(_SCOPE))
            self._close_after(lambda: self._editors.canvas.editor.apply(edit))
            return
        if action == "delete":
            self.ask(self._delete_question())
            return
        words = tr("Name of the new variable") if action == "new" else tr("New name")
        answered = self._on_made if action == "new" else self._on_renamed
        yes = tr("Make") if action == "new" else tr("Rename")
        name = self.search.text() if action == "new" else self._name
        self.ask(Question(words, yes, answered=answered, refused=lambda: self.ask(None), name=name))

    @property
    def _name(self) -> str:
        variable = self._editors.canvas.editor.project.variable(str(self.edit.value))
        return variable.name if variable is not None else ""

    def _delete_question(self) -> Question:
        project = self._editors.canvas.editor.project
        uses = len(variable_uses(project, str(self.edit.value)))
        words = count_words(
            uses,
            "One block uses the variable “{name}”. It stays, without a variable.",
            "{n} blocks use the variable “{name}”. They stay, without a variable.",
            name=self._name,
        )
        return Question(
            words, tr("Delete"), answered=self._on_deleted, refused=lambda: self.ask(None)
        )

    def _on_made(self, name: str) -> None:
        editor = self._editors.canvas.editor

        def make() -> None:
            with editor.transaction(tr("make a variable")):
                variable = editor.add_variable(name.strip())
                editor.apply(SetField(self.edit.block, self.edit.key, variable))

        self._close_after(make)

    def _on_renamed(self, name: str) -> None:
        edit = RenameVariable(str(self.edit.value), name.strip())
        self._close_after(lambda: self._editors.canvas.editor.apply(edit))

    def _on_deleted(self, _name: str) -> None:
        edit = RemoveVariable(str(self.edit.value))
        self._close_after(lambda: self._editors.canvas.editor.apply(edit))

    def _close_after(self, change: Callable[[], object]) -> None:
        """Make a change, and go away; say why not when the editor refuses it."""
        try:
            change()
        except EditRefused as refused:
            self.reason.tell(refused.sentence)
            self.adjustSize()
            return
        self._editors.close()


class RobotPopup(ChoicePopup):
    """A robot of the Robots page, all of them, or a new one."""

    def options(self) -> list[Option]:
        """The robots by name, and all of them."""
        editor = self._editors.canvas.editor
        entries = robot_entries(editor.project, editor.language)
        names = dict.fromkeys(entry.name for entry in entries)
        found = [Option(name, name, "bot") for name in names if name != ALL_ROBOTS]
        return [*found, Option(tr("all robots"), ALL_ROBOTS, "users")]

    def more_rows(self) -> list[Option]:
        """A new robot goes on the Robots page."""
        return [Option(tr("new robot…"), icon="plus", action="new")]

    def act(self, action: str) -> None:
        """Ask for the name."""
        words = tr("Name of the new robot. It is put on the Robots page.")
        made, name = self._on_made, self.search.text()
        self.ask(
            Question(words, tr("Add"), answered=made, refused=lambda: self.ask(None), name=name)
        )

    def _on_made(self, name: str) -> None:
        editor, name = self._editors.canvas.editor, name.strip()
        reason = why_not_robot_name(editor, name)
        if reason is not None:
            self.reason.tell(reason)
            self.adjustSize()
            return
        with editor.transaction(tr("add a robot")):
            stacks = editor.project.pages["robots"]
            place = (
                InStack(stacks[-1].id, len(stacks[-1].body))
                if stacks
                else editor.new_stack("robots", 40, 40)
            )
            block = editor.create(ROBOT_BLOCK, place)
            editor.apply(SetField(block, "name", name))
            editor.apply(SetField(self.edit.block, self.edit.key, name))
        self._editors.close()

"""Opens motions, keeps them in the project, deletes them there, reads and writes them as text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtGui import QCursor, QKeySequence
from PySide6.QtWidgets import QMenu

from nep_core.errors import NepError
from nep_studio.animation_files import to_toml
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.animations import Use
from nep_studio.blocks.own_animations import OwnAnimation, free_name
from nep_studio.problems import problem_of
from nep_studio.ui.messages import Answer, Message, Messages, announce
from nep_studio.ui.messages_question import QuestionDialog
from nep_studio.ui.motion.header import kind_words
from nep_studio.ui.motion.menu_titles import add_title
from nep_studio.ui.panels.log.saving import save_text
from nep_studio.ui.words import count_words, tr

if TYPE_CHECKING:
    from nep_studio.ui.motion.window import MotionWindow


class ProjectCommands:
    """The actions that reach beyond the window."""

    def __init__(self, window: MotionWindow) -> None:
        self.window, self.desk, self.kept = window, window.desk, window.kept
        self._use: Use | None = None
        add, keys = window.actions_by_name.add, QKeySequence.StandardKey
        add("new_motion", tr("New"), self.new, icon_name="file-plus", keys=keys.New)
        add(
            "open_motion", tr("Open…"), self.show_open_menu, icon_name="folder-open", keys=keys.Open
        )
        words, tip = (
            tr("Keep in the project"),
            tr("Keep the motion in the project: blocks can play it"),
        )
        add("save_motion", words, self.save, icon_name="save", keys=keys.Save, tip=tip)
        add("import_motion", tr("From Choregraphe…"), self.ask_text, icon_name="clipboard-paste")
        add("export_motion", tr("Save as a file…"), self.export, icon_name="download")
        add("delete_motion", tr("Delete from the project…"), self.ask_delete, icon_name="trash-2")
        self._add_menus()

    def update(self) -> None:
        """Let those actions be used that have something to do."""
        actions, is_there = self.window.actions_by_name, bool(self.desk.motion.joints)
        is_kept = self.desk.name in self.kept.own()
        can_save = self.kept.editor is not None and (self.desk.is_modified or not is_kept)
        actions.enable(is_there and can_save, "save_motion")
        actions.enable(is_there, "export_motion")
        actions.enable(is_kept, "delete_motion")

    def _add_menus(self) -> None:
        actions, add = self.window.actions_by_name, self.window.actions_by_name.add
        change = add("change_motion", tr("Change"), lambda: None, icon_name="sliders-horizontal")
        menu = QMenu(self.window)
        menu.addActions([actions[n] for n in ("mirror", "backwards", "stretch", "give_time")])
        change.setMenu(menu)
        robot = add("robot_pose", tr("From a robot"), lambda: None, icon_name="bot")
        self.robot_menu = QMenu(self.window)
        self.robot_menu.aboutToShow.connect(self._fill_robot_menu)
        robot.setMenu(self.robot_menu)
        more = add("more_motion", tr("More"), lambda: None, icon_name="ellipsis")
        menu = QMenu(self.window)
        menu.addActions([actions[n] for n in ("import_motion", "export_motion", "delete_motion")])
        more.setMenu(menu)

    def _fill_robot_menu(self) -> None:
        self.window.player.pause()
        self.window.robots.fill(self.robot_menu, self.window.main.studio.language)

    # Opening

    def new(self, use: Use | None = None) -> None:
        """Begin a new motion; the block of ``use`` plays it once it is kept."""
        from nep_studio.ui.motion.window import new_motion

        def begin() -> None:
            self._show(new_motion(), "")
            self._use = use

        self.guard(begin)

    def show_open_menu(self) -> None:
        """Show the motions that there are."""
        menu = self.open_menu()
        bar_button = self.window.actions_by_name["open_motion"]
        widgets = [w for w in bar_button.associatedObjects() if w.isWidgetType()]
        holder = next((w for w in widgets if hasattr(w, "widgetForAction")), None)
        button = holder.widgetForAction(bar_button) if holder is not None else None
        place = button.mapToGlobal(button.rect().bottomLeft()) if button else QCursor.pos()
        menu.popup(place)

    def open_menu(self) -> QMenu:
        """The motions of the project, then those that come with the robot."""
        menu = QMenu(self.window)
        menu.aboutToHide.connect(menu.deleteLater)
        own = self.kept.own()
        add_title(menu, tr("In this project"))
        for name, motion in own.items():
            menu.addAction(motion.title, self._opener(name))
        if not own:
            menu.addAction(tr("None yet")).setEnabled(False)
        add_title(menu, tr("That come with the robot, as a start"))
        for kind, use in kind_words().items():
            inner = menu.addMenu(use)
            inner.setStyleSheet("QMenu { menu-scrollable: 1; }")  # never as large as the screen
            for name, words in self.kept.shipped(kind).items():
                inner.addAction(words, self._opener(name))
            inner.setEnabled(not inner.isEmpty())
        return menu

    def open(self, name: str) -> None:
        """Open a motion of the project, or one that comes with the robot as a start."""
        own = self.kept.own().get(name)
        if own is not None:
            self._show(own, name)
            return
        try:
            self._show(self.kept.load(name), "")
        except NepError as error:
            self.tell_error(error)

    def _opener(self, name: str) -> Callable[[], None]:
        return lambda: self.guard(lambda: self.open(name))

    def _show(self, motion: OwnAnimation, name: str) -> None:
        self.window.player.pause()
        self._use = None
        self.desk.open(motion, name)
        self.desk.moved.emit()
        self.desk.chosen_changed.emit()

    # Keeping

    def save(self) -> bool:
        """Keep the motion in the project; whether that went well."""
        if self.kept.editor is None:
            self._tell(tr("No project is open"), "", tr("Open a project, then keep the motion."))
            return False
        try:
            name = self.kept.save(self.desk.motion, self.desk.name, self._use)
        except EditRefused as refused:
            step = tr("Give it a name and at least one pose, then keep it again.")
            self._tell(tr("The motion could not be kept"), tr(str(refused)), step)
            return False
        self._use = None
        self.desk.saved(name)
        announce(self.window, tr("The motion is kept. Blocks can play it."))
        return True

    def guard(self, then: Callable[[], object]) -> None:
        """Do something after asking what is to become of changes."""
        if not self.desk.is_modified or not self.desk.motion.joints:
            then()
            return

        def save_first() -> None:
            if self.save():
                then()

        title = tr("Keep the changes of “{title}”?", title=self.desk.motion.title)
        answers = (
            Answer(tr("Keep in the project"), save_first, "primary"),
            Answer(tr("Throw away"), then),
            Answer(tr("Cancel"), lambda: None),
        )
        self.ask(Message("warning", title, answers=answers))

    def ask_delete(self) -> None:
        """Ask whether to take the motion out of the project; say what plays it."""
        name = self.desk.name
        uses = self.kept.uses(name)
        told = count_words(uses, "1 block plays it", "{n} blocks play it")
        words = tr("{uses}: choose another motion there.", uses=told) if uses else ""
        title = tr("Delete “{title}” from the project?", title=self.desk.motion.title)
        answers = (
            Answer(tr("Delete"), lambda: self.delete(name)),
            Answer(tr("Cancel"), lambda: None, "primary"),
        )
        self.ask(Message("warning", title, words, answers=answers))

    def delete(self, name: str) -> None:
        """Take a motion out of the project; it stays here, to be kept again."""
        self.kept.delete(name)
        self.desk.changed.emit()

    # As text

    def ask_text(self) -> None:
        """Ask for what Choregraphe has exported."""
        from nep_studio.ui.motion.importing import ImportDialog

        dialog = ImportDialog(self.desk.body, self.window)
        dialog.read.connect(lambda joints: self.guard(lambda: self.bring_in(joints)))
        dialog.open()

    def bring_in(self, joints: OwnAnimation) -> None:
        """Show a motion that was read; it is not kept yet."""
        self.window.player.pause()
        self.desk.open(joints, is_kept=False)
        self.desk.moved.emit()

    def export(self) -> None:
        """Ask for a file, and write the motion into it."""
        text = to_toml(self.desk.motion)
        name = f"{free_name(self.desk.motion.title, ())}.toml"

        def save(path: Path) -> None:
            path.write_text(text, encoding="utf-8")

        save_text(self.window, self.messages, name, save)

    # Telling

    @property
    def messages(self) -> Messages:
        """The door for messages; they are shown in the main window."""
        return self.window.main.messages

    def tell_error(self, error: NepError) -> None:
        """Say what went wrong, over this window."""
        problem = problem_of(error)
        ok = Answer(tr("OK"), lambda: None, "primary")
        checklist = tuple(map(tr, problem.checklist))
        title, sentence = tr(problem.title), tr(problem.sentence)
        message = Message("error", title, sentence, checklist, problem.details, (ok,))
        self.ask(message)

    def _tell(self, title: str, sentence: str, step: str) -> None:
        ok = Answer(tr("OK"), lambda: None, "primary")
        message = Message("warning", title, sentence, checklist=(step,), answers=(ok,))
        self.ask(message)

    def ask(self, message: Message) -> None:
        """Ask, or tell what has to be read, over this window."""
        QuestionDialog(message, self.window).open()

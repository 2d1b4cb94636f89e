"""What can be done with a motion, as actions of its page: each has words, an icon, keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QInputDialog, QMenu

from faults import FaultError
from faults.files import write_whole
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.animations import Use
from nep_studio.blocks.own_animations import OwnAnimation, free_name
from nep_studio.problems import problem_of
from nep_studio.project.kept_files import to_toml
from nep_studio.ui.labels import labelled
from nep_studio.ui.message_cards import QuestionDialog
from nep_studio.ui.messages import Answer, Message, announce
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.widgets.forms import add_title
from nep_studio.ui.widgets.questions import save_text
from nep_studio.ui.words import count_words, tr

from . import editing
from .bars import kind_words

if TYPE_CHECKING:
    from .page import MotionPage


PLAIN_KEYS = {
    Qt.Key.Key_Space: "play_motion",
    Qt.Key.Key_K: "add_pose",
    Qt.Key.Key_D: "copy_pose",
    Qt.Key.Key_L: "loop_motion",
    Qt.Key.Key_Home: "first_pose",
    Qt.Key.Key_Delete: "delete_pose",
    Qt.Key.Key_Backspace: "delete_pose",
}
COPY_GAP_S = 0.5
"""So much later than the last pose copies come, where the moment shown says nothing else."""
LOOKS = {"front": "the front", "side": "the side", "back": "behind", "top": "above"}
"""From where the robot can be looked at."""
LEAST_STRETCH, MOST_STRETCH = 10, 1000


class Commands:
    """Adds the actions of a page, and does what they ask for."""

    def __init__(self, page: MotionPage) -> None:
        self.page, self.controller, self.player = page, page.controller, page.player
        add, keys = self.page.actions_by_name.add, QKeySequence.StandardKey
        add("add_pose", "Add a pose", self.add_pose, icon_name="plus")
        add("copy_pose", "Copy the poses to here", self.copy, icon_name="copy-plus")
        add("delete_pose", "Delete the poses", self.delete, icon_name="trash-2")
        add("all_poses", "Choose all poses", self.choose_all, keys=keys.SelectAll)
        self._add_play()
        self._add_changes()

    def update(self) -> None:
        """Let those actions be used that have something to do."""
        actions, controller = self.page.actions_by_name, self.controller
        is_there = bool(controller.motion.joints)
        actions.enable(bool(controller.chosen), "copy_pose", "delete_pose")
        names = ("first_pose", "play_motion", "mirror", "backwards", "stretch", "all_poses")
        actions.enable(is_there, *names)
        self._tell_keys()

    def _tell_keys(self) -> None:
        """Say in tool tips which keys are pressed without Ctrl: they are no shortcuts."""
        for key, name in reversed(PLAIN_KEYS.items()):
            action = self.page.actions_by_name[name]
            keys = QKeySequence(key).toString(QKeySequence.SequenceFormat.NativeText)
            action.setToolTip(f"{action.text()} ({keys})")

    def plain(self, key: int) -> QAction | None:
        """What a key without Ctrl does; None when it means nothing here.

        They are no shortcuts: a button that has the focus is pressed with the space bar.
        """
        name = PLAIN_KEYS.get(Qt.Key(key))
        return None if name is None else self.page.actions_by_name[name]

    def _add_play(self) -> None:
        add, begin = self.page.actions_by_name.add, lambda: self.controller.show(0.0)
        add("first_pose", "To the beginning", begin, icon_name="rotate-ccw")
        add("play_motion", "Play", self.player.toggle, icon_name="play")
        loop = add("loop_motion", "Again and again", lambda: None, icon_name="repeat")
        loop.setCheckable(True)
        loop.toggled.connect(self._on_loop_toggled)
        self.player.changed.connect(self._on_playing_changed)
        curve = add("show_curve", "The curve of one joint", lambda: None, icon_name="chart-line")
        curve.setCheckable(True)
        curve.toggled.connect(self.page.show_curve)

    def _add_changes(self) -> None:
        add = self.page.actions_by_name.add
        flip, turn = editing.mirrored, editing.backwards
        add("mirror", "Mirror: left is right", lambda: self._do(tr("Mirror: left is right"), flip))
        add("backwards", "Backwards", lambda: self._do(tr("Backwards"), turn))
        add("stretch", "Slower or faster…", self.ask_stretch, icon_name="gauge")
        look = add("look_from", "Look from", lambda: None, icon_name="eye")
        menu = QMenu(self.page)
        for preset, words in LOOKS.items():
            labelled(menu.addAction("", partial(self._look_from, preset)), text=words)
        look.setMenu(menu)
        add("give_time", "Give it the time it needs", self.give_time, icon_name="hourglass")

    # What they do

    def add_pose(self) -> None:
        """Keep the pose that is shown."""
        self.player.pause()
        self.controller.add_key(tr("add a key pose"))

    def copy(self) -> None:
        """Copy the chosen poses to the moment that is shown, or behind the last one."""
        controller, now_s = self.controller, self.controller.cursor_s
        if not controller.chosen:
            return
        is_away = all(abs(now_s - time) > editing.SAME_S for time in controller.chosen)
        end_s = controller.motion.duration_s + COPY_GAP_S
        target = now_s if is_away and now_s > 0 else end_s
        controller.copy_chosen(target - controller.chosen[0], tr("copy key poses"))
        controller.show(controller.chosen[0])

    def delete(self) -> None:
        """Take the chosen poses away."""
        self.controller.delete_chosen(tr("delete key poses"))

    def choose_all(self) -> None:
        """Choose every pose."""
        self.controller.choose(editing.key_times(self.controller.motion))

    def give_time(self) -> None:
        """Make it as slow as the robot needs, where it is too fast."""
        self.player.pause()
        self.controller.give_time(tr("give it the time it needs"))

    def ask_stretch(self) -> None:
        """Ask how many percent of its time the motion is to take."""
        dialog = QInputDialog(self.page)
        dialog.setWindowTitle(tr("Slower or faster"))
        dialog.setLabelText(tr("How long it takes, in percent of now:"))
        dialog.setInputMode(QInputDialog.InputMode.IntInput)
        dialog.setIntRange(LEAST_STRETCH, MOST_STRETCH)
        dialog.setIntValue(100)
        dialog.intValueSelected.connect(self.stretch)
        dialog.open()

    def stretch(self, percent: int) -> None:
        """Let it take so many percent of its time."""
        motion = editing.stretched(self.controller.motion, percent / 100.0)
        self.controller.choose(())
        self.controller.do(tr("change how long it takes"), motion)

    def show_menu(self, place: object) -> None:
        """The menu of the timeline."""
        assert isinstance(place, QPoint)
        menu = QMenu(self.page)
        actions = self.page.actions_by_name
        menu.addActions([actions[name] for name in ("add_pose", "copy_pose", "delete_pose")])
        menu.addSeparator()
        menu.addActions([actions[name] for name in ("all_poses", "mirror", "backwards", "stretch")])
        menu.aboutToHide.connect(menu.deleteLater)
        menu.popup(place)

    def _do(self, label: str, change: Callable[[OwnAnimation], OwnAnimation]) -> None:
        self.player.pause()
        self.controller.choose(())
        self.controller.do(label, change(self.controller.motion))

    def _look_from(self, preset: str) -> None:
        self.page.view.look_from(preset)

    def _on_loop_toggled(self, is_on: bool) -> None:
        self.player.is_looping = is_on

    def _on_playing_changed(self, is_playing: bool) -> None:
        actions, theme = self.page.actions_by_name, self.page.look.theme
        actions.label("play_motion", "Pause" if is_playing else "Play")
        self._tell_keys()
        actions["play_motion"].setIcon(icon("pause" if is_playing else "play", theme))


# Opens motions, keeps them in the project, deletes them there, reads and writes them as text.


class ProjectCommands:
    """The actions that reach beyond the page."""

    def __init__(self, page: MotionPage) -> None:
        self.page, self.controller, self.kept = page, page.controller, page.kept
        self._use: Use | None = None
        add, keys = page.actions_by_name.add, QKeySequence.StandardKey
        add("new_motion", "New", self.new, icon_name="file-plus")
        add("open_motion", "Open…", self.show_open_menu, icon_name="folder-open")
        add(
            "save_motion",
            "Keep in the project",
            self.save,
            icon_name="save",
            keys=keys.Save,
            tip="Keep the motion in the project: blocks can play it",
        )
        add("import_motion", "From Choregraphe…", self.ask_text, icon_name="clipboard-paste")
        add("export_motion", "Save as a file…", self.export, icon_name="download")
        add("delete_motion", "Delete from the project…", self.ask_delete, icon_name="trash-2")
        self._add_menus()

    def update(self) -> None:
        """Let those actions be used that have something to do."""
        actions, is_there = self.page.actions_by_name, bool(self.controller.motion.joints)
        is_kept = self.controller.name in self.kept.own()
        can_save = self.kept.editor is not None and (self.controller.is_modified or not is_kept)
        actions.enable(is_there and can_save, "save_motion")
        actions.enable(is_there, "export_motion")
        actions.enable(is_kept, "delete_motion")

    def _add_menus(self) -> None:
        def add_menu(name: str, words: str, icon_name: str, *entries: str) -> QMenu:
            menu, actions = QMenu(self.page), self.page.actions_by_name
            menu.addActions([actions[entry] for entry in entries])
            actions.add(name, words, lambda: None, icon_name=icon_name).setMenu(menu)
            return menu

        changes = "mirror", "backwards", "stretch", "give_time"
        add_menu("change_motion", "Change", "sliders-horizontal", *changes)
        self.robot_menu = add_menu("robot_pose", "From a robot", "bot")
        self.robot_menu.aboutToShow.connect(self._fill_robot_menu)
        files = "import_motion", "export_motion", "delete_motion"
        add_menu("more_motion", "More", "ellipsis", *files)

    def _fill_robot_menu(self) -> None:
        self.page.player.pause()
        self.page.robots.fill(self.robot_menu, self.page.host.services.language)

    # Opening

    def new(self, use: Use | None = None) -> None:
        """Begin a new motion; the block of ``use`` plays it once it is kept."""
        from .page import new_motion

        def begin() -> None:
            self._show(new_motion(), "")
            self._use = use

        self.guard(begin)

    def show_open_menu(self) -> None:
        """Show the motions that there are."""
        button = self.page.toolbar.widgetForAction(self.page.actions_by_name["open_motion"])
        self.open_menu().popup(button.mapToGlobal(button.rect().bottomLeft()))

    def open_menu(self) -> QMenu:
        """The motions of the project, then those that come with the robot."""
        menu = QMenu(self.page)
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
        except FaultError as error:
            self.tell_error(error)

    def _opener(self, name: str) -> Callable[[], None]:
        return lambda: self.guard(lambda: self.open(name))

    def _show(self, motion: OwnAnimation, name: str) -> None:
        self.page.player.pause()
        self._use = None
        self.controller.open(motion, name)

    # Keeping

    def save(self) -> bool:
        """Keep the motion in the project; whether that went well."""
        if self.kept.editor is None:
            self._tell(tr("No project is open"), tr("Open a project, then keep the motion."))
            return False
        try:
            name = self.kept.save(self.controller.motion, self.controller.name, self._use)
        except EditRefused as refused:
            step = tr("Give it a name and at least one pose, then keep it again.")
            self._tell(tr("The motion could not be kept"), step, tr(refused.sentence))
            return False
        self._use = None
        self.controller.saved(name)
        announce(self.page, tr("The motion is kept. Blocks can play it."))
        return True

    def guard(self, then: Callable[[], object]) -> None:
        """Do something after asking what is to become of changes."""
        if not self.controller.is_modified or not self.controller.motion.joints:
            then()
            return

        def save_first() -> None:
            if self.save():
                then()

        title = tr("Keep the changes of “{title}”?", title=self.controller.motion.title)
        answers = (
            Answer(tr("Keep in the project"), save_first, "primary"),
            Answer(tr("Throw away"), then),
            Answer(tr("Cancel"), lambda: None),
        )
        self.ask(Message("warning", title, answers=answers))

    def ask_delete(self) -> None:
        """Ask whether to take the motion out of the project; say what plays it."""
        name = self.controller.name
        uses = self.kept.uses(name)
        told = count_words(uses, "1 block plays it", "{n} blocks play it")
        words = tr("{uses}: choose another motion there.", uses=told) if uses else ""
        title = tr("Delete “{title}” from the project?", title=self.controller.motion.title)
        answers = (
            Answer(tr("Delete"), lambda: self.delete(name)),
            Answer(tr("Cancel"), lambda: None, "primary"),
        )
        self.ask(Message("warning", title, words, answers=answers))

    def delete(self, name: str) -> None:
        """Take a motion out of the project; it stays here, to be kept again."""
        self.kept.delete(name)
        self.controller.changed.emit()

    # As text

    def ask_text(self) -> None:
        """Ask for what Choregraphe has exported."""
        from .importing import ImportDialog

        dialog = ImportDialog(self.controller.body, self.page)
        dialog.read.connect(lambda joints: self.guard(lambda: self.bring_in(joints)))
        dialog.open()

    def bring_in(self, joints: OwnAnimation) -> None:
        """Show a motion that was read; it is not kept yet."""
        self.page.player.pause()
        self.controller.open(joints, is_kept=False)

    def export(self) -> None:
        """Ask for a file, and write the motion into it."""
        text = to_toml(self.controller.motion)
        name = f"{free_name(self.controller.motion.title, ())}.toml"
        messages = self.page.host.services.messages
        save_text(self.page, messages, name, lambda path: write_whole(path, text))

    # Telling

    def tell_error(self, error: FaultError) -> None:
        """Say what went wrong, over this page."""
        problem = problem_of(error)
        ok = Answer(tr("OK"), lambda: None, "primary")
        checklist = tuple(map(tr, problem.checklist))
        title, sentence = tr(problem.title), tr(problem.sentence)
        self.ask(Message("error", title, sentence, checklist, problem.details, (ok,)))

    def _tell(self, title: str, step: str, sentence: str = "") -> None:
        ok = Answer(tr("OK"), lambda: None, "primary")
        self.ask(Message("warning", title, sentence, checklist=(step,), answers=(ok,)))

    def ask(self, message: Message) -> None:
        """Ask, or tell what has to be read, over this page."""
        QuestionDialog(message, self.page).open()

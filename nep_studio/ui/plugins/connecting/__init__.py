"""Connecting a real robot: find it, test the way to it step by step, use it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.fixes import use_real_robot
from nep_studio.problems import Problem
from nep_studio.ui.words import tr
from robots.naoqi.discovery import SavedLogin, save_login, saved_login

if TYPE_CHECKING:
    from nep_studio.ui.shell.main_window import MainWindow

    from .dialog import ConnectDialog


# Puts “Connect a robot” into the window: its action, and what “Use this robot” changes.


def add_connecting(window: MainWindow) -> None:
    """Add the action; it is in the Robots menu and in the command palette."""
    words = tr("Connect a robot…")
    tip = tr("Find a real NAO in the network, test the way to it, and use it in this project.")
    action = window.actions_by_name.add(
        "connect_robot", words, lambda: open_connecting(window), icon_name="plug", tip=tip
    )
    window.menus["robots"].addAction(action)


def open_connecting(window: MainWindow, robot: str = "") -> ConnectDialog | None:
    """Show the dialog, for a robot of the project; None when no project is open."""
    if window.files.document is None:
        window.messages.refuse(tr("There is no project to run."), (tr("Open or make one first."),))
        return None
    from .dialog import ConnectDialog

    editor = window.workbench.canvas.editor
    entries = robot_entries(editor.project, editor.language)
    names = [entry.name for entry in entries] or ["NAO"]
    dialog = ConnectDialog(names, window.look, window)
    meant = next((entry for entry in entries if entry.name == robot), None)
    meant = meant or next((one for one in entries if one.address.strip()), None)
    if meant is not None:
        dialog.robot.setCurrentText(meant.name)
        login = saved_login(meant.address.strip())
        if login is None:
            dialog.show_address(meant.address.strip())
        else:
            dialog.show_address(meant.address.strip(), login.user, login.password)
    dialog.used.connect(
        lambda name, place, user, password, fingerprint: use_robot(
            window, name, place, SavedLogin(user, password, fingerprint) if password else None
        )
    )
    dialog.open()
    return dialog


def use_robot(window: MainWindow, robot: str, address: str, login: SavedLogin | None) -> None:
    """Let a robot of the project be the real one at an address; one step of undo."""
    workbench = window.workbench
    _keep_login(window, address, login)
    try:
        block = use_real_robot(workbench.canvas.editor, robot, address, tr("connect a robot"))
    except EditRefused as refusal:
        window.messages.refuse(refusal.sentence, refusal.checklist)
        return
    workbench.show_block(block)
    window.messages.confirm(
        tr("{robot} is now the real one at {address}", robot=robot, address=address)
    )


def _keep_login(window: MainWindow, address: str, login: SavedLogin | None) -> None:
    try:
        save_login(address, login)
    except OSError as error:
        sentence = tr("User and password could not be kept; the robot will ask for them again.")
        steps = (tr("Is there room on the disk?"),)
        window.messages.tell_problem(
            Problem(tr("Not everything was kept"), sentence, steps, str(error))
        )

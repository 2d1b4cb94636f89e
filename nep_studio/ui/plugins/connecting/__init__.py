"""Connecting a real robot: find it, test the way to it step by step, use it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.operations.fixes import use_real_robot
from nep_studio.problems import Problem
from nep_studio.ui.host import Host, NewAction, Parts, Plugin
from nep_studio.ui.words import tr
from robots.naoqi.discovery import SavedLogin, save_login, saved_login

if TYPE_CHECKING:
    from .dialog import ConnectDialog


def make(host: Host) -> Parts:
    """The action, in the Robots menu; others open the dialog for one robot."""
    action = NewAction(
        "connect_robot",
        "Connect a robot…",
        lambda: open_connecting(host),
        "plug",
        tip="Find a real NAO in the network, test the way to it, and use it in this project.",
        menu="robots",
    )
    commands = {"connecting.open": lambda robot="": open_connecting(host, robot)}
    return Parts(actions=[action], commands=commands)


def open_connecting(host: Host, robot: str = "") -> ConnectDialog | None:
    """Show the dialog, for a robot of the project; None when no project is open."""
    if host.services.document is None:
        host.services.messages.refuse(
            tr("There is no project to run."), (tr("Open or make one first."),)
        )
        return None
    from .dialog import ConnectDialog

    editor = host.workbench.canvas.editor
    entries = robot_entries(editor.project, editor.language)
    names = [entry.name for entry in entries] or ["NAO"]
    dialog = ConnectDialog(names, host.services.look, host.widget)
    meant = next((entry for entry in entries if entry.name == robot), None)
    meant = meant or next((one for one in entries if one.address.strip()), None)
    if meant is not None:
        dialog.robot.setCurrentText(meant.name)
        address = meant.address.strip()
        login = saved_login(address)
        dialog.show_address(address, *((login.user, login.password) if login else ()))
    dialog.used.connect(
        lambda name, place, user, password, fingerprint: use_robot(
            host, name, place, SavedLogin(user, password, fingerprint) if password else None
        )
    )
    dialog.open()
    return dialog


def use_robot(host: Host, robot: str, address: str, login: SavedLogin | None) -> None:
    """Let a robot of the project be the real one at an address; one step of undo."""
    workbench = host.workbench
    try:
        save_login(address, login)
    except OSError as error:
        sentence = tr("User and password could not be kept; the robot will ask for them again.")
        steps = (tr("Is there room on the disk?"),)
        host.services.messages.tell_problem(
            Problem(tr("Not everything was kept"), sentence, steps, str(error))
        )
    try:
        editor = workbench.canvas.editor
        with editor.history.as_own():
            block = use_real_robot(editor, robot, address, tr("connect a robot"))
    except EditRefused as refusal:
        host.services.messages.refuse(refusal.sentence, refusal.checklist)
        return
    told = tr("{robot} is now the real one at {address}", robot=robot, address=address)
    workbench.show_change(block, told)


plugin = Plugin("connecting", make, order=140)

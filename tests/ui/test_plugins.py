"""Plugins: each is one folder with one object, and sees the host and the services only."""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from nep_studio.ui import plugins
from nep_studio.ui.host import Plugin
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.plugin_host import names_of_plugins
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window
from tests.ui.window.putting_away import put_away

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

UI = Path(plugins.__file__).parent.parent
SHELL, PLUGINS = "nep_studio.ui.shell", "nep_studio.ui.plugins"
ASKED = re.compile(r"\.ask\(\s*\"([a-z_]+\.[a-z_]+)\"")


# What the modules name and import


def modules(ui: Path) -> Iterator[tuple[str, Path]]:
    """The modules outside the shell, by their full names."""
    for path in sorted(ui.rglob("*.py")):
        parts = path.relative_to(ui).with_suffix("").parts
        if parts[0] != "shell":
            yield ".".join(("nep_studio", "ui", *parts)).removesuffix(".__init__"), path


def names_main_window(ui: Path) -> list[str]:
    """The modules outside the shell in whose code the main window is named."""
    found = []
    for module, path in modules(ui):
        tokens = tokenize.generate_tokens(io.StringIO(path.read_text(encoding="utf-8")).readline)
        if any(one.type == tokenize.NAME and one.string == "MainWindow" for one in tokens):
            found.append(module)
    return found


def imported_names(node: ast.AST, package: str) -> list[str]:
    """The full names that a statement imports in a module of a package."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if not isinstance(node, ast.ImportFrom):
        return []
    above = package.split(".")[: package.count(".") + 2 - node.level] if node.level else []
    start = ".".join([*above, *filter(None, [node.module])])
    return [f"{start}.{alias.name}" for alias in node.names]


def wrong_imports(ui: Path) -> list[str]:
    """What modules import, for types too, of the shell, or of a plugin that they do not belong to.

    Even what stands below the plugins must not know them.
    """
    wrong = []
    for module, path in modules(ui):
        own = ".".join(module.split(".")[:4]) if module.startswith(f"{PLUGINS}.") else ""
        package = module if path.name == "__init__.py" else module.rpartition(".")[0]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            for name in imported_names(node, package):
                is_foreign = name.startswith(f"{PLUGINS}.") and not f"{name}.".startswith(f"{own}.")
                if is_foreign or f"{name}.".startswith(f"{SHELL}."):
                    wrong.append(f"{module}: {name}")
    return wrong


def test_only_the_shell_names_the_main_window() -> None:
    assert names_main_window(UI) == []


def test_no_plugin_imports_the_shell_or_another_plugin() -> None:
    assert wrong_imports(UI) == []


@pytest.mark.parametrize(
    ("place", "source", "found"),
    [
        ("plugins/log/panel.py", "from nep_studio.ui.shell.app import main", "shell.app.main"),
        ("plugins/log/panel.py", "from ..cues import plugin", "plugins.cues.plugin"),
        ("plugins/log/__init__.py", "import nep_studio.ui.plugins.cues", "plugins.cues"),
        ("plugins/log/panel.py", "def f():\n    from ...shell import app", "shell.app"),
        ("running/control.py", "from nep_studio.ui.plugins.log import panel", "plugins.log.panel"),
        ("workbench/code.py", "if T:\n    from ..shell.app import main", "shell.app.main"),
    ],
)
def test_a_planted_import_is_found(tmp_path: Path, place: str, source: str, found: str) -> None:
    path = tmp_path / place
    path.parent.mkdir(parents=True)
    path.write_text(source, encoding="utf-8")

    [wrong] = wrong_imports(tmp_path)

    assert wrong.endswith(f": nep_studio.ui.{found}")


def test_a_planted_name_of_the_window_is_found(tmp_path: Path) -> None:
    (tmp_path / "running").mkdir()
    (tmp_path / "running" / "a.py").write_text('"""Of MainWindow."""\n', encoding="utf-8")
    (tmp_path / "running" / "b.py").write_text("def f(x: MainWindow): ...\n", encoding="utf-8")

    assert names_main_window(tmp_path) == ["nep_studio.ui.running.b"]


# What the plugins are


def test_each_folder_has_one_plugin_of_its_name(window: MainWindow) -> None:
    found = {name: sys.modules[f"{PLUGINS}.{name}"].plugin for name in names_of_plugins()}

    assert {name: one.name for name, one in found.items()} == {name: name for name in found}
    assert all(isinstance(one, Plugin) for one in found.values())
    folders = {path.parent.name for path in (UI / "plugins").glob("*/__init__.py")}
    assert found.keys() == folders


def test_each_command_that_is_asked_for_is_offered(window: MainWindow) -> None:
    sources = [path.read_text(encoding="utf-8") for path in UI.rglob("*.py")]

    asked = {name for source in sources for name in ASKED.findall(source)}

    assert len(asked) > 5
    assert asked - window.host._commands.keys() == set()


def test_a_command_that_nobody_offers_is_nothing(window: MainWindow) -> None:
    assert window.host.ask("weather.rain", 3) is None


def test_what_plugins_share_is_made_once(window: MainWindow) -> None:
    made = window.host.shared(Shared, Shared)

    assert window.host.shared(Shared, lambda: pytest.fail("it is there")) is made


class Shared:
    """Something that several plugins need."""


WEATHER = """
from PySide6.QtWidgets import QLabel

from nep_studio.ui.host import Host, NewAction, NewPanel, Parts, Plugin


def make(host: Host) -> Parts:
    label = QLabel("Sunny")
    label.setObjectName("weather")
    action = NewAction("rain", "Let it rain", lambda: label.setText("Rainy"), menu="robots")
    commands = {"weather.told": label.text}
    return Parts(NewPanel(label, "Weather", "flag", "right"), [action], commands=commands)


plugin = Plugin("weather", make, needs_project=True)
"""


@pytest.fixture
def weather(
    tmp_path: Path, studio: Studio, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> MainWindow:
    """A window with one folder more among the plugins."""
    folder = tmp_path / "more" / "weather"
    folder.mkdir(parents=True)
    (folder / "__init__.py").write_text(WEATHER, encoding="utf-8")
    monkeypatch.setattr(plugins, "__path__", [*plugins.__path__, str(folder.parent)])
    monkeypatch.delitem(sys.modules, f"{PLUGINS}.weather", raising=False)
    made = MainWindow(studio)
    qtbot.addWidget(made, before_close_func=put_away)
    made.show()
    made.start(None)
    qtbot.waitExposed(made)
    return made


@pytest.fixture
def new_project(weather: MainWindow, qtbot: QtBot) -> Callable[[], None]:
    """Opens an empty project."""

    def new() -> None:
        weather.files.new()
        qtbot.waitUntil(lambda: weather.workbench.canvas.isVisible())

    return new


def test_a_folder_adds_a_panel_an_action_and_a_command(
    weather: MainWindow, new_project: Callable[[], None]
) -> None:
    assert not weather.actions_by_name["rain"].isEnabled()
    new_project()
    panel = next(one for one in weather.workbench.panels.all if one.title == "Weather")

    panel.action.trigger()
    weather.actions_by_name["rain"].trigger()

    assert panel.widget.isVisible()
    assert weather.host.ask("weather.told") == "Rainy"
    assert weather.menus["robots"].actions()[-1] is weather.actions_by_name["rain"]
    assert weather.workbench.panels.areas["right"].count() > 1


def test_a_plugin_is_there_once_in_another_language(
    weather: MainWindow, new_project: Callable[[], None]
) -> None:
    new_project()

    weather.studio.choose_language("es")

    found = weather.workbench.findChildren(QLabel, "weather")
    assert [one.text() for one in found] == ["Sunny"]
    assert weather.host.ask("weather.told") == "Sunny"

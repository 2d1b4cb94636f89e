import pytest
from PySide6.QtCore import Qt
from nep_studio import paths

def shot(window, name, qtbot, wait=400):
    qtbot.wait(wait)
    window.grab().save(f"/tmp/shots/{name}.png")

@pytest.mark.parametrize("size", [(1366, 728)])
def test_shots(window, qtbot, size):
    n = size[0]
    window.resize(*size)
    window.files.open_example(paths.examples() / "karate_greeting.nep")
    by = {p.title: p for p in window.workbench.panels.all}
    window.workbench.panels.show(by["Person"].widget)
    shot(window, f"person1_{n}", qtbot, 1000)
    window.actions_by_name["run"].trigger()
    shot(window, f"person2_{n}", qtbot, 6000)
    window.actions_by_name["stop"].trigger()
    qtbot.wait(1500)

"""The benchmark of the canvas: its reference works, its mouse is real, its peers are asked for."""

from pathlib import Path

import psutil
import pytest
from PySide6.QtCore import QPointF

from benchmarks import canvas, canvas_workload
from benchmarks.canvas_blockly import chromium, measuring
from benchmarks.canvas_driving import Driver, NotPainted
from benchmarks.canvas_reference import ReferenceView
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.ui.theme.colours import LIGHT, load_theme


@pytest.fixture
def reference(qtbot) -> ReferenceView:
    words = canvas_workload.language()
    view = ReferenceView(Editor(canvas_workload.made(200, words), words), load_theme(LIGHT))
    qtbot.addWidget(view)
    view.resize(800, 600)
    view.show()
    qtbot.waitExposed(view)
    view.look_at(QPointF(0, 0))
    return view


def test_a_stack_of_the_reference_is_dragged_step_by_step(reference: ReferenceView) -> None:
    driver = Driver(reference)
    grip = QPointF(reference.mapFromScene(QPointF(60, 54)))
    places: list[QPointF] = []

    times_ms = driver.drag(
        grip, [(10, 0), (30, 5)], lambda: places.append(reference.place_of("s0"))
    )

    assert places == [QPointF(50, 40), QPointF(70, 45)]
    assert all(time_ms > 0 for time_ms in times_ms)


def test_the_reference_follows_the_program(reference: ReferenceView) -> None:
    editor = reference.editor
    body = editor.project.stacks["s0"].body
    before = len(reference.scene().items())

    editor.apply(DeleteBlocks(body[0], len(body)))
    after = len(reference.scene().items())
    editor.history.undo()

    assert before - after == 101  # the blocks and what carries them
    assert len(reference.scene().items()) == before


def test_a_step_that_paints_nothing_is_not_taken_for_a_fast_one(reference: ReferenceView) -> None:
    driver = Driver(reference)

    with pytest.raises(NotPainted):
        driver.cpu_ms(lambda: None)


def test_a_figure_that_could_not_be_had_misses_its_goal() -> None:
    figure = canvas.budget("keystroke", {}, "canvas")

    assert figure["ok"] is False


def test_without_npm_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measuring, "_provide_chromium", lambda: "chromium")
    monkeypatch.setenv("PATH", "")

    with pytest.raises(measuring.PeerMissing, match="npm is missing"):
        measuring.measure((100,), 1)


def test_without_rights_it_says_how_to_install_chromium(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = measuring.dev_system.Machine(has_apt=True, rights="sudo asks")
    monkeypatch.setattr(measuring, "executable", lambda: None)
    monkeypatch.setattr(measuring.shutil, "which", lambda name: name)
    monkeypatch.setattr(measuring.dev_system, "this_machine", lambda: machine)

    with pytest.raises(measuring.PeerMissing, match="sudo apt-get install --yes chromium"):
        measuring.measure((100,), 1)


@pytest.mark.skipif(chromium.executable() is None, reason="Chromium is not installed")
def test_chromium_answers_and_leaves_no_process(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    page.write_text("<script>window.isReady = true; window.answer = 42</script>")
    before = set(psutil.Process().children(recursive=True))

    with chromium.Chromium(chromium.executable() or "") as browser:
        browser.open(page)
        answer = browser.evaluate("Promise.resolve(window.answer)")
        started = set(psutil.Process().children(recursive=True)) - before

    assert answer == 42
    assert started
    assert not any(process.is_running() for process in started)

"""dev_tests.py: all tests, once more those that failed beside others; what none may leave."""

import sys
import threading
from pathlib import Path

import pytest

import dev_tests
from tests import conftest

pytestmark = pytest.mark.long


def test_what_fails_beside_others_is_tried_again_alone_and_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "test_it.py").write_text(
        "from pathlib import Path\n"
        "def test_well(): Path('well').touch(exist_ok=False)\n"
        "def test_once(): assert Path('once').exists() or Path('once').write_text('')\n"
    )
    monkeypatch.chdir(tmp_path)

    code = dev_tests.run_all(sys.executable, tmp_path, ["-p", "no:xdist"])

    told = capfd.readouterr().err
    assert code == 0
    assert told.count("test_it.py::test_once") == 2
    assert "please mend them" in told
    assert dev_tests.run_all(sys.executable, tmp_path, ["-p", "no:xdist"]) == 1


def test_a_thread_that_a_test_leaves_working_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(conftest, "LOOKS", 2)
    is_over = threading.Event()

    def work() -> None:
        while not is_over.is_set():
            pass

    assert not conftest.keeps_busy()
    busy = threading.Thread(target=work)
    busy.start()
    try:
        assert any(conftest.keeps_busy() for _ in range(20))  # others may have the processor
    finally:
        is_over.set()
        busy.join()

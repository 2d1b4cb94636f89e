"""The runner of benchmarks: what it finds, what it asks of a figure, and when it fails."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from benchmarks import __main__ as runner

pytestmark = pytest.mark.long

GOOD = 'def run():\n    print("chatter")\n    return [{"name": "a", "value": 2.0, "unit": "s"}]\n'

WAITING = """
import subprocess, sys, tempfile, time
from pathlib import Path

LIMIT_S = {limit_s}

def run():
    folder = Path(tempfile.mkdtemp(prefix="left-"))
    sleep = [sys.executable, "-c", "import time; time.sleep(600)"]
    child = subprocess.Popen(sleep, start_new_session=True)
    part = Path(__file__).with_name("told.part")
    part.write_text(f"{{child.pid}} {{folder}}")
    part.rename(part.with_name("told.txt"))
    {then}
"""
"""A benchmark that starts a process of its own, and waits."""

ALONE = pytest.mark.skipif(os.name != "posix", reason="Windows has no such signals")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project's folder of benchmarks, with the real runner in it."""
    benchmarks = tmp_path / "benchmarks"
    benchmarks.mkdir()
    for name in ("__init__.py", "__main__.py", "peers.py"):
        source = Path(runner.__file__).with_name(name).read_text(encoding="utf-8")
        (benchmarks / name).write_text(source, encoding="utf-8")
    monkeypatch.setattr(runner, "FOLDER", benchmarks)
    return benchmarks


def test_a_benchmark_is_a_module_with_a_function_run(folder: Path) -> None:
    (folder / "quick.py").write_text("\n" + GOOD)
    (folder / "workload.py").write_text("BLOCKS = 5000\n")

    assert runner.benchmark_names(folder) == ["quick"]


def test_figures_are_one_json_object_a_line_whatever_the_benchmark_prints(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "quick.py").write_text("\n" + GOOD)

    code = runner.main(["--json"])

    figure = json.loads(capsys.readouterr().out)
    assert code == 0
    assert list(figure) == ["name", "value", "unit", "reference", "ratio", "goal", "ok"]
    assert (figure["name"], figure["value"], figure["ok"]) == ("a", 2.0, True)


def test_a_missed_goal_and_a_benchmark_that_fails_give_exit_code_1(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "broken.py").write_text("\ndef run():\n    raise OSError\n")
    (folder / "slow.py").write_text(
        "\n" + GOOD.replace('"s"', '"s", "goal": "at most 1", "ok": False')
    )

    codes = [runner.main(["broken"]), runner.main(["slow"])]

    lines = capsys.readouterr().out.splitlines()
    assert codes == [1, 1]
    assert "goal to run: MISSED" in lines[0]
    assert "goal at most 1: MISSED" in lines[1]


@pytest.mark.parametrize(
    ("figure", "lacks"),
    [
        ({"name": "a", "unit": "s"}, "value"),
        ({"name": "a", "value": 1, "unit": "s", "goal": "at most 1"}, "ok"),
    ],
)
def test_a_figure_that_lacks_something_is_refused_by_name(figure: dict, lacks: str) -> None:
    with pytest.raises(ValueError, match=rf"lacks {lacks}\."):
        runner.complete(figure)


@pytest.mark.parametrize(("arguments", "heard"), [([], False), (["--with-peers"], True)])
def test_a_benchmark_hears_whether_peers_are_to_be_measured(
    folder: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    heard: bool,
) -> None:
    monkeypatch.setenv("NEP_STUDIO_BENCH_WITH_PEERS", "0")
    (folder / "asking.py").write_text(
        "from benchmarks import peers\n\ndef run():\n"
        '    return [{"name": "peers", "value": peers.are_wanted(), "unit": ""}]\n'
    )

    runner.main(["--json", *arguments])

    assert json.loads(capsys.readouterr().out)["value"] is heard


def test_a_figure_that_could_not_be_measured_is_no_failure(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "quick.py").write_text("\n" + GOOD.replace("2.0", "None"))

    code = runner.main([])

    assert code == 0
    assert capsys.readouterr().out.split() == ["a", "-", "s"]


def test_an_unknown_benchmark_is_refused_with_the_known_ones(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "quick.py").write_text("\n" + GOOD)

    with pytest.raises(SystemExit) as ending:
        runner.main(["quik"])

    assert ending.value.code == 2
    assert "no benchmark is called quik; there are: quick" in capsys.readouterr().err


def wait_until(is_so, seconds: float = 20.0) -> bool:
    """Look until something is so."""
    end = time.monotonic() + seconds
    while not (found := is_so()) and time.monotonic() < end:
        time.sleep(0.02)
    return bool(found)


def is_running(pid: int) -> bool:
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def left_of(folder: Path) -> tuple[int, Path]:
    """The process that a benchmark started, and its temporary folder."""
    pid, place = (folder / "told.txt").read_text().split()
    return int(pid), Path(place)


def test_a_benchmark_that_runs_past_its_limit_is_ended_named_and_fails(
    folder: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (folder / "endless.py").write_text(WAITING.format(limit_s=3, then="time.sleep(600)"))
    (folder / "quick.py").write_text("\n" + GOOD)

    code = runner.main([])

    told = capfd.readouterr()
    pid, place = left_of(folder)
    assert code == 1
    assert "endless ran past its 3 s" in told.err
    assert "goal to end within 3 s: MISSED" in told.out.splitlines()[0]
    assert told.out.splitlines()[1].split()[:3] == ["a", "2", "s"]
    assert not is_running(pid) and not place.exists()


def test_a_benchmark_that_asks_a_person_gets_no_answer_and_fails(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "asking.py").write_text('\ndef run():\n    input("Go on? ")\n')

    assert runner.main(["asking"]) == 1
    assert "asking" in capsys.readouterr().out


def test_what_a_benchmark_left_running_ends_with_it(folder: Path) -> None:
    then = 'return [{"name": "a", "value": 1, "unit": ""}]'
    (folder / "careless.py").write_text(WAITING.format(limit_s=30, then=then))

    code = runner.main([])

    pid, place = left_of(folder)
    assert code == 0
    assert not is_running(pid) and not place.exists()


@ALONE
@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_a_runner_that_is_stopped_leaves_no_process_and_no_folder(folder: Path, name: str) -> None:
    (folder / "endless.py").write_text(WAITING.format(limit_s=300, then="time.sleep(600)"))
    command = [sys.executable, "-m", "benchmarks"]
    with subprocess.Popen(command, cwd=folder.parent, stderr=subprocess.DEVNULL) as running:
        assert wait_until((folder / "told.txt").exists)

        running.send_signal(getattr(signal, name))
        code = running.wait(30)

    pid, place = left_of(folder)
    assert code == 128 + getattr(signal, name)
    assert not is_running(pid) and not place.parent.exists()


def test_every_limit_is_read_without_running_the_benchmark() -> None:
    limits = {
        name: runner.limit_of(Path(runner.__file__).with_name(f"{name}.py"))
        for name in ("start", "gestures", "registry")
    }

    assert limits["gestures"] > limits["start"] > limits["registry"] == runner.USUAL_LIMIT_S

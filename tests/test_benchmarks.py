"""The runner of benchmarks: what it finds, what it asks of a figure, and when it fails."""

import json
from pathlib import Path

import pytest

from benchmarks import __main__ as runner

GOOD = 'def run():\n    print("chatter")\n    return [{"name": "a", "value": 2.0, "unit": "s"}]\n'


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

"""When .ci/run freezes the program: always but when git is sure that packaging is as it was."""

import os
import shutil
import subprocess
from pathlib import Path

import parts
import pytest
import unchanged

NOON_S = 1_790_000_000.0
HOUR_S = 3600.0


def commit(root: Path, name: str, at_s: float) -> None:
    file = root / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"{at_s}")
    for words in (["add", "."], ["commit", "--quiet", "--message", name]):
        git(root, *words, date=f"{at_s:.0f} +0000")


def git(root: Path, *words: str, date: str = "") -> None:
    names = {
        f"GIT_{who}_{what}": "x" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
    }
    variables = names | {"GIT_COMMITTER_DATE": date, "GIT_CONFIG_GLOBAL": os.devnull}
    subprocess.run(["git", *words], cwd=root, check=True, env=os.environ | variables)


@pytest.mark.skipif(shutil.which("git") is None, reason="no git")
def test_it_is_frozen_after_a_change_of_packaging_for_a_day(tmp_path: Path) -> None:
    git(tmp_path, "init", "--quiet")
    commit(tmp_path, "packaging/deb.py", NOON_S)
    commit(tmp_path, "nep_core/processes/node.py", NOON_S + 20 * HOUR_S)

    assert not unchanged.is_unchanged(tmp_path, "", NOON_S + 23 * HOUR_S)
    assert unchanged.is_unchanged(tmp_path, "", NOON_S + 25 * HOUR_S)
    assert unchanged.is_unchanged(tmp_path, "HEAD~1", NOON_S)
    with pytest.raises(subprocess.CalledProcessError):
        unchanged.is_unchanged(tmp_path, "no_such_commit", NOON_S)
    (tmp_path / "build.spec").touch()
    assert not unchanged.is_unchanged(tmp_path, "HEAD", NOON_S + 25 * HOUR_S)


def test_where_git_cannot_tell_it_is_frozen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(unchanged, "ROOT", tmp_path)
    monkeypatch.setenv("GIT_CEILING_DIRECTORIES", str(tmp_path.parent))

    code = unchanged.main()

    assert code == 1
    assert "not known" in capsys.readouterr().err


def test_every_place_that_decides_is_there_and_the_checking_machine_asks() -> None:
    run = (parts.ROOT / ".ci" / "run").read_text(encoding="utf-8")

    assert all((parts.ROOT / place).exists() for place in unchanged.PLACES)
    assert "python3 dev.py test\n" in run and "python3 dev.py lint" in run
    assert "! python3 packaging/unchanged.py; then\n    python3 dev.py test -m freeze" in run

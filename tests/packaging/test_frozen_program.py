"""Freezes the whole program and does with it what a person would: pytest -m freeze."""

import json
import subprocess
import sys
from pathlib import Path

import parts
import pytest

MOST_MB = 420


@pytest.mark.freeze
@pytest.mark.timeout(1200)
def test_the_frozen_program_does_what_the_source_version_does(tmp_path: Path) -> None:
    scripts = parts.ROOT / "packaging"
    subprocess.run([sys.executable, scripts / "freeze.py"], cwd=parts.ROOT, check=True)
    report = tmp_path / "smoke.json"

    tried = subprocess.run(
        [sys.executable, scripts / "smoke.py", "--report", report],
        cwd=parts.ROOT,
        capture_output=True,
        text=True,
    )

    assert tried.returncode == 0, tried.stdout + tried.stderr
    assert json.loads(report.read_text())["ok"] is True
    folder = parts.ROOT / "dist" / parts.NAME
    size = sum(path.stat().st_size for path in folder.rglob("*") if not path.is_symlink())
    assert size < MOST_MB * 1e6

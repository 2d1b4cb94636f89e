"""The pictures of the robots' room in the documentation show it as it is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

TOOLS = Path(__file__).resolve().parents[3] / "tools"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems draw letters in another way")
def test_the_robots_in_the_documentation_look_as_they_do_now() -> None:
    command = [sys.executable, str(TOOLS / "robot_images.py"), "--check"]

    done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=False)

    assert done.returncode == 0, done.stdout + done.stderr

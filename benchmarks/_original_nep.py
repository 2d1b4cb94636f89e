"""The original ``nep`` package, fetched with pip into a folder that is removed afterwards."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator

PACKAGES = ("nep==0.5.4.8", "simplejson", "msgpack")
FETCH_S = 120


@contextlib.contextmanager
def original_nep() -> Iterator[str]:
    """Make ``import nep`` work here and in child processes; "" or why it does not."""
    with tempfile.TemporaryDirectory(prefix="nep-original-") as folder:
        fetch = [sys.executable, "-m", "pip", "install", "--quiet", "--no-input", "--no-deps"]
        try:
            done = subprocess.run(
                [*fetch, "--target", folder, *PACKAGES],
                capture_output=True,
                text=True,
                timeout=FETCH_S,
            )
        except subprocess.TimeoutExpired:
            yield f"{PACKAGES[0]} could not be fetched in {FETCH_S} s."
            return
        if done.returncode != 0:
            yield f"{PACKAGES[0]} could not be fetched: {done.stderr.strip()[-400:]}"
            return
        sys.path.append(folder)  # last: what we have is used
        before = os.environ.get("PYTHONPATH")
        os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [before, folder]))
        try:
            yield ""
        finally:
            sys.path.remove(folder)
            if before is None:
                del os.environ["PYTHONPATH"]
            else:
                os.environ["PYTHONPATH"] = before

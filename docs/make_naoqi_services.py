"""Writes docs/naoqi_services.md: what the virtual NAO offers to programs made for a real one.

.venv/bin/python docs/make_naoqi_services.py
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "naoqi_services.md"


def main() -> int:
    """Make the page."""
    sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "nodes" / "action" / "naoqi")]
    from services_table import page

    PAGE.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())

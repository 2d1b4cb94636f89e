"""Writes docs/robot_blocks.md: what was looked at for every block about robots, on both robots.

.venv/bin/python docs/make_robot_blocks.py            run every block on both robots, write it
.venv/bin/python docs/make_robot_blocks.py --check    compare the words only, change nothing
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "docs" / "robot_blocks.md"


def main() -> int:
    """Make the table, or compare it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare, change nothing")
    parser.add_argument("--port", type=int, default=19559, help="a free port for the NAOqi robot")
    options = parser.parse_args()
    sys.path.insert(0, str(ROOT))
    from tests.stories.robot_block_stage import DRIVERS
    from tests.stories.robot_block_table import run_all, table

    if options.check:
        is_right = TABLE.is_file() and TABLE.read_text(encoding="utf-8") == table({})
        print("It is up to date." if is_right else "docs/robot_blocks.md is out of date.")
        return 0 if is_right else 1
    results = {driver: run_all(driver, options.port) for driver in DRIVERS}
    TABLE.write_text(table(results), encoding="utf-8")
    return 0 if all(all(one.values()) for one in results.values()) else 1


if __name__ == "__main__":
    sys.exit(main())

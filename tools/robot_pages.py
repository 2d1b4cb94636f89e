"""Writes the pages that tests know: blocks on both robots, services of the virtual NAO.

.venv/bin/python tools/robot_pages.py blocks            run every block on both robots, write it
.venv/bin/python tools/robot_pages.py blocks --check    compare the words only, change nothing
.venv/bin/python tools/robot_pages.py services          what programs for a real NAO find here

They become docs/robot_blocks.md and docs/naoqi_services.md.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BLOCKS = ROOT / "docs" / "robot_blocks.md"
SERVICES = ROOT / "docs" / "naoqi_services.md"

sys.path.insert(0, str(ROOT))


def main() -> int:
    """Make a page, or compare it; the exit code is 1 when it is not right."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("page", choices=["blocks", "services"])
    parser.add_argument("--check", action="store_true", help="compare, change nothing")
    parser.add_argument("--port", type=int, default=19559, help="a free port for the NAOqi robot")
    options = parser.parse_args()
    if options.page == "services":
        return _services(is_check=options.check)
    return _blocks(options.port, is_check=options.check)


def _services(*, is_check: bool) -> int:
    from tests.robots.naoqi.services_table import page

    if is_check:
        return _compared(SERVICES, page())
    SERVICES.write_text(page(), encoding="utf-8")
    return 0


def _blocks(free_port: int, *, is_check: bool) -> int:
    from tests.stories.robot_block_stage import DRIVERS
    from tests.stories.robot_block_table import run_all, table

    if is_check:
        return _compared(BLOCKS, table({}))
    results = {driver: run_all(driver, free_port) for driver in DRIVERS}
    BLOCKS.write_text(table(results), encoding="utf-8")
    return 0 if all(all(one.values()) for one in results.values()) else 1


def _compared(path: Path, wanted: str) -> int:
    is_right = path.is_file() and path.read_text(encoding="utf-8") == wanted
    where = path.relative_to(ROOT).as_posix()
    print(f"{where} is up to date." if is_right else f"{where} is out of date.")
    return int(not is_right)


if __name__ == "__main__":
    sys.exit(main())

"""The scripts of packaging/ are no package: they are found in their folder."""

import sys
from pathlib import Path

import dev

sys.path.append(str(Path(dev.__file__).parent / "packaging"))

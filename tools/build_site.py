"""Makes the documentation as a web site that needs no server and no internet.

    .venv/bin/python tools/build_site.py                     into build/site, in all languages
    .venv/bin/python tools/build_site.py --folder FOLDER     somewhere else
    .venv/bin/python tools/build_site.py --languages en de   only these

It is made of docs/guide and the other files in docs, of the help, the definitions, the manifests
and the messages: tools/website says how. A link that leads nowhere is an error.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "build" / "site"


def main() -> int:
    """Make the site; the exit code is 1 when a page is wrong, 2 when a library is missing."""
    options = _parsed()
    for variable in ("QT_SCALE_FACTOR", "QT_FONT_DPI", "QT_STYLE_OVERRIDE"):
        os.environ.pop(variable, None)
    os.environ |= {"QT_QPA_PLATFORM": "offscreen", "LC_ALL": "C.UTF-8", "LANGUAGE": "en"}
    sys.path.insert(0, str(ROOT))
    try:
        from tools.website.build import (  # Qt reads the environment when it is loaded
            WrongLinks,
            build,
        )
        from tools.website.window import Shortcuts
        from tools.website.written import WrongPage
    except ModuleNotFoundError as error:
        _tell(f"{error.name} is not there. After “python3 dev.py setup”, use .venv/bin/python.")
        return 2

    with tempfile.TemporaryDirectory(prefix="nep-site-") as home:
        os.environ["NEP_STUDIO_FOLDER"] = home
        try:
            built = build(options.folder, options.languages, Shortcuts(Path(home)))
        except (WrongLinks, WrongPage) as error:
            _tell(str(error))
            return 1
    first = options.folder / "index.html"
    _tell(f"{built.pages} pages, {built.size / 1e6:.1f} MB. Open {first} in a browser.")
    return 0


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--folder", type=Path, default=SITE, help="where it is made")
    parser.add_argument("--languages", nargs="+", metavar="CODE", default=_all_languages())
    return parser.parse_args()


def _all_languages() -> list[str]:
    tables = ROOT / "resources" / "translations"
    return ["en", *sorted(path.stem for path in tables.glob("*.toml"))]


def _tell(words: str) -> None:
    sys.stdout.write(words + "\n")


if __name__ == "__main__":
    sys.exit(main())

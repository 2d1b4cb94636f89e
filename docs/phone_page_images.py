"""Makes the pictures of the phone's page, and those of the warning that comes before it.

    .venv/bin/python docs/phone_page_images.py           into docs/images and resources/phone_page
    .venv/bin/python docs/phone_page_images.py --check   compare the drawings, change nothing

The page is opened in a real Chromium as a phone has it, fed with a movement; the warning is drawn.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tests.nodes.sensory.chromium import Chromium

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
PAGE = ROOT / "resources" / "phone_page"
WARNINGS = [(phone, theme) for phone in ("android", "ios") for theme in ("light", "dark")]

os.environ |= {"LC_ALL": "C.UTF-8", "LANGUAGE": "en", "QT_QPA_PLATFORM": "offscreen"}
sys.path.insert(0, str(ROOT))


def main() -> int:
    """Make or compare the pictures; the exit code is 1 when a drawing is out of date."""
    options = _parsed()
    out_of_date = [name for name in map(_drawn, WARNINGS) if name] if options.check else []
    for name in out_of_date:
        sys.stdout.write(f"{name} is out of date\n")
    if not options.check:
        _draw()
        _photograph()
    return int(bool(out_of_date))


def _draw() -> None:
    from warning_drawings import drawing

    for phone, theme in WARNINGS:
        path = PAGE / f"warning_{phone}_{theme}.svg"
        path.write_text(drawing(phone, theme), encoding="utf-8", newline="\n")


def _drawn(warning: tuple[str, str]) -> str:
    """The name of a drawing that is not as it would be drawn now; empty when it is."""
    from warning_drawings import drawing

    path = PAGE / f"warning_{'_'.join(warning)}.svg"
    is_there = path.is_file() and path.read_text(encoding="utf-8") == drawing(*warning)
    return "" if is_there else path.name


def _photograph() -> None:
    """Open the page twice, light and dark, move the phone, and take a picture."""
    from image_files import write_small
    from PySide6.QtGui import QImage

    from nodes.sensory.connectors.connector import Settings
    from nodes.sensory.phone_page.server import PhonePage
    from tests.nodes.sensory.chromium import Chromium

    with tempfile.TemporaryDirectory(prefix="nep-page-") as folder:
        server = PhonePage(Settings(port=0), Path(folder))
        url = server.start()
        assert server.certificate is not None
        browser = Chromium(Path(folder) / "profile", server.certificate.spki_sha256)
        try:
            for theme in ("light", "dark"):
                picture = QImage.fromData(_picture(browser, url, is_dark=theme == "dark"))
                size = write_small(picture, IMAGES / f"phone-page-{theme}.png")
                sys.stdout.write(f"phone-page-{theme:14} {size}\n")
        finally:
            browser.close()
            server.stop()


def _picture(browser: Chromium, url: str, *, is_dark: bool) -> bytes:
    page = browser.page(url, is_dark=is_dark)
    page.feel((0.0, 0.0, 0.0))
    page.until("document.body?.dataset.state", "ready")
    page.tap("#allow")
    for step in range(300):
        x, y, z = _acceleration(step / 60)
        reading = {"xyz": {"x": x, "y": y, "z": z}}
        page.call("Emulation.setSensorOverrideReadings", type="accelerometer", reading=reading)
        page.value("new Promise(requestAnimationFrame)")
    picture: bytes = page.screenshot()
    page.close()
    return picture


def _acceleration(t: float) -> tuple[float, float, float]:
    """A hand that waves for a while, in m/s²."""
    swing = math.exp(-(((t - 3.4) / 0.9) ** 2))
    wave = swing * math.sin(2 * math.pi * 1.6 * t)
    return 9 * wave, 6.5 + 4 * swing * math.sin(2 * math.pi * 3.2 * t + 1), 6.8 - 3 * swing * wave


def _parsed() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare, and change nothing")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())

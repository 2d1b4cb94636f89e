"""Paints a moving robot with OpenGL on a display; prints the renderer and the ms of a frame."""

from __future__ import annotations

import json
import statistics
import sys
import time

from PySide6.QtWidgets import QApplication

from benchmarks.robot_view import FRAMES, HEIGHT, WIDTH, scene_of
from nep_studio.ui.robot_view.camera import Camera, Frame, Lens
from nep_studio.ui.robot_view.drawing import gl_bodies
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.gestures import seeing_all
from nep_studio.ui.robot_view.painter import groups_of
from nep_studio.ui.robot_view.shading import Shades
from nep_studio.ui.robot_view.view import nao_folder
from nep_studio.ui.theme.colours import load_theme


def main() -> int:
    """Measure; 1 where there is no OpenGL."""
    app = QApplication([])
    gpu = gl_bodies("opengl")
    if gpu is None:
        return 1
    figure, shades = load_figure(nao_folder()), Shades(load_theme("light"))
    camera = seeing_all(Camera(), scene_of(figure, 1, 0), Frame(WIDTH, HEIGHT))
    spent = []
    for number in range(FRAMES + 5):
        start = time.perf_counter()
        groups = groups_of(scene_of(figure, 1, number))
        gpu.picture(groups, Lens(camera, WIDTH, HEIGHT), shades)
        spent.append(1000 * (time.perf_counter() - start))
    print(json.dumps({"renderer": gpu.renderer, "ms": statistics.median(spent[5:])}))
    app.processEvents()
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Painting with OpenGL: where there is a context it looks like QPainter's, else nothing breaks."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtWidgets import QApplication

from benchmarks.virtual_display import NoDisplay, virtual_display
from nep_studio.ui.robot_view.drawing import NoContext, gl_bodies
from nep_studio.ui.robot_view.gl_bodies import mesh_of
from nep_studio.ui.robot_view.gl_context import GlContext
from nep_studio.ui.robot_view.parts import Blob, Solids

pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[3]
NO_CONTEXT = 77
CHILD = """
import json, sys
from PySide6.QtCore import QSize
from PySide6.QtWidgets import QApplication
from nep_core.wire.messages import RobotState
from nep_studio.ui.robot_view.drawing import NoContext, gl_bodies
from nep_studio.ui.robot_view.figure import load_figure
from nep_studio.ui.robot_view.view import RobotView, nao_folder
from nep_studio.ui.theme.look import Look
import numpy as np

app = QApplication([])
if gl_bodies("opengl") is None:
    sys.exit({no_context})
figure = load_figure(nao_folder())
joints = dict(zip(figure.body.names, figure.body.posture_angles("Stand").tolist()))
state = RobotState(robot="nao", joints=joints, leds={{"LeftFaceLeds": 0xFF0000}})
pictures = []
for drawing in ("painter", "opengl"):
    view = RobotView(Look(app, "light"), drawing=drawing)
    view.resize(320, 320)
    view.show_robot("nao", state)
    view.show()
    image = view.grab().toImage().convertToFormat(view.grab().toImage().Format.Format_RGB32)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(320, 320, 4)[..., :3].astype(int)
    pictures.append((rows, view.painter.gl is not None))
    view.hide()
(plain, _), (fast, used) = pictures
far = np.abs(plain - fast).max(axis=2)
print(json.dumps({{"used": used, "share": float((far > 60).mean()), "mean": float(far.mean())}}))
"""


def test_bodies_look_alike_with_and_without_opengl() -> None:
    try:
        with virtual_display() as environment:
            child = subprocess.run(
                [sys.executable, "-c", CHILD.format(no_context=NO_CONTEXT)],
                cwd=ROOT,
                env=environment,
                capture_output=True,
                text=True,
                timeout=90,
            )
    except NoDisplay as error:
        pytest.skip(str(error))
    if child.returncode == NO_CONTEXT or "could not connect to display" in child.stderr:
        pytest.skip("there is no OpenGL 3.3 here")

    assert child.returncode == 0, child.stderr
    seen = json.loads(child.stdout.splitlines()[-1])
    assert seen["used"]
    assert seen["share"] < 0.05
    assert seen["mean"] < 8


def test_without_a_screen_there_is_no_context_and_no_crash(qapp: QApplication) -> None:
    with pytest.raises(NoContext):
        GlContext.made()

    assert gl_bodies("opengl") is None
    assert gl_bodies("auto") is None


def test_a_mesh_has_its_vertices_on_the_shape_and_normals_outwards() -> None:
    blob = Blob((0.1, 0.0, 0.0), (0.5, 0.3, 0.2), (3.0, 5.0))

    mesh = mesh_of(Solids.of([[blob]]))

    places, normals = mesh[:, :3] - blob.at, mesh[:, 3:6]
    x, y, z = np.abs(places / blob.size).T
    assert np.allclose((x**3 + y**3) ** (5 / 3) + z**5, 1.0, atol=0.02)
    assert (np.einsum("nc,nc->n", places, normals) > 0).all()

"""What curves over time are drawn with: the width of lines, and points as Qt takes them."""

from __future__ import annotations

import numpy as np
import pyqtgraph
from PySide6.QtGui import QFontMetricsF, QPolygonF

from nep_studio.ui.ring import Floats
from nep_studio.ui.theme.colours import HIGH_CONTRAST, Theme

_DOT = np.array([[-1.0, 0.0], [1.0, 0.0]])


def line_width(theme: Theme, metrics: QFontMetricsF) -> float:
    """How wide curves are: wider with larger text and with high contrast."""
    width = max(1, round(metrics.height() / 17))
    return width + 1 if theme.name == HIGH_CONTRAST else width


def polygon(points: Floats) -> QPolygonF:
    """Points (n, 2) as Qt takes them."""
    if len(points) == 1:
        points = points[[0, 0]]
    if len(points) == 2 and (points[0] == points[1]).all():
        points = points + _DOT  # one sample between two gaps: a short line, so that it is seen
    made: QPolygonF = pyqtgraph.functions.create_qpolygonf(len(points))
    pyqtgraph.functions.ndarray_from_qpolygonf(made)[:] = points
    return made

"""What is in a picture: the stacks of a page, of all pages, or the selected blocks."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QFont, QPainter

from nep_studio.blocks.operations.selection import members, runs
from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.boxes import Chain
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.layout import Layout
from nep_studio.ui.canvas.page import PageLayout, boxes_of
from nep_studio.ui.pages_bar import page_title

What = Literal["page", "selection", "pages"]

MARGIN = 24.0
"""The room around the blocks, in canvas units."""


@dataclass
class Part:
    """Stacks that lie on one page, with a title above them where there are several pages."""

    chains: list[Chain]
    bounds: Rect
    title: str = ""


@dataclass
class Scene:
    """Parts below each other; all sizes are in canvas units."""

    parts: list[Part] = field(default_factory=list)
    title_height: float = 0.0
    margin: float = MARGIN

    @property
    def width(self) -> float:
        """How wide all of it is."""
        return max((part.bounds.width for part in self.parts), default=0.0) + 2 * self.margin

    @property
    def height(self) -> float:
        """How high all of it is."""
        inside = sum(self._height_of(part) for part in self.parts)
        return inside + self.margin * (len(self.parts) + 1)

    def _height_of(self, part: Part) -> float:
        return part.bounds.height + (self.title_height if part.title else 0.0)


def scene_of(canvas: Canvas, what: What, margin: float = MARGIN) -> Scene:
    """What of a canvas is asked for; a scene without parts when there are no blocks."""
    scene = Scene(title_height=canvas.measures.line * 2.2, margin=margin)
    if what == "selection":
        chains = _selected(canvas)
        scene.parts = [Part(chains, _bounds(chains))] if chains else []
        return scene
    project = canvas.editor.project
    pages = list(project.pages) if what == "pages" else [canvas.page]
    for page in pages:
        layout = PageLayout(project, canvas.editor.language, canvas.measures)
        layout.show(page)
        chains = list(layout.chains.values())
        if chains:
            title = page_title(project, page) if what == "pages" else ""
            scene.parts.append(Part(chains, _bounds(chains), title))
    return scene


def paint_scene(painter: QPainter, scene: Scene, canvas: Canvas, scale: float) -> None:
    """Paint it from (0, 0) on; the painter counts in canvas units."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    blocks = BlockPainter(canvas.theme, canvas.editor.language, canvas.measures, canvas.block_font)
    y = scene.margin
    for part in scene.parts:
        if part.title:
            _paint_title(painter, part.title, QPointF(scene.margin, y), scene, canvas)
            y += scene.title_height
        left = scene.margin
        if canvas.measures.is_mirrored:
            left = scene.width - scene.margin - part.bounds.width
        painter.translate(left - part.bounds.x, y - part.bounds.y)
        for chain in part.chains:
            blocks.paint(painter, boxes_of(chain, part.bounds), max(scale, 1.0))
        painter.translate(part.bounds.x - left, part.bounds.y - y)
        y += part.bounds.height + scene.margin


def _paint_title(painter: QPainter, title: str, at: QPointF, scene: Scene, canvas: Canvas) -> None:
    font = QFont(canvas.block_font)
    font.setPointSizeF(font.pointSizeF() * 1.3)
    font.setBold(True)
    painter.setFont(font)
    painter.setPen(canvas.theme.colour("text"))
    row = QRectF(at.x(), at.y(), scene.width - 2 * scene.margin, scene.title_height)
    painter.drawText(row, title)


def _selected(canvas: Canvas) -> list[Chain]:
    """The selected blocks, where they lie on the page."""
    project = canvas.editor.project
    layout = Layout(project, canvas.editor.language, canvas.measures)
    chains = []
    for run in runs(project, canvas.selection.ids):
        placed = canvas.page_layout.placed(run.first)
        if placed is None:
            continue
        chain = layout.chain(members(project, run), shown=True)
        side = placed.box.width if placed.box.is_mirrored else 0.0
        chain.x, chain.y = placed.x + side, placed.y
        chains.append(chain)
    return chains


def _bounds(chains: list[Chain]) -> Rect:
    """The rectangle around chains, with the tabs below them."""
    rects = []
    for chain in chains:
        left = chain.x - chain.width if chain.is_mirrored else chain.x
        rects.append(Rect(left, chain.y, chain.width, chain.height + 8.0))
    whole = rects[0]
    for rect in rects[1:]:
        whole = whole.united(rect)
    return whole

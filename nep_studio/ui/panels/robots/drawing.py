"""Draws a robot: shell, joints, lights in their colours, and the part that is touched."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QRadialGradient

from nep_studio.ui.theme import Theme

from .figure import Dot

LIMB_MM, HAND_MM, FOOT_MM = 52.0, 26.0, 46.0
HEAD_WIDE_MM, HEAD_HIGH_MM = 88.0, 78.0
TORSO_WIDE_MM, HIPS_WIDE_MM = 122.0, 96.0
EYE_MM = 25.0
EDGE_MM = 4.0


class RobotDrawing:
    """One drawing of a robot in mm; ``leds`` are 0xRRGGBB by light."""

    def __init__(
        self, painter: QPainter, theme: Theme, dots: Mapping[str, Dot], leds: Mapping[str, int]
    ) -> None:
        self._painter, self._dots, self._leds = painter, dots, leds
        self._shell = theme.colour("text" if theme.is_dark else "field")
        self._edge = theme.colour("muted")
        self._joint = theme.block("robots").fill
        self._dark = QColor(Qt.GlobalColor.black) if theme.is_dark else theme.colour("text")

    def draw(self) -> None:
        """Draw the farthest parts first."""
        parts: list[tuple[float, Callable[[], None]]] = [
            (self._near("L_knee", "L_ankle"), lambda: self._leg("L")),
            (self._near("R_knee", "R_ankle"), lambda: self._leg("R")),
            (self._near("L_elbow", "L_hand"), lambda: self._arm("L")),
            (self._near("R_elbow", "R_hand"), lambda: self._arm("R")),
            (self._near("torso"), self._torso),
            (self._near("head"), self._head),
        ]
        for _, draw in sorted(parts, key=lambda part: part[0]):
            draw()

    def _near(self, *names: str) -> float:
        return sum(self._dots[name].near for name in names) / len(names)

    def at(self, name: str) -> QPointF:
        """Where a part is."""
        dot = self._dots[name]
        return QPointF(dot.x, dot.y)

    def _leg(self, side: str) -> None:
        hip, knee, ankle = (self.at(f"{side}_{part}") for part in ("hip", "knee", "ankle"))
        heel, toe = self.at(f"{side}_heel"), self.at(f"{side}_toe")
        foot = [(heel, toe, FOOT_MM), (ankle, (heel + toe) / 2, FOOT_MM)]
        self._tubes([(knee, ankle, LIMB_MM), (hip, knee, LIMB_MM)])
        self._joint_at(knee, 15)
        self._tubes(foot)
        light = {"L": "LeftFootLeds", "R": "RightFootLeds"}[side]
        self._light((heel + toe * 2) / 3, 9, light)

    def _arm(self, side: str) -> None:
        shoulder, elbow = self.at(f"{side}_shoulder"), self.at(f"{side}_elbow")
        hand = self.at(f"{side}_hand")
        self._tubes([(shoulder, elbow, LIMB_MM * 0.8), (elbow, hand, LIMB_MM * 0.8)])
        self._joint_at(shoulder, 22)
        self._joint_at(elbow, 13)
        self._joint_at(hand, HAND_MM)

    def _torso(self) -> None:
        neck, left, right = self.at("neck"), self.at("L_hip"), self.at("R_hip")
        middle = (left + right) / 2
        chest = neck + (middle - neck) * 0.3
        shoulders = [self.at(f"{side}_shoulder") for side in ("L", "R")]
        self._tubes(
            [
                (neck, chest, LIMB_MM),
                (shoulders[0], shoulders[1], LIMB_MM),
                (chest, middle, HIPS_WIDE_MM),
                (chest, chest + (middle - neck) * 0.2, TORSO_WIDE_MM),
            ]
        )
        if self._near("chest") > self._near("torso"):
            self._ring(self.at("chest"), 15)
            self._light(self.at("chest"), 11, "ChestLeds")

    def _head(self) -> None:
        head = self.at("head")
        for side, light in (("L", "LeftEarLeds"), ("R", "RightEarLeds")):
            self._ear(side, light)
        self._painter.setPen(QPen(self._edge, EDGE_MM))
        self._painter.setBrush(self._shell)
        self._painter.drawEllipse(head, HEAD_WIDE_MM, HEAD_HIGH_MM)
        for name in ("head_rear", "head_middle", "head_front"):
            if self._near(name) > self._near("head") - 30:
                self._joint_at(self.at(name), 11)
                self._light(self.at(name), 6, "BrainLeds")
        for side, light in (("L", "LeftFaceLeds"), ("R", "RightFaceLeds")):
            if self._near(f"{side}_eye") > self._near("head"):
                self._eye(self.at(f"{side}_eye"), light)
        if self._near("mouth") > self._near("head"):
            self._mouth()

    def _mouth(self) -> None:
        pen = QPen(self._dark, 5)
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        self._painter.setPen(pen)
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        box = QRectF(0, 0, 38, 20)
        box.moveCenter(self.at("mouth"))
        self._painter.drawArc(box, 200 * 16, 140 * 16)

    def _ear(self, side: str, light: str) -> None:
        place = self.at(f"{side}_ear")
        self._joint_at(place, 30)
        self._light(place, 19, light)

    def _eye(self, place: QPointF, light: str) -> None:
        self._glow(place, EYE_MM * 1.9, light)
        self._ring(place, EYE_MM)
        self._light(place, EYE_MM * 0.84, light)
        self._painter.setBrush(self._dark)
        self._painter.drawEllipse(place, EYE_MM * 0.42, EYE_MM * 0.42)

    def _glow(self, place: QPointF, radius: float, light: str) -> None:
        colour = self._led(light)
        if colour is None:
            return
        glow = QRadialGradient(place, radius)
        colour.setAlpha(150)
        glow.setColorAt(0.5, colour)
        colour.setAlpha(0)
        glow.setColorAt(1.0, colour)
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(glow)
        self._painter.drawEllipse(place, radius, radius)

    def _light(self, place: QPointF, radius: float, light: str) -> None:
        """A light in its colour; one that is off is grey."""
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(self._led(light) or self._edge)
        self._painter.drawEllipse(place, radius, radius)

    def _led(self, light: str) -> QColor | None:
        number = self._leds.get(light, 0)
        return QColor.fromRgb(0xFF000000 | number) if number else None

    def _ring(self, place: QPointF, radius: float) -> None:
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(self._dark)
        self._painter.drawEllipse(place, radius, radius)

    def _joint_at(self, place: QPointF, radius: float) -> None:
        self._painter.setPen(QPen(self._edge, EDGE_MM * 0.7))
        self._painter.setBrush(self._joint)
        self._painter.drawEllipse(place, radius, radius)

    def _tubes(self, tubes: list[tuple[QPointF, QPointF, float]]) -> None:
        """Thick round lines with one edge around all of them."""
        for is_edge in (True, False):
            for start, end, width in tubes:
                pen = QPen(self._edge if is_edge else self._shell, width)
                pen.setWidthF(width + 2 * EDGE_MM if is_edge else width)
                pen.setCapStyle(Qt.PenCapStyle.RoundCap)
                self._painter.setPen(pen)
                self._painter.drawLine(start, end)

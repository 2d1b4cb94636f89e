"""A little live curve of how hard a watch is moved, over the last seconds."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

from PySide6.QtCore import QObject, QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy

from nep_core.wire.messages import IMU, Imu
from nep_studio.blocks.operations.fixes import WATCH
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.labels import labelled
from nep_studio.ui.running.runner import Heard, Runner, Tap
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import InLines
from nep_studio.ui.words import count_words, tr

RATE_OVER_S = 2.0
MOVED_OVER_S = 1.0
REMEMBERED_S = 60.0
SILENT_S = 2.0
"""After so long without a sample it is said that nothing comes."""
MOVED_M_S2 = 2.5
"""Noise and a pulse stay far below; a wave of the hand, or turning the device, is above."""
_GAP_STEPS = 2.5
_MOST_LOST = 10_000
"""A sensor's clock that jumps does not mean that a million samples were lost."""


@dataclass(frozen=True)
class Flow:
    """How a watch sends; None where nobody can tell. ``gaps`` are those of the last minute."""

    rate_hz: float = 0.0
    loss: float | None = None
    gaps: int = 0
    drift_ppm: float | None = None
    delay_ms: float | None = None


class Receiving:
    """Follows the samples of one watch; times are ``time.monotonic()``."""

    def __init__(self) -> None:
        self.source = ""
        self.is_simulated = False
        self.has_rotation = False
        self.has_moved = False
        """Whether it was moved since it began to send."""
        self.movement_m_s2 = 0.0
        """How far its acceleration reached in the last second."""
        self.heard_s = -math.inf
        self._counts: deque[tuple[float, int]] = deque(maxlen=1000)
        self._latest: deque[tuple[float, tuple[float, float, float]]] = deque(maxlen=2000)
        self._holes: deque[tuple[float, int]] = deque(maxlen=1000)
        self._last_t: float | None = None

    def hear(self, message: Imu, now_s: float) -> None:
        """Take a batch that has arrived."""
        if not message.t or not message.acc:
            return
        if now_s - self.heard_s > SILENT_S:
            self._counts.clear()  # the rate is that since it sends again
            self._last_t = None
        self.source, self.is_simulated = message.source, message.simulated
        self.has_rotation = message.gyr is not None
        self.heard_s = now_s
        self._counts.append((now_s, len(message.t)))
        # Note where samples are missing, as far as their times tell
        step_s = 1 / message.rate_hz if message.rate_hz > 0 else 0.0
        for t in message.t:
            if step_s and self._last_t is not None and t - self._last_t > _GAP_STEPS * step_s:
                count = round((t - self._last_t) / step_s) - 1
                self._holes.append((now_s, min(count, _MOST_LOST)))
            self._last_t = t
        self._latest.extend((now_s, row) for row in message.acc)
        while self._latest and now_s - self._latest[0][0] > MOVED_OVER_S:
            self._latest.popleft()
        axes = list(zip(*(row for _, row in self._latest), strict=True))
        self.movement_m_s2 = max(max(axis) - min(axis) for axis in axes)
        self.has_moved |= self.movement_m_s2 > MOVED_M_S2

    def is_sending(self, now_s: float) -> bool:
        """Whether samples came just now."""
        return now_s - self.heard_s < SILENT_S

    def flow(self, now_s: float, measures: Mapping[str, float]) -> Flow:
        """How it sends; what its node ``measures`` goes before what is counted here."""
        lost = sum(count for _, count in self._recent_holes(now_s))
        there = sum(count for time_s, count in self._counts if now_s - time_s < REMEMBERED_S)
        loss = lost / (lost + there) if there else None
        return Flow(
            rate_hz=measures.get("rate_hz") or self.rate_hz(now_s),
            loss=measures.get("loss", loss),
            gaps=int(measures.get("gaps", len(self._recent_holes(now_s)))),
            drift_ppm=measures.get("drift_ppm"),
            delay_ms=measures.get("delay_ms"),
        )

    def rate_hz(self, now_s: float) -> float:
        """Samples a second that came in the last seconds; 0 when nothing comes."""
        if not self.is_sending(now_s):
            return 0.0
        counted = [(time_s, n) for time_s, n in self._counts if now_s - time_s <= RATE_OVER_S]
        if len(counted) < 2:
            return 0.0
        seconds = counted[-1][0] - counted[0][0]
        return sum(count for _, count in counted[1:]) / seconds if seconds > 0 else 0.0

    def _recent_holes(self, now_s: float) -> list[tuple[float, int]]:
        return [one for one in self._holes if now_s - one[0] < REMEMBERED_S]


# Hears the watch of a project: whose samples come, how fast, and what its node says of it.

TELL_MS = 250
FORGOTTEN_S = 60.0
"""A watch that was silent for so long is not spoken of any more."""


class WatchListener(QObject):
    """Hears ``/imu`` between ``start`` and ``stop``; of one node when ``node`` names it.

    ``changed`` tells 4 times a second how it is; ``heard`` gives the batches (Imu) of the watch
    that is followed: a real one before a simulated one, the newest of several.
    """

    changed = Signal()
    heard = Signal(list)

    def __init__(self, runner: Runner, parent: QObject | None = None, node: str = "") -> None:
        super().__init__(parent)
        self.node = node
        self._runner = runner
        self._tap: Tap | None = None
        self._by_node: dict[str, Receiving] = {}
        self._kept = ""
        self._telling = QTimer(self, interval=TELL_MS)
        self._telling.timeout.connect(self.changed)

    def start(self) -> None:
        """Hear from now on."""
        if self._tap is None:
            self._tap = self._runner.tap(IMU, kind=Imu, parent=self)
            self._tap.arrived.connect(self.hear)
            self._telling.start()

    def stop(self) -> None:
        """Hear no more."""
        self._telling.stop()
        if self._tap is not None:
            self._tap.close()
            self._tap = None

    def begin_anew(self, node: str) -> None:
        """Forget what was heard; follow this node."""
        self.node = node
        self._by_node.clear()

    def hear(self, batch: Sequence[Heard]) -> None:
        """Take batches of samples."""
        now_s = time.monotonic()
        mine: list[tuple[str, Imu]] = []
        for one in batch:
            if not self.node or one.sender == self.node:
                self._by_node.setdefault(one.sender, Receiving()).hear(one.message, now_s)
                mine.append((one.sender, one.message))
        followed = self.source
        if found := [message for sender, message in mine if sender == followed]:
            self.heard.emit(found)

    @property
    def source(self) -> str:
        """The node whose watch is followed; "" when none was heard lately."""
        if self.node:
            return self.node
        now_s = time.monotonic()
        known = {
            name: one for name, one in self._by_node.items() if now_s - one.heard_s < FORGOTTEN_S
        }

        def rank(name: str) -> tuple[bool, bool, bool, float]:
            one, is_kept = known[name], name == self._kept  # two that send do not take turns
            return one.is_sending(now_s), not one.is_simulated, is_kept, one.heard_s

        self._kept = max(known, key=rank, default="")
        return self._kept

    @property
    def receiving(self) -> Receiving:
        """What is heard of the watch that is followed."""
        return self._by_node.get(self.source) or Receiving()

    @property
    def is_sending(self) -> bool:
        """Whether samples come."""
        return self.receiving.is_sending(time.monotonic())

    @property
    def silent_s(self) -> float:
        """How long nothing has come; infinity before the first samples."""
        return time.monotonic() - self.receiving.heard_s

    @property
    def flow(self) -> Flow:
        """How the watch sends."""
        status = self.status
        measures = status.measures if status is not None and self.is_sending else {}
        return self.receiving.flow(time.monotonic(), measures)

    @property
    def status(self) -> NodeStatus | None:
        """How the node of the watch is doing."""
        return self._runner.board.nodes.get(self.source)

    @property
    def awaited(self) -> PlannedNode | None:
        """A node that runs here and waits for a watch; None when there is none."""
        nodes, started = self._runner.board.nodes, self._runner.started
        there = (started[name] for name in started if name in nodes and nodes[name].is_there)
        return next((planned for planned in there if planned.node == WATCH), None)

    @property
    def planned(self) -> PlannedNode | None:
        """How the node of the watch was started, when that was here."""
        return self._runner.started.get(self.source)


SHOWN_S = 6.0
GAP_S = 0.5
LEAST_REACH_M_S2 = 6.0
"""Of stillness the noise is not blown up to the full height."""
LINES_HIGH = 3.6


class LittleCurve(InLines):
    """The length of the acceleration; what is newest is where reading ends."""

    usual_lines = (14, LINES_HIGH)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self._points: deque[tuple[float, float]] = deque(maxlen=4000)
        labelled(self, name="How hard it is moved, over the last seconds")
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def take(self, batch: Sequence[Imu]) -> None:
        """Draw these samples too."""
        for message in batch:
            for t, row in zip(message.t, message.acc, strict=False):
                if self._points and t <= self._points[-1][0]:
                    self._points.clear()  # another clock
                self._points.append((t, math.hypot(*row)))
        while self._points and self._points[-1][0] - self._points[0][0] > SHOWN_S:
            self._points.popleft()
        if self.isVisible():
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the curve in a field."""
        theme = self._look.theme
        edge = max(1.0, self.fontMetrics().height() / 14)
        room = QRectF(self.rect()).adjusted(edge, edge, -edge, -edge)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(theme.colour("line"), edge))
            painter.setBrush(theme.colour("field"))
            painter.drawRoundedRect(room, edge * 5, edge * 5)
            painter.setClipRect(room)
            painter.setPen(QPen(theme.colour("plot_1"), edge * 1.8))
            for part in self._parts(room.adjusted(edge, edge * 3, -edge, -edge * 3)):
                painter.drawPolyline(part)

    def _parts(self, room: QRectF) -> list[QPolygonF]:
        """The curve in pixels, cut where nothing came for a while."""
        if not self._points:
            return []
        values = [value for _, value in self._points]
        middle = (max(values) + min(values)) / 2
        reach = max(LEAST_REACH_M_S2, (max(values) - min(values)) / 2)
        newest, parts, before = self._points[-1][0], [QPolygonF()], self._points[0][0]
        for t, value in self._points:
            if t - before > GAP_S:
                parts.append(QPolygonF())
            before = t
            x = room.right() - (newest - t) / SHOWN_S * room.width()
            y = room.center().y() - (value - middle) / reach * room.height() / 2
            parts[-1].append(QPointF(x, y))
        return parts


# The big dot that answers a movement: grey while nothing comes, green once it has moved.

Moving = Literal["waiting", "still", "moved", "failed"]
LIVELIEST_M_S2 = 15.0
"""A movement of so much fills the dot."""
SMALLEST = 0.62
ICONS = {"waiting": "hourglass", "still": "hand", "moved": "check", "failed": "x"}
COLOURS = {"waiting": "muted", "still": "info", "moved": "success", "failed": "error"}


class MoveDot(InLines):
    """Grows with the movement; its shape and its sign differ, not its colour alone."""

    usual_lines = (LINES_HIGH, LINES_HIGH)

    def __init__(self, look: Look) -> None:
        super().__init__()
        self.state: Moving = "waiting"
        self._look = look
        self._liveliness = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)

    def show_movement(self, state: Moving, movement_m_s2: float) -> None:
        """Show how it is; the movement is how far the acceleration reached lately."""
        liveliness = min(1.0, max(0.0, movement_m_s2 / LIVELIEST_M_S2))
        if (state, liveliness) != (self.state, self._liveliness):
            self.state, self._liveliness = state, liveliness
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        theme, side = self._look.theme, min(self.width(), self.height())
        colour = theme.colour(COLOURS[self.state])
        is_live = self.state in ("still", "moved")
        share = SMALLEST + (1 - SMALLEST) * self._liveliness if is_live else SMALLEST + 0.2
        radius = side / 2 * share - 1
        middle = QPointF(self.width() / 2, self.height() / 2)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            pen = QPen(colour, max(1.5, side / 28))
            if not is_live:
                pen.setStyle(Qt.PenStyle.DashLine)
            painter.setPen(pen)
            painter.setBrush(colour if is_live else Qt.BrushStyle.NoBrush)
            painter.drawEllipse(middle, radius, radius)
            sign = side * 0.34
            place = QRectF(middle.x() - sign / 2, middle.y() - sign / 2, sign, sign)
            of_sign = theme.colour("field") if is_live else colour
            paint_icon(painter, place, ICONS[self.state], of_sign)


# How a watch sends, in words and numbers: rate, loss, gaps, delay and the drift of its clock.

Grade = Literal["good", "fair", "poor"]
GRADES = get_args(Grade)

GOOD_HZ, FAIR_HZ = 25.0, 14.0
"""Gestures are told apart from 16 samples a second on; 25 and more are better."""
MOST_LOSS = (0.02, 0.10)
MOST_DELAY_MS = (150.0, 500.0)
MOST_GAPS = (0, 5)
MOST_DRIFT_PPM = (500.0, 5000.0)


@dataclass(frozen=True)
class Figure:
    """One number of a watch: what it is, the number with its unit, how good it is, and why."""

    name: str
    number: str
    grade: Grade
    words: str


def figures(flow: Flow) -> list[Figure]:
    """What is known of how a watch sends, the most important first."""
    number = tr("{number} a second", number=round(flow.rate_hz))
    words = tr("fast enough"), tr("enough; 50 are better"), tr("too few: choose 50 in the app")
    found = [_figure(tr("Samples"), number, -flow.rate_hz, (-GOOD_HZ, -FAIR_HZ), words)]
    if flow.loss is not None:
        percent, digits = flow.loss * 100, 1 if 0 < flow.loss < 0.0995 else 0
        number = tr("{percent} %", percent=f"{percent:.{digits}f}")
        words = tr("next to nothing is missing"), tr("it still works"), tr("go nearer to the Wi-Fi")
        found.append(_figure(tr("Lost"), number, flow.loss, MOST_LOSS, words))
    words = (
        tr("it never paused in the last minute"),
        tr("short pauses in the last minute"),
        tr("many pauses: keep its screen on"),
    )
    found.append(_figure(tr("Gaps"), str(flow.gaps), flow.gaps, MOST_GAPS, words))
    return [*found, *_times(flow)]


def _times(flow: Flow) -> Iterator[Figure]:
    """How late it is, and how its clock runs, as far as that is known."""
    if flow.delay_ms is not None:
        late = tr("late: let the app send more often")
        words = tr("as good as at once"), tr("a little late"), late
        number = tr("{number} ms", number=round(flow.delay_ms))
        yield _figure(tr("Delay"), number, flow.delay_ms, MOST_DELAY_MS, words)
    if flow.drift_ppm is not None:
        words = (
            tr("its clock runs like ours"),
            tr("its clock runs a little differently; that is allowed for"),
            tr("its clock runs very differently; that is allowed for"),
        )
        number = tr("{seconds} s an hour", seconds=f"{flow.drift_ppm * 3600 / 1e6:+.2f}")
        yield _figure(tr("Clock"), number, abs(flow.drift_ppm), MOST_DRIFT_PPM, words)


def figure_lines(flow: Flow) -> str:
    """The same, a line each, as for a tool tip."""
    return "\n".join(f"{one.name}: {one.number} ({one.words})" for one in figures(flow))


def rate_words(rate_hz: float) -> str:
    """Such as “62 samples a second”."""
    return count_words(round(rate_hz), "1 sample a second", "{n} samples a second")


def _figure(
    name: str, number: str, value: float, most: tuple[float, float], words: tuple[str, str, str]
) -> Figure:
    """A value of which less is better: good or fair up to ``most``, with the words of each."""
    at = sum(value > limit for limit in most)
    return Figure(name, number, GRADES[at], words[at])

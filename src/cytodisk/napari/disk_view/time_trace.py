"""`TimeTrace`: a number against time, with a line at the frame that is shown."""

from __future__ import annotations

from typing import Any

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt, Signal
from qtpy.QtGui import QColor, QFont, QPainter, QPen, QPolygonF
from qtpy.QtWidgets import QWidget

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.plot.time_axis import FrameTimes, stands_alone

_LEAST_HEIGHT, _LARGEST_HEIGHT = 92, 150
_LEFT, _RIGHT = 46, 8  # pixels beside the line
_MARGIN = 0.06  # of the range of values, above and below
_NOW, _ZERO = QColor("#E69F00"), QColor(128, 128, 128, 160)


class TimeTrace(QWidget):
    """One line against time.

    Parameters
    ----------
    colour : str
        Of the line.
    parent : QWidget, optional

    Attributes
    ----------
    chosen : Signal
        With the number of the frame that was clicked.
    """

    chosen = Signal(int)

    def __init__(self, colour: str, parent: QWidget | None = None):
        super().__init__(parent)
        self.colour, self.text_colour = QColor(colour), QColor("black")
        self.title = ""
        self.times: FrameTimes | None = None
        self.values: FloatArray = np.zeros(0)
        self.now: int | None = None
        self.with_zero = False
        self.setMinimumHeight(_LEAST_HEIGHT)
        self.setMaximumHeight(_LARGEST_HEIGHT)
        self.setToolTip("Click to go to a frame.")

    def show_line(
        self, title: str, times: FrameTimes, values: FloatArray, *, with_zero: bool = False
    ) -> None:
        """Show a line.

        Parameters
        ----------
        title : str
            With the unit.
        times : FrameTimes
        values : ndarray of shape (T,) and dtype float
            NaN leaves a gap.
        with_zero : bool
            Draw a line at 0.
        """
        self.title, self.times, self.values, self.with_zero = title, times, values, with_zero
        self.update()

    def clear(self, title: str) -> None:
        """Show no line, but words."""
        self.title, self.times, self.values = title, None, np.zeros(0)
        self.update()

    def set_now(self, frame: int | None) -> None:
        """Move the line at the frame that is shown."""
        if frame != self.now:
            self.now = frame
            self.update()

    @property
    def limits(self) -> tuple[float, float]:
        """Ends of the axis of values."""
        known = self.values[np.isfinite(self.values)]
        low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)
        if self.with_zero:
            low, high = min(low, 0.0), max(high, 0.0)
        margin = _MARGIN * ((high - low) or abs(high) or 1.0)
        return low - margin, high + margin

    @property
    def box(self) -> QRectF:
        """Where the line is, in pixels of the widget."""
        line = self.fontMetrics().height()
        below = line + 8
        return QRectF(
            _LEFT, line + 3, max(1, self.width() - _LEFT - _RIGHT), self.height() - line - 3 - below
        )

    def x_of(self, frame: float) -> float:
        """Place of a frame across the widget."""
        if self.times is None:
            return float(self.box.left())
        last = max(1, self.times.count - 1)
        return float(self.box.left() + (frame - self.times.first) / last * self.box.width())

    def frame_at(self, x: float) -> int | None:
        """Number of the frame at a place across the widget; None without a line."""
        if self.times is None:
            return None
        share = (x - self.box.left()) / self.box.width()
        place = round(float(share) * max(1, self.times.count - 1))
        return int(self.times.first + min(max(place, 0), self.times.count - 1))

    def mousePressEvent(self, event: Any) -> None:
        """Tell the frame that is clicked."""
        self._choose(event)

    def mouseMoveEvent(self, event: Any) -> None:
        """Tell the frame that the pressed mouse is moved to."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._choose(event)

    def _choose(self, event: Any) -> None:
        frame = self.frame_at(event.position().x())
        if frame is not None and frame != self.now:
            self.chosen.emit(frame)

    def paintEvent(self, event: Any) -> None:
        """Paint it."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(self.text_colour)
        metrics = self.fontMetrics()
        title = metrics.elidedText(self.title, Qt.TextElideMode.ElideRight, self.width())
        painter.drawText(0, metrics.ascent(), title)
        if self.times is not None:
            self._paint_axes(painter, self.times)
            self._paint_values(painter, self.times)
        painter.end()

    def _paint_axes(self, painter: QPainter, times: FrameTimes) -> None:
        box, (low, high) = self.box, self.limits
        painter.setFont(QFont(self.font().family(), 8))
        faint = QColor(self.text_colour)
        faint.setAlpha(120)
        painter.setPen(QPen(faint, 1.0))
        painter.drawLine(box.bottomLeft(), box.bottomRight())
        painter.drawLine(box.topLeft(), box.bottomLeft())
        if self.with_zero and low < 0.0 < high:
            y = box.bottom() - (0.0 - low) / (high - low) * box.height()
            painter.setPen(QPen(_ZERO, 1.0, Qt.PenStyle.DashLine))
            painter.drawLine(QPointF(box.left(), y), QPointF(box.right(), y))
        painter.setPen(self.text_colour)
        flags = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for value, y in ((high, box.top() + 4), (low, box.bottom() - 4)):
            words = rounded(value, 2).replace("-", "−")
            painter.drawText(QRectF(0, y - 8, _LEFT - 4, 16), flags, words)
        self._paint_times(painter, times)

    def _paint_times(self, painter: QPainter, times: FrameTimes) -> None:
        box, top = self.box, self.box.bottom() + 2
        for place, flag in ((0, Qt.AlignmentFlag.AlignLeft), (-1, Qt.AlignmentFlag.AlignRight)):
            room = QRectF(box.left(), top, box.width(), 16)
            painter.drawText(room, flag | Qt.AlignmentFlag.AlignVCenter, f"{float(times.at[place]):.4g}")
        middle = QRectF(box.left(), top, box.width(), 16)
        painter.drawText(middle, Qt.AlignmentFlag.AlignCenter, times.label)

    def _paint_values(self, painter: QPainter, times: FrameTimes) -> None:
        box, (low, high) = self.box, self.limits
        y = box.bottom() - (self.values - low) / (high - low) * box.height()
        x = np.array([self.x_of(times.first + times.stride * k) for k in range(times.count)])
        painter.setPen(QPen(self.colour, 1.5))
        known = np.isfinite(y)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(np.int8)))
        for first, last in zip(edges[::2], edges[1::2], strict=True):
            points = [QPointF(float(a), float(b)) for a, b in zip(x[first:last], y[first:last], strict=True)]
            painter.drawPolyline(QPolygonF(points))
        painter.setBrush(self.colour)
        for place in np.flatnonzero(stands_alone(self.values)):
            painter.drawEllipse(QPointF(float(x[place]), float(y[place])), 1.5, 1.5)
        if self.now is not None and times.first <= self.now <= times.first + times.count - 1:
            painter.setPen(QPen(_NOW, 2.0))
            painter.drawLine(
                QPointF(self.x_of(self.now), box.top()), QPointF(self.x_of(self.now), box.bottom())
            )

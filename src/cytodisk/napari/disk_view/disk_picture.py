"""`DiskPicture`: the disk of a cell, painted by Qt."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from qtpy.QtCore import QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QFont, QImage, QPainter, QPainterPath, QPen
from qtpy.QtWidgets import QSizePolicy, QWidget

from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.napari.disk_view.cell_marks import PINNED, POINTED
from cytodisk.napari.disk_view.disk_paths import grid_path, window_path
from cytodisk.napari.disk_view.disk_pixels import DiskColours, DiskFrame, DiskPixels

LEAST_SIZE, LARGEST_SIZE = 220, 420
_USUAL_SIZE = 280

_NUMBERS = 18  # pixels that the numbers of sectors take beyond the ring
_RING, _GAP = 8, 2
_AWAY = 11  # middles of these numbers from the ring
_CROSS = 5
_RING_LINE = QColor(128, 128, 128)


class DiskPicture(QWidget):
    """The disk, its ring, its numbers of sectors, and what is pointed at.

    Parameters
    ----------
    parent : QWidget, optional

    Attributes
    ----------
    hovered : Signal
        With (u, v) under the cursor.
    clicked : Signal
        With (u, v).
    left : Signal
        The cursor is not on the disk any more.
    """

    hovered = Signal(float, float)
    clicked = Signal(float, float)
    left = Signal()

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.colours: DiskColours | None = None
        self.message = ""
        self.cross: tuple[float, float] | None = None
        self.window: int | None = None
        self.pinned: int | None = None
        self.text_colour = QColor("black")
        self.with_grid = True
        self._kept: dict[str, tuple[Any, Any]] = {}
        self.setMouseTracking(True)
        self.setMinimumSize(LEAST_SIZE, LEAST_SIZE)
        policy = QSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)

    def sizeHint(self) -> QSize:
        """As wide as a dock usually is."""
        return QSize(_USUAL_SIZE, _USUAL_SIZE)

    def hasHeightForWidth(self) -> bool:
        """It is a square."""
        return True

    def heightForWidth(self, width: int) -> int:
        """As high as it is wide."""
        return int(np.clip(width, LEAST_SIZE, LARGEST_SIZE))

    def show_colours(self, colours: DiskColours | None, message: str = "") -> None:
        """Show another frame, another cell, or none with a message."""
        self.colours, self.message = colours, message
        self._kept.pop("image", None)
        self.update()

    def point_at(
        self, cross: tuple[float, float] | None, window: int | None, pinned: int | None = None
    ) -> None:
        """Mark a place, the window that holds it, and a window that stays marked."""
        if (cross, window, pinned) != (self.cross, self.window, self.pinned):
            self.cross, self.window, self.pinned = cross, window, pinned
            self.update()

    @property
    def frame(self) -> DiskFrame:
        """Where the disk lies, in pixels of the widget, whose middle is its own."""
        size = min(self.width(), self.height(), LARGEST_SIZE)
        outer = 0.5 * size - _NUMBERS
        if self.colours is None or self.colours.ring is None:
            return DiskFrame(size, outer)
        return DiskFrame(size, outer - _RING - _GAP, (outer - _RING, outer))

    @property
    def _corner(self) -> tuple[float, float]:
        size = self.frame.size
        return 0.5 * (self.width() - size), 0.5 * (self.height() - size)

    def place_of(self, x: float, y: float) -> tuple[float, float] | None:
        """(u, v) of a point of the widget; None outside the disk and its ring."""
        left, top = self._corner
        return self.frame.place(x - left, y - top)

    def point_of(self, u: float, v: float) -> tuple[float, float]:
        """(x, y) in the widget of a place of the disk."""
        (left, top), (x, y) = self._corner, self.frame.point(u, v)
        return left + x, top + y

    def mouseMoveEvent(self, event: Any) -> None:
        """Tell the place under the cursor."""
        self._tell(event, self.hovered)

    def mousePressEvent(self, event: Any) -> None:
        """Tell the place that is clicked."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._tell(event, self.clicked)

    def leaveEvent(self, event: Any) -> None:
        """Tell that the cursor is gone."""
        self.left.emit()

    def _tell(self, event: Any, signal: Any) -> None:
        point = event.position()
        place = None if self.colours is None else self.place_of(point.x(), point.y())
        if place is None:
            self.left.emit()
        else:
            signal.emit(*place)

    def paintEvent(self, event: Any) -> None:
        """Paint it."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(*self._corner)
        if self.colours is not None:
            self._paint_disk(painter, self.colours)
        if self.message:
            self._paint_message(painter)
        painter.end()

    def _paint_disk(self, painter: QPainter, colours: DiskColours) -> None:
        frame, grid = self.frame, colours.grid
        painter.drawImage(QRectF(0, 0, frame.size, frame.size), self._image(colours))
        if self.with_grid and colours.windows is not None:
            painter.setPen(QPen(QColor(255, 255, 255, 90), 0.6))
            painter.drawPath(
                self._once("grid", (frame, grid.radii.tobytes()), lambda: grid_path(grid, frame))
            )
        self._paint_circles(painter, colours)
        self._paint_numbers(painter, grid.sectors)
        if colours.windows is None:
            return
        for number, colour in ((self.pinned, PINNED), (self.window, POINTED)):
            if number is not None:
                _paint_over(painter, window_path(grid, frame, number), QColor(colour))
        if self.cross is not None:
            _paint_over(painter, _cross(*frame.point(*self.cross)), QColor(POINTED))

    def _image(self, colours: DiskColours) -> QImage:
        """The coloured disk in pixels of the screen."""
        ratio, frame = self.devicePixelRatioF(), self.frame
        key = (frame, ratio)
        found = self._kept.get("image")
        if found is None or found[0] != key:
            ring = None if frame.ring is None else (frame.ring[0] * ratio, frame.ring[1] * ratio)
            fine = replace(frame, size=round(frame.size * ratio), radius=frame.radius * ratio, ring=ring)
            pixels = self._once(
                "pixels", (fine, colours.grid.radii.tobytes()), lambda: DiskPixels(colours.grid, fine)
            )
            found = key, image_of(pixels, colours)
            self._kept["image"] = found
        image: QImage = found[1]
        return image

    def _once(self, name: str, key: Any, make: Any) -> Any:
        """What was made for this size and these radii, or is made now."""
        if name not in self._kept or self._kept[name][0] != key:
            self._kept[name] = key, make()
        return self._kept[name][1]

    def _paint_circles(self, painter: QPainter, colours: DiskColours) -> None:
        frame = self.frame
        middle = QPointF(0.5 * frame.size, 0.5 * frame.size)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(self.text_colour, 1.0))
        painter.drawEllipse(middle, frame.radius, frame.radius)
        if frame.ring is not None:
            painter.setPen(QPen(_RING_LINE, 0.8))
            for radius in frame.ring:
                painter.drawEllipse(middle, radius, radius)
        if colours.nucleus_radius is not None:
            inner = frame.radius * colours.nucleus_radius
            for colour, width in (("black", 2.6), ("white", 1.4)):
                painter.setPen(QPen(QColor(colour), width))
                painter.drawEllipse(middle, inner, inner)

    def _paint_numbers(self, painter: QPainter, sectors: int) -> None:
        """Numbers of the four sectors that begin there, ticks between, and the ring that marks sector 0."""
        frame = self.frame
        painter.setPen(QPen(self.text_colour, 1.0))
        painter.setFont(QFont(self.font().family(), 8))
        outer = 0.5 * frame.size - _NUMBERS
        for quarter, (u, v) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
            middle = QPointF(0.5 * frame.size + u * (outer + _AWAY), 0.5 * frame.size + v * (outer + _AWAY))
            box = QRectF(middle.x() - 12, middle.y() - 8, 24, 16)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, str(sectors * quarter // 4))
        angle = np.pi / sectors
        painter.setPen(QPen(QColor("black"), 1.2))
        painter.setBrush(QColor("white"))
        painter.drawEllipse(QPointF(*frame.point(np.cos(angle), np.sin(angle))), 4.0, 4.0)
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _paint_message(self, painter: QPainter) -> None:
        size = self.frame.size
        box = QRectF(0.14 * size, 0.2 * size, 0.72 * size, 0.6 * size)
        painter.setPen(QColor("#333333") if self.colours is not None else self.text_colour)
        flags = int(Qt.AlignmentFlag.AlignCenter) | int(Qt.TextFlag.TextWordWrap)
        painter.drawText(box, flags, self.message)


def image_of(pixels: DiskPixels, colours: DiskColours) -> QImage:
    """A picture of the disk's windows or signal, with its ring.

    Parameters
    ----------
    pixels : DiskPixels
    colours : DiskColours
    """
    windows = colours.windows
    if windows is None:
        windows = np.full(pixels.grid.n_windows, np.uint32(0xFFD9D9D9))
    painted = pixels.painted(windows, colours.ring)
    if colours.hatched is not None and colours.windows is not None:
        pixels.hatched(painted, colours.hatched)
    if colours.image is not None:
        _put_onto(painted, colours.image, pixels)
    size = pixels.frame.size
    image = QImage(painted.tobytes(), size, size, 4 * size, QImage.Format.Format_ARGB32_Premultiplied)
    return image.copy()  # with pixels of its own


def _put_onto(painted: AnyArray, image: AnyArray, pixels: DiskPixels) -> None:
    """Put a signal that was mapped onto the disk in the place of the windows."""
    inside = pixels.numbers < pixels.grid.n_windows
    places: FloatArray = (pixels.frame.places_uv[inside] + 1.0) * 0.5 * len(image)
    column, row = np.clip(places.astype(np.intp), 0, len(image) - 1).T
    painted[inside] = image[row, column]


def _cross(x: float, y: float) -> QPainterPath:
    path = QPainterPath(QPointF(x - _CROSS, y))
    path.lineTo(x + _CROSS, y)
    path.moveTo(x, y - _CROSS)
    path.lineTo(x, y + _CROSS)
    return path


def _paint_over(painter: QPainter, path: QPainterPath, colour: QColor) -> None:
    """Paint lines that show on dark and on light."""
    for pen in (QPen(QColor("black"), 3.4), QPen(colour, 1.6)):
        painter.setPen(pen)
        painter.drawPath(path)

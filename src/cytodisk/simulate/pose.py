"""Pose of a simulated cell: how its own frame lies in the image, waist and stretch included."""

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.simulate.flow import NOTHING, Swing


@dataclass(frozen=True, eq=False)
class Pose:
    """Map from the cell's frame (heading +x, centre 0) to the image, invertible in closed form.

    Applied in this order: neck, stretch, bend, turn, shift.

    Attributes
    ----------
    radius : float
        Size of the cell, in pixels.
    heading : float
        At frame 0, in radians from +x towards +y.
    turn : float
        In radians per frame.
    speed : float
        Along the heading, in pixels per frame.
    neck : Swing of one
        Logarithm of how much narrower the middle gets.
    neck_width : float
        Standard deviation of the neck along the cell, in pixels.
    stretch : Swing of two
        Logarithms of the stretch along (and shortening across), and the same at 45°.
    bend : Swing of one
        Shift across of a point one radius ahead or behind, against the middle, in pixels.
    """

    radius: float
    heading: float = 0.0
    turn: float = 0.0
    speed: float = 0.0
    neck: Swing = NOTHING
    neck_width: float = 1.0
    stretch: Swing = NOTHING
    bend: Swing = NOTHING

    def to_image(self, points_yx: FloatArray, frame: float) -> FloatArray:
        """Where points of the cell's frame are in the image.

        Parameters
        ----------
        points_yx : ndarray of shape (N, 2) and dtype float
            (row, column) in pixels from the cell's centre.
        frame : float
            Time in frames.

        Returns
        -------
        ndarray of shape (N, 2) and dtype float
            In pixels from where the centre is in frame 0.
        """
        across, along = points_yx.T
        across = across * np.exp(-self._narrowing(along, frame))
        across, along = self._stretched(across, along, frame, 1.0)
        across = across + self._shift_across(along, frame)
        return np.column_stack([across, along]) @ self._axes(frame) + self._centre(frame)

    def to_cell(self, points_yx: FloatArray, frame: float) -> FloatArray:
        """Inverse of `to_image`.

        Parameters
        ----------
        points_yx : ndarray of shape (N, 2) and dtype float
            (row, column) in pixels from where the centre is in frame 0.
        frame : float
            Time in frames.

        Returns
        -------
        ndarray of shape (N, 2) and dtype float
        """
        across, along = self._axes(frame) @ (points_yx - self._centre(frame)).T
        across = across - self._shift_across(along, frame)
        across, along = self._stretched(across, along, frame, -1.0)
        across = across * np.exp(self._narrowing(along, frame))
        return np.column_stack([across, along])

    def _narrowing(self, along: FloatArray, frame: float) -> FloatArray:
        return np.asarray(self.neck.level(frame).sum() * np.exp(-0.5 * (along / self.neck_width) ** 2))

    def _stretched(
        self, across: FloatArray, along: FloatArray, frame: float, sign: float
    ) -> tuple[FloatArray, FloatArray]:
        """Product with the exponential of a symmetric matrix of trace 0, which keeps areas."""
        if not self.stretch.low.size:
            return across, along
        straight, slanted = sign * self.stretch.level(frame)
        size = np.hypot(straight, slanted)
        even, odd = np.cosh(size), np.sinh(size) / max(size, 1e-12)
        return (
            even * across + odd * (slanted * along - straight * across),
            even * along + odd * (straight * along + slanted * across),
        )

    def _shift_across(self, along: FloatArray, frame: float) -> FloatArray:
        return np.asarray(self.bend.level(frame).sum() * ((along / self.radius) ** 2 - 0.25))

    def _axes(self, frame: float) -> FloatArray:
        """Rows: the unit vectors across and along the cell, (y, x)."""
        angle = self.heading + self.turn * frame
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def _centre(self, frame: float) -> FloatArray:
        """The end of an arc of a circle: its chord points half a turn back."""
        chord = self.speed * frame * np.sinc(self.turn * frame / (2.0 * np.pi))
        middle = self.heading + 0.5 * self.turn * frame
        return np.asarray(chord * np.array([np.sin(middle), np.cos(middle)]))

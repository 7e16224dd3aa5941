"""Beads on the edge of a cell, from frame to frame: to the nearest edge, held apart by line tension."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.windows.springs.closed_springs import relaxed
from cytodisk.windows.springs.layer_borders import Border, one_turn
from cytodisk.windows.springs.spring_sides import way_down

_PER_SECTOR = 4


@dataclass(frozen=True, eq=False)
class EdgeBeads:
    """Beads that slide along the edge of a cell, the same ones in every frame.

    Attributes
    ----------
    border : Border
        The edge.
    places : ndarray of shape (n,) and dtype float
        Distance of each bead along it, not decreasing through one turn. Bead i has the angle 2π i / n.
    """

    border: Border
    places: FloatArray

    @classmethod
    def along(cls, outline_yx: FloatArray, angles: FloatArray, sectors: int) -> EdgeBeads:
        """Beads of a first frame, four a sector, at even angles.

        Parameters
        ----------
        outline_yx : ndarray of shape (B, 2) and dtype float
            Closed polygon, (row, column) in pixels.
        angles : ndarray of shape (B,) and dtype float
            Of its points, in radians, increasing within one turn.
        sectors : int

        Returns
        -------
        EdgeBeads
        """
        border, turn = Border(outline_yx), 2.0 * np.pi
        wanted = turn * np.arange(_PER_SECTOR * sectors) / (_PER_SECTOR * sectors)
        lifted = np.mod(wanted - angles[0], turn)
        places = np.interp(lifted, np.append(angles - angles[0], turn), border.arc)
        return cls(border, one_turn(places, border.length)[:-1])

    def carried(self, outline_yx: FloatArray, line_tension: float) -> EdgeBeads:
        """The beads on the next frame's edge, in the same frame of reference.

        Each goes halfway between the nearest place of the next edge and the one it is nearest to, then
        springs along the edge pull beads apart.

        Parameters
        ----------
        outline_yx : ndarray of shape (B, 2) and dtype float
            Closed polygon, (row, column) in pixels.
        line_tension : float
            Over how many sectors springs even out distances.

        Returns
        -------
        EdgeBeads
        """
        here, there = self.border, Border(outline_yx)
        _, nearest = there.nearest(here.at(self.places)[:, None])
        onwards = one_turn(nearest[:, 0], there.length)[:-1]
        _, back = way_down(self.places, here.feet_of(there), there.arc, here.length)
        backwards = one_turn(np.mod(back, there.length), there.length)[:-1]
        backwards += there.length * np.round((onwards - backwards).mean() / there.length)
        between = 0.5 * (onwards + backwards)
        return EdgeBeads(there, relaxed(between, there.length, (_PER_SECTOR * line_tension) ** 2))

    @property
    def angles(self) -> FloatArray:
        """Angle of each point of the outline in radians, increasing within one turn, shape (B,)."""
        turn = 2.0 * np.pi
        knots = np.append(self.places, self.places[0] + self.border.length)
        within = self.places[0] + np.mod(self.border.arc[:-1] - self.places[0], self.border.length)
        found = np.interp(within, knots, turn * np.linspace(0.0, 1.0, len(knots)))
        steps = np.mod(np.diff(found), turn)
        return np.asarray(found[0] + np.concatenate([[0.0], np.cumsum(steps)]))

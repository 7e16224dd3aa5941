"""`Nucleus`: what a map with a nucleus knows beyond one without."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.nucleus.cone import TURN, rounded
from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.geometry.placed_mask import PlacedMask


@dataclass(frozen=True, eq=False)
class Nucleus:
    """A nucleus on a circle of its own in the disk.

    On a triangle of the cytoplasm the map is linear in the share of the cytoplasm's disk area between a
    place and the membrane, (1 - r²) / (1 - R²), and in the turn, θ / 2π. On one of the nucleus it is linear
    in (u, v) of the nucleus' own unit disk, whose polygon goes to the round disk as `cone` says, and then to
    radius R.

    Attributes
    ----------
    radius : float
        R, of its circle in the disk.
    boundary : ndarray of shape (N,) and dtype int
        Vertices of the nuclear outline in order, from +x towards +y.
    inside : ndarray of shape (F,) and dtype bool
        Whether each triangle lies in the nucleus.
    places : ndarray of shape (V, 2) and dtype float
        (share, turn) of the cytoplasm's vertices and of the nuclear outline, shares 0 at the membrane and 1
        at the outline; (u, v) in the nucleus' own disk of the others.
    lifts : ndarray of shape (F, 3) and dtype int
        Whole turns to add to those of each corner of a triangle of the cytoplasm, so that they fit together.
    placed_mask : PlacedMask
        The nucleus as it was mapped.
    report : NucleusReport
        What fitting it into its cell changed.

    Examples
    --------
    >>> import cytodisk as cd
    >>> cell, nucleus = cd.simulate.disk(20), cd.simulate.disk(8, margin=20)
    >>> disk = cd.map_to_disk(cell, nucleus=nucleus)
    >>> disk.nucleus.radius, disk.nucleus.report.area_px
    (0.5, 197)
    """

    radius: float
    boundary: IntArray
    inside: BoolArray
    places: FloatArray
    lifts: IntArray
    placed_mask: PlacedMask
    report: NucleusReport

    def __getstate__(self) -> dict[str, Any]:
        """What is computed from the fields is not sent to other processes."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def mask(self) -> BoolArray:
        """The nucleus' mask, shape (H, W) and dtype bool; made anew each time."""
        return self.placed_mask.whole

    @cached_property
    def boundary_angles(self) -> FloatArray:
        """Angles of the nuclear outline's vertices in radians, increasing through one turn, shape (N,)."""
        return loop_angles(self.places[self.boundary, 1])

    def corners(self, triangles: IntArray) -> FloatArray:
        """(share, turn) of the corners of the cytoplasm's triangles, shape (cytoplasm's triangles, 3, 2).

        Turns differ within a triangle as the map does: they may be below 0 or above 1.
        """
        found = self.places[triangles[~self.inside]]
        found[..., 1] += self.lifts[~self.inside]
        return found

    @cached_property
    def own_uv(self) -> FloatArray:
        """(u, v) in the nucleus' own disk of its vertices, on the circle those of its outline, shape (V, 2).

        Those of the cytoplasm's vertices have no meaning.
        """
        own = self.places.copy()
        angles = TURN * own[self.boundary, 1]
        own[self.boundary] = np.column_stack([np.cos(angles), np.sin(angles)])
        return own

    def in_disk(self, in_nucleus: BoolArray) -> FloatArray:
        """(u, v) in the whole disk of all vertices, shape (V, 2).

        Parameters
        ----------
        in_nucleus : ndarray of shape (V,) and dtype bool
            Vertices inside the nuclear outline.
        """
        angles, radii = TURN * self.places[:, 1], self.radius_at(self.places[:, 0])
        uv = radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        uv[in_nucleus] = self.radius * rounded(self.places[in_nucleus], self.boundary_angles)
        return np.asarray(uv)

    def radius_at(self, share: FloatArray) -> FloatArray:
        """Radius in the disk of places in the cytoplasm; it is R at share 1."""
        square = self.radius**2
        return np.asarray(np.sqrt(np.maximum(1.0 - (1.0 - square) * share, square)))

    def share_at(self, radius: FloatArray) -> FloatArray:
        """Share of the cytoplasm's disk area outside a radius of R or more, 0 to 1."""
        square = self.radius**2
        return np.asarray(np.clip((1.0 - np.square(radius)) / (1.0 - square), 0.0, 1.0))

    def placed(self, corner: tuple[int, int], image_shape: tuple[int, int]) -> Nucleus:
        """The same in the image that its mask was cut out of, as `DiskMap.placed`."""
        return replace(self, placed_mask=self.placed_mask.within(corner, image_shape))


def loop_angles(turns: FloatArray) -> FloatArray:
    """Angles in radians along a loop, from turns that leave whole ones open: increasing through one turn."""
    steps = np.mod(np.diff(turns), 1.0)
    return np.asarray(TURN * (turns[0] + np.append(0.0, np.cumsum(steps))))

"""Displacement fields from the frames of a movie to one reference frame, by demons on the masks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.motion.demons import displacement_between, raster_of
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.nonrigid.nonrigid_parameters import NonrigidParameters
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.snake import sample_field
from cytodisk.taking import takes

_MARGIN_PX = 10


@dataclass(frozen=True, eq=False)
class ReferenceField:
    """Where each place of a frame was in the reference frame.

    Attributes
    ----------
    frame : int
    displacement : ndarray of shape (2, H, W) and dtype float
        To the reference, (row, column) in pixels, on a grid in the movie's common frame.
    corner : ndarray of shape (2,) and dtype float
        Of the first pixel of the grid, (row, column) in the common frame.
    transform, reference : RigidTransform
        From the image's frame to the common one, in this frame and in the reference frame.
    masks : ndarray of shape (2, H, W) and dtype bool
        The cell in this frame and in the reference frame, on the grid.
    """

    frame: int
    displacement: FloatArray
    corner: FloatArray
    transform: RigidTransform
    reference: RigidTransform
    masks: BoolArray

    def to_reference(self, points_yx: FloatArray) -> FloatArray:
        """Places in the image of the reference frame.

        Parameters
        ----------
        points_yx : ndarray of shape (..., 2) and dtype float
            In the image of this frame, (row, column) in pixels.

        Returns
        -------
        ndarray of the same shape
            Beyond the grid the displacement is that of its rim.
        """
        common = self.transform(points_yx)
        flat = common.reshape(-1, 2) - self.corner
        moved = np.column_stack([sample_field(part, flat) for part in self.displacement])
        return self.reference.inverse(common + moved.reshape(common.shape))

    @cached_property
    def turned_over(self) -> BoolArray:
        """Whether the field folds at each pixel of the grid: neighbours change places; shape (H, W)."""
        (yy, yx), (xy, xx) = (np.gradient(part) for part in self.displacement)
        return np.asarray((1.0 + yy) * (1.0 + xx) - yx * xy <= 0.0)

    @property
    def folded(self) -> float:
        """Share of the cell's pixels at which the field folds, 0 to 1."""
        return float(self.turned_over[self.masks[0]].mean())

    @property
    def outside(self) -> float:
        """Share of what the field carries from the reference cell that lies outside of the cell here."""
        carried = self._carried
        return float((carried & ~self.masks[0]).sum() / max(int(carried.sum()), 1))

    @cached_property
    def _carried(self) -> BoolArray:
        """Pixels of the grid that come from inside the reference cell."""
        shape = self.masks.shape[1:]
        places = np.argwhere(np.ones(shape, dtype=bool)) + self.displacement.reshape(2, -1).T
        return (sample_field(self.masks[1].astype(np.float64), places) >= 0.5).reshape(shape)


@takes(NonrigidParameters)
def fields_to_reference(movie: DiskMovie, **settings: object) -> Iterator[ReferenceField]:
    """Register each frame of a movie to its first one: what the paper calls nonrigid image registration.

    Rigid motion is taken out first, as for tracking. Masks are registered, not images.

    Parameters
    ----------
    movie : DiskMovie
        Its outlines and their rigid motion are used, not its maps.
    **settings
        See `NonrigidParameters`.

    Yields
    ------
    ReferenceField
        One a frame with a cell, in their order; the first is at rest.

    Raises
    ------
    MissingPartError
        SimpleITK is not installed.

    References
    ----------
    u-Unwrap, section 2 and appendix A.1. Thirion 1998, Image matching as a diffusion process,
    doi:10.1016/S1361-8415(98)80022-4.
    """
    chosen = NonrigidParameters.of(**settings)
    found = {
        frame: record.boundary for frame, record in enumerate(movie.records) if record.boundary is not None
    }
    outlines = {frame: one.transform(one.contour.outline_yx) for frame, one in found.items()}
    corner, shape = _grid(list(outlines.values()))
    first = min(found)
    reference = raster_of(outlines[first], corner, shape)
    field = np.zeros((2, *shape))
    for frame, boundary in found.items():
        mask = raster_of(outlines[frame], corner, shape)
        if frame != first:
            start = field if chosen.warm_start else None
            field = displacement_between(mask, reference, chosen.iterations, chosen.sigma, start)
        masks = np.stack([mask, reference])
        yield ReferenceField(frame, field, corner, boundary.transform, found[first].transform, masks)


def _grid(outlines: list[FloatArray]) -> tuple[FloatArray, tuple[int, int]]:
    """First pixel and shape of a grid that holds all outlines, with a margin."""
    low = np.min([one.min(axis=0) for one in outlines], axis=0)
    high = np.max([one.max(axis=0) for one in outlines], axis=0)
    corner = np.floor(low) - _MARGIN_PX
    rows, columns = (np.ceil(high) + _MARGIN_PX - corner).astype(int) + 1
    return corner, (int(rows), int(columns))

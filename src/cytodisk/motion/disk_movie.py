"""`DiskMovie`: the disk maps of a movie, in correspondence through time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import MapError, ParameterError
from cytodisk.geometry.outline import on_border
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.tracking import TrackedBoundary, point_angles
from cytodisk.scale import Scale

_NUCLEUS_POINTS = 256


@dataclass(frozen=True, eq=False)
class FrameRecord:
    """What became of one frame.

    Attributes
    ----------
    status : str
        "ok", "refused" (the mask cannot be used), "missing" (the label is not there) or "unreadable".
    reason : str
        Why there is no map; empty if there is one.
    load_boundary : callable or None
        Gives the tracked boundary; None if there is none.
    nucleus_held : str
        Why the nucleus is that of the frame before, moved with the cell; empty if it is the frame's own.
    """

    status: str
    reason: str
    load_boundary: Callable[[], TrackedBoundary] | None
    nucleus_held: str = ""

    @property
    def has_map(self) -> bool:
        """Whether the frame was mapped."""
        return self.load_boundary is not None

    @cached_property
    def boundary(self) -> TrackedBoundary | None:
        """Tracked boundary, None without a map; read when first asked for."""
        return None if self.load_boundary is None else self.load_boundary()


@dataclass(frozen=True, eq=False)
class DiskMovie(Sequence[DiskMap]):
    """Maps of one cell through time: a point of the disk corresponds to one place of the cell in every frame.

    On the edge that is tracked. Inside it is an assumption, which `interior` of `map_movie` chooses.

    `movie[t]` is the `DiskMap` of frame t, read when asked for; a frame without one raises `MapError` with
    the reason.

    Attributes
    ----------
    records : tuple of FrameRecord
        One a frame.
    image_shape : (int, int)
        (H, W) of the masks.
    scale : Scale
        µm per pixel and seconds per frame; where unknown, results are in px and frames.
    load : callable
        Gives the map of a frame that has one.

    Examples
    --------
    >>> import cytodisk as cd
    >>> movie = cd.map_movie(cd.simulate.movie("growing", frames=3, radius_px=12.0).masks)
    >>> movie.status, movie[2].certificate.valid
    (['ok', 'ok', 'ok'], True)
    >>> same_place = [disk.to_cell([[0.5, 0.0]]) for disk in movie]  # a point of the disk in every frame
    """

    records: tuple[FrameRecord, ...]
    image_shape: tuple[int, int]
    scale: Scale
    load: Callable[[int], DiskMap]

    def __repr__(self) -> str:
        mapped = int(self.mapped.sum())
        return f"<DiskMovie: {mapped} of {len(self)} frames mapped, {self.n_points} boundary points>"

    def __len__(self) -> int:
        return len(self.records)

    @overload
    def __getitem__(self, frame: int) -> DiskMap: ...
    @overload
    def __getitem__(self, frame: slice) -> list[DiskMap]: ...
    def __getitem__(self, frame: int | slice) -> DiskMap | list[DiskMap]:
        """Map of a frame, or a list of maps; negative numbers count from the end."""
        if isinstance(frame, slice):
            return [self[number] for number in range(*frame.indices(len(self)))]
        if not isinstance(frame, int | np.integer):
            raise ParameterError(f"a movie is indexed by frame number, got {frame!r}")
        number = int(frame) + (len(self) if frame < 0 else 0)
        if not 0 <= number < len(self):
            raise IndexError(f"frame {frame} of a movie of {len(self)} frames")
        record = self.records[number]
        if not record.has_map:
            raise MapError(f"frame {number} has no map: {record.reason}")
        return self.load(number)

    @property
    def status(self) -> list[str]:
        """Status of each frame."""
        return [record.status for record in self.records]

    @property
    def mapped(self) -> BoolArray:
        """Whether each frame has a map, shape (T,)."""
        return np.array([record.has_map for record in self.records])

    @property
    def n_points(self) -> int:
        """Tracked boundary points a frame; 0 if no frame has a map."""
        return next((len(found.s) for found in self._boundaries if found is not None), 0)

    @property
    def point_angles(self) -> FloatArray:
        """Angle of each tracked point on the disk, in radians, the same in every frame, shape (N,)."""
        return point_angles(self.n_points)

    @cached_property
    def points_yx(self) -> FloatArray:
        """Tracked boundary points in the image, shape (T, N, 2), (row, column) in pixels; NaN without map."""
        return self._by_frame((self.n_points, 2), lambda found: found.points_yx)

    @cached_property
    def normals_yx(self) -> FloatArray:
        """Outward unit normals at the tracked points, in the image, shape (T, N, 2)."""
        return self._by_frame((self.n_points, 2), lambda found: found.normals_yx)

    @cached_property
    def lengths_px(self) -> FloatArray:
        """Boundary length that belongs to each tracked point, in pixels, shape (T, N)."""
        return self._by_frame((self.n_points,), lambda found: found.lengths_px)

    @cached_property
    def residual_px(self) -> FloatArray:
        """Tracking residual of each frame in pixels, shape (T,); see `TrackedBoundary`."""
        return self._by_frame((), lambda found: np.array(found.residual_px))

    @property
    def nucleus_held(self) -> list[str]:
        """By frame, why the nucleus is that of the frame before, moved with the cell; empty if it is not."""
        return [record.nucleus_held for record in self.records]

    @cached_property
    def nucleus_points_yx(self) -> FloatArray:
        """Points of the nuclear outline in the image, at even angles, the same in every frame.

        Shape (T, 256, 2), (row, column) in pixels; NaN in frames without a map or without a nucleus.
        """
        angles = point_angles(_NUCLEUS_POINTS)
        circle = np.column_stack([np.cos(angles), np.sin(angles)])
        out = np.full((len(self), *circle.shape), np.nan)
        for frame in np.flatnonzero(self.mapped):
            disk = self[int(frame)]
            if disk.nucleus is not None:
                out[frame] = disk.to_cell(disk.nucleus.radius * circle)
        return out

    @property
    def transforms(self) -> list[RigidTransform | None]:
        """From each frame to the movie's common frame, that of its first map; None without map."""
        return [None if found is None else found.transform for found in self._boundaries]

    @property
    def on_border(self) -> BoolArray:
        """Whether each tracked point lies on the image's border, shape (T, N)."""
        points = self._by_frame((self.n_points, 2), lambda found: found.outline_points_yx)
        return np.stack([on_border(frame, self.image_shape) for frame in points])

    def registered(self, points_yx: FloatArray) -> FloatArray:
        """Points of all frames in the movie's common frame: rigid motion taken out.

        Parameters
        ----------
        points_yx : ndarray of shape (T, ..., 2) and dtype float
            In the image, (row, column) in pixels.

        Returns
        -------
        ndarray of the same shape
            NaN for frames without a map.
        """
        moved = np.full_like(points_yx, np.nan)
        for frame, transform in enumerate(self.transforms):
            if transform is not None:
                moved[frame] = transform(points_yx[frame])
        return moved

    @property
    def _boundaries(self) -> list[TrackedBoundary | None]:
        return [record.boundary for record in self.records]

    def _by_frame(self, shape: tuple[int, ...], value: Callable[[TrackedBoundary], FloatArray]) -> FloatArray:
        out = np.full((len(self), *shape), np.nan)
        for frame, found in enumerate(self._boundaries):
            if found is not None:
                out[frame] = value(found)
        return out

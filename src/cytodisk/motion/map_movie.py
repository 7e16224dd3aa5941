"""`map_movie`: from masks to maps that correspond through time."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.loading import load_map
from cytodisk.errors import CytodiskError, MaskError, StudyError
from cytodisk.files import make_folder
from cytodisk.motion.disk_movie import DiskMovie, FrameRecord
from cytodisk.motion.following import map_frames
from cytodisk.motion.nucleus.movie_nuclei import CellsWithNuclei, check_settings, parse_nuclei
from cytodisk.motion.still_interior import fade_in_px
from cytodisk.motion.tracking_parameters import MovieMapParameters
from cytodisk.scale import Scale
from cytodisk.taking import takes

_KEPT = 4  # maps that a movie on disk keeps in memory


@takes(MovieMapParameters)
def map_movie(
    masks: Any,
    *,
    nuclei: Any = None,
    folder: str | os.PathLike[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> DiskMovie:
    """Map every frame of a movie of one cell onto the disk, in correspondence through time.

    The boundary is tracked from frame to frame, so that each place of the edge keeps its angle on the disk;
    the inside starts from where the last frame put it. What the inside did meanwhile, a mask does not show:
    with `interior="area"` each place keeps its share of the area on the way from the edge, with "still" it
    keeps its position in the lab. A frame that cannot be mapped (empty, damaged) is a
    gap with a reason, and the movie goes on after it.

    Parameters
    ----------
    masks : array_like of shape (T, H, W), DataArray with dims (time, y, x), or sequence of (H, W) arrays
        Masks of one cell. A sequence may read its frames when asked for them.
    nuclei : array_like of shape (T, H, W), DataArray or sequence of (H, W) arrays, optional
        The nucleus of the cell in each frame, as many as masks. Its outline is followed as the edge is, so
        that each place of it keeps its angle, too; one that turns in the cell turns its own part of
        the disk alone. A frame without one is a gap, or has that of the frame before (`missing`).
    folder : path-like, optional
        Write the maps there and read them when asked for, so that memory stays bounded; by default they
        stay in memory.
    progress : callable, optional
        Called with (frames done, frames in all).
    **settings
        See `MovieMapParameters`; `align` holds for the first frame; `nucleus_radius`, `several` and `missing`
        count with nuclei alone.

    Returns
    -------
    DiskMovie

    Raises
    ------
    MaskError
        `masks` is not a movie, or no frame of it can be mapped.
    NucleusError
        `nuclei` do not go with the masks.
    ParameterError
        A parameter is out of its range.
    StudyError
        The folder cannot be written, or holds maps already.

    See Also
    --------
    map_to_disk : One cell, or one frame.
    sample_movie : The signal in the windows of each frame.
    edge_velocity : How the edge moves.

    References
    ----------
    u-Unwrap, section 3 (i), appendix A.1 and A.2.2.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("bulging", frames=4, radius_px=15.0)
    >>> movie = cd.map_movie(truth.masks, pixel_size_um=0.16, frame_interval_s=5.0)
    >>> len(movie), all(disk.certificate.valid for disk in movie)
    (4, True)

    With the nuclei, of which one is missing:

    >>> truth = cd.simulate.movie_with_nuclei("bulging", frames=4, radius_px=15.0, nucleus_missing=0.25)
    >>> movie = cd.map_movie(truth.masks, nuclei=truth.nuclei, missing="hold")
    >>> movie.status, [bool(words) for words in movie.nucleus_held]
    (['ok', 'ok', 'ok', 'ok'], [False, True, False, False])
    """
    given = MovieMapParameters.of(**settings)
    scale = Scale.of(masks).given(given.pixel_size_um, given.frame_interval_s)
    fade_in_px(given, scale)
    check_settings(nuclei is not None, given)
    frames = parse_masks(masks)
    if nuclei is not None:
        frames = CellsWithNuclei(frames, parse_nuclei(nuclei, frames))
    store: _Memory | _Folder = _Memory() if folder is None else _Folder(Path(folder))
    records: list[FrameRecord] = []
    shape: tuple[int, ...] = ()
    for result in map_frames(frames, given, scale):
        if result.mapped is not None:
            found = result.mapped.disk.placed_mask.image_shape
            _check_shape(found, shape, result.frame)
            shape = found
            store.keep(result.frame, result.mapped.disk)
        records.append(result.record)
        if progress is not None:
            progress(len(records), len(frames))
    if not shape:
        raise MaskError(f"no frame of {len(records)} could be mapped; frame 0: {records[0].reason}")
    return DiskMovie(tuple(records), (shape[0], shape[1]), scale, store.load)


def _check_shape(found: tuple[int, ...], before: tuple[int, ...], frame: int) -> None:
    if before and found != before:
        raise MaskError(
            f"frame {frame} of masks has shape {found}, those before {before}: crop the frames alike"
        )


def parse_masks(masks: Any) -> Any:
    """A sequence of frames, from whatever a user has.

    Parameters
    ----------
    masks : array_like, DataArray or sequence
        See `map_movie`.

    Returns
    -------
    sequence of array_like of shape (H, W)

    Raises
    ------
    MaskError
        It has not three dimensions or a single frame, or its frames differ in shape.
    """
    if isinstance(masks, xr.DataArray):
        if set(masks.dims) != {"time", "y", "x"}:
            raise MaskError(f"masks have the dims {list(masks.dims)}: a movie of one cell has time, y, x")
        masks = masks.transpose("time", "y", "x")
    if not (hasattr(masks, "__getitem__") and hasattr(masks, "__len__")):
        raise MaskError(
            f"masks must be an array (T, H, W) or a sequence of frames, got {type(masks).__name__}"
        )
    if hasattr(masks, "ndim") and masks.ndim != 3:
        raise MaskError(
            f"masks have shape {tuple(masks.shape)}: a movie of one cell is (time, y, x); "
            "for one frame use map_to_disk"
        )
    if len(masks) < 2:
        raise MaskError(f"masks hold {len(masks)} frame: a movie has two at least; for one use map_to_disk")
    if isinstance(masks, list | tuple):
        shapes = {np.shape(mask) for mask in masks if not isinstance(mask, CytodiskError)}
        if len(shapes) > 1:
            raise MaskError(f"masks differ in shape ({sorted(shapes)}): crop the frames alike")
    if hasattr(masks, "shape"):
        frames, height, width = masks.shape
        if width < frames / 4 and width < height / 4:
            raise MaskError(
                f"masks of shape {tuple(masks.shape)} were understood as {frames} frames of {height} × "
                f"{width} pixels, which looks like time on the last axis: pass numpy.moveaxis(masks, -1, 0)"
            )
    return masks.to_numpy() if isinstance(masks, xr.DataArray) else masks


class _Memory:
    """Maps of a movie in memory."""

    def __init__(self) -> None:
        self._maps: dict[int, DiskMap] = {}

    def keep(self, frame: int, disk: DiskMap) -> None:
        self._maps[frame] = disk

    def load(self, frame: int) -> DiskMap:
        return self._maps[frame]


class _Folder:
    """Maps of a movie on disk, the last used ones in memory."""

    def __init__(self, folder: Path) -> None:
        try:
            make_folder(folder)
            taken = any(folder.glob("frame_*.npz"))
        except OSError as error:
            raise StudyError(f"folder {folder} cannot be written: {error.strerror}") from error
        if taken:
            raise StudyError(f"folder {folder} holds maps already: pass another folder")
        self._folder = folder
        self.load = lru_cache(maxsize=_KEPT)(self._read)

    def keep(self, frame: int, disk: DiskMap) -> None:
        disk.save(self._path(frame))

    def _read(self, frame: int) -> DiskMap:
        return load_map(self._path(frame))

    def _path(self, frame: int) -> Path:
        return self._folder / f"frame_{frame:05d}.npz"

"""`geometry_controls`: what each window would hold if the cell only moved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import xarray as xr
from scipy import sparse

from cytodisk.analysis.activity import Grid
from cytodisk.analysis.controls.depth_profile import DepthProfile
from cytodisk.analysis.controls.held_places import HeldPlaces
from cytodisk.analysis.controls.lab_mean import LabMean
from cytodisk.analysis.controls.slow_level import brightness, slow_level
from cytodisk.analysis.signal_frames import parse_signals
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import instance_of, whole_number
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.windows.layer_coords import layer_coords

LAB, DEPTH_PROFILE = "lab", "depth_profile"

Levels: TypeAlias = dict[int, FloatArray]
"""Level of each frame by channel, shape (C, 1, 1)."""

_LEAST_SHARE = 0.8  # of a window that must have a value in the lab


def geometry_controls(
    movie: DiskMovie,
    grid: Grid,
    signal: Any,
    max_lag: int,
    *,
    frames: Sequence[int] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> xr.Dataset:
    """Sample two images made from the movie itself: its mean in the lab, and its mean by depth.

    A cell that moves over a still pattern, or a cortex that moves with the edge, makes signal and edge
    velocity correlate without any signalling. These two controls change with the motion alone.

    Parameters
    ----------
    movie : DiskMovie
    grid : PolarGrid, EdgeGrid or RingGrid
        The windows of the signal.
    signal : array_like of shape (T, H, W) or (T, C, H, W), DataArray or sequence
        As for `sample_movie`.
    max_lag : int
        Largest lag that will be looked at, in frames: so many before and after a frame are left out of its
        mean in the lab.
    frames : sequence of int, optional
        Frames that are used, by their place in the movie; by default all that have a map.
    progress : callable, optional
        Called with (steps done, in all); a frame has five steps.

    Returns
    -------
    Dataset with dims (time, channel, layer, sector), without channel if the signal has none
        lab, the mean over time at each place of the image, over the frames in which the cell holds it;
        depth_profile, the mean over the whole movie at each depth below the edge. Both are sampled as a
        signal is, by the same windows and weights. lab is NaN where frames further away than `max_lag` hold
        less than 80 % of the window, each place three times at least.

    Raises
    ------
    SignalError
        The signal does not fit the movie.
    ParameterError
        `movie` is no DiskMovie, `grid` no grid, `max_lag` no whole number, or none of `frames` has a map.

    See Also
    --------
    without_controls : Takes them out of a signal.
    cross_correlate : Correlates what is left with the motion of the edge.

    Notes
    -----
    Both means fade with the movie: each frame counts divided by its level, a parabola in time through how
    bright it is against the mean at the same places or depths, and the control is multiplied by it again.
    Without that a still pattern that bleaches would not be explained by its mean.

    Images are read one at a time, each five times; what stays in memory is a sum over time of the part of
    the image that the cell holds. The cell's own signal of neighbouring frames is left out of the lab mean,
    because with it the control would follow the signal.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("fluctuating", frames=40, radius_px=14)
    >>> movie, grid = cd.map_movie(truth.masks), cd.polar_windows(layers=2, sectors=6)
    >>> signal = truth.signal.sel(channel="edge")
    >>> controls = cd.geometry_controls(movie, grid, signal, max_lag=5)
    >>> left = cd.without_controls(cd.sample_movie(movie, grid, signal)["mean"].isel(channel=0), controls)
    >>> dict(left.sizes)
    {'time': 40, 'layer': 2, 'sector': 6}
    """
    instance_of("movie", movie, DiskMovie, "a DiskMovie, as map_movie returns it")
    instance_of("grid", grid, Grid, "a PolarGrid, EdgeGrid or RingGrid")
    lag = whole_number("max_lag", max_lag, 0)
    known = parse_signals(signal, len(movie), movie.image_shape)
    wanted = range(len(movie)) if frames is None else sorted(set(frames))
    used = [int(frame) for frame in wanted if 0 <= frame < len(movie) and movie.mapped[frame]]
    if not used:
        raise ParameterError(f"frames: none of {len(wanted)} has a map")
    steps = _Steps(progress, 5 * len(used))
    holes: dict[int, IntArray] = {}
    places = HeldPlaces.of(steps.over((frame, _mask(movie[frame], frame, holes)) for frame in used))

    def image(frame: int) -> FloatArray:
        cut = places.cut(known.image(frame))
        if frame in holes:
            row, column = (holes[frame] - places.corner).T
            cut[:, row, column] = np.nan
        return cut

    run = _Sampling(movie, grid, places, image, len(known.channels))
    tables = run.tables(used, lag, steps)
    dims = ("time", "channel", "layer", "sector")
    coords: dict[str, Any] = {"channel": known.channels}
    coords |= layer_coords(grid) | {"sector": np.arange(grid.sectors)}
    coords |= movie.scale.time_coords(np.arange(len(movie)))
    data = {name: (dims, table, {"units": "a.u."}) for name, table in tables.items()}
    attrs = movie.scale.attrs | {"max_lag": lag}
    found = xr.Dataset(data, coords, attrs).set_xindex("frame")
    return found if known.channel_names is not None else found.isel(channel=0, drop=True)


def _mask(disk: DiskMap, frame: int, holes: dict[int, IntArray]) -> BoolArray:
    """Mask of a frame; the pixels of its excluded holes are noted."""
    if disk.holes is not None:
        holes[frame] = disk.holes.pixels_yx
    return disk.mask


class _Steps:
    """Counts what is done."""

    def __init__(self, progress: Callable[[int, int], None] | None, total: int):
        self._progress, self._total, self._done = progress, total, 0

    def over(self, items: Any) -> Any:
        """The items, counted one by one."""
        for item in items:
            yield item
            self._done += 1
            if self._progress is not None:
                self._progress(self._done, self._total)


@dataclass(frozen=True, eq=False)
class _Sampling:
    """Windows laid on the controls of a movie, frame by frame."""

    movie: DiskMovie
    grid: Grid
    places: HeldPlaces
    image: Callable[[int], FloatArray]
    channels: int

    def tables(self, used: list[int], lag: int, steps: _Steps) -> dict[str, FloatArray]:
        """Both controls, shape (T, C, L, S) each."""
        places, image = self.places, self.image
        shape = len(self.movie), self.channels, self.grid.layers, self.grid.sectors
        lab, depth = np.full((2, *shape), np.nan)
        in_lab, by_depth = self._levels(used, lag, steps)
        mean, profile = self._sums(used, in_lab, by_depth, steps)
        there = set(used)

        def change(frame: int, how: Callable[[FloatArray, BoolArray], None]) -> None:
            if frame in there:
                how(image(frame) / in_lab[frame], places.mask(frame))

        for frame in range(used[0], used[0] + lag):
            change(frame, mean.remove)
        last = used[0] - 1
        for frame in steps.over(used):
            for step in range(last + 1, frame + 1):
                change(step + lag, mean.remove)
                change(step - lag - 1, mean.add)
            last = frame
            mask, weights = places.mask(frame), self.grid.on(self.movie[frame]).weights
            held = mean.at(mask) * in_lab[frame][..., 0], profile.at(mask) * by_depth[frame][..., 0]
            lab[frame] = _in_windows(weights, held[0], _LEAST_SHARE).reshape(shape[1:])
            depth[frame] = _in_windows(weights, held[1], 0.0).reshape(shape[1:])
        return {LAB: lab, DEPTH_PROFILE: depth}

    def _sums(
        self, used: list[int], in_lab: Levels, by_depth: Levels, steps: _Steps
    ) -> tuple[LabMean, DepthProfile]:
        """Both sums over all frames, each frame divided by its level."""
        mean = LabMean(self.channels, self.places.shape)
        profile = DepthProfile(self.channels, max(self.places.shape))
        for frame in steps.over(used):
            pixels, mask = self.image(frame), self.places.mask(frame)
            mean.add(pixels / in_lab[frame], mask)
            profile.add(pixels / by_depth[frame], mask)
        return mean, profile

    def _levels(self, used: list[int], lag: int, steps: _Steps) -> tuple[Levels, Levels]:
        """How bright each frame is against either mean, slow changes alone."""
        even: Levels = dict.fromkeys(used, np.ones((self.channels, 1, 1)))
        mean, profile = self._sums(used, even, even, steps)
        ratios = np.empty((len(used), 2, self.channels))
        for place, frame in enumerate(steps.over(used)):
            mask = self.places.mask(frame)
            pixels = self.image(frame)[:, mask]
            ratios[place] = brightness(pixels, mean.at(mask)), brightness(pixels, profile.at(mask))
        found = (slow_level(np.array(used), ratios[:, which], lag) for which in (0, 1))
        in_lab, by_depth = (dict(zip(used, level[..., None, None], strict=True)) for level in found)
        return in_lab, by_depth


def _in_windows(weights: sparse.csr_array, pixels: FloatArray, least_share: float) -> FloatArray:
    """Mean of the known pixels (C, P) in each window, shape (C, windows); NaN where too few are known."""
    known = np.isfinite(pixels)
    area = np.asarray(weights.sum(axis=1)).ravel()
    held = np.asarray(weights @ known.T.astype(np.float64)).T
    total = np.asarray(weights @ np.where(known, pixels, 0.0).T).T
    enough = (held > 0) & (held >= least_share * area)
    return np.where(enough, total / np.where(held > 0, held, 1.0), np.nan)

"""Activity of a movie: a signal in every window of every frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
import xarray as xr

from cytodisk.analysis.signal_frames import parse_signals
from cytodisk.arrays import FloatArray
from cytodisk.checks import instance_of
from cytodisk.disk.disk_map import DiskMap
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.scale import Scale
from cytodisk.taking import takes
from cytodisk.windows.depths import DEPTHS, NUCLEUS_DISTANCES
from cytodisk.windows.grid_parameters import SampleParameters
from cytodisk.windows.layer_coords import layer_coords
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.sample import sample, sampled_pixels

GEOMETRY = ("area", "centroid_y", "centroid_x", *DEPTHS)
DISTANCES = (*DEPTHS, *NUCLEUS_DISTANCES)
STATISTICS = ("mean", "sd", "min", "max", "n_pixels", "n_nan")


@runtime_checkable
class Grid(Protocol):
    """What `sample_movie` needs of a grid: `PolarGrid`, `EdgeGrid` or `RingGrid`."""

    @property
    def layers(self) -> int: ...
    @property
    def sectors(self) -> int: ...
    def on(self, disk: DiskMap, /) -> WindowsOnCell: ...


@takes(SampleParameters)
def sample_movie(
    movie: DiskMovie,
    grid: Grid,
    signals: Any,
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Statistics of a signal in every window of every frame, frame by frame.

    Parameters
    ----------
    movie : DiskMovie
    grid : PolarGrid, EdgeGrid or RingGrid
        A window that is empty in a frame has n_pixels 0 and is NaN there.
    signals : array_like of shape (T, H, W) or (T, C, H, W), DataArray or sequence
        As many frames as the movie; a DataArray has the dims time, (channel,) y, x. A sequence may read its
        frames, (H, W) or (C, H, W), when asked for them.
    progress : callable, optional
        Called with (frames done, frames in all).
    **settings
        See `SampleParameters`.

    Returns
    -------
    Dataset with dims (time, channel, layer, sector)
        mean, sd, min, max, n_pixels, n_nan as for `sample`; area and depth of the windows (depth, depth_p5,
        depth_p95: their distance to the cell's edge) and status, reason by frame; with layers of a nucleus
        nucleus_distance, …_p5 and …_p95, and the coordinate compartment;
        centroid_y and centroid_x of the windows as coordinates, which go with any of the others. A frame
        without a map is NaN with its reason. The coordinate time_s is
        there when the frame interval is known; units are in the attrs of each variable.

    Raises
    ------
    SignalError
        The signals do not fit the movie, or two channels have one name.
    ParameterError
        `movie` is no DiskMovie, `grid` no grid, or `nan` is unknown.

    See Also
    --------
    sample : One frame, or one cell.
    edge_velocity : The motion of the edge by the same frames and sectors.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=3, radius_px=15.0)
    >>> movie = cd.map_movie(truth.masks)
    >>> activity = cd.sample_movie(movie, cd.polar_windows(layers=2, sectors=6), truth.signal)
    >>> dict(activity["mean"].sizes)
    {'time': 3, 'channel': 2, 'layer': 2, 'sector': 6}
    """
    how = dict(SampleParameters.of(**settings))
    order = "the order is sample_movie(movie, grid, signals)"
    instance_of("movie", movie, DiskMovie, "a DiskMovie, as map_movie returns it", order)
    instance_of("grid", grid, Grid, "a PolarGrid, EdgeGrid or RingGrid", order)
    known = parse_signals(signals, len(movie), movie.image_shape)
    tables = ActivityTables(len(movie), known.channels, grid)
    for sampled in sample_frames(movie, grid, known.image, progress=progress, **how):
        tables.put(sampled.frame, sampled.arrays)
    return tables.dataset(movie)


@dataclass(frozen=True, eq=False)
class SampledFrame:
    """One frame of a movie with its windows and what was measured in them.

    Attributes
    ----------
    frame : int
        Its place in the movie, from 0.
    disk : DiskMap
    windows : WindowsOnCell
    arrays : dict of str to ndarray
        See `window_arrays`.
    """

    frame: int
    disk: DiskMap
    windows: WindowsOnCell
    arrays: dict[str, FloatArray]


def sample_frames(
    movie: DiskMovie,
    grid: Grid,
    image: Callable[[int], Any],
    *,
    progress: Callable[[int, int], None] | None = None,
    **settings: Any,
) -> Iterator[SampledFrame]:
    """Lay windows on the mapped frames of a movie and sample a signal, one frame in memory at a time.

    Parameters
    ----------
    movie : DiskMovie
    grid : PolarGrid, EdgeGrid or RingGrid
    image : callable
        Gives the image of a frame, as `window_arrays` takes it, by the frame's place in the movie.
    progress : callable, optional
        Called with (frames done, frames in all); frames without a map count.
    **settings
        As for `sample`.

    Yields
    ------
    SampledFrame
    """
    for frame, has_map in enumerate(movie.mapped):
        if has_map:
            disk = movie[frame]
            windows = grid.on(disk)
            yield SampledFrame(frame, disk, windows, window_arrays(windows, image(frame), **settings))
        if progress is not None:
            progress(frame + 1, len(movie))


def window_arrays(windows: WindowsOnCell, image: Any, **settings: Any) -> dict[str, FloatArray]:
    """What is known of the windows of one frame: the one step that all activity comes from.

    Parameters
    ----------
    windows : WindowsOnCell
    image : array_like of shape (C, H, W), DataArray with dims (channel, y, x), or None
        Without an image there are no statistics.
    **settings
        As for `sample`.

    Returns
    -------
    dict of str to ndarray
        Statistics of shape (C, L, S); of shape (L, S) area in square pixels, and centroid_y, centroid_x,
        depth, depth_p5 and depth_p95 in pixels, and with a nucleus nucleus_distance, …_p5 and …_p95.
    """
    if image is None:
        return pixel_arrays(windows, None)
    data = sample(windows, image, **settings)
    return {name: data[name].to_numpy() for name in STATISTICS} | pixel_arrays(windows, None)


def pixel_arrays(
    windows: WindowsOnCell, pixels: FloatArray | None, nan: str = "propagate"
) -> dict[str, FloatArray]:
    """As `window_arrays`, from the values of the cell's pixels alone.

    Parameters
    ----------
    windows : WindowsOnCell
    pixels : ndarray of shape (C, P) and dtype float, or None
        Of each pixel of the mask, in row-major order.
    nan : {"propagate", "omit"}
    """
    arrays = {"area": windows.areas} | windows.depth_columns
    arrays["centroid_y"], arrays["centroid_x"] = np.moveaxis(windows.centroids_yx, -1, 0)
    return arrays if pixels is None else sampled_pixels(windows, pixels, nan=nan) | arrays


def geometry_of(grid: Grid) -> tuple[str, ...]:
    """Names of what is known of the windows of a grid without a signal."""
    return (*GEOMETRY, *NUCLEUS_DISTANCES) if "compartment" in layer_coords(grid) else GEOMETRY


class ActivityTables:
    """Arrays of the windows of a movie, filled frame by frame; NaN where there is nothing.

    Parameters
    ----------
    n_frames : int
    channels : list of str
    grid : Grid
    statistics : sequence of str
        Which of them are kept.
    """

    def __init__(
        self, n_frames: int, channels: list[str], grid: Grid, statistics: Sequence[str] = STATISTICS
    ):
        shape = n_frames, grid.layers, grid.sectors
        self.channels = channels
        self._coords = layer_coords(grid)
        self.tables = {name: np.full((n_frames, len(channels), *shape[1:]), np.nan) for name in statistics}
        self.tables |= {name: np.full(shape, np.nan) for name in geometry_of(grid)}

    def put(self, frame: int, arrays: dict[str, FloatArray]) -> None:
        """Keep the arrays of a frame, as `window_arrays` returns them."""
        for name in self.tables.keys() & arrays.keys():
            self.tables[name][frame] = arrays[name]

    def dataset(self, movie: DiskMovie, first_frame: int = 0) -> xr.Dataset:
        """All of it, with the status of the movie's frames; see `activity_dataset`."""
        reasons = [record.reason for record in movie.records]
        found = activity_dataset(self.tables, self.channels, movie.status, reasons, movie.scale, first_frame)
        return found.assign_coords(self._coords)


def activity_dataset(
    tables: dict[str, FloatArray],
    channels: list[str],
    status: list[str],
    reasons: list[str],
    scale: Scale,
    first_frame: int = 0,
) -> xr.Dataset:
    """Tables of a movie as a Dataset with coordinates and units.

    Parameters
    ----------
    tables : dict of str to ndarray of shape (T, C, L, S), or (T, L, S) for area, depths and centroids
        Areas in square pixels, depths in pixels; they become µm² and µm where the pixel size is known.
    channels, status, reasons : list of str
        The first by channel, the others by frame.
    scale : Scale
    first_frame : int
        Number of the first frame.

    Returns
    -------
    Dataset
    """
    dims = {4: ("time", "channel", "layer", "sector"), 3: ("time", "layer", "sector")}
    data: dict[str, Any] = {}
    units = {
        "area": scale.area_unit,
        "centroid_y": "px",
        "centroid_x": "px",
        "n_pixels": "px²",
        "n_nan": "px²",
    } | dict.fromkeys(DISTANCES, scale.length_unit)
    for name, values in tables.items():
        scaled = values
        if name == "area":
            scaled = scale.area(values)
        elif name in DISTANCES:
            scaled = scale.length(values)
        data[name] = (dims[values.ndim], scaled, {"units": units.get(name, "a.u.")})
    data["status"] = ("time", np.array(status, dtype=str))
    data["reason"] = ("time", np.array(reasons, dtype=str))
    layers, sectors = tables["area"].shape[1:]
    coords: dict[str, Any] = {
        "channel": channels,
        "layer": np.arange(layers),
        "sector": np.arange(sectors),
    }
    coords |= scale.time_coords(first_frame + np.arange(len(status)))
    return with_places(xr.Dataset(data, coords, attrs=scale.attrs).set_xindex("frame"))


def with_places(activity: xr.Dataset) -> xr.Dataset:
    """The Dataset with the windows' centroids as coordinates, and the scale in the attrs of all numbers."""
    scale = Scale.of(activity)
    for name in (*activity.data_vars, "centroid_y", "centroid_x"):
        if activity[name].dtype.kind == "f":
            activity[name].attrs |= scale.attrs
    return activity.set_coords(["centroid_y", "centroid_x"])

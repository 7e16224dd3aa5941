"""Kymographs: intensity through time along a line of the image, or along the tracked edge."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.boundary_depth import places_at_depth
from cytodisk.analysis.signal_frames import MovieSignals, parse_signals
from cytodisk.arrays import AnyArray, BoolArray, FloatArray
from cytodisk.checks import number_between, whole_number
from cytodisk.errors import ParameterError, SignalError
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.tracking import point_angles
from cytodisk.scale import Scale

_ROUNDING = 1e-9  # of the spacing: a line's end at a whole number of steps is a place


def line_kymograph(line_yx: Any, signals: Any, *, width_px: int = 1, spacing_px: float = 1.0) -> xr.DataArray:
    """Intensity along a line in every frame, linear between pixels and averaged over the line's width.

    Parameters
    ----------
    line_yx : array_like of shape (M, 2)
        Corners of the line, (row, column) in pixels, pixel centres at integers.
    signals : array_like of shape (T, H, W) or (T, C, H, W), DataArray or sequence
        A DataArray has the dims time, (channel,) y, x; a sequence may read its frames when asked for them.
    width_px : int
        Lines that are averaged, a pixel apart, side by side and centred on `line_yx`.
    spacing_px : float
        From one place on the line to the next, in pixels.

    Returns
    -------
    DataArray with dims (time, distance), or (time, distance, channel) if the signals have channels
        distance from the line's first point, in µm when attrs `pixel_size_um` of the signals is known, else
        px, as its attrs `units` say; y and x of each place in pixels; time_s when attrs `frame_interval_s`
        is known. What is left of the line behind the last whole step is not sampled.

    Raises
    ------
    SignalError
        The signals are not a movie.
    ParameterError
        The line is none, or leaves the image, or a number is out of its range.

    See Also
    --------
    boundary_kymograph : Along the edge instead of a line.

    References
    ----------
    u-Unwrap, Fig. 1C.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> image = np.broadcast_to(np.arange(8.0), (2, 6, 8))  # two frames, brighter to the right
    >>> kymograph = cd.line_kymograph([(3, 1), (3, 5)], image)
    >>> kymograph.to_numpy()
    array([[1., 2., 3., 4., 5.],
           [1., 2., 3., 4., 5.]])
    """
    line = _parse_line(line_yx)
    width_px, spacing_px = (
        whole_number("width_px", width_px, 1, 10_000),
        number_between("spacing_px", spacing_px, 1e-3, 1e6),
    )
    _refuse_path(signals)
    known = _parse_movie(signals)
    distance, places, normals = _along(line, spacing_px)
    offsets = np.arange(width_px) - 0.5 * (width_px - 1)
    band = places[:, None] + offsets[:, None] * normals[:, None]
    _check_inside(band.reshape(-1, 2), known.image_shape, width_px)
    rows = [bilinear(known.image(frame), band).mean(axis=-1) for frame in range(len(known))]
    scale = Scale.of(signals)
    coords: dict[str, Any] = {
        "distance": ("distance", scale.length(distance), {"units": scale.length_unit}),
        "y": ("distance", places[:, 0], {"units": "px"}),
        "x": ("distance", places[:, 1], {"units": "px"}),
    }
    attrs = {"width_px": width_px, "spacing_px": spacing_px}
    return _kymograph(np.array(rows), "distance", known, coords, scale, attrs).rename("line_kymograph")


def boundary_kymograph(movie: DiskMovie, depth: float, signals: Any, *, points: int = 360) -> xr.DataArray:
    """Intensity along the tracked edge of a cell, at a depth below it, in every frame.

    From each point of the edge the ray of the map is followed, on which the angle of the disk stays the
    same, up to the first place whose distance from the outline is the depth. The same point is the same
    part of the edge in every frame, as far as tracking went without starting anew.

    Parameters
    ----------
    movie : DiskMovie
        Of `map_movie`, or a cell's of a study: `study.movie(cell)`.
    depth : float
        In µm when the movie knows its scale, else in pixels; 0 is the edge itself, half of whose light
        comes from outside the cell.
    signals : array_like of shape (T, H, W) or (T, C, H, W), DataArray or sequence
        As for `sample_movie`.
    points : int
        Angles of the disk, evenly spaced.

    Returns
    -------
    DataArray with dims (time, point), or (time, point, channel) if the signals have channels
        NaN where a ray comes nowhere that deep, where the edge is the image's border, and in frames without
        a map. Coordinates angle, in radians; y and x (time, point), the places in pixels; time_s when the
        frame interval is known. attrs hold depth and depth_units.

    Raises
    ------
    SignalError
        The signals do not fit the movie.
    ParameterError
        The movie is none, or the depth or the number of points is out of its range.

    See Also
    --------
    line_kymograph : Along a line.
    sample_movie : Means of windows instead of points.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=3, radius_px=15.0)
    >>> movie = cd.map_movie(truth.masks)
    >>> kymograph = cd.boundary_kymograph(movie, 2.0, truth.signal, points=90)
    >>> kymograph.dims, kymograph.shape
    (('time', 'point', 'channel'), (3, 90, 2))
    """
    if not isinstance(movie, DiskMovie):
        raise ParameterError(
            f"movie must be a DiskMovie, got {type(movie).__name__}: pass study.movie(cell), "
            "or map_movie(masks)"
        )
    _refuse_path(signals)
    depth = number_between("depth", depth, 0.0)
    points = whole_number("points", points, 1, 1_000_000)
    known = parse_signals(signals, len(movie), movie.image_shape)
    angles, scale = point_angles(points), movie.scale
    places = np.full((len(movie), points, 2), np.nan)
    rows = np.full((len(movie), len(known.channels), points), np.nan)
    for frame, record in enumerate(movie.records):
        image = known.image(frame)
        if record.has_map:
            places[frame] = places_at_depth(movie[frame], angles, depth / scale.length(1.0))
            rows[frame] = bilinear(image, places[frame])
    coords: dict[str, Any] = {
        "point": np.arange(points),
        "angle": ("point", angles, {"units": "rad"}),
        "y": (("time", "point"), places[..., 0], {"units": "px"}),
        "x": (("time", "point"), places[..., 1], {"units": "px"}),
    }
    attrs = {"depth": depth, "depth_units": scale.length_unit}
    named = _kymograph(rows, "point", known, coords, scale, attrs)
    return named.rename("boundary_kymograph")


def bilinear(frame: AnyArray, points_yx: FloatArray) -> FloatArray:
    """Values of an image between its pixels.

    Parameters
    ----------
    frame : ndarray of shape (..., H, W)
    points_yx : ndarray of shape (*P, 2) and dtype float
        (row, column) in pixels; beyond the outermost pixel centres those count.

    Returns
    -------
    ndarray of shape (..., *P) and dtype float
        NaN where the point is NaN, or a pixel that has a share in it.
    """
    last = np.array(frame.shape[-2:]) - 1
    known: BoolArray = np.all(np.isfinite(points_yx), axis=-1)
    points = np.clip(np.where(known[..., None], points_yx, 0.0), 0, last)
    low = np.minimum(np.floor(points).astype(np.int64), np.maximum(last - 1, 0))
    share = points - low
    out = np.zeros((*frame.shape[:-2], *known.shape))
    for down in (0, 1):
        for right in (0, 1):
            row, column = (np.minimum(low + np.array([down, right]), last)[..., axis] for axis in (0, 1))
            weight = np.abs(1 - down - share[..., 0]) * np.abs(1 - right - share[..., 1])
            # A pixel without a share says nothing, not even NaN.
            out += np.where(weight > 0.0, frame[..., row, column], 0.0) * weight
    return np.where(known, out, np.nan)


def _parse_line(line_yx: Any) -> FloatArray:
    try:
        line = np.asarray(line_yx, dtype=np.float64)
    except (TypeError, ValueError):
        line = np.empty(0)
    if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all():
        raise ParameterError(
            f"line_yx must be two or more points (row, column) of finite numbers, got shape {line.shape}"
        )
    moved = np.append(True, (np.diff(line, axis=0) != 0).any(axis=1))
    if moved.sum() < 2:
        raise ParameterError("line_yx has no length: pass points that differ")
    return np.asarray(line[moved])


def _refuse_path(signals: Any) -> None:
    if isinstance(signals, str | bytes | os.PathLike):
        raise SignalError(
            f"signals must be frames of a movie, got the path {signals!r}: read it, as "
            "cd.read_image(path, unnamed='T')"
        )


def _parse_movie(signals: Any) -> MovieSignals:
    """Signals that are measured without a movie of masks: they need only fit each other."""
    if isinstance(signals, xr.DataArray):
        sizes = signals.sizes
        return parse_signals(signals, sizes.get("time", 0), (sizes.get("y", 0), sizes.get("x", 0)))
    if not hasattr(signals, "__getitem__") or not hasattr(signals, "__len__") or not len(signals):
        raise SignalError(f"signals must be frames of a movie, got {type(signals).__name__}")
    first = np.shape(signals[0])
    if len(first) not in (2, 3):
        raise SignalError(
            f"a frame of the signals has shape {first}: pass (time, y, x) or (time, channel, y, x)"
        )
    return parse_signals(signals, len(signals), (first[-2], first[-1]))


def _along(line: FloatArray, spacing: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Distance, position and normal of each place on a line."""
    steps = np.diff(line, axis=0)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    distance = spacing * np.arange(int(arc[-1] / spacing * (1.0 + _ROUNDING)) + 1)
    distance = np.minimum(distance, arc[-1])
    segment = np.clip(np.searchsorted(arc, distance, side="right") - 1, 0, len(steps) - 1)
    direction = steps / np.diff(arc)[:, None]
    places = line[segment] + (distance - arc[segment])[:, None] * direction[segment]
    return distance, places, np.column_stack([-direction[segment, 1], direction[segment, 0]])


def _check_inside(points: FloatArray, shape: tuple[int, int], width_px: int) -> None:
    last = np.array(shape) - 1.0
    outside = ((points < -_ROUNDING) | (points > last + _ROUNDING)).any(axis=1)
    if outside.any():
        y, x = points[outside][0]
        raise ParameterError(
            f"line_yx leaves the image at (row, column) ({y:.1f}, {x:.1f}): an image of shape {shape} has "
            f"places from (0, 0) to ({shape[0] - 1}, {shape[1] - 1}); width_px is {width_px}"
        )


def _kymograph(
    rows: FloatArray,
    along: str,
    signals: MovieSignals,
    coords: dict[str, Any],
    scale: Scale,
    attrs: dict[str, Any],
) -> xr.DataArray:
    """Values of shape (T, C, D) with their coordinates, as (time, along[, channel])."""
    known = scale.time_coords(np.arange(len(rows)))
    dims = ["time", along]
    if signals.channel_names is None:
        rows = rows[:, 0]
    else:
        rows, dims = np.moveaxis(rows, 1, 2), [*dims, "channel"]
        known["channel"] = signals.channel_names
    attrs = {"units": "a.u."} | scale.attrs | attrs
    return xr.DataArray(rows, known | coords, dims, attrs=attrs).set_xindex("frame")

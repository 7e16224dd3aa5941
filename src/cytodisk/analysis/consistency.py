"""How consistent windows are through time: the two measures of the paper (section 3, Fig. 4)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.motion.disk_movie import DiskMovie

_LEAST_SECTORS = 3  # for a correlation: any two points lie on a line


def consecutive_correlation(activity: xr.DataArray) -> xr.DataArray:
    """Pearson correlation over sectors of each frame with the next, by layer.

    Parameters
    ----------
    activity : DataArray with dims time and sector, and any others
        Such as the mean of `sample_movie`.

    Returns
    -------
    DataArray with the dims of `activity` but sector
        Of frame t with t + 1, over the sectors that have a signal in both, stored at t: the last is NaN, as
        is a pair with fewer than three such sectors, or in which a signal does not vary.

    See Also
    --------
    centroid_displacement : How far the windows move.

    References
    ----------
    u-Unwrap, section 3, Fig. 4C.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> frame = np.array([1.0, 4.0, 2.0, 3.0])
    >>> activity = xr.DataArray([[frame], [2 * frame], [-frame]], dims=("time", "layer", "sector"))
    >>> cd.consecutive_correlation(activity).to_numpy().round(6).T
    array([[ 1., -1., nan]])
    """
    values = activity.transpose("time", ..., "sector").to_numpy()
    out = np.full(values.shape[:-1], np.nan)
    out[:-1] = correlation_over_sectors(values[:-1], values[1:])
    dims = tuple(dim for dim in activity.transpose("time", ..., "sector").dims if dim != "sector")
    coords: dict[Any, Any] = {
        name: coord for name, coord in activity.coords.items() if set(coord.dims) <= set(dims)
    }
    return xr.DataArray(out, coords, dims, name="consecutive_correlation", attrs={"units": "1"})


def centroid_displacement(movie: DiskMovie, activity: xr.Dataset) -> xr.DataArray:
    """How far each window's centroid moves from a frame to the next, rigid motion of the cell taken out.

    Parameters
    ----------
    movie : DiskMovie
    activity : Dataset
        Of `sample_movie` on it: its centroid_y and centroid_x.

    Returns
    -------
    DataArray with dims (time, layer, sector)
        In µm when the movie knows its scale, else px, as attrs `units` says; of frame t to t + 1, stored at
        t: the last is NaN, and so is a step at which tracking started anew, or the window was empty before or
        after. Its mean over windows is the paper's measure.

    See Also
    --------
    consecutive_correlation : How alike the signal of consecutive frames is.

    References
    ----------
    u-Unwrap, section 3, Fig. 4D.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("still", frames=3, radius_px=15.0)
    >>> movie = cd.map_movie(truth.masks)
    >>> activity = cd.sample_movie(movie, cd.polar_windows(layers=2, sectors=6), truth.signal)
    >>> moved = cd.centroid_displacement(movie, activity)
    >>> moved.shape, moved.attrs["units"]
    ((3, 2, 6), 'px')
    """
    centroids = np.stack([activity["centroid_y"].to_numpy(), activity["centroid_x"].to_numpy()], axis=-1)
    steps = movie.scale.length(displacement_between(movie.registered(centroids)))
    for number, record in enumerate(movie.records[1:]):
        if record.boundary is not None and record.boundary.restarted:
            steps[number] = np.nan  # windows before and after have nothing to do with each other
    coords = {name: activity[name] for name in ("frame", "layer", "sector")}
    attrs = {"units": movie.scale.length_unit} | movie.scale.attrs
    return xr.DataArray(steps, coords, ("time", "layer", "sector"), name="centroid_displacement", attrs=attrs)


def correlation_over_sectors(here: FloatArray, there: FloatArray) -> FloatArray:
    """Pearson correlation over the last axis, of the sectors that have a value in both.

    NaN where these are fewer than three, or a signal does not vary.
    """
    both = np.isfinite(here) & np.isfinite(there)
    count = both.sum(axis=-1)
    usable = count >= _LEAST_SECTORS
    centred = []
    for values in (here, there):
        held = np.where(both, values, 0.0)
        middle = held.sum(axis=-1, keepdims=True) / np.maximum(count, 1)[..., None]
        centred.append(np.where(both, values - middle, 0.0))
        usable &= np.where(both, values, -np.inf).max(axis=-1) > np.where(both, values, np.inf).min(axis=-1)
    a, b = centred
    with np.errstate(invalid="ignore", divide="ignore"):
        found = (a * b).sum(axis=-1) / np.sqrt((a**2).sum(axis=-1) * (b**2).sum(axis=-1))
    return np.asarray(np.where(usable, found, np.nan))


def displacement_between(positions: FloatArray) -> FloatArray:
    """Distance of each position to the next frame's, shape (T, …) of positions (T, …, 2); the last is NaN."""
    out = np.full(positions.shape[:-1], np.nan)
    out[:-1] = np.linalg.norm(np.diff(positions, axis=0), axis=-1)
    return out

"""Edge velocity of a movie, by sector and by boundary point."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.checks import instance_of, one_of
from cytodisk.disk.sector_parameters import SECTORS, SectorParameters
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.edge import STRETCHES, displacement_by_sector, edge_motion, normal_displacement
from cytodisk.motion.swept_edge import FRAMES, Frame
from cytodisk.motion.velocity_error import velocity_error


def edge_velocity(movie: DiskMovie, sectors: int = SECTORS, *, frame: Frame = "lab") -> xr.DataArray:
    """Outward velocity of the cell's edge by frame and sector.

    Area that the sector's edge sweeps from frame t to t + 1, over the mean of its lengths in both frames, so
    that velocity times length adds up to the area won less the area lost. It is stored at t: the last frame
    is NaN, as is one without a map before or after it. Edge on the image's border is left out.

    Parameters
    ----------
    movie : DiskMovie
    sectors : int
        From angle 0 of the disk (+u) towards +v, like those of `polar_windows`.
    frame : {"lab", "cell"}
        "lab": motion over the substrate. "cell": change of shape only, after rigid registration.

    Returns
    -------
    DataArray with dims (time, sector)
        Protrusion positive. attrs `units` is "µm/s" when the movie knows its scale, else "px/frame" (or a
        mixture, when it knows one of the two).

    Raises
    ------
    WindowError
        `sectors` is not a whole number from 1 to 100 000.
    ParameterError
        `movie` is no DiskMovie, or an unknown frame.

    See Also
    --------
    boundary_velocity : By tracked point of the edge instead of by sector.
    edge_changes : With the error of the velocity, and areas won and lost.
    edge_events : Protrusions and retractions.

    References
    ----------
    u-Unwrap, section 3 and Fig. S5.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=15.0, speed_px=0.5)
    >>> velocity = cd.edge_velocity(cd.map_movie(truth.masks), sectors=8)
    >>> velocity.dims, velocity.attrs["units"]
    (('time', 'sector'), 'px/frame')
    >>> 0.5 < velocity.mean().item() < 0.7
    True
    """
    _check_movie(movie)
    sectors, frame = SectorParameters(sectors=sectors).sectors, one_of("frame", frame, FRAMES)
    values = np.full((len(movie), sectors), np.nan)
    for number, (here, there) in _pairs(movie):
        values[number] = displacement_by_sector(here, there, movie.image_shape, sectors, frame)
    return _labelled(movie, movie.scale.velocity(values), "sector", frame)


def boundary_velocity(movie: DiskMovie, *, frame: Frame = "lab") -> xr.DataArray:
    """Outward velocity of the edge around every tracked boundary point; see `edge_velocity`.

    Parameters
    ----------
    movie : DiskMovie
    frame : {"lab", "cell"}

    Returns
    -------
    DataArray with dims (time, point)
        With the coordinate `angle`, the points' angles on the disk in radians; points on the image's border
        are NaN.

    Raises
    ------
    ParameterError
        `movie` is no DiskMovie, or an unknown frame.

    See Also
    --------
    edge_velocity : The mean of each sector.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=15.0, speed_px=0.5)
    >>> velocity = cd.boundary_velocity(cd.map_movie(truth.masks))
    >>> velocity.dims, 0.5 < velocity.mean().item() < 0.7
    (('time', 'point'), True)
    """
    _check_movie(movie)
    frame = one_of("frame", frame, FRAMES)
    values = np.full((len(movie), movie.n_points), np.nan)
    for number, (here, there) in _pairs(movie):
        values[number] = normal_displacement(here, there, frame)
    border = movie.on_border
    values[:-1][border[:-1] | border[1:]] = np.nan
    labelled = _labelled(movie, movie.scale.velocity(values), "point", frame)
    return labelled.assign_coords(angle=("point", movie.point_angles))


def edge_changes(
    movie: DiskMovie,
    sectors: int = SECTORS,
    *,
    frame: Frame = "lab",
) -> xr.Dataset:
    """Edge velocity with its error bar, and the areas that the cell won and lost, by frame and sector.

    Parameters
    ----------
    movie : DiskMovie
    sectors : int
    frame : {"lab", "cell"}

    Returns
    -------
    Dataset with dims (time, sector)
        velocity, velocity_fastest (of the sector's fastest half pixel of edge), velocity_error (standard
        deviation), protruded_area, retracted_area, edge_length (mean of both frames'); their units are in
        the attrs of each.

    Raises
    ------
    WindowError, ParameterError
        An argument is out of its range.

    See Also
    --------
    edge_velocity : The velocity alone, faster.
    edge_events : Takes these areas, too.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=15.0)
    >>> changes = cd.edge_changes(cd.map_movie(truth.masks), sectors=8)
    >>> bool((changes["protruded_area"].sum("sector") > changes["retracted_area"].sum("sector"))[0])
    True
    """
    sectors, frame = SectorParameters(sectors=sectors).sectors, one_of("frame", frame, FRAMES)
    _check_movie(movie)
    found = {
        name: np.full((len(movie), sectors), np.nan)
        for name in ("displacement_px", "fastest_px", "protruded_px2", "retracted_px2", "length_px")
    }
    stretches = np.full((len(movie), 2, STRETCHES), np.nan)
    for number, (here, there) in _pairs(movie):
        motion = edge_motion(here, there, movie[number], movie[number + 1], sectors, frame=frame)
        for name, values in found.items():
            values[number] = getattr(motion, name)
        stretches[number] = motion.stretches_px
    found["error_px"] = velocity_error(found["displacement_px"], found["length_px"], stretches)
    scale = movie.scale
    scaled = {
        "velocity": ("displacement_px", scale.velocity, scale.velocity_unit),
        "velocity_fastest": ("fastest_px", scale.velocity, scale.velocity_unit),
        "velocity_error": ("error_px", scale.velocity, scale.velocity_unit),
        "protruded_area": ("protruded_px2", scale.area, scale.area_unit),
        "retracted_area": ("retracted_px2", scale.area, scale.area_unit),
        "edge_length": ("length_px", scale.length, scale.length_unit),
    }
    columns = {
        name: _labelled(movie, convert(found[source]), "sector", frame).assign_attrs(units=units)
        for name, (source, convert, units) in scaled.items()
    }
    return xr.Dataset(columns, attrs={"frame": frame} | scale.attrs)


def _check_movie(movie: Any) -> None:
    instance_of("movie", movie, DiskMovie, "a DiskMovie, as map_movie returns it")


def _pairs(movie: DiskMovie) -> Any:
    """(number, boundaries of this frame and the next) where both have a map and tracking went on."""
    for number, (first, second) in enumerate(zip(movie.records, movie.records[1:], strict=False)):
        here, there = first.boundary, second.boundary
        if here is not None and there is not None and not there.restarted:
            yield number, (here, there)


def _labelled(movie: DiskMovie, values: Any, last: str, frame: str) -> xr.DataArray:
    coords: dict[str, Any] = movie.scale.time_coords(np.arange(len(movie))) | {
        last: np.arange(values.shape[1])
    }
    name = "edge_velocity" if last == "sector" else "boundary_velocity"
    attrs = {"units": movie.scale.velocity_unit, "frame": frame} | movie.scale.attrs
    array = xr.DataArray(values, coords, ("time", last), name=name, attrs=attrs)
    return array.set_xindex("frame")

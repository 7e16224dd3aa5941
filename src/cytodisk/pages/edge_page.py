"""The page of how a cell's edge moves."""

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.pages.drawn_movie import DrawnMovie
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.movie.edge_arrows import draw_velocity_arrows
from cytodisk.plot.movie.edge_motion import draw_area_change, draw_tracks
from cytodisk.plot.movie.mean_velocity import draw_mean_velocity
from cytodisk.plot.style import nice_length
from cytodisk.plot.time_axis import time_stamp

_ARROWS, _TRACKS, _TRACKS_LEFT = 52.0, 44.0, 60.0  # mm, width of the panels
_TALL, _LINES, _LINE_LEFT, _LINE_WIDTH = 54.0, 26.0, 15.0, 98.0  # mm
_POINTS_SHOWN = 120  # arrows around the cell
_OUTLINES_SHOWN = 20
_USUAL_ARROW, _LONGEST_ARROW = 0.12, 0.25  # of the cell: percentile 95, and the longest


def edge_sheet(movie: DrawnMovie) -> Sheet:
    """Arrows of the fastest frame and tracks above; area change and edge velocity through time below.

    Parameters
    ----------
    movie : DrawnMovie
        With at least one map.

    Returns
    -------
    Sheet
    """
    top = movie.heading_mm + 17.0
    first = top + _TALL + 14.0
    second = first + _LINES + 9.0
    velocity = movie.activity["velocity"].transpose("time", "sector").load()
    moves = bool(np.isfinite(velocity).any())
    sheet = Sheet(second + _LINES + 11.0 if moves else top + _TALL + 9.0)
    movie.write_heading(sheet, "motion of the edge")
    _draw_arrows(sheet, top, movie, velocity.to_numpy())
    _draw_tracks(sheet, top, movie)
    if moves:
        _draw_changes(sheet, first, second, movie, velocity)
    return sheet


def fastest_frame(velocity: FloatArray) -> int | None:
    """Frame with the largest mean speed of its sectors.

    A leap of the mask is not left out: it is what the reader of the figure has to see.

    Parameters
    ----------
    velocity : ndarray of shape (T, S) and dtype float

    Returns
    -------
    int or None
        None when no frame has a velocity.
    """
    known = np.isfinite(velocity)
    if not known.any():
        return None
    size = np.where(known, np.abs(velocity), 0.0)
    return int((size.sum(axis=1) / np.maximum(known.sum(axis=1), 1)).argmax())


def _draw_arrows(sheet: Sheet, top: float, movie: DrawnMovie, velocity: FloatArray) -> None:
    fastest = fastest_frame(velocity)
    if fastest is None:
        sheet.text(8.0, top + 0.5 * _TALL, "no two frames in a row to compare", color="0.3")
        return
    time = movie.first + fastest
    here, there = (movie.maps.records[number].boundary for number in (time, time + 1))
    if here is None or there is None:
        return
    step = there.points_yx - here.points_yx
    ax = sheet.axes(4.0, top, _ARROWS, _TALL)
    ax.set_anchor("NW")
    draw_velocity_arrows(
        ax,
        movie.maps,
        time,
        every=max(1, len(step) // _POINTS_SHOWN),
        stretch=_stretch(step, here.contour.outline_yx),
        scale=movie.scale,
    )
    stamp = time_stamp(time, movie.scale)
    stamp += "" if movie.scale.frame_interval_s is None else f" (frame {time})"
    _write_above(sheet, movie, 4.0, "largest mean speed:", f"{stamp} and the next")


def _draw_tracks(sheet: Sheet, top: float, movie: DrawnMovie) -> None:
    ax = sheet.axes(_TRACKS_LEFT, top, _TRACKS, _TALL)
    ax.set_anchor("NW")
    every = -(-movie.frames // _OUTLINES_SHOWN)
    draw_tracks(ax, movie.points_yx, every=every, first_frame=movie.first, scale=movie.scale)
    which = "every frame" if every == 1 else f"every {every} frames"
    _write_above(sheet, movie, _TRACKS_LEFT, f"outlines {which},", "paths of points from the dot on")


def _write_above(sheet: Sheet, movie: DrawnMovie, left: float, *lines: str) -> None:
    for number, words in enumerate(lines):
        sheet.panel_title(left, movie.heading_mm + 3.0 + 3.3 * number, words)


def _draw_changes(
    sheet: Sheet, first: float, second: float, movie: DrawnMovie, velocity: xr.DataArray
) -> None:
    changes = sheet.axes(_LINE_LEFT, first, _LINE_WIDTH, _LINES)
    won, lost = (
        movie.activity[name].sum("sector", min_count=1, keep_attrs=True)
        for name in ("protruded_area", "retracted_area")
    )
    draw_area_change(changes, won, lost, scale=movie.scale)
    changes.set_xlabel("")
    changes.tick_params(labelbottom=False)
    speeds = sheet.axes(_LINE_LEFT, second, _LINE_WIDTH, _LINES)
    draw_mean_velocity(speeds, velocity, scale=movie.scale)


def _stretch(step_yx: FloatArray, outline_yx: FloatArray) -> float:
    """So much longer than their steps are arrows that most can be seen and none leaves the panel."""
    length = np.hypot(*step_yx.T)
    if not length.max() > 0:
        return 1.0
    size = float(np.ptp(outline_yx, axis=0).max())
    usual = _USUAL_ARROW * size / max(float(np.percentile(length, 95)), 1e-9)
    return nice_length(max(1.0, min(usual, _LONGEST_ARROW * size / float(length.max()))))

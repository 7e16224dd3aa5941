"""Directions of cells on the disk, out of directions in the image."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.population.cell_directions import DIRECTION, STRENGTH

TURN = "disk_turn"


def direction_units(names: Iterable[str]) -> dict[str, str]:
    """Units of those columns that hold directions, or their strength.

    Parameters
    ----------
    names : iterable of str
        Columns of cells.
    """
    angles, strengths = DIRECTION.format(""), STRENGTH.format("")
    of_angles = {name: "°" for name in names if name == TURN or name.startswith(angles)}
    return of_angles | {name: "1" for name in names if name.startswith(strengths)}


def image_directions(
    cells: pd.DataFrame, turn: FloatArray, axis: FloatArray, long: FloatArray
) -> dict[str, Any]:
    """Columns of directions that a still cell has.

    A direction in the disk is that in the image less the angle by which the disk is turned in it: that of the
    edge on average, so that it holds for maps of any `align`.

    Parameters
    ----------
    cells : DataFrame
        With nucleus_direction and nucleus_polarity where cells have a nucleus.
    turn, axis, long : ndarray of shape (cells,) and dtype float64
        See `RowMoments`.

    Returns
    -------
    dict of str to ndarray
        The turn, and disk_direction_NAME in degrees with direction_strength_NAME for the long axis and, with
        nuclei, for the direction from the nucleus' centroid to the cell's.
    """
    found: dict[str, Any] = {TURN: turn % 360.0} | _columns("axis", axis - turn, long)
    if "nucleus_direction" in cells and cells["nucleus_direction"].notna().any():
        direction = cells["nucleus_direction"].to_numpy(np.float64) - turn
        polarity = np.minimum(cells["nucleus_polarity"].to_numpy(np.float64), 1.0)
        found = _columns("nucleus", direction, polarity) | found
    return found


def _columns(name: str, direction: Any, strength: Any) -> dict[str, Any]:
    known = np.isfinite(direction) & np.isfinite(strength)
    return {
        DIRECTION.format(name): np.where(known, direction % 360.0, np.nan),
        STRENGTH.format(name): np.where(known, np.clip(strength, 0.0, 1.0), np.nan),
    }


def movie_directions(frames: pd.DataFrame, edge: pd.DataFrame, sectors: int) -> dict[str, float]:
    """Columns of directions of one cell of a movie, in the disk, where sectors follow the cell.

    Parameters
    ----------
    frames : DataFrame
        A row for each frame with a map, in order: frame, centroid_y, centroid_x, turn, axis, long, and with
        nuclei nucleus_direction and nucleus_polarity.
    edge : DataFrame
        Columns sector and velocity, of all frames of the cell.
    sectors : int

    Returns
    -------
    dict of str to float
        As `image_directions`, and "motion": the displacement of the centroid, strength net over path;
        "front": the first harmonic of the mean velocity by sector, strength its size over that of all
        sectors. Directions of single frames are averaged as vectors, long axes as axes.
    """
    turn = np.radians(frames["turn"].to_numpy(np.float64))
    middle = np.degrees(np.angle(_mean(np.exp(1j * turn))))
    found: dict[str, float] = {TURN: float(middle % 360.0)}
    if "nucleus_direction" in frames:
        towards = np.radians(frames["nucleus_direction"].to_numpy(np.float64)) - turn
        found |= _of_vector("nucleus", _mean(frames["nucleus_polarity"].to_numpy() * np.exp(1j * towards)))
    found |= _axis(np.radians(frames["axis"].to_numpy(np.float64)) - turn, frames["long"].to_numpy())
    found |= _motion(frames, turn)
    means = edge.groupby("sector")["velocity"].mean().reindex(range(sectors)).to_numpy(np.float64)
    known = np.isfinite(means)
    angle = 2.0 * np.pi * (np.arange(sectors) + 0.5) / sectors
    wave, size = np.sum((means * np.exp(1j * angle))[known]), np.abs(means[known]).sum()
    return found | _of_vector("front", wave / size if size > 0 else np.nan)


def _motion(frames: pd.DataFrame, turn: FloatArray) -> dict[str, float]:
    place = frames["centroid_x"].to_numpy(np.float64) + 1j * frames["centroid_y"].to_numpy(np.float64)
    steps = np.diff(place)
    path = np.abs(steps).sum()
    in_disk = np.sum(steps * np.exp(-1j * turn[:-1]))
    return _of_vector("motion", in_disk / path if path > 0 else np.nan)


def _axis(angle: FloatArray, long: FloatArray) -> dict[str, float]:
    """Mean of axes, which have no ends, and then the end that most frames have."""
    double = _mean(long * np.exp(2j * angle))
    mean = np.angle(double) / 2.0
    side = np.nansum(long * np.cos(angle - mean))
    return _of_vector("axis", np.abs(double) * np.exp(1j * (mean if side >= 0 else mean + np.pi)))


def _mean(vectors: Any) -> Any:
    known = vectors[np.isfinite(vectors)]
    return known.mean() if len(known) else np.nan


def _of_vector(name: str, vector: Any) -> dict[str, float]:
    found = _columns(name, np.degrees(np.angle(vector)), np.abs(vector))
    return {column: float(value) for column, value in found.items()}

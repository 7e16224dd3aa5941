"""The direction of each cell on the disk, and the turn that takes it to sector 0."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.errors import PopulationError
from cytodisk.population.ratios import known_mean

DIRECTIONS = ("nucleus", "front", "motion", "axis")
SIGNAL = "signal:"
DIRECTION, STRENGTH = "disk_direction_{}", "direction_strength_{}"


def no_alignment(cells: int) -> pd.DataFrame:
    """The table of cells that are not turned."""
    nothing = np.full(cells, np.nan)
    return pd.DataFrame(
        {
            "direction": nothing,
            "strength": nothing,
            "shift": np.zeros(cells, dtype=np.int64),
            "status": np.full(cells, "not aligned", dtype=object),
        }
    )


def chosen_direction(
    by: str,
    cells: pd.DataFrame,
    signal: Iterator[tuple[slice, FloatArray]] | None,
    sectors: int,
    weakest: float,
) -> pd.DataFrame:
    """Direction, strength, shift and status by cell.

    Parameters
    ----------
    by : str
        See `Population.align`.
    cells : DataFrame
    signal : iterator of (slice, ndarray), optional
        Values of the one channel that gives the direction, as `Population.blocks` gives them.
    sectors : int
    weakest : float

    Returns
    -------
    DataFrame

    Raises
    ------
    PopulationError
        There is no such direction.
    """
    if by == "none":
        return no_alignment(len(cells))
    if signal is not None:
        direction, strength = signal_direction(signal, len(cells))
    else:
        direction, strength = _given_direction(by, cells)
    with np.errstate(invalid="ignore"):
        status = np.where(strength >= weakest, "ok", f"its direction is weaker than {weakest:g}")
    status = np.where(np.isfinite(direction) & np.isfinite(strength), status, "it has no direction")
    turned = np.where(status == "ok", direction, 0.0)
    shift = np.rint(turned * sectors / 360.0).astype(np.int64) % sectors
    return pd.DataFrame(
        {"direction": direction, "strength": strength, "shift": shift, "status": status.astype(object)}
    )


def _given_direction(by: str, cells: pd.DataFrame) -> tuple[FloatArray, FloatArray]:
    if by not in DIRECTIONS:
        words = ", ".join(repr(name) for name in ("none", *DIRECTIONS))
        raise PopulationError(f"align: {by!r} is none of {words} or 'signal:CHANNEL'")
    names = DIRECTION.format(by), STRENGTH.format(by)
    for name in names:
        if name not in cells:
            have = [one for one in DIRECTIONS if DIRECTION.format(one) in cells]
            words = f"those that are there: {', '.join(have)}" if have else "none is there"
            advice = {
                "nucleus": "map the cells with --nuclei",
                "front": "the cells must come from movies",
                "motion": "the cells must come from movies",
            }.get(by, "give the table this column")
            raise PopulationError(f"align: cells have no column {name} ({words}): {advice}, or use 'none'")
    direction, strength = (pd.to_numeric(cells[name], errors="coerce").to_numpy(np.float64) for name in names)
    return direction % 360.0, strength


def signal_direction(blocks: Iterator[tuple[slice, FloatArray]], cells: int) -> tuple[FloatArray, FloatArray]:
    """First harmonic of a channel around each cell.

    Parameters
    ----------
    blocks : iterator of (slice, ndarray of shape (cells, 1, layers, sectors))
    cells : int

    Returns
    -------
    direction : ndarray of shape (cells,) and dtype float64
        Degrees in the disk; NaN for a cell without values.
    strength : ndarray of shape (cells,) and dtype float64
        Length of the sum of the values as vectors over the sum of their sizes.
    """
    direction, strength = np.full(cells, np.nan), np.full(cells, np.nan)
    for rows, block in blocks:
        wave = first_harmonic(block[:, 0])
        direction[rows] = np.degrees(np.angle(wave)) % 360.0
        size = np.abs(around(block[:, 0])).sum(axis=-1)
        with np.errstate(invalid="ignore", divide="ignore"):
            strength[rows] = np.abs(wave) / size
    return direction, strength


def around(block: FloatArray) -> FloatArray:
    """Mean over the layers of each sector (cells, sectors).

    A sector without a value counts as the mean of its cell.
    """
    means = known_mean(block, -2)
    level = known_mean(means, -1)[..., None]
    return np.where(np.isfinite(means), means, level)


def first_harmonic(block: FloatArray) -> np.ndarray:
    """Sum over sectors of the values as vectors that point to the sectors' middles: (cells,) complex.

    Parameters
    ----------
    block : ndarray of shape (cells, layers, sectors) and dtype float64

    Returns
    -------
    ndarray of shape (cells,) and dtype complex128
    """
    sectors = block.shape[-1]
    angle = 2.0 * np.pi * (np.arange(sectors) + 0.5) / sectors
    return np.asarray(around(block) @ np.exp(1j * angle))

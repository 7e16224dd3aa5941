"""Which columns of the cells are compared as scalars."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

import pandas as pd

from cytodisk.errors import PopulationError
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.runs.population.movies.wave_summaries import WAVE_UNITS
from cytodisk.runs.population.opening.disk_directions import TURN
from cytodisk.runs.population.opening.joined_cells import FRAMES, PLACES
from cytodisk.store.nuclei.summary_columns import PERINUCLEAR_SHARE, PERIPHERAL_SHARE, column_of

_DEFAULT = ("area", "nucleus_area", "nucleus_polarity", *WAVE_UNITS)
_DEFAULT_OF_CHANNEL = (PERINUCLEAR_SHARE, PERIPHERAL_SHARE)
_NO_SCALARS = (*PLACES, CONDITION, EXPERIMENT, FRAMES, TURN, "centroid_y", "centroid_x", "day", "dose")
_DIRECTIONS = ("disk_direction_", "nucleus_direction", "signal_direction_")
_SHOWN = 12


def chosen_scalars(
    cells: pd.DataFrame, channels: Sequence[str], scalars: Sequence[str] | None
) -> tuple[str, ...]:
    """Names of columns that are compared.

    Parameters
    ----------
    cells : DataFrame
    channels : sequence of str
        Of the population.
    scalars : sequence of str, optional
        By default few, because all are corrected together: area; with nuclei area and polarity of the nucleus
        and, of each channel, its share of signal around the nucleus and at the membrane; for the summary
        "waves" their numbers.

    Returns
    -------
    tuple of str

    Raises
    ------
    PopulationError
        A column is not there, or holds no numbers.
    """
    there = candidates(cells)
    if scalars is None:
        of_channels = [column_of(name, channel) for channel in channels for name in _DEFAULT_OF_CHANNEL]
        return tuple(
            name for name in (*_DEFAULT, *of_channels) if name in there and cells[name].notna().any()
        )
    if isinstance(scalars, str):
        raise PopulationError(f"scalars must be a list of names, got {scalars!r}: write [{scalars!r}]")
    for name in scalars:
        if name not in there:
            near = get_close_matches(str(name), there, 1, 0.6)
            more = "" if len(there) <= _SHOWN else f" and {len(there) - _SHOWN} more"
            hint = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(there[:_SHOWN])}{more}"
            what = "is no number that can be compared" if name in cells else "is no column of the cells"
            raise PopulationError(f"scalars: {name!r} {what}: {hint}")
    return tuple(dict.fromkeys(scalars))


def candidates(cells: pd.DataFrame) -> list[str]:
    """Columns that can be compared: numbers, but for places and angles."""
    return [
        str(name)
        for name in cells
        if name not in _NO_SCALARS
        and not str(name).startswith(_DIRECTIONS)
        and pd.api.types.is_numeric_dtype(cells[name])
        and not pd.api.types.is_bool_dtype(cells[name])
    ]

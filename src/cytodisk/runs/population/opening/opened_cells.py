"""What is asked for of cells, and what comes of it: the parts of a `Population`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import pandas as pd
import xarray as xr

from cytodisk.runs.population.opening.noted_cells import LeftOut


class Wanted(NamedTuple):
    """What a user asks for; see `open_population`.

    Attributes
    ----------
    summary : str
    channels, scalars : sequence of str, or None
    left_out : LeftOut
        Gets the cells without values.
    """

    summary: str
    channels: Sequence[str] | None
    scalars: Sequence[str] | None
    left_out: LeftOut


class OpenedCells(NamedTuple):
    """The parts of a `Population`.

    Attributes
    ----------
    values, areas : DataArray or None
    cells : DataFrame
    scalars : tuple of str
    """

    values: xr.DataArray | None
    areas: xr.DataArray | None
    cells: pd.DataFrame
    scalars: tuple[str, ...]

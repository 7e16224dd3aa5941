"""Means of a study's channels in the windows of one cell."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.store.spatial.study_places import MappedStudy


def window_means(study: MappedStudy) -> Callable[[int, int], dict[str, FloatArray]]:
    """A function that gives the mean of each channel, shape (layers, sectors), by cell and frame.

    Parameters
    ----------
    study : Study

    Returns
    -------
    callable
        Of (cell, frame). Without a signal it gives nothing.
    """
    windows = study.windows
    measured = windows[windows["channel"].notna()]
    places = {} if measured.empty else measured.groupby(["cell", "frame"], sort=False).indices

    def of(cell: int, frame: int) -> dict[str, FloatArray]:
        if (cell, frame) not in places:
            return {}
        rows = measured.iloc[places[cell, frame]]
        return {str(name): _table(own) for name, own in rows.groupby("channel", sort=False)}

    return of


def _table(rows: pd.DataFrame) -> FloatArray:
    values = np.full((rows["layer"].max() + 1, rows["sector"].max() + 1), np.nan)
    values[rows["layer"], rows["sector"]] = rows["mean"]
    return values

"""The power of waves by their number around the cell, their direction and their frequency, as a table."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy.signal import welch

from cytodisk.analysis.correlation.prepared_series import interpolated
from cytodisk.arrays import FloatArray

MOST_MODES = 8

_SEGMENT = 0.5  # of the movie: three segments that overlap by half smooth the spectrum
_SHORTEST = 16  # frames


def spectrum_table(values: FloatArray) -> pd.DataFrame:
    """Share of power by mode and frequency.

    Parameters
    ----------
    values : ndarray of shape (T, S) and dtype float
        NaN is filled in linearly in time; a sector without any value counts as its mean.

    Returns
    -------
    DataFrame
        mode, positive towards higher sectors, and 0; frequency in periods a frame, above 0; power. Shares of
        all modes up to `MOST_MODES` and all frequencies add up to 1; empty for values that do not change.

    Notes
    -----
    A wave cos(mode · angle - 2π frequency · time) is a complex line at -frequency in the Fourier coefficient
    of its mode around the cell: Welch's spectrum of that coefficient tells both directions apart.
    """
    filled = interpolated(values - np.nanmean(values, axis=0)) if np.isfinite(values).any() else values
    filled = np.nan_to_num(filled)
    frames, sectors = filled.shape
    around = np.fft.fft(filled, axis=1)
    modes = np.arange(0, min(MOST_MODES, (sectors - 1) // 2) + 1)
    length = min(frames, max(_SHORTEST, int(_SEGMENT * frames)))
    how = {"nperseg": length, "return_onesided": False, "detrend": "linear", "axis": 0}
    frequency, power = welch(around[:, modes], **how)
    ordered = np.argsort(frequency)
    frequency, power = frequency[ordered], power[ordered]
    up, down = np.flatnonzero(frequency > 0), np.flatnonzero(frequency < 0)[::-1]
    count = min(len(up), len(down))
    rows = []
    for mode in modes:
        anticlockwise, clockwise = power[up[:count], mode], power[down[:count], mode]
        if mode:
            rows += [(mode, clockwise), (-mode, anticlockwise)]
        else:
            rows.append((0, 0.5 * (clockwise + anticlockwise)))
    table = pd.concat(
        [
            pd.DataFrame({"mode": mode, "frequency": frequency[up[:count]], "power": part})
            for mode, part in rows
        ],
        ignore_index=True,
    )
    whole = float(table["power"].sum())
    if not whole > 0.0:
        return table.iloc[:0]
    return table.assign(power=table["power"] / whole).sort_values(["mode", "frequency"], ignore_index=True)

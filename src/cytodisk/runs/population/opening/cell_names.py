"""A short name for each cell of a population, no two alike."""

from __future__ import annotations

import pandas as pd


def cell_names(cells: pd.DataFrame) -> pd.Series[str]:
    """Names of cells: as much of study, file, frame and label as tells them apart.

    Parameters
    ----------
    cells : DataFrame
        Columns input, source, frame and label.

    Returns
    -------
    Series of str
        Such as "day1, cells.tif, frame 3, label 7", or "day1, label 7" for a study of one file.
    """
    parts = []
    if cells["input"].nunique() > 1:
        parts.append(cells["input"])
    if not parts or (cells.groupby("input")["source"].nunique() > 1).any():
        parts.append(cells["source"])
    files = cells.groupby(["input", "source"], sort=False)
    if (files["frame"].nunique() > 1).any():
        parts.append("frame " + cells["frame"].astype(str))
    if (files.size() > 1).any() or len(parts) < 2:
        parts.append("label " + cells["label"].astype(str))
    names = parts[0].astype(str)
    for part in parts[1:]:
        names = names + ", " + part.astype(str)
    twice = names.duplicated(keep=False)
    return names.where(~twice, names + " (" + cells["number"].astype(str) + ")")

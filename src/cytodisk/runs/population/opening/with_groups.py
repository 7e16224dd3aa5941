"""Columns of a table of groups, for cells of finished studies."""

from __future__ import annotations

import os

import numpy as np
import pandas as pd

from cytodisk.runs.groups.groups_file import read_groups


def with_groups(
    cells: pd.DataFrame, groups: str | os.PathLike[str] | None
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Cells with the columns of a table of groups in place of those that they have.

    Parameters
    ----------
    cells : DataFrame
        All cells of the studies, with input, source, label and frame.
    groups : path-like, optional
        See `read_groups`.

    Returns
    -------
    cells : DataFrame
    warnings : tuple of str
        What a user should know of the table, such as cells that no row is about.

    Raises
    ------
    ReadError, ParameterError
        The table cannot be used; all faults are said at once.
    """
    if groups is None:
        return cells, ()
    places = cells[["input", "source", "label", "frame"]].assign(cell=np.arange(len(cells)))
    found = read_groups(groups).match(places)
    joined = pd.concat([cells.drop(columns=[*found.values], errors="ignore"), found.values], axis=1)
    joined.attrs = dict(cells.attrs)
    return joined, found.warnings

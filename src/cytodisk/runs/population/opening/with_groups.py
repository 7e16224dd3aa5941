"""Columns of a table of groups, for cells of finished studies."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from cytodisk.runs.groups.groups_file import read_groups
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.joined_cells import refuse_taken


def with_groups(
    cells: pd.DataFrame, groups: str | os.PathLike[str] | None, studies: Sequence[FoundStudy]
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Cells with the columns of a table of groups in place of those that they have.

    Parameters
    ----------
    cells : DataFrame
        All cells of the studies, with input, source, label and frame.
    groups : path-like, optional
        See `read_groups`.
    studies : sequence of FoundStudy
        Their provenance has the paths of mask files.

    Returns
    -------
    cells : DataFrame
    warnings : tuple of str
        What a user should know of the table, such as cells that no row is about.

    Raises
    ------
    ReadError, ParameterError
        The table cannot be used; all faults are said at once.
    PopulationError
        A column has a name that populations need.
    """
    if groups is None:
        return cells, ()
    places = cells[["input", "source", "label", "frame"]].assign(cell=np.arange(len(cells)))
    by_study = {study.name: study for study in studies}
    files = places[["input", "source"]].drop_duplicates()
    named = zip(files["input"], files["source"], strict=True)
    files["path"] = [_mask_path(by_study[name], source) for name, source in named]
    places["path"] = places[["input", "source"]].merge(files, how="left")["path"].to_numpy()
    table = read_groups(groups)
    refuse_taken(table.names, table.path.name)
    found = table.match(places)
    joined = pd.concat([cells.drop(columns=[*found.values], errors="ignore"), found.values], axis=1)
    joined.attrs = dict(cells.attrs)
    return joined, found.warnings


def _mask_path(study: FoundStudy, source: str) -> str:
    """Where the masks of a study were; empty where its provenance does not say."""
    masks = study.provenance.get("inputs", {}).get("masks", {})
    path = str(masks.get("path", ""))
    return str(Path(path) / source) if path and "files" in masks and study.run != "movie" else path

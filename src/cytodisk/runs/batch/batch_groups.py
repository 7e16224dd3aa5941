"""The table of groups of a batch: read and compared with its inputs before anything runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pandas as pd

from cytodisk.errors import ReadError
from cytodisk.images.mask_names import mask_names
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.input_columns import OWN_COLUMNS
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.runs.groups.groups import WHAT, Groups
from cytodisk.runs.groups.groups_file import read_groups
from cytodisk.runs.groups.known_cells import FILE


def read_batch_groups(path: Path, inputs: Sequence[BatchInput], columns: Sequence[str]) -> Groups:
    """Read the table of groups of a batch.

    Parameters
    ----------
    path : Path
    inputs : sequence of BatchInput
    columns : sequence of str
        Names of the columns that inputs carry.

    Returns
    -------
    Groups

    Raises
    ------
    ReadError, ParameterError
        It cannot be read, is no such table, names files that are none of the inputs, or has a column that the
        batch file fills in, too.
    """
    groups, faults = read_groups(path), Faults()
    for name in groups.names:
        if name in OWN_COLUMNS:
            words = f"column {name!r} is one that the tables have anyway: choose another name"
            faults.add(f"{path.name} line 1", words)
        if name not in columns:
            continue
        place = columns.index(name)
        given = [item.name for item in inputs if item.columns[place] is not None]
        if given:
            words = (
                f"column {name!r} is in the batch file, too, as for input {given[0]}: give it in one of them"
            )
            faults.add(f"{path.name} line 1", words)
    faults.raise_if_any(path, WHAT)
    if FILE in groups.keys:
        groups.check_files(pd.DataFrame(_files(inputs)))
    return groups


def masks_of(item: BatchInput, source: str) -> Path:
    """The file of an input that a row of its table of cells comes from."""
    return item.masks / source if item.kind == "map" and item.masks.is_dir() else item.masks


def _files(inputs: Sequence[BatchInput]) -> Iterator[dict[str, str]]:
    """The mask files of all inputs, as far as their names tell."""
    for item in inputs:
        sources = [item.masks.name]
        if item.kind == "map" and item.masks.is_dir():
            try:
                sources = [file.name for file, _ in mask_names(item.masks)]
            except ReadError:  # which the input's own row tells of
                sources = [""]
        for source in sources:
            yield {"input": item.name, "source": source, "path": str(masks_of(item, source))}

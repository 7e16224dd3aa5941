"""The table of groups of a run over cells of mask files."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import replace

import pandas as pd

from cytodisk.errors import CytodiskError
from cytodisk.images.mask_files import MaskSource, read_source_cells
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.groups.given_groups import GivenGroups
from cytodisk.runs.groups.groups import Groups
from cytodisk.runs.groups.groups_file import read_groups
from cytodisk.runs.groups.known_cells import CELL


def with_groups(inputs: CellInputs, groups: str | os.PathLike[str] | None) -> CellInputs:
    """The files of a run with a table of groups, if one is given.

    Parameters
    ----------
    inputs : CellInputs
    groups : path-like, optional
        See `read_groups`.

    Returns
    -------
    CellInputs
        What a user should know of the groups is among its remarks.

    Raises
    ------
    ReadError, ParameterError
        The table cannot be read, is no such table, or does not fit the cells.
    """
    if groups is None:
        return inputs
    found = read_groups(groups)
    given = GivenGroups(
        found, cells_of(inputs.sources, found), {source.name: source.path for source in inputs.sources}
    )
    return replace(inputs, groups=given, remarks=(*inputs.remarks, *given.found.warnings))


def cells_of(sources: Sequence[MaskSource], groups: Groups) -> pd.DataFrame:
    """The cells of mask files as far as a table of groups asks for them, by `cell`, their number in the run.

    Parameters
    ----------
    sources : sequence of MaskSource
    groups : Groups

    Returns
    -------
    DataFrame
        With `source`, `frame` and `label`.
    """
    rows = list(_cells(sources, CELL in groups.keys))
    return pd.DataFrame(rows, columns=["source", "frame", "label"]).reset_index(names="cell")


def _cells(sources: Sequence[MaskSource], by_label: bool) -> Iterator[tuple[str, int, int]]:
    """Name of the file, frame and label of each cell; 0 where a file or an image holds none."""
    for source in sources:
        look = source.look
        if source.file is None or look is None:
            yield source.name, 0, 0
        elif look.kind == "labels":
            for frame, labels in enumerate(look.labels):
                held = () if isinstance(labels, CytodiskError) else labels
                yield from ((source.name, frame, label) for label in held or (0,))
        elif by_label:  # the value of a mask, which no look tells
            yield from ((source.name, found.frame, found.label) for found in read_source_cells([source]))
        else:
            yield from ((source.name, frame, 1) for frame in range(source.file.n_frames))

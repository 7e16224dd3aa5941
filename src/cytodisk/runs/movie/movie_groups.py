"""The table of groups of a movie's run."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from cytodisk.runs.groups.given_groups import GivenGroups
from cytodisk.runs.groups.groups_file import read_groups
from cytodisk.runs.movie.movie_inputs import MovieInputs


def with_movie_groups(
    inputs: MovieInputs, masks: str | os.PathLike[str], groups: str | os.PathLike[str] | None
) -> MovieInputs:
    """The files of a movie's run with a table of groups, if one is given.

    Parameters
    ----------
    inputs : MovieInputs
    masks : path-like
        As given: a file, a folder or a pattern, whose name is that of the file in the table.
    groups : path-like, optional
        See `read_groups`; `cell` is the cell's label, or its track where labels are linked.

    Returns
    -------
    MovieInputs
        What a user should know of the groups is among its notes.

    Raises
    ------
    ReadError, ParameterError
        The table cannot be read, is no such table, or does not fit the cells.
    """
    if groups is None:
        return inputs
    tracks, frames = inputs.tracks, [len(track.frames) for track in inputs.tracks]
    cells = pd.DataFrame(
        {
            "cell": np.repeat([track.cell for track in tracks], frames),
            "label": np.repeat([track.label for track in tracks], frames),
            "frame": np.concatenate([track.frames for track in tracks]),
        }
    )
    path = Path(masks).absolute()
    return replace(inputs, groups=GivenGroups(read_groups(groups), cells, {path.name: path}))

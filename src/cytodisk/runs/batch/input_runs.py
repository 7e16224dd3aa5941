"""The runs that inputs of a batch can have; with all that maps, so only the process that maps loads it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.cells.cell_inputs import open_inputs
from cytodisk.runs.map.map_study import map_study
from cytodisk.runs.movie.movie_inputs import open_movie
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.movie.movie_study import movie_study
from cytodisk.store.study import Study


def run_of(item: BatchInput, folder: Path) -> Callable[..., Study]:
    """The run of an input, to be called with `resume` or `overwrite`.

    Parameters
    ----------
    item : BatchInput
    folder : Path

    Returns
    -------
    callable
    """
    if isinstance(item.parameters, MovieParameters):
        movie = open_movie(item.masks, item.signal, item.parameters, item.signal_name, item.nuclei)
        return partial(movie_study, movie, folder)
    inputs = open_inputs(item.masks, item.signal, item.parameters, item.signal_name, item.nuclei)
    return partial(map_study, inputs, folder)

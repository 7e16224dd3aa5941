"""Cells of `cytodisk movie` as the parts of a population."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from cytodisk.runs.population.movies.summary_names import OF_CORRELATIONS, OF_PREDICTIONS, OF_WAVES
from cytodisk.runs.population.opening.chosen_scalars import chosen_scalars
from cytodisk.runs.population.opening.common_channels import chosen_channels
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.opening.movie_cells import read_movie_values
from cytodisk.runs.population.opening.opened_cells import OpenedCells, Wanted

_WITHOUT_CHANNELS = ("velocity", *OF_PREDICTIONS, *OF_WAVES)  # or with names that are none


def movie_population(
    studies: Sequence[FoundStudy], cells: pd.DataFrame, frames: pd.DataFrame, wanted: Wanted
) -> OpenedCells:
    """What each cell contributes, areas and directions.

    Parameters
    ----------
    studies : sequence of FoundStudy
        Of `cytodisk movie`, alike.
    cells, frames : DataFrame
        Usable cells; rows of all frames.
    wanted : Wanted

    Returns
    -------
    OpenedCells

    Raises
    ------
    PopulationError
        A channel is missing, no cell has values, or they are of different shapes; a scalar is none.
    """
    channels = wanted.channels
    if wanted.summary not in _WITHOUT_CHANNELS and not (
        channels is None and wanted.summary in OF_CORRELATIONS
    ):
        channels = chosen_channels(studies, channels)
    values, areas, cells = read_movie_values(
        studies, cells, frames, channels, wanted.summary, wanted.left_out
    )
    names = [str(name) for name in values["channel"].values]
    return OpenedCells(values, areas, cells, chosen_scalars(cells, names, wanted.scalars))

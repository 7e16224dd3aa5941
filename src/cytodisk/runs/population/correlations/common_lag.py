"""The longest lag for all movies of a batch."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cytodisk.errors import CytodiskError, PopulationError
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.pooling.batch_movies import BatchMovies
from cytodisk.runs.used_series.chosen_of_study import usual_lag
from cytodisk.store.study import open_study


def common_lag(movies: BatchMovies, min_pairs: int) -> int:
    """The usual longest lag of the movie in the middle: of all movies half are as long, or longer.

    Raises
    ------
    PopulationError
        No study can be read.
    """
    lags = [*_usual_lags(movies.studies, min_pairs)]
    if not lags:
        raise PopulationError(f"no study of batch {movies.folder} can be read: run cytodisk batch again")
    return int(np.median(lags))


def _usual_lags(studies: Sequence[FoundStudy], min_pairs: int) -> Iterator[int]:
    for study in studies:
        try:
            opened = open_study(study.folder)
        except CytodiskError:  # its row says why once it is correlated
            continue
        yield usual_lag(opened, [int(cell) for cell in opened.cells["cell"].unique()], min_pairs)

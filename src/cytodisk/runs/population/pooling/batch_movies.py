"""The movies of a batch whose cells can be pooled, and the group of each of these cells."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.errors import PopulationError
from cytodisk.images.short_lists import shortened
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, names_in
from cytodisk.runs.population.opening.alike_settings import check_alike
from cytodisk.runs.population.opening.found_studies import FoundStudy, find_studies
from cytodisk.runs.population.opening.joined_cells import joined_rows
from cytodisk.runs.population.opening.movie_cells import rows_by_cell
from cytodisk.runs.population.opening.with_groups import with_groups

ALL = "all cells"
"""Condition of cells in a batch that names none."""


@dataclass(frozen=True)
class BatchMovies:
    """Studies of movies in a batch folder.

    Attributes
    ----------
    folder : Path
    studies : tuple of FoundStudy
        Their windows lie at the same places, and their frames are as far apart.
    left_out : tuple of dict
        input, status and reason of the inputs without a study, and of those that are no movies.
    remarks : tuple of str
        What a user should know of the studies together.
    groups : DataFrame
        By input and cell: condition and experiment, as text; empty where they are unknown.
    """

    folder: Path
    studies: tuple[FoundStudy, ...]
    left_out: tuple[dict[str, Any], ...]
    remarks: tuple[str, ...]
    groups: pd.DataFrame


def movies_of(folder: Path, groups: str | os.PathLike[str] | None = None) -> BatchMovies:
    """The movies of a batch.

    Parameters
    ----------
    folder : Path
        Of a batch.
    groups : path-like, optional
        Table of groups, whose columns take the place of those of the batch.

    Raises
    ------
    PopulationError
        It has no movie, or its movies cannot be pooled: their windows differ, or their frame intervals.
    """
    found, without = find_studies(folder)
    movies = [study for study in found if study.run == "movie"]
    others = [_row(study.name, "no movie: nothing in it changes with time") for study in found]
    others = [row for row, study in zip(others, found, strict=True) if study.run != "movie"]
    lost = [_row(str(row["input"]), str(row["reason"])) for row in without.rows]
    if not movies:
        raise PopulationError(f"batch {folder} has no movie: this needs kind = 'movie' in its file")
    remarks = check_alike(movies)
    check_intervals(movies)
    cells, told = with_groups(rows_by_cell(joined_rows(movies)), groups, movies)
    return BatchMovies(folder, tuple(movies), (*lost, *others), (*remarks, *told), _groups(cells))


def _groups(cells: pd.DataFrame) -> pd.DataFrame:
    """Condition and experiment of each cell."""
    condition = names_in(cells, CONDITION)
    if condition.isna().all():
        condition = pd.Series(ALL, index=cells.index)
    return pd.DataFrame(
        {
            "input": cells["input"],
            "cell": cells["number"],
            CONDITION: condition.fillna(""),
            EXPERIMENT: names_in(cells, EXPERIMENT).fillna(""),
        }
    ).reset_index(drop=True)


def check_intervals(studies: Sequence[FoundStudy]) -> None:
    """Refuse movies whose lags are not the same times.

    Raises
    ------
    PopulationError
        Their frame intervals differ: the message says which has what.
    """
    found: dict[float | None, list[str]] = {}
    for study in studies:
        found.setdefault(study.provenance.get("frame_interval_s"), []).append(study.name)
    if len(found) > 1:
        words = "; ".join(
            f"{'unknown' if seconds is None else f'{seconds:g} s'} in {shortened(names)}"
            for seconds, names in found.items()
        )
        raise PopulationError(
            f"movies differ in the frame interval: {words}: their frames are not as far apart; make a "
            "batch of those with one interval, or give the right one with frame_interval_s"
        )


def _row(name: str, reason: str) -> dict[str, Any]:
    return {"input": name, "status": "left out", "reason": reason}

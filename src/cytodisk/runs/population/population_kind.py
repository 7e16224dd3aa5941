"""What `cytodisk population` writes."""

from cytodisk.store.populations.population_columns import population_tables
from cytodisk.store.populations.population_study import RUN
from cytodisk.store.study_kind import StudyKind


def population_kind(curves: bool = False) -> StudyKind:
    """The tables and files of a population's study.

    Parameters
    ----------
    curves : bool
        What is compared is a curve over lags, not the sectors of a disk.

    Returns
    -------
    StudyKind
    """
    tables = population_tables(curves)
    return StudyKind(
        RUN,
        "cytodisk population",
        "open its report.html, or read it with open_population_study",
        tables["cells"],
        {name: columns for name, columns in tables.items() if name != "cells"},
        in_parts=False,
    )

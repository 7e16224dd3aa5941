"""What `cytodisk population` writes."""

from dataclasses import replace

from cytodisk.store.populations.population_columns import TABLES, population_tables
from cytodisk.store.populations.population_study import RUN
from cytodisk.store.study_kind import StudyKind

POPULATION = StudyKind(
    RUN,
    "cytodisk population",
    "open its report.html, or read it with open_population_study",
    TABLES["cells"],
    {name: columns for name, columns in TABLES.items() if name != "cells"},
    in_parts=False,
)
"""Of windows; see `with_tables_of`."""


def with_tables_of(kind: StudyKind, *, curves: bool) -> StudyKind:
    """The kind with the tables that a population has.

    Parameters
    ----------
    kind : StudyKind
    curves : bool
        What is compared is a curve over lags, not the sectors of a disk.

    Returns
    -------
    StudyKind
    """
    tables = population_tables(curves)
    return replace(
        kind,
        cells=tables["cells"],
        others={name: columns for name, columns in tables.items() if name != "cells"},
    )

"""Names of columns that the tables of a run have anyway, so that a user's column must have another."""

from __future__ import annotations

from cytodisk.store.nuclei.nucleus_columns import NUCLEI_COLUMNS, NUCLEUS_COLUMNS
from cytodisk.store.nuclei.nucleus_track_columns import NUCLEUS_TRACK_COLUMNS
from cytodisk.store.nuclei.summary_columns import PLACE_COLUMNS, SIGNAL_REMARKS
from cytodisk.store.tables import (
    CONSISTENCY_COLUMNS,
    EDGE_COLUMNS,
    SOURCE_COLUMNS,
    TRACK_COLUMNS,
)
from cytodisk.store.window_columns import NUCLEUS_WINDOW_COLUMNS, WINDOW_COLUMNS, WINDOW_SIZE_COLUMNS

_CELLS = (*SOURCE_COLUMNS, *TRACK_COLUMNS, *WINDOW_SIZE_COLUMNS)
_OF_NUCLEI = (*NUCLEUS_COLUMNS, *NUCLEI_COLUMNS, *NUCLEUS_WINDOW_COLUMNS, *NUCLEUS_TRACK_COLUMNS)
_OF_SUMMARIES = (*PLACE_COLUMNS, SIGNAL_REMARKS)
_TABLES = (_CELLS, WINDOW_COLUMNS, EDGE_COLUMNS, CONSISTENCY_COLUMNS, _OF_NUCLEI, _OF_SUMMARIES)

TABLE_NAMES = frozenset(column.name for columns in _TABLES for column in columns)
"""Of the tables of maps and movies, but for columns with the name of a channel in them."""
RENAMED = {"replicate": "experiment"}
"""Words of earlier versions, and what a column is called now."""


def renamed_words(name: str) -> str:
    """What to do about a column with a word of earlier versions."""
    return f"column {name!r} is called {RENAMED[name]}: rename it"

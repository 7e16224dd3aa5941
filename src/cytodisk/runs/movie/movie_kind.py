"""What `cytodisk movie` writes."""

from cytodisk.store.nuclei.nucleus_track_columns import NUCLEUS_TRACK_COLUMNS
from cytodisk.store.study_folder import part_patterns
from cytodisk.store.study_kind import ACTIVITY, StudyKind
from cytodisk.store.tables import (
    CELL_COLUMNS,
    CONSISTENCY_COLUMNS,
    EDGE_COLUMNS,
    TRACK_COLUMNS,
)
from cytodisk.store.window_columns import WINDOW_COLUMNS, WINDOW_SIZE_COLUMNS

MOVIE = StudyKind(
    "movie",
    "cytodisk movie",
    "read it with open_study",
    (*CELL_COLUMNS, *WINDOW_SIZE_COLUMNS, *TRACK_COLUMNS),
    {"windows": WINDOW_COLUMNS, "edge": EDGE_COLUMNS, "consistency": CONSISTENCY_COLUMNS},
    (ACTIVITY, *part_patterns("maps/cell_{}.npz", frames=True)),
    NUCLEUS_TRACK_COLUMNS,
)
"""Without nuclei; `MOVIE.with_nuclei` with them."""

"""What `cytodisk map` writes."""

from cytodisk.store.study_folder import part_patterns
from cytodisk.store.study_kind import StudyKind
from cytodisk.store.tables import SOURCE_COLUMNS
from cytodisk.store.window_columns import WINDOW_COLUMNS, WINDOW_SIZE_COLUMNS

MAP = StudyKind(
    "map",
    "cytodisk map",
    "read it with open_study",
    (*SOURCE_COLUMNS, *WINDOW_SIZE_COLUMNS),
    {"windows": WINDOW_COLUMNS},
    tuple(
        pattern
        for name in (
            "maps/cell_{}.npz",
            "maps/cell_{}.geojson",
            *(f"figures/cell_{{}}.{kind}" for kind in ("png", "pdf", "svg")),
        )
        for pattern in part_patterns(name)
    ),
)
"""Without nuclei; `MAP.with_nuclei` with them."""

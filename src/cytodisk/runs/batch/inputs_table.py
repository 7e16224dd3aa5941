"""The table with a row for each input."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.store.tables import Columns

# After the column "input" and those that the user gives.
INPUT_COLUMNS: Columns = (
    ("kind", pa.string(), ""),
    ("masks", pa.string(), ""),
    ("signal", pa.string(), ""),
    ("status", pa.string(), ""),
    ("reason", pa.string(), ""),
    ("cells", pa.int64(), ""),
    ("frames", pa.int64(), ""),
    ("mapped", pa.int64(), ""),
    ("qc_flags", pa.int64(), ""),
    ("pixel_size_um", pa.float64(), "µm"),
    ("frame_interval_s", pa.float64(), "s"),
    ("length_unit", pa.string(), ""),
    ("velocity_unit", pa.string(), ""),
)
OWN_COLUMNS = ("input", *(name for name, _, _ in INPUT_COLUMNS))

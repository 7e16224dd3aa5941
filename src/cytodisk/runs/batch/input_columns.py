"""The table with a row for each input."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.store.tables import Column, Columns

INPUT = Column("input", pa.string(), "", "name of the input in the batch file")
INPUT_COLUMNS: Columns = (
    Column("kind", pa.string(), "", "movie or map"),
    Column("masks", pa.string(), "", "file of the masks"),
    Column("signal", pa.string(), "", "file of the signal; empty if there is none"),
    Column("nuclei", pa.string(), "", "file of the nuclei; empty if there is none"),
    Column(
        "status",
        pa.string(),
        "",
        "ok; refused (you can mend it); failed (unexpected); crashed, killed, timed out or out of memory",
    ),
    Column("reason", pa.string(), "", "why the input has no result; empty if it has one"),
    Column("cells", pa.int64(), "", "number of cells"),
    Column("frames", pa.int64(), "", "number of frames of all cells of a movie; of a map the same as cells"),
    Column("mapped", pa.int64(), "", "number of those that have a map"),
    Column("qc_flags", pa.int64(), "", "number of those that a QC flag names"),
    Column("flags", pa.string(), "", "names of the QC flags of its study; empty if there are none"),
    Column("pixel_size_um", pa.float64(), "µm", "side of a pixel; empty if unknown"),
    Column("frame_interval_s", pa.float64(), "s", "time between frames; empty if unknown"),
    Column("length_unit", pa.string(), "", "unit of lengths in this row: µm or px"),
    Column("velocity_unit", pa.string(), "", "unit of velocities in this row, such as µm/s"),
)
"""Columns after `INPUT` and those that the user gives."""

UNITS = INPUT_COLUMNS[-2:]
OWN_COLUMNS = (INPUT.name, *(column.name for column in INPUT_COLUMNS))

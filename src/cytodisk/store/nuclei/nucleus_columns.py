"""What the tables of a study with nuclei say of them, beside what every study says."""

import pyarrow as pa

from cytodisk.store.tables import CELL, FRAME, LABEL, SOURCE, Column, Columns

N_NUCLEI = Column(
    "n_nuclei",
    pa.int64(),
    "",
    "number of nuclei of the cell; pieces of less than a tenth of the largest do not count",
)
NUCLEI = Column(
    "nuclei", pa.string(), "", "labels of its nuclei in their file, the largest first, as 3 or 3,7"
)
_STATUS = (
    "ok; none; several; partly outside, if more than 10 % of the nucleus lie outside the cell; shared, if "
    "another cell has more than 10 % of it; unusable, if their file cannot be read"
)

NUCLEUS_COLUMNS: Columns = (
    N_NUCLEI,
    NUCLEI,
    Column("nucleus_status", pa.string(), "", _STATUS),
    Column("nucleus_remarks", pa.string(), "", "each change that fitting the nucleus into the cell made"),
    Column("nucleus_area_px", pa.int64(), "px²", "area of the nucleus as it was mapped, in pixels"),
    Column("nucleus_dropped_px", pa.int64(), "px²", "area of specks and of other nuclei that were left out"),
    Column("nucleus_filled_px", pa.int64(), "px²", "area of the holes of the nucleus that were filled"),
    Column("nucleus_outside_px", pa.int64(), "px²", "area of the nucleus outside the cell, clipped"),
    Column(
        "nucleus_clipped_px",
        pa.int64(),
        "px²",
        "area of the nucleus that was clipped because it touched the cell's edge",
    ),
    Column(
        "nucleus_clipped_share",
        pa.float64(),
        "1",
        "share of the nuclear outline as it came that lay at the cell's edge or outside",
    ),
    Column("nucleus_joined_px", pa.int64(), "px²", "area of the paths that join several nuclei"),
)
"""Of the table of cells."""

NUCLEI_COLUMNS: Columns = (
    CELL._replace(meaning="number of the cell in this run; empty for a nucleus that no cell holds"),
    SOURCE,
    FRAME,
    LABEL._replace(meaning="value of the cell in its label image; empty for a nucleus that no cell holds"),
    NUCLEI,
    N_NUCLEI,
    Column("overlap", pa.float64(), "1", "share of the nuclei's area that lies inside the cell"),
    Column("status", pa.string(), "", f"{_STATUS}; or no cell"),
    Column("reason", pa.string(), "", "what the status means here; empty for ok"),
)
"""Of the table of nuclei: a row for each cell, and one for each nucleus that no cell holds."""

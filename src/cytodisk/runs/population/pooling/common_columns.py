"""Columns that the tables of all pooled results have."""

from __future__ import annotations

import pyarrow as pa

from cytodisk.runs.batch.input_columns import INPUT
from cytodisk.store.populations.place_columns import CONDITION, CONTROL, EXPERIMENT
from cytodisk.store.tables import CELL, Column, Columns

N_CELLS = Column("n_cells", pa.int64(), "", "number of cells with a value")
N_EXPERIMENTS = Column("n_experiments", pa.int64(), "", "number of experiments with a value")
SMALLEST_P = Column("smallest_p", pa.float64(), "1", "smallest p that this number of experiments can reach")

OF_CELL: Columns = (INPUT, CELL, CONDITION, EXPERIMENT)
"""Which cell a row is of."""

STUDIES: Columns = (
    INPUT,
    Column(
        "status",
        pa.string(),
        "",
        "ok: done now; kept: from before; refused, or left out: the reason says why",
    ),
    Column("reason", pa.string(), "", "why the study has no result; empty if it has one"),
    Column("cells", pa.int64(), "", "number of its cells that are pooled"),
)
"""One row an input of the batch."""

STATUS: Columns = (
    Column("status", pa.string(), "", "ok, refused by the command, or left out of the pool"),
    Column("reason", pa.string(), "", "why the cell is left out; empty if it is not"),
    Column("qc_flags", pa.string(), "", "names of its QC flags, with ; between"),
)
"""How each cell went."""

COMPARED: Columns = (CONDITION._replace(meaning="the condition that is compared with the control"), CONTROL)
"""Which conditions a row compares."""

DIFFERENCE: Columns = (
    Column("difference_low", pa.float64(), "1", "lower end of its 95 % interval"),
    Column("difference_high", pa.float64(), "1", "upper end of its 95 % interval"),
    Column("n_control", pa.int64(), "", "number of experiments of the control with a value"),
    Column("n_treated", pa.int64(), "", "number of experiments of the condition with a value"),
    Column("p", pa.float64(), "1", "share of relabelled experiments with at least such a difference"),
    Column(
        "p_fwer",
        pa.float64(),
        "1",
        "the same for the largest of all rows of the two conditions: up to 0.05 they differ",
    ),
    SMALLEST_P,
    Column(
        "p_holm",
        pa.float64(),
        "1",
        "p_fwer corrected for the number of conditions that are compared with the control (Holm)",
    ),
    Column("comparisons", pa.int64(), "", "number of conditions that were compared with the control"),
)
"""Of a difference between conditions."""

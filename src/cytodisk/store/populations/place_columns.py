"""Columns that several tables of a population share: which condition, channel and window a row is about."""

import pyarrow as pa

from cytodisk.store.tables import CHANNEL, Column, Columns

SIGNAL = "signal"
"""Unit of a column that has that of the compared values: "a.u.", or "1" where each cell was normalised."""

CONDITION = Column("condition", pa.string(), "", "what was done to the cells")
TREATED = CONDITION._replace(meaning="the condition that is compared with the control")
CONTROL = Column("control", pa.string(), "", "the condition that it is compared with")
EXPERIMENT = Column(
    "experiment",
    pa.string(),
    "",
    "the independent repetition (day, dish, animal) that the cell is from; empty if it is unknown",
)
COMPARTMENT = Column(
    "compartment", pa.string(), "", "nucleus, cytoplasm, or cell where cells were mapped without a nucleus"
)
LAYER = Column("layer", pa.int64(), "", "layer of the window: 0 is at the cell's edge, numbers grow inwards")
SECTOR = Column(
    "sector",
    pa.int64(),
    "",
    "sector of the window; 0 starts at the direction that cells are aligned by, else as in the maps",
)
LAG = Column("lag", pa.float64(), "lag", "lag of the curve, or time after the event")
DEPTH = Column(
    "depth",
    pa.float64(),
    "length",
    "distance of the layer to the cell's edge: median over cells of the median of their windows; empty if it "
    "is unknown",
)
WINDOW: Columns = (CHANNEL, COMPARTMENT, LAYER, SECTOR)
"""Which window of which channel; of curves `LAG` stands in the place of `SECTOR`."""

PAIR: Columns = (TREATED, CONTROL)
"""Which two conditions are compared."""

EFFECT: Columns = (
    Column(
        "effect_size",
        pa.float64(),
        "1",
        "difference in standard deviations of the experiments' means (Hedges' g), treated minus control",
    ),
    Column("low", pa.float64(), "1", "lower end of the 95 % interval of effect_size"),
    Column("high", pa.float64(), "1", "upper end of the 95 % interval of effect_size"),
)


def p_values(of: str) -> Columns:
    """The columns of probabilities of a test.

    Parameters
    ----------
    of : str
        What is tested together, as "windows and channels of this comparison".
    """
    return (
        Column(
            "p",
            pa.float64(),
            "1",
            "share of relabelled experiments with at least such a difference; of this row alone",
        ),
        Column(
            "p_fwer",
            pa.float64(),
            "1",
            f"the same for the largest difference of all {of} (max-T): at most 0.05 is significant",
        ),
        Column(
            "q", pa.float64(), "1", f"false discovery rate (Benjamini and Hochberg) over all {of}, from p"
        ),
    )

"""The columns of all tables of a population's study."""

import pyarrow as pa

from cytodisk.store.populations.place_columns import (
    CONDITION,
    DEPTH,
    EFFECT,
    EXPERIMENT,
    LAG,
    PAIR,
    SECTOR,
    SIGNAL,
    WINDOW,
    p_values,
)
from cytodisk.store.tables import CHANNEL, Column, Columns

HOLM = Column("p_holm", pa.float64(), "1", "")

CELL_COLUMNS: Columns = (
    CONDITION,
    EXPERIMENT,
    Column("cell", pa.string(), "", "name of the cell"),
    Column("direction", pa.float64(), "°", "direction of the cell that it was aligned by, in the disk"),
    Column("strength", pa.float64(), "1", "how clear that direction is: from 0, none, to 1"),
    Column("shift", pa.float64(), "", "number of sectors that the cell was turned by"),
    Column(
        "alignment", pa.string(), "", "aligned, not asked for, or why the cell has no direction to align by"
    ),
    Column(
        "distance_to_mean",
        pa.float64(),
        "1",
        "how far the cell's windows are from the mean of its condition: root mean square over windows, each "
        "in standard deviations over cells; about 1 for a typical cell",
    ),
    Column(
        "left_out", pa.string(), "", "why the cell is in no mean and in no test; empty for one that is used"
    ),
)
"""What the table of cells has in any case: the user's columns and the scalars stand beside it."""

ATLAS_COLUMNS: Columns = (
    CONDITION,
    *WINDOW,
    DEPTH,
    Column("mean", pa.float64(), SIGNAL, "mean over experiments of each experiment's mean over its cells"),
    Column("sd", pa.float64(), SIGNAL, "standard deviation over cells"),
    Column("sem", pa.float64(), SIGNAL, "standard error of the mean, over experiments"),
    Column("n_cells", pa.int64(), "", "number of cells with a value in this window"),
    Column("n_experiments", pa.int64(), "", "number of experiments with such a cell"),
)

WINDOW_COLUMNS: Columns = (
    *PAIR,
    *WINDOW,
    Column("mean_control", pa.float64(), SIGNAL, "mean over the control's experiments"),
    Column("mean_treated", pa.float64(), SIGNAL, "mean over the treated condition's experiments"),
    Column("difference", pa.float64(), SIGNAL, "mean_treated minus mean_control"),
    Column("difference_low", pa.float64(), SIGNAL, "lower end of the 95 % interval of difference"),
    Column("difference_high", pa.float64(), SIGNAL, "upper end of the 95 % interval of difference"),
    *EFFECT,
    Column("score", pa.float64(), "1", "the statistic that is tested: difference over its standard error"),
    *p_values("windows and channels of this comparison"),
    HOLM._replace(meaning="p_fwer corrected for all conditions that are compared with the control (Holm)"),
    Column("cluster", pa.int64(), "", "number of the cluster that the window is in; 0 for none"),
    Column("n_control", pa.int64(), "", "number of experiments of the control with a value here"),
    Column("n_treated", pa.int64(), "", "number of experiments of the treated condition with a value here"),
    Column("status", pa.string(), "", "ok, or why the window is not tested"),
)

CLUSTER_COLUMNS: Columns = (
    *PAIR,
    CHANNEL,
    Column("cluster", pa.int64(), "", "number of the cluster in this comparison, from 1"),
    Column("sign", pa.int64(), "", "1 where the treated cells have more signal, -1 where they have less"),
    Column("mass", pa.float64(), "1", "sum of the statistic over the cluster's windows"),
    Column(
        "p",
        pa.float64(),
        "1",
        "share of relabelled experiments whose largest cluster has at least this mass: at most 0.05 is "
        "significant; corrected for all clusters and channels of this comparison",
    ),
    HOLM._replace(meaning="p corrected for all conditions that are compared with the control (Holm)"),
    Column("n_windows", pa.int64(), "", "number of its windows"),
    Column("layers", pa.string(), "", "its layers, as 0-2"),
    Column("sectors", pa.string(), "", "its sectors, as 12-25; 55-3 goes on over the last. Lags of curves"),
    Column("difference", pa.float64(), SIGNAL, "treated minus control, mean over its windows"),
)

SCALAR_COLUMNS: Columns = (
    *PAIR,
    Column("scalar", pa.string(), "", "what is compared: a column of the table of cells"),
    CHANNEL._replace(meaning="name of the channel that it was measured in; empty for none"),
    Column("what", pa.string(), "", "what it is, in words"),
    Column("unit", pa.string(), "", "its unit"),
    Column("mean_control", pa.float64(), "", "mean over the control's experiments; see unit"),
    Column("mean_treated", pa.float64(), "", "mean over the treated condition's experiments; see unit"),
    Column("difference", pa.float64(), "", "treated minus control; see unit"),
    Column("difference_low", pa.float64(), "", "lower end of the 95 % interval of difference"),
    Column("difference_high", pa.float64(), "", "upper end of the 95 % interval of difference"),
    *EFFECT,
    *p_values("scalars of this comparison"),
    HOLM._replace(meaning="p_fwer corrected for all conditions that are compared with the control (Holm)"),
    Column("n_control", pa.int64(), "", "number of experiments of the control with a value"),
    Column("n_treated", pa.int64(), "", "number of experiments of the treated condition with a value"),
    Column("status", pa.string(), "", "ok, or why the scalar is not tested"),
)

PROFILE_COLUMNS: Columns = (
    CONDITION,
    EXPERIMENT,
    CHANNEL,
    WINDOW[1],
    WINDOW[2],
    DEPTH,
    Column("mean", pa.float64(), SIGNAL, "mean of the layer over the experiment's cells of this condition"),
    Column("sd", pa.float64(), SIGNAL, "standard deviation over these cells"),
    Column("n_cells", pa.int64(), "", "number of these cells"),
)

EXPERIMENT_COLUMNS: Columns = (
    CONDITION,
    EXPERIMENT,
    Column("cells", pa.int64(), "", "number of cells of this condition in this experiment"),
    Column("used", pa.bool_(), "", "whether the experiment is in the tests"),
    Column("reason", pa.string(), "", "why it is not; empty if it is"),
)

LEFT_OUT_COLUMNS: Columns = (
    *PAIR,
    Column("left_out", pa.string(), "", "the experiment that is left out"),
    Column("result", pa.string(), "", "what is compared without it: a scalar, a cluster, or windows"),
    Column("difference", pa.float64(), "", "treated minus control, with all experiments"),
    Column("difference_without", pa.float64(), "", "treated minus control, without this experiment"),
    Column("p_without", pa.float64(), "1", "probability without it, of this number alone, not corrected"),
)

COMPARISON_COLUMNS: Columns = (
    *PAIR,
    Column("channels", pa.string(), "", "the channels that are tested together, with commas between"),
    Column("unit", pa.string(), "", "experiment, or cell: what counts as independent"),
    Column(
        "design",
        pa.string(),
        "",
        "paired, where each experiment has both conditions, or unpaired; not tested, where there is no test",
    ),
    Column("n_control", pa.int64(), "", "number of experiments (or cells, see unit) of the control"),
    Column("n_treated", pa.int64(), "", "the same of the treated condition"),
    Column("smallest_p", pa.float64(), "1", "smallest probability that this number can reach at all"),
    Column(
        "smallest_p_holm",
        pa.float64(),
        "1",
        "the same after the correction for all conditions that are compared with the control (Holm)",
    ),
    Column("windows_tested", pa.int64(), "", "number of windows, all channels, that are tested"),
    Column("windows_found", pa.int64(), "", "number of these that differ, p_holm at most 0.05"),
    Column("clusters_found", pa.int64(), "", "number of clusters with p_holm at most 0.05"),
    Column("scalars_found", pa.int64(), "", "number of scalars with p_holm at most 0.05"),
    Column("smallest_found", pa.float64(), "1", "smallest p_fwer of all windows"),
    HOLM._replace(
        meaning="smallest_found corrected for all conditions that are compared with the control (Holm)"
    ),
    Column("finding", pa.string(), "", "what was found, in a sentence with its numbers"),
)

_STEP = "for one step of the dose (see dose_scale)"
_TREND: Columns = (
    Column("slope", pa.float64(), SIGNAL, f"change {_STEP}"),
    Column("slope_low", pa.float64(), SIGNAL, "lower end of the 95 % interval of slope"),
    Column("slope_high", pa.float64(), SIGNAL, "upper end of the 95 % interval of slope"),
    Column("correlation", pa.float64(), "1", "correlation of the means of experiments with the dose"),
)
TREND_COLUMNS: Columns = (
    *WINDOW,
    *_TREND,
    *p_values("windows and channels of the trend"),
    Column("cluster", pa.int64(), "", "number of the cluster that the window is in; 0 for none"),
    Column("n_units", pa.int64(), "", "number of experiments and doses with a value here"),
    Column("status", pa.string(), "", "ok, or why the window is not tested"),
)

SCALAR_TREND_COLUMNS: Columns = (
    Column("scalar", pa.string(), "", "what follows the dose: a column of the table of cells"),
    CHANNEL._replace(meaning="name of the channel that it was measured in; empty for none"),
    *(column._replace(unit="") for column in _TREND),
    *p_values("scalars of the trend"),
    Column("n_units", pa.int64(), "", "number of experiments and doses with a value"),
    Column("status", pa.string(), "", "ok, or why the scalar is not tested"),
)

GALLERY_COLUMNS: Columns = (
    CONDITION,
    EXPERIMENT,
    Column("cell", pa.string(), "", "name of the cell"),
    Column("row", pa.int64(), "", "row of the cell in the table of cells, from 0"),
    Column("place", pa.string(), "", "nearest, or farthest: of the mean of its condition"),
    Column("rank", pa.int64(), "", "1 for the nearest, or the farthest, of its condition"),
    *WINDOW,
    Column("value", pa.float64(), SIGNAL, "value of the window, normalised and aligned as in the atlas"),
)

EXCLUDED_COLUMNS: Columns = (
    Column("input", pa.string(), "", "name of the study that it is from"),
    Column("source", pa.string(), "", "name of its mask file"),
    Column("frame", pa.int64(), "", "number of its frame, from 0; empty for a file as a whole"),
    Column("label", pa.int64(), "", "value of the cell in its label image; empty for a file as a whole"),
    Column("reason", pa.string(), "", "why it is not in the population"),
)
"""Cells and files of the studies that are in no row of the table of cells."""

WARNING_COLUMNS: Columns = (
    *PAIR,
    Column("name", pa.string(), "", "name of the warning"),
    Column("finding", pa.string(), "", "what was found"),
    Column("consequence", pa.string(), "", "what it means for the result"),
    Column("remedy", pa.string(), "", "what to do"),
)

TABLES: dict[str, Columns] = {
    "cells": CELL_COLUMNS,
    "atlas": ATLAS_COLUMNS,
    "windows": WINDOW_COLUMNS,
    "clusters": CLUSTER_COLUMNS,
    "scalars": SCALAR_COLUMNS,
    "profiles": PROFILE_COLUMNS,
    "experiments": EXPERIMENT_COLUMNS,
    "left_out": LEFT_OUT_COLUMNS,
    "comparisons": COMPARISON_COLUMNS,
    "trends": TREND_COLUMNS,
    "scalar_trends": SCALAR_TREND_COLUMNS,
    "gallery": GALLERY_COLUMNS,
    "excluded": EXCLUDED_COLUMNS,
    "warnings": WARNING_COLUMNS,
}
"""Columns of every table, by its name. All tables are there in every study; some may have no rows."""


def population_tables(curves: bool) -> dict[str, Columns]:
    """Columns of every table.

    Parameters
    ----------
    curves : bool
        What is compared is a curve over lags, not the sectors of a disk.

    Returns
    -------
    dict of str to tuple of Column
        By name of the table.
    """
    if not curves:
        return TABLES
    return {
        name: tuple(LAG if column is SECTOR else column for column in columns)
        for name, columns in TABLES.items()
    }

"""QC flags of the numbers of nucleus and cytoplasm: no direction, no ratio, background that was left in."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.analysis.compartments.nucleus_place import LEAST_OFFSET_PX
from cytodisk.number_words import rounded
from cytodisk.runs.qc_flags.column_flags import ColumnRule
from cytodisk.runs.qc_flags.qc_flag import QCFlag, frames_of, mapped_rows, places_of
from cytodisk.store.nuclei.summary_columns import (
    CYTOPLASM_MEAN,
    DARKEST_AROUND,
    RATIO,
    SIGNAL_REMARKS,
    channels_among,
    column_of,
)
from cytodisk.store.study import Study

LARGEST_BACKGROUND = 0.1
"""Darkest places around the cells, over the mean of their cytoplasm, above which ratios are drawn to 1."""

nucleus_in_the_middle = ColumnRule(
    "nucleus in the middle",
    "the nucleus has no direction in {frames}",
    f"The centroids of cell and nucleus are less than {LEAST_OFFSET_PX:g} px apart: which side the nucleus "
    "is on is left to the pixels. nucleus_direction and signal_direction are empty.",
    "Leave these rows out where directions count, also with --align nucleus.",
    "nucleus_offset",
    lambda column, scale: column < scale.length(LEAST_OFFSET_PX),
    lambda value, row, scale: f"{rounded(value)} {scale.length_unit} apart",
)


def no_ratio(study: Study) -> Iterator[QCFlag]:
    """Cells with a nucleus in which a channel has no ratio of nucleus to cytoplasm, or no shares."""
    rows = mapped_rows(study)
    columns = [
        column_of(number, channel)
        for channel in channels_among(map(str, study.cells))
        for number in (RATIO, "perinuclear_share")
    ]
    if not columns or "nucleus_area" not in rows:
        return
    rows = rows[rows["nucleus_area"].notna() & rows[columns].isna().any(axis=1)]
    if len(rows):
        yield QCFlag(
            "no nucleus ratio",
            f"a ratio of nucleus to cytoplasm, or a share of the cytoplasm, is missing in "
            f"{frames_of(study, len(rows))}",
            "A mean is 0 or below, windows have no number, or layers are too wide for thirds.",
            "Subtract less background; mend pixels without a number; use 3 layers of cytoplasm or more.",
            places_of(rows, lambda row: str(row[SIGNAL_REMARKS.name])),
        )


def background(study: Study) -> Iterator[QCFlag]:
    """Channels whose background is still in the ratio of nucleus to cytoplasm."""
    rows = mapped_rows(study)
    found = {channel: _background(rows, channel) for channel in channels_among(map(str, study.cells))}
    told = [
        f"{channel} {share:.0%}" for channel, share in found.items() if share > LARGEST_BACKGROUND
    ]  # of one without a number nothing is known
    if told:
        yield QCFlag(
            "background",
            f"no place around the cells is dark, next to their cytoplasm: {', '.join(told)} of its mean",
            "If that is background, it is in both means and draws the ratio of nucleus to cytoplasm to 1, "
            "and shares of the cytoplasm to 1/3. If cells fill the image, its background cannot be seen.",
            "Subtract the mean of a place without cells from each channel, and run again. Or take it off in "
            "the table: (nucleus_mean − background) / (cytoplasm_mean − background).",
        )


def _background(rows: Any, channel: str) -> float:
    """Darkest place around any cell over the median of the cytoplasm's means; NaN if there is none."""
    around = rows[column_of(DARKEST_AROUND, channel)]
    mean = rows[column_of(CYTOPLASM_MEAN, channel)].median()
    return float(around.min() / mean) if mean > 0 else np.nan
